// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "command_line/exit_codes.h"
#include "command_line/write_manuals.h"

namespace cdprep::cli {
namespace {

/// Returns the text escaped so that troff finds no request and no escape in it.
std::string plain(const std::string& text) {
    std::string out;
    for (const char letter : text) {
        if (letter == '\\') {
            out += "\\e";
        } else if (letter == '-') {
            out += "\\-";
        } else {
            out += letter;
        }
    }
    return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

/// Returns the name of a page: "cdprep-query" for "cdprep query".
std::string page_name(std::string name) {
    std::ranges::replace(name, ' ', '-');
    return name;
}

std::string bold(const std::string& text) {
    return "\\fB" + plain(text) + "\\fR";
}

std::string option_term(const OptionEntry& option) {
    std::string text;
    for (const std::string& name : option.names) text += (text.empty() ? "" : ", ") + bold(name);
    if (!option.value.empty() && option.names.front().starts_with('-')) {
        text += " \\fI" + plain(option.value) + "\\fR";
    }
    return text;
}

std::string options_section(const std::string& title, const std::vector<OptionEntry>& options) {
    if (options.empty()) return "";
    std::string text = ".SS " + plain(title) + "\n";
    for (const OptionEntry& option : options) {
        text += ".TP\n" + option_term(option) + "\n" + plain(full_text(option)) + "\n";
    }
    return text;
}

}  // namespace

std::string man_page(const CommandPage& page, const std::string& version) {
    std::string title = page_name(page.name);
    for (char& letter : title) {
        if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
    }
    std::string text = ".TH " + plain(title) + " 1 \"\" \"cdprep " + version + "\"\n";
    text += ".SH NAME\n" + plain(page_name(page.name)) + " \\- " + plain(page.summary) + "\n";
    text += ".SH SYNOPSIS\n" + bold(page.usage()) + "\n";
    if (!page.notes.empty()) {
        text += ".SH DESCRIPTION\n";
        std::size_t begin = 0;
        while (begin < page.notes.size()) {
            const std::size_t end = std::min(page.notes.find("\n\n", begin), page.notes.size());
            for (const std::string& line : wrapped(page.notes.substr(begin, end - begin), 90)) {
                text += plain(line) + "\n";
            }
            if (end < page.notes.size()) text += ".PP\n";
            begin = end + 2;
        }
    }
    if (!page.commands.empty()) {
        text += ".SH COMMANDS\n";
        for (const auto& [name, summary] : page.commands) {
            text += ".TP\n" + bold(page_name(page.name) + "-" + name) + "(1)\n" + plain(summary) +
                    ".\n";
        }
    }
    text += ".SH OPTIONS\n" + options_section("Inputs", page.inputs);
    for (const OptionGroup& group : page.groups)
        text += options_section(group.title, group.options);
    if (!page.examples.empty()) {
        text += ".SH EXAMPLES\n.nf\n";
        for (const std::string& example : page.examples) text += plain(example) + "\n";
        text += ".fi\n";
    }
    text += ".SH EXIT STATUS\n";
    for (const ExitText& each : kExitTexts) {
        text += ".TP\n" + bold(std::to_string(static_cast<int>(each.code))) + "\n" +
                plain(each.text) + "\n";
    }
    const std::size_t parent = page.name.rfind(' ');
    if (parent != std::string::npos) {
        text += ".SH SEE ALSO\n" + bold(page_name(page.name.substr(0, parent))) + "(1)\n";
    }
    return text;
}

}  // namespace cdprep::cli
