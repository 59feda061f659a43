// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/answer_report.h"

#include <nlohmann/json.hpp>

namespace cdprep::report {
namespace {

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

/// Written by hand, with a blank after each comma: pairs come by the million.
std::string pairs_text(std::span<const TrianglePair> pairs) {
    std::string text = "[";
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (i > 0) text += ", ";
        text += '[';
        text += std::to_string(pairs[i].a);
        text += ", ";
        text += std::to_string(pairs[i].b);
        text += ']';
    }
    return text + "]";
}

std::string as_json(const PairAnswer& answer) {
    std::string text = "{\"pose\": " + std::to_string(answer.pose) +
                       ", \"hit\": " + (answer.hit ? "true" : "false");
    if (answer.count) text += ", \"count\": " + std::to_string(*answer.count);
    if (answer.pairs) text += ", \"pairs\": " + pairs_text(*answer.pairs);
    if (answer.containment) {
        text += std::string(", \"containment\": \"") + word(answer.containment->answer) + "\"";
        text += ", \"winding\": " + nlohmann::json(answer.containment->winding).dump();
    }
    return text + "}";
}

std::string as_text(const PairAnswer& answer) {
    std::string text = "pose " + std::to_string(answer.pose) + ": ";
    text += answer.hit ? "hit" : "free";
    if (answer.count) text += ", " + std::to_string(*answer.count) + " pairs";
    if (answer.containment)
        text += std::string(", containment ") + word(answer.containment->answer);
    if (answer.pairs) {
        for (const TrianglePair& pair : *answer.pairs) {
            text += "\n  " + std::to_string(pair.a) + " " + std::to_string(pair.b);
        }
    }
    return text;
}

}  // namespace

const char* answers_begin(AnswerFormat format) {
    return format == AnswerFormat::json ? "[" : "";
}

const char* answers_between(AnswerFormat format) {
    return format == AnswerFormat::json ? ",\n " : "\n";
}

const char* answers_end(AnswerFormat format) {
    return format == AnswerFormat::json ? "]\n" : "\n";
}

std::string answer(const PairAnswer& answer, AnswerFormat format) {
    return format == AnswerFormat::text ? as_text(answer) : as_json(answer);
}

}  // namespace cdprep::report
