// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/command_page.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

namespace cdprep::cli {
namespace {

/// The line between notes and examples. CLI11 keeps both as one text after a command's options.
constexpr const char* kExamples = "Examples:";

/// Returns where the line between notes and examples begins, or npos without examples. Notes may
/// hold its word too, so the last whole line counts.
std::size_t find_examples(const std::string& footer) {
    return ("\n" + footer).rfind("\n" + std::string(kExamples) + "\n");
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
    return parts;
}

std::string upper(std::string word) {
    for (char& letter : word) {
        if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
    }
    return word;
}

/// Returns the placeholder for people for a type name of CLI11.
std::string placeholder(const std::string& type) {
    if (type == "UINT" || type == "INT") return "N";
    if (type == "FLOAT") return "NUMBER";
    return type;
}

OptionEntry entry_of(const CLI::Option& option) {
    OptionEntry entry;
    if (option.get_positional()) {
        entry.names = {upper(option.get_name())};
    } else {
        for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
        for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
    }
    const std::string type = option.get_type_name();  // with the words that the checks add
    const std::size_t colon = type.find(':');
    if (option.get_type_size_max() > 0) entry.value = placeholder(type.substr(0, colon));
    const std::string allowed = colon == std::string::npos ? "" : type.substr(colon + 1);
    entry.is_list = allowed.starts_with('[');
    if (allowed.starts_with('{') || entry.is_list) {
        entry.words = split(allowed.substr(1, allowed.size() - 2), '|');
    } else if (allowed != "DIR") {  // CLI::ExistingDirectory
        entry.range = allowed;
    }
    entry.text = option.get_description();
    entry.preset = option.get_default_str();
    entry.is_required = option.get_required();
    entry.is_repeatable = option.get_items_expected_max() > 1;
    return entry;
}

/// Returns true if the description has a clause "word: meaning" for each allowed word.
bool explains_all(const OptionEntry& option) {
    return std::ranges::all_of(option.words, [&](const std::string& word) {
        return option.text.find(word + ": ") != std::string::npos;
    });
}

/// Returns "a, b or c" for a choice and "a list of a, b, c" for a list.
std::string words_text(const OptionEntry& option) {
    std::string text = option.is_list ? "a list of " : "";
    const std::string last = option.is_list ? ", " : " or ";
    for (std::size_t i = 0; i < option.words.size(); ++i) {
        text += (i == 0 ? "" : i + 1 == option.words.size() ? last : ", ") + option.words[i];
    }
    return text;
}

}  // namespace

std::string CommandPage::usage() const {
    std::string text = name;
    if (!groups.empty()) text += " [OPTION]...";
    if (!commands.empty()) text += " COMMAND";
    for (const OptionEntry& input : inputs) {
        const std::string word = input.names.front() + (input.is_repeatable ? "..." : "");
        text += input.is_required ? " " + word : " [" + word + "]";
    }
    return text;
}

CommandPage page_of(const Command& described, const std::string& name) {
    const CLI::App& command = described.app();
    CommandPage page;
    page.name = name;
    page.summary = command.get_description();
    for (const CLI::App* each : command.get_subcommands([](const CLI::App*) { return true; })) {
        page.commands.emplace_back(each->get_name(), each->get_description());
    }
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_group().empty()) continue;
        if (option->get_positional()) {
            page.inputs.push_back(entry_of(*option));
            continue;
        }
        const std::string& title = option->get_group();
        auto group = std::ranges::find(page.groups, title, &OptionGroup::title);
        if (group == page.groups.end()) group = page.groups.insert(group, {title, {}});
        group->options.push_back(entry_of(*option));
    }
    // The options of every command come last; CLI11 adds them first.
    const auto general = std::ranges::find(page.groups, "General", &OptionGroup::title);
    if (general != page.groups.end()) std::rotate(general, general + 1, page.groups.end());
    const std::string footer = command.get_footer();
    const std::size_t begin = find_examples(footer);
    page.notes = footer.substr(0, begin);
    while (!page.notes.empty() && page.notes.back() == '\n') page.notes.pop_back();
    if (begin != std::string::npos) {
        for (const std::string& line : split(footer.substr(begin), '\n')) {
            if (line.starts_with("  ")) page.examples.push_back(line.substr(2));
        }
    }
    return page;
}

std::vector<CommandPage> pages_of(const Command& program) {
    std::vector<CommandPage> pages;
    const auto add = [&](const auto& again, const Command& command,
                         const std::string& name) -> void {
        pages.push_back(page_of(command, name));
        for (const Command& each : command.commands()) again(again, each, name + " " + each.name());
    };
    add(add, program, program.name());
    return pages;
}

void Command::set_notes(const std::string& notes, const std::vector<std::string>& examples) const {
    std::string footer = notes;
    if (!examples.empty()) footer += (notes.empty() ? "" : "\n\n") + std::string(kExamples);
    for (const std::string& example : examples) footer += "\n  " + example;
    app_->footer(footer);
}

std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
    std::vector<std::string> lines;
    std::string line;
    std::istringstream stream(text);
    for (std::string word; stream >> word;) {
        if (!line.empty() && line.size() + 1 + word.size() > width) {
            lines.push_back(line);
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    if (!line.empty()) lines.push_back(line);
    return lines;
}

std::string full_text(const OptionEntry& option) {
    std::string text = option.text;
    if (!text.empty() && !text.ends_with('.')) text += '.';
    const bool is_input = !option.names.front().starts_with('-');
    std::vector<std::string> limits;
    if (!explains_all(option)) limits.push_back(words_text(option));
    if (!option.range.empty()) limits.push_back(option.range);
    if (!option.preset.empty()) limits.push_back("default " + option.preset);
    if (option.is_required && !is_input) limits.emplace_back("required");
    if (limits.empty()) return text;
    text += " [";
    for (const std::string& limit : limits) text += (text.ends_with('[') ? "" : "; ") + limit;
    return text + "]";
}

}  // namespace cdprep::cli
