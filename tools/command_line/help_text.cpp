// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/help_text.h"

#include <CLI/CLI.hpp>
#include <memory>

namespace cdprep::cli {
namespace {

constexpr std::size_t kWidth = 80;
constexpr std::size_t kTextColumn = 28;  ///< where descriptions begin

/// Returns "-o, --output FILE". A long name without a short one is aligned with other long names.
std::string names_of(const OptionEntry& option) {
    std::string text;
    for (const std::string& name : option.names) text += (text.empty() ? "" : ", ") + name;
    if (text.starts_with("--")) text.insert(0, 4, ' ');
    if (!option.value.empty() && text.find('-') != std::string::npos) text += " " + option.value;
    return text + (option.is_repeatable && !text.starts_with(' ') && text[0] != '-' ? "..." : "");
}

/// Returns a term and its text. The text begins on the same line if the term is short.
std::string row(const std::string& term, const std::string& text) {
    std::string rows = "  " + term;
    const bool is_long = rows.size() + 2 > kTextColumn;
    if (is_long) rows += '\n';
    bool is_first = !is_long;
    for (const std::string& line : wrapped(text, kWidth - kTextColumn)) {
        rows += std::string(kTextColumn - (is_first ? rows.size() : 0), ' ') + line + '\n';
        is_first = false;
    }
    if (rows.back() != '\n') rows += '\n';
    return rows;
}

std::string section(const std::string& title, const std::vector<OptionEntry>& options) {
    if (options.empty()) return "";
    std::string text = "\n" + title + ":\n";
    for (const OptionEntry& option : options) text += row(names_of(option), full_text(option));
    return text;
}

std::string paragraphs(const std::string& notes) {
    std::string text;
    std::size_t begin = 0;
    while (begin < notes.size()) {
        const std::size_t end = std::min(notes.find("\n\n", begin), notes.size());
        text += '\n';
        for (const std::string& line : wrapped(notes.substr(begin, end - begin), kWidth)) {
            text += line + '\n';
        }
        begin = end + 2;
    }
    return text;
}

class HelpFormatter : public CLI::FormatterBase {
public:
    std::string make_help(const CLI::App* command, std::string name,
                          CLI::AppFormatMode /*mode*/) const override {
        const std::string full = name.empty() ? command->get_name() : name;
        return help_text(page_of(Command(*const_cast<CLI::App*>(command)), full));
    }
};

}  // namespace

std::string help_text(const CommandPage& page) {
    std::string text = "Usage: " + page.usage() + "\n\n" + page.summary + ".\n";
    if (!page.commands.empty()) {
        text += "\nCommands:\n";
        for (const auto& [name, summary] : page.commands) text += row(name, summary + ".");
    }
    text += section("Inputs", page.inputs);
    for (const OptionGroup& group : page.groups) text += section(group.title, group.options);
    text += paragraphs(page.notes);
    if (!page.examples.empty()) text += "\nExamples:\n";
    for (const std::string& example : page.examples) text += "  " + example + '\n';
    return text;
}

void use_help_text(CLI::App& program) {
    const auto formatter = std::make_shared<HelpFormatter>();
    const auto use = [&](const auto& again, CLI::App& command) -> void {
        command.formatter(formatter);
        for (CLI::App* each : command.get_subcommands([](const CLI::App*) { return true; })) {
            again(again, *each);
        }
    };
    use(use, program);
}

}  // namespace cdprep::cli
