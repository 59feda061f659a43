// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/clash_report.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <variant>

#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {
namespace {

std::string quoted(const std::string& text) {
    return compact(nlohmann::ordered_json(text));
}

/// Returns the mean of a pair, rounded to three digits.
double seconds_per_pair(const ClashCounts& counts) {
    if (counts.queried == 0) return 0;
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.2e",
                  counts.seconds / static_cast<double>(counts.queried));
    return std::strtod(text.data(), nullptr);
}

}  // namespace

void ClashCounts::add(const ClashCounts& other) noexcept {
    queried += other.queried;
    clashes += other.clashes;
    undecided += other.undecided;
    seconds += other.seconds;
}

ClashReport::ClashReport(Ask effect, AnswerFormat format) : effect_(effect), format_(format) {}

std::string ClashReport::begin() const {
    return format_ == AnswerFormat::json ? "{\"clashes\": [" : "";
}

std::string ClashReport::line(const std::string& a, const std::string& b,
                              const cli::ClashAnswer& answer) const {
    return std::visit(
        [&](const auto& found) {
            if (format_ == AnswerFormat::text) {
                return printable(a) + " and " + printable(b) + answer_words(found) + "\n";
            }
            const std::string object = "{\"a\": " + quoted(a) + ", \"b\": " + quoted(b) +
                                       ", \"effect\": \"" + find_needs(effect_)->name + "\"" +
                                       answer_members(found) + "}";
            return format_ == AnswerFormat::json ? ",\n " + object : object + "\n";
        },
        answer);
}

std::string ClashReport::next(std::string lines) {
    if (format_ == AnswerFormat::json && is_first_ && !lines.empty()) {
        is_first_ = false;
        lines.erase(0, 1);  // the comma
    }
    return lines;
}

std::string ClashReport::finish(const ClashSummary& summary) const {
    switch (format_) {
        case AnswerFormat::text:
            return summary_text(summary);
        case AnswerFormat::json:
            return "],\n\"summary\": " + summary_json(summary) + "}\n";
        default:
            return "{\"summary\": " + summary_json(summary) + "}\n";
    }
}

const char* ClashReport::limit_name() const noexcept {
    if (effect_ == Ask::overlap) return nullptr;
    return effect_ == Ask::within ? "tolerance" : "max_distance";
}

std::string ClashReport::summary_json(const ClashSummary& summary) const {
    nlohmann::ordered_json json = {{"scene", summary.scene},
                                   {"version", CDPREP_VERSION},
                                   {"effect", find_needs(effect_)->name},
                                   {"objects", summary.objects},
                                   {"models", summary.models},
                                   {"pairs_possible", summary.possible},
                                   {"candidates", summary.candidates},
                                   {"queried", summary.counts.queried},
                                   {"clashes", summary.counts.clashes},
                                   {"undecided", summary.counts.undecided}};
    if (const char* limit = limit_name()) json[limit] = summary.largest;
    json["rounding"] = summary.rounding;
    json["seconds_per_pair"] = seconds_per_pair(summary.counts);
    return compact(json);
}

std::string ClashReport::summary_text(const ClashSummary& summary) const {
    const ClashCounts& counts = summary.counts;
    std::string text = counted(summary.objects, "object", "objects") + " of " +
                       counted(summary.models, "model", "models") + ", " +
                       counted(summary.possible, "possible pair", "possible pairs") + ": " +
                       counted(summary.candidates, "candidate", "candidates") + ", " +
                       std::to_string(counts.queried) + " queried, " +
                       counted(counts.clashes, "clash", "clashes");
    if (counts.undecided > 0) text += ", " + std::to_string(counts.undecided) + " undecided";
    if (const char* limit = limit_name()) {
        text += std::string("; ") + limit + " " + number_text(summary.largest);
    }
    if (summary.rounding > 0) {
        text += "; transforms were rounded to rigid ones by " + number_text(summary.rounding);
    }
    return text + "; " + number_text(seconds_per_pair(counts)) + " s a pair\n";
}

}  // namespace cdprep::report
