// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/explain.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "text/json_layout.h"
#include "validate/severity_name.h"

namespace cdprep::report {
namespace {

constexpr std::size_t kLineLength = 78;
constexpr std::size_t kLabel = 10;  ///< columns

/// Returns a paragraph after its label, broken at spaces.
std::string paragraph(std::string label, std::string_view text) {
    label.resize(kLabel, ' ');
    std::string result = label;
    std::size_t column = kLabel;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        if (column > kLabel && column + 1 + end > kLineLength) {
            result += '\n';
            result.append(kLabel, ' ');
            column = kLabel;
        } else if (column > kLabel) {
            result += ' ';
            ++column;
        }
        result += text.substr(0, end);
        column += end;
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return result + "\n";
}

}  // namespace

std::string explain_text(const mesh::RuleText& rule) {
    std::string text = mesh::id_of(rule.rule) + " " + rule.name + " (" +
                       severity_name(rule.severity) + "): " + rule.title + "\n\n";
    text += paragraph("Means", rule.meaning) + paragraph("Matters", rule.why) +
            paragraph("Remedy", rule.remedy) + paragraph("Decided", rule.decided);
    return *rule.measure == '\0' ? text : text + paragraph("Measure", rule.measure);
}

std::string rule_list_text(std::span<const mesh::RuleText> rules) {
    std::string text;
    for (const mesh::RuleText& rule : rules) {
        std::string severity = severity_name(rule.severity);
        severity.resize(std::string_view("warning ").size(), ' ');
        text += mesh::id_of(rule.rule) + " " + severity + rule.name + ": " + rule.title + "\n";
    }
    return text;
}

std::string explain_json(std::span<const mesh::RuleText> rules) {
    nlohmann::ordered_json json = {{"rules", nlohmann::ordered_json::array()}};
    for (const mesh::RuleText& rule : rules) {
        json["rules"].push_back({{"rule", mesh::id_of(rule.rule)},
                                 {"name", rule.name},
                                 {"severity", severity_name(rule.severity)},
                                 {"title", rule.title},
                                 {"meaning", rule.meaning},
                                 {"why", rule.why},
                                 {"remedy", rule.remedy},
                                 {"decided", rule.decided},
                                 {"measure", rule.measure}});
    }
    return laid_out(json, 0) + "\n";
}

}  // namespace cdprep::report
