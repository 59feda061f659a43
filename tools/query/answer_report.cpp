// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/answer_report.h"

#include <array>
#include <charconv>
#include <cmath>
#include <ostream>

#include "text/number_text.h"

// This file writes JSON by hand. There may be millions of pairs, and scripts may rely on the blank
// after each comma and colon.

namespace cdprep::report {
namespace {

template <class Number>
void append(std::string& text, Number value) {
    std::array<char, 32> digits;  // the shortest form of a double takes at most 24
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text.append(digits.data(), end.ptr);
}

template <class Number>
std::string number(Number value) {
    std::string text;
    append(text, value);
    return text;
}

/// Returns a member of a JSON object after others. JSON has no infinity, so an infinite number is
/// left out: of points and rays with coordinates near the limit of doubles.
std::string finite_member(const char* name, double value) {
    return std::isfinite(value) ? std::string(", \"") + name + "\": " + number(value) : "";
}

const char* word(Answer answer) {
    switch (answer) {
        case Answer::no:
            return "no";
        case Answer::yes:
            return "yes";
        default:
            return "unknown";
    }
}

const char* word(bool yes) {
    return yes ? "true" : "false";
}

std::string place(const Double3& p, const char* between) {
    return number(p.x) + between + number(p.y) + between + number(p.z);
}

/// The separators around pairs: `row_begin` 17 `between` 4 `row_end`, with `comma` between two
/// pairs.
struct PairStyle {
    const char* row_begin;
    const char* between;
    const char* row_end;
    const char* comma;
};

std::string pairs_text(std::span<const TrianglePair> pairs, const PairStyle& style) {
    std::string text;
    text.reserve(pairs.size() * 16);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (i > 0) text += style.comma;
        text += style.row_begin;
        append(text, pairs[i].a);
        text += style.between;
        append(text, pairs[i].b);
        text += style.row_end;
    }
    return text;
}

std::string crossings_json(std::span<const Crossing> crossings) {
    std::string pairs, segments;
    for (const Crossing& crossing : crossings) {
        if (!pairs.empty()) {
            pairs += ", ";
            segments += ", ";
        }
        pairs += '[';
        append(pairs, crossing.pair.a);
        pairs += ", ";
        append(pairs, crossing.pair.b);
        pairs += ']';
        if (crossing.is_flat) {
            segments += "null";
            continue;
        }
        segments += '[';
        segments += place(crossing.from, ", ");
        segments += ", ";
        segments += place(crossing.to, ", ");
        segments += ']';
    }
    return ", \"pairs\": [" + pairs + "], \"segments\": [" + segments + "]";
}

std::string crossings_text(std::span<const Crossing> crossings) {
    std::string text;
    for (const Crossing& crossing : crossings) {
        text += "\n  ";
        append(text, crossing.pair.a);
        text += ' ';
        append(text, crossing.pair.b);
        if (crossing.is_flat) {
            text += " flat";
            continue;
        }
        text += " from ";
        text += place(crossing.from, " ");
        text += " to ";
        text += place(crossing.to, " ");
    }
    return text;
}

/// Returns the members "count" and "pairs", each only if the answer has it.
template <class Answer>
std::string count_and_pairs_json(const Answer& answer) {
    std::string text;
    if (answer.count) text += ", \"count\": " + number(*answer.count);
    if (answer.pairs) {
        text += ", \"pairs\": [" + pairs_text(*answer.pairs, {"[", ", ", "]", ", "}) + "]";
    }
    return text;
}

/// Returns the pairs, each on its own line, or "" if there is no list.
std::string pair_lines(const std::optional<std::span<const TrianglePair>>& pairs) {
    return pairs ? pairs_text(*pairs, {"\n  ", " ", "", ""}) : "";
}

std::string as_json(const CoarseAnswer& answer) {
    const CoarseCollision& collision = answer.collision;
    return "{\"pose\": " + number(answer.pose) + ", \"answer\": \"" + word(collision.answer) +
           "\", \"approximate\": true, \"error_a\": " + number(collision.error_a) +
           ", \"error_b\": " + number(collision.error_b) + "}";
}

std::string as_text(const CoarseAnswer& answer) {
    const CoarseCollision& collision = answer.collision;
    const std::string text = "pose " + number(answer.pose) +
                             ": solids collide: " + word(collision.answer) +
                             ", approximate: the surfaces are at most ";
    return text + number(collision.error_a) + " and " + number(collision.error_b) +
           " away from the facets";
}

std::string as_json(const HullCollideAnswer& answer) {
    return "{\"pose\": " + number(answer.pose) + ", \"hit\": " + word(answer.hit) +
           ", \"approximate\": true}";
}

std::string as_text(const HullCollideAnswer& answer) {
    return "pose " + number(answer.pose) +
           (answer.hit ? ": hulls touch, approximate: the models may not touch" : ": no contact");
}

std::string as_json(const HullDistanceAnswer& answer) {
    std::string text =
        "{\"pose\": " + number(answer.pose) + ", \"found\": " + word(answer.distance.has_value());
    if (answer.distance) {
        const ConvexDistance& d = *answer.distance;
        text += ", \"lower\": " + number(d.lower) + ", \"upper\": " + number(d.upper) +
                ", \"witness_a\": [" + place(d.witness_a, ", ") + "], \"witness_b\": [" +
                place(d.witness_b, ", ") + "]";
    }
    return text + ", \"approximate\": true}";
}

std::string as_text(const HullDistanceAnswer& answer) {
    const std::string text = "pose " + number(answer.pose) + ": ";
    if (!answer.distance) return text + "nothing within the limit";
    const ConvexDistance& d = *answer.distance;
    return text + "distance of hulls " + number(d.lower) + " to " + number(d.upper) + ", at " +
           place(d.witness_a, " ") + " and " + place(d.witness_b, " ") +
           ", approximate: the models may be farther apart";
}

const char* word(FeatureKind kind) {
    switch (kind) {
        case FeatureKind::vertex:
            return "vertex";
        case FeatureKind::edge:
            return "edge";
        default:
            return "face";
    }
}

std::string as_json(const ContactFeature& feature) {
    std::string text = std::string("{\"kind\": \"") + word(feature.kind) +
                       "\", \"triangle\": " + number(feature.triangle);
    if (feature.kind == FeatureKind::vertex) text += ", \"vertex\": " + number(feature.vertex);
    if (feature.kind == FeatureKind::edge) {
        text += ", \"edge\": " + number(static_cast<unsigned>(feature.edge));
    }
    return text + "}";
}

std::string as_json(const Contact& contact) {
    std::string text =
        "{\"id\": [" + number(contact.id >> 32) + ", " + number(contact.id & 0xffffffffU) +
        "], \"piece_a\": " + number(contact.piece_a) + ", \"piece_b\": " + number(contact.piece_b) +
        ", \"members\": " + number(contact.members) + ", \"lower\": " + number(contact.lower) +
        ", \"upper\": " + number(contact.upper) +
        ", \"overlap\": " + word((contact.flags & contact_overlap) != 0) +
        ", \"internal_edge\": " + word((contact.flags & contact_internal_edge) != 0) +
        ", \"from_behind\": " + word((contact.flags & contact_from_behind) != 0) +
        ", \"deep\": " + word((contact.flags & contact_deep) != 0) + ", \"normal\": [" +
        place(contact.normal, ", ") + "], \"feature_a\": " + as_json(contact.feature_a) +
        ", \"feature_b\": " + as_json(contact.feature_b) + ", \"point_a\": [" +
        place(contact.point_a, ", ") + "], \"point_b\": [" + place(contact.point_b, ", ") + "]";
    if (contact.point_count == 0) return text + "}";
    text += ", \"points\": [";
    for (std::uint32_t i = 0; i < contact.point_count; ++i) {
        const ManifoldPoint& point = contact.points[i];
        text += std::string(i > 0 ? ", " : "") + "{\"on_a\": [" + place(point.on_a, ", ") +
                "], \"on_b\": [" + place(point.on_b, ", ") +
                "], \"distance\": " + number(point.distance) + ", \"id\": \"" +
                hexadecimal(point.id) + "\"}";
    }
    return text + "]}";
}

std::string as_json(const ContactsAnswer& answer) {
    std::string text = "{\"pose\": " + number(answer.pose) +
                       ", \"count\": " + number(answer.contacts.size()) +
                       ", \"found\": " + number(answer.verdict.found) +
                       ", \"computed\": " + number(answer.verdict.computed) +
                       ", \"work\": " + number(answer.verdict.work) +
                       ", \"searched\": " + word(answer.verdict.searched) +
                       ", \"complete\": " + word(answer.verdict.complete) + ", \"contacts\": [";
    for (std::size_t i = 0; i < answer.contacts.size(); ++i) {
        text += (i > 0 ? ", " : "") + as_json(answer.contacts[i]);
    }
    return text + "]}";
}

std::string as_text(const ContactFeature& feature) {
    const std::string triangle = number(feature.triangle);
    switch (feature.kind) {
        case FeatureKind::vertex:
            return "vertex " + number(feature.vertex);
        case FeatureKind::edge:
            return "edge " + number(static_cast<unsigned>(feature.edge)) + " of triangle " +
                   triangle;
        default:
            return "triangle " + triangle;
    }
}

std::string as_text(const ContactsAnswer& answer) {
    std::string text = "pose " + number(answer.pose) + ": " +
                       counted(answer.contacts.size(), "contact", "contacts");
    if (!answer.verdict.complete) {
        text += " of " + number(answer.verdict.found) +
                (answer.verdict.searched ? " found" : " found before the budget ended the search");
    }
    for (const Contact& contact : answer.contacts) {
        text += "\n  pieces " + number(contact.piece_a) + " and " + number(contact.piece_b) +
                ": distance " + number(contact.lower) + " to " + number(contact.upper) +
                ((contact.flags & contact_deep) != 0 ? ", enclosed" : "") + ", normal " +
                place(contact.normal, " ") + ", " + as_text(contact.feature_a) + " and " +
                as_text(contact.feature_b) + ", at " + place(contact.point_a, " ") + " and " +
                place(contact.point_b, " ") +
                (contact.members > 1 ? ", " + number(contact.members) + " joined" : "");
        for (std::uint32_t i = 0; i < contact.point_count; ++i) {
            const ManifoldPoint& point = contact.points[i];
            text += "\n    " + number(point.distance) + " from " + place(point.on_a, " ") + " to " +
                    place(point.on_b, " ");
        }
    }
    return text;
}

std::string as_json(const InsideAnswer& answer) {
    return "{\"point\": " + number(answer.point) + ", \"inside\": \"" +
           word(answer.inclusion.answer) +
           "\", \"on_surface\": " + word(answer.inclusion.on_surface) +
           ", \"winding\": " + number(answer.inclusion.winding) + "}";
}

std::string as_text(const InsideAnswer& answer) {
    return "point " + number(answer.point) + ": inside " + word(answer.inclusion.answer) +
           (answer.inclusion.on_surface ? ", on the surface"
                                        : ", winding " + number(answer.inclusion.winding));
}

std::string as_json(const ClosestAnswer& answer) {
    std::string text =
        "{\"point\": " + number(answer.point) + ", \"found\": " + word(answer.closest.has_value());
    if (answer.closest) {
        text += finite_member("lower", answer.closest->lower) +
                finite_member("upper", answer.closest->upper) +
                ", \"triangle\": " + number(answer.closest->triangle) + ", \"at\": [" +
                place(answer.closest->point, ", ") + "]";
    }
    return text + "}";
}

std::string as_text(const ClosestAnswer& answer) {
    const std::string text = "point " + number(answer.point) + ": ";
    if (!answer.closest) return text + "nothing";
    return text + "distance " + number(answer.closest->lower) + " to " +
           number(answer.closest->upper) + ", triangle " + number(answer.closest->triangle) +
           ", at " + place(answer.closest->point, " ");
}

std::string as_json(const RayAnswer& answer) {
    std::string text =
        "{\"ray\": " + number(answer.ray) + ", \"hit\": " + word(answer.hit.has_value());
    if (answer.hit) {
        text += finite_member("t", answer.hit->t) +
                ", \"triangle\": " + number(answer.hit->triangle) + ", \"at\": [" +
                place(answer.hit->point, ", ") + "]";
    }
    return text + "}";
}

std::string as_text(const RayAnswer& answer) {
    const std::string text = "ray " + number(answer.ray) + ": ";
    if (!answer.hit) return text + "free";
    return text + "hit at t " + number(answer.hit->t) + ", triangle " +
           number(answer.hit->triangle) + ", at " + place(answer.hit->point, " ");
}

}  // namespace

