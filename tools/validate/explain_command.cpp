// SPDX-License-Identifier: GPL-3.0-or-later
#include <iostream>
#include <memory>
#include <string>

#include "cli/command.h"
#include "command_line/command_page.h"
#include "validate/explain.h"
#include "validate/rule_settings.h"

namespace cdprep::cli {
namespace {

struct ExplainArguments {
    std::string rule;
    std::string format = "text";
};

Exit run(const ExplainArguments& arguments) {
    const bool is_json = arguments.format == "json";
    if (arguments.rule.empty()) {
        std::cout << (is_json ? report::explain_json(mesh::all_rules())
                              : report::rule_list_text(mesh::all_rules()));
        return Exit::success;
    }
    const auto rule = mesh::find_rule(arguments.rule);
    if (!rule) {
        return fail("explain", {ErrorCode::bad_argument, report::unknown_rule(arguments.rule)});
    }
    const mesh::RuleText& text = mesh::text_of(*rule);
    std::cout << (is_json ? report::explain_json({&text, 1}) : report::explain_text(text));
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
