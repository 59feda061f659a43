// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/usage.h"

#include <algorithm>
#include <cmath>

#include "text/nearest_word.h"
#include "text/printable.h"

namespace cdprep::cli {
namespace {

std::string in_quotes(const std::string& word) {
    return "'" + report::printable(word) + "'";
}

/// "a, b or c", with that conjunction.
std::string listed(const std::vector<std::string>& words, const char* conjunction) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool is_last = i + 1 == words.size();
        if (i > 0) text += is_last ? " " + std::string(conjunction) + " " : ", ";
        text += words[i];
    }
    return text;
}

std::string joined(const std::vector<std::string>& words, const char* separator) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
    return text;
}

CLI::Validator number_above(double limit, bool may_be_equal, const std::string& wanted) {
    return {[=](std::string& word) -> std::string {
                double number = 0;
                const bool is_number =
                    CLI::detail::lexical_cast(word, number) && std::isfinite(number);
                if (is_number && (number > limit || (may_be_equal && number == limit))) return "";
                return in_quotes(word) + " is not " + wanted + ".";
            },
            may_be_equal ? "0 or more" : "above 0"};
}

/// The command that the arguments came to, "cdprep query collide" with all above it.
struct Reached {
    const CLI::App* command;
    std::string name;
};

Reached reached(const CLI::App& app) {
    Reached at{&app, app.get_name()};
    for (;;) {
        const auto chosen = at.command->get_subcommands();
        if (chosen.empty()) return at;
        at = {chosen.front(), at.name + " " + chosen.front()->get_name()};
    }
}

std::vector<std::string> command_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; })) {
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

/// How the command takes its inputs: "cdprep query ray model".
std::string with_inputs(const Reached& at) {
    std::string text = at.name;
    for (const CLI::Option* option : at.command->get_options()) {
        if (option->get_positional()) text += " " + option->get_name();
    }
    return text;
}

/// The option or input of that name; null when it is none of the command's.
const CLI::Option* option_of(const CLI::App& command, const std::string& name) {
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_name() == name) return option;
    }
    return nullptr;
}

/// "--rays is required: File of rays ...", "b is required: ... Usage: 'cdprep query collide a b'."
std::string required(const Reached& at, const std::string& name) {
    const CLI::Option* option = option_of(*at.command, name);
    if (option == nullptr) return name + " is required.";
    const std::string text = name + " is required: " + option->get_description() + ".";
    return option->get_positional() ? text + " Usage: '" + with_inputs(at) + "'." : text;
}

/// The library's own words, as a sentence: "--parts: 'x' is not a number." of
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

CLI::Validator one_of(std::vector<std::string> words) {
    const std::string all = listed(words, "or");
    return {[words, all](std::string& word) -> std::string {
                if (std::find(words.begin(), words.end(), word) != words.end()) return "";
                return in_quotes(word) + " is not " + all + "." + report::suggestion(word, words);
            },
            "{" + joined(words, "|") + "}"};
}

CLI::Validator whole_from(std::uint64_t least, std::uint64_t most) {
    const bool is_open = most == std::numeric_limits<std::uint64_t>::max();
    const std::string wanted =
        is_open ? "a whole number of " + std::to_string(least) + " or more"
                : "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
    return {[=](std::string& word) -> std::string {
                std::uint64_t number = 0;
                const bool is_number =
                    !word.empty() && word[0] != '-' && CLI::detail::lexical_cast(word, number);
                if (is_number && number >= least && number <= most) return "";
                return in_quotes(word) + " is not " + wanted + ".";
            },
            is_open ? std::to_string(least) + " or more"
                    : std::to_string(least) + " to " + std::to_string(most)};
}

CLI::Validator zero_or_more(const char* unit) {
    const std::string wanted = unit == nullptr
                                   ? "a finite number of 0 or more"
                                   : "a finite number of " + std::string(unit) + ", 0 or more";
    return number_above(0, true, wanted);
}

CLI::Validator size_to_petabyte() {
    return {[](std::string& word) -> std::string {
                constexpr std::uint64_t kPetabyte = std::uint64_t{1} << 50;
                const std::string typed = word;
                std::uint64_t bytes = 0;
                try {
                    CLI::AsSizeValue(false)(word);
                    CLI::detail::lexical_cast(word, bytes);
                } catch (const CLI::ValidationError&) {
                    bytes = 0;
                }
                if (typed[0] != '-' && bytes > 0 && bytes <= kPetabyte) return "";
                return in_quotes(typed) + " is not a size from 1B to 1PB, such as 500MB or 2GB.";
            },
            "1B to 1PB"};
}

CLI::Validator above_zero() {
    return number_above(0, false, "a finite number above 0");
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

}  // namespace cdprep::cli