std::string answer_members(const PairAnswer& answer) {
    std::string text = std::string(", \"hit\": ") + word(answer.hit);
    if (answer.is_approximate) text += ", \"approximate\": true";
    text += count_and_pairs_json(answer);
    if (answer.crossings) text += crossings_json(*answer.crossings);
    if (answer.containment) {
        text += std::string(", \"containment\": \"") + word(answer.containment->answer) +
                "\", \"winding\": " + number(answer.containment->winding);
    }
    return text;
}

std::string answer_words(const PairAnswer& answer) {
    const bool is_unknown =
        !answer.hit && answer.containment && answer.containment->answer == Answer::unknown;
    std::string text = answer.hit ? ": hit" : is_unknown ? ": unknown" : ": free";
    if (answer.count) text += ", " + number(*answer.count) + " pairs";
    if (answer.is_approximate) text += ", approximate: some may be missing";
    if (answer.containment) {
        text += std::string(", containment ") + word(answer.containment->answer);
    }
    text += pair_lines(answer.pairs);
    if (answer.crossings) text += crossings_text(*answer.crossings);
    return text;
}

std::string answer_members(const DistanceAnswer& answer) {
    std::string text = std::string(", \"found\": ") + word(answer.distance.has_value());
    if (answer.distance) {
        const Distance& d = *answer.distance;
        text += ", \"lower\": " + number(d.lower) + ", \"upper\": " + number(d.upper) +
                ", \"witness_a\": [" + place(d.witness_a, ", ") + "], \"witness_b\": [" +
                place(d.witness_b, ", ") + "], \"triangle_a\": " + number(d.triangle_a) +
                ", \"triangle_b\": " + number(d.triangle_b);
    }
    return text;
}

