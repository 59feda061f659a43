// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/usage.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "text/nearest_word.h"
#include "text/printable.h"

namespace cdprep::cli {
namespace {

/// The command that the arguments select. `name` includes its parents: "cdprep query collide".
struct Reached {
    const CLI::App* command;
    std::string name;
};

bool any_command(const CLI::App* /*command*/) {
    return true;
}

Reached reached(const CLI::App& app) {
    Reached at{&app, app.get_name()};
    for (;;) {
        const auto chosen = at.command->get_subcommands();
        if (chosen.empty()) return at;
        at = {chosen.front(), at.name + " " + chosen.front()->get_name()};
    }
}

/// Returns the command that the words name. CLI11 has not read them yet, so the value of an option
/// may count as a command too.
Reached command_named(const CLI::App& app, std::span<const char* const> words) {
    Reached at{&app, app.get_name()};
    for (const char* const word : words) {
        for (const CLI::App* sub : at.command->get_subcommands(any_command)) {
            if (sub->get_name() != word) continue;
            at = {sub, at.name + " " + word};
            break;
        }
    }
    return at;
}

std::vector<std::string> command_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::App* sub : command.get_subcommands(any_command)) {
        names.push_back(sub->get_name());
    }
    return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

std::string unknown_option(const Reached& at, const std::string& word) {
    const std::string name = word.substr(0, word.find('='));
    const auto close = report::suggestion(name, option_names(*at.command));
    return at.name + ": " + in_quotes(name) + " is not an option of this command." +
           (close.empty() ? " '" + at.name + " --help' lists all." : close);
}

std::string unknown_command(const Reached& at, const std::string& word) {
    const auto close = report::suggestion(word, command_names(*at.command));
    return at.name + ": " + in_quotes(word) + " is not a command." +
           (close.empty() ? " Choose from " + listed(command_names(*at.command), "and") + "."
                          : close);
}

bool is_option(const std::string& word) {
    return word.size() > 1 && word[0] == '-';
}

/// Returns the command with its inputs: "cdprep query ray model".
std::string with_inputs(const Reached& at) {
    std::string text = at.name;
    for (const CLI::Option* option : at.command->get_options()) {
        if (option->get_positional()) text += " " + option->get_name();
    }
    return text;
}

/// Returns the option or input of that name; null if the command has none.
const CLI::Option* option_of(const CLI::App& command, const std::string& name) {
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_name() == name) return option;
    }
    return nullptr;
}

/// Returns "--rays is required: A file with rays ...", or "b is required: ... Usage: 'cdprep query
/// collide a b'." for an input.
std::string required(const Reached& at, const std::string& name) {
    const CLI::Option* option = option_of(*at.command, name);
    if (option == nullptr) return name + " is required.";
    const std::string text = name + " is required: " + option->get_description() + ".";
    return option->get_positional() ? text + " Usage: '" + with_inputs(at) + "'." : text;
}

/// Returns a message of CLI11 as a sentence of ours: "--parts: 'x' is not a number." for
/// "Could not convert: --parts = x".
std::string as_sentence(const Reached& at, std::string text) {
    constexpr std::string_view kRequired = " is required";
    if (text.ends_with(kRequired)) {
        return required(at, text.substr(0, text.size() - kRequired.size()));
    }
    constexpr std::string_view kExcludes = " excludes ";
    if (const std::size_t between = text.find(kExcludes); between != std::string::npos) {
        return text.substr(0, between) + " and " + text.substr(between + kExcludes.size()) +
               " cannot be given together. Remove one of them.";
    }
    constexpr std::string_view kConvert = "Could not convert: ";
    if (text.starts_with(kConvert)) {
        const std::size_t equals = text.find(" = ");
        if (equals != std::string::npos) {
            return text.substr(kConvert.size(), equals - kConvert.size()) + ": " +
                   in_quotes(text.substr(equals + 3)) + " is not a number.";
        }
    }
    const std::string name = text.substr(0, text.find(": "));
    if (text.find(" required but received ") != std::string::npos) {
        return name + " is given more than once.";
    }
    if (text.ends_with(" missing")) return name + " needs a value.";
    while (!text.empty() && (text.back() == '.' || text.back() == '\n')) text.pop_back();
    return text.ends_with('?') ? text : text + ".";
}

}  // namespace

std::string in_quotes(const std::string& word) {
    return "'" + report::printable(word) + "'";
}

std::string listed(const std::vector<std::string>& words, const char* conjunction) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool is_last = i + 1 == words.size();
        if (i > 0) text += is_last ? " " + std::string(conjunction) + " " : ", ";
        text += words[i];
    }
    return text;
}

std::string usage_sentence(const CLI::App& app, const CLI::ParseError& error) {
    const Reached at = reached(app);
    const std::vector<std::string> left = at.command->remaining();
    const auto option = std::find_if(left.begin(), left.end(), is_option);
    if (option != left.end()) return unknown_option(at, *option);
    const bool needs_command = at.command->get_require_subcommand_min() > 0;
    if (needs_command && !left.empty()) return unknown_command(at, left.front());
    if (needs_command) {
        return at.name + ": a command is missing. Choose from " +
               listed(command_names(*at.command), "and") + ".";
    }
    if (!left.empty()) {
        return at.name + ": " + in_quotes(left.front()) + " is one argument too many. Usage: '" +
               with_inputs(at) + "'.";
    }
    return at.name + ": " + as_sentence(at, error.what());
}

std::string empty_value_sentence(const CLI::App& app, std::span<const char* const> before,
                                 std::string_view argument) {
    const std::string option(argument.substr(0, argument.find('=')));
    return command_named(app, before).name + ": " + report::printable(option) + ": " + kEmptyValue;
}

}  // namespace cdprep::cli
