// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "command_line/command_line.h"

namespace cdprep::cli {

/// An option or an input, as help, man pages, completion and tables show it.
struct OptionEntry {
    std::vector<std::string> names;  ///< "-o", "--output"; for an input only its name: "INPUT"
    std::string value;               ///< "FILE"; empty for a flag
    std::vector<std::string> words;  ///< the allowed values of a choice or list; else empty
    bool is_list = false;            ///< several words may be given, separated by commas
    std::string range;               ///< "1 to 4096"; empty if no value is excluded
    std::string text;                ///< a sentence without its period
    std::string preset;              ///< the default as typed; empty if there is none
    bool is_required = false;
    bool is_repeatable = false;
};

struct OptionGroup {
    std::string title;
    std::vector<OptionEntry> options;
};

/// All texts about a command. The option tree of the program is their only source.
struct CommandPage {
    std::string name;                                           ///< "cdprep query collide"
    std::string summary;                                        ///< a phrase: "Query baked files"
    std::vector<std::pair<std::string, std::string>> commands;  ///< names and summaries
    std::vector<OptionEntry> inputs;
    std::vector<OptionGroup> groups;
    std::string notes;                  ///< paragraphs between empty lines, or empty
    std::vector<std::string> examples;  ///< command lines

    /// "cdprep hull [OPTION]... INPUT".
    [[nodiscard]] std::string usage() const;
};

/// Returns the page of a command whose full name is `name`.
[[nodiscard]] CommandPage page_of(const Command& command, const std::string& name);

/// Returns the pages of a program and all its commands. A command follows its parent.
[[nodiscard]] std::vector<CommandPage> pages_of(const Command& program);

/// Returns `text` in lines of at most `width` columns; words are not cut.
[[nodiscard]] std::vector<std::string> wrapped(const std::string& text, std::size_t width);

/// Returns the text of an option with its allowed values and its default, one sentence each.
[[nodiscard]] std::string full_text(const OptionEntry& option);

}  // namespace cdprep::cli
