// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/inaccessible_report.h"

namespace cdprep::report {
namespace {

std::string list(std::span<const std::uint32_t> numbers, const char* comma) {
    std::string text;
    for (const std::uint32_t number : numbers) {
        if (!text.empty()) text += comma;
        text += std::to_string(number);
    }
    return text;
}

std::string sentence(const InaccessibleAnswer& answer) {
    std::string text = std::to_string(answer.count) + " of " + std::to_string(answer.triangles) +
                       " triangles cannot be reached straight towards the centre";
    if (answer.edge_on > 0) {
        text += "; " + std::to_string(answer.edge_on) + " lie edge-on to it and are left out";
    }
    return text + ".\n";
}

}  // namespace

std::string inaccessible_text(const InaccessibleAnswer& answer, AnswerFormat format) {
    if (format == AnswerFormat::text) {
        std::string text = sentence(answer);
        if (answer.numbers && !answer.numbers->empty()) text += list(*answer.numbers, "\n") + "\n";
        return text;
    }
    std::string text = "{\"count\": " + std::to_string(answer.count) +
                       ", \"edge_on\": " + std::to_string(answer.edge_on) +
                       ", \"triangles\": " + std::to_string(answer.triangles);
    if (answer.numbers) text += ", \"inaccessible\": [" + list(*answer.numbers, ", ") + "]";
    return text + "}\n";
}

}  // namespace cdprep::report
