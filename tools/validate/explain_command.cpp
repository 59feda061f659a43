// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "cli/command.h"
#include "command_line/command_page.h"
#include "text/json_layout.h"
#include "validate/defects/rule.h"
#include "validate/rule_settings.h"
#include "validate/severity_name.h"

namespace cdprep::cli {
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

/// Returns a text for people: definition, effect, repair and method of decision of a rule.
std::string explain_text(const mesh::RuleText& rule) {
    std::string text = mesh::id_of(rule.rule) + " " + rule.name + " (" +
                       report::severity_name(rule.severity) + "): " + rule.title + "\n\n";
    text += paragraph("Means", rule.meaning) + paragraph("Matters", rule.why) +
            paragraph("Remedy", rule.remedy) + paragraph("Decided", rule.decided);
    return *rule.measure == '\0' ? text : text + paragraph("Measure", rule.measure);
}

/// Returns one line per rule: id, severity, name, title.
std::string rule_list_text(std::span<const mesh::RuleText> rules) {
    std::string text;
    for (const mesh::RuleText& rule : rules) {
        std::string severity = report::severity_name(rule.severity);
        severity.resize(std::string_view("warning ").size(), ' ');
        text += mesh::id_of(rule.rule) + " " + severity + rule.name + ": " + rule.title + "\n";
    }
    return text;
}

/// Returns all texts as JSON: {"rules": [...]}.
std::string explain_json(std::span<const mesh::RuleText> rules) {
    nlohmann::ordered_json json = {{"rules", nlohmann::ordered_json::array()}};
    for (const mesh::RuleText& rule : rules) {
        json["rules"].push_back({{"rule", mesh::id_of(rule.rule)},
                                 {"name", rule.name},
                                 {"severity", report::severity_name(rule.severity)},
                                 {"title", rule.title},
                                 {"meaning", rule.meaning},
                                 {"why", rule.why},
                                 {"remedy", rule.remedy},
                                 {"decided", rule.decided},
                                 {"measure", rule.measure}});
    }
    return report::laid_out(json, 0) + "\n";
}

struct ExplainArguments {
    std::string rule;
    std::string format = "text";
};

Exit run(const ExplainArguments& arguments) {
    const bool is_json = arguments.format == "json";
    if (arguments.rule.empty()) {
        std::cout << (is_json ? explain_json(mesh::all_rules())
                              : rule_list_text(mesh::all_rules()));
        return Exit::success;
    }
    const auto rule = mesh::find_rule(arguments.rule);
    if (!rule) {
        return fail("explain", {ErrorCode::bad_argument, report::unknown_rule(arguments.rule)});
    }
    const mesh::RuleText& text = mesh::text_of(*rule);
    std::cout << (is_json ? explain_json({&text, 1}) : explain_text(text));
    return Exit::success;
}

}  // namespace

void add_explain(const Command& app, Exit& exit) {
    auto arguments = std::make_shared<ExplainArguments>();
    const Command command = app.add_command("explain", "Explain a rule of 'cdprep validate'");
    command.set_notes("", {"cdprep explain", "cdprep explain CDP0203"});
    command.add_option("rule", arguments->rule,
                       "An id such as CDP0203, or a name such as sliver. Default: list all rules");
    add_report_format(command, arguments->format);
    command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace cdprep::cli