std::string answer_words(const DistanceAnswer& answer) {
    if (!answer.distance) return ": nothing within the limit";
    const Distance& d = *answer.distance;
    return ": distance " + number(d.lower) + " to " + number(d.upper) + ", triangles " +
           number(d.triangle_a) + " and " + number(d.triangle_b) + ", at " +
           place(d.witness_a, " ") + " and " + place(d.witness_b, " ");
}

std::string answer_members(const WithinAnswer& answer) {
    return std::string(", \"within\": ") + word(answer.within) + count_and_pairs_json(answer);
}

std::string answer_words(const WithinAnswer& answer) {
    std::string text = answer.within ? ": within" : ": farther";
    if (answer.count) text += ", " + number(*answer.count) + " pairs";
    return text + pair_lines(answer.pairs);
}

namespace {

/// Returns an answer that begins with its pose.
template <class Answer>
std::string of_pose(const Answer& answer, AnswerFormat format) {
    const std::string pose = number(answer.pose);
    if (format == AnswerFormat::text) return "pose " + pose + answer_words(answer);
    return "{\"pose\": " + pose + answer_members(answer) + "}";
}

}  // namespace

void Answers::add(const PairAnswer& answer) {
    write(of_pose(answer, format_));
}

void Answers::add(const CoarseAnswer& answer) {
    write(format_ == AnswerFormat::text ? as_text(answer) : as_json(answer));
}
void Answers::add(const DistanceAnswer& answer) {
    write(of_pose(answer, format_));
}

void Answers::add(const HullCollideAnswer& answer) {
    write(format_ == AnswerFormat::text ? as_text(answer) : as_json(answer));
}

void Answers::add(const HullDistanceAnswer& answer) {
    write(format_ == AnswerFormat::text ? as_text(answer) : as_json(answer));
}

void Answers::add(const WithinAnswer& answer) {
    write(of_pose(answer, format_));
}

void Answers::add(const ContactsAnswer& answer) {
    write(format_ == AnswerFormat::text ? as_text(answer) : as_json(answer));
}

void Answers::add(const InsideAnswer& answer) {
    write(format_ == AnswerFormat::text ? as_text(answer) : as_json(answer));
}

void Answers::add(const ClosestAnswer& answer) {
    write(format_ == AnswerFormat::text ? as_text(answer) : as_json(answer));
}

void Answers::add(const RayAnswer& answer) {
    write(format_ == AnswerFormat::text ? as_text(answer) : as_json(answer));
}

void Answers::finish() {
    if (format_ == AnswerFormat::json) out_ << (is_first_ ? "[]\n" : "]\n");
    out_.flush();
}

void Answers::write(const std::string& answer) {
    if (format_ == AnswerFormat::json) {
        out_ << (is_first_ ? "[" : ",\n ") << answer;
        is_first_ = false;
        return;
    }
    out_ << answer << '\n';
}

}  // namespace cdprep::report
