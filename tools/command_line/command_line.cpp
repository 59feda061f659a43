// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/command_line.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <span>
#include <string_view>

#include "command_line/help_text.h"
#include "command_line/usage.h"

namespace cdprep::cli {
namespace {

CLI::Validator validator_of(const Check& check) {
    return {[test = check.test](std::string& word) { return test(word); }, check.words};
}

/// Refuses an empty value: a variable that a script forgot to set must not mean the default.
Option filled(CLI::Option& option) {
    option.transform(CLI::Validator(
        [](std::string& word) { return std::string(word.empty() ? kEmptyValue : ""); }, ""));
    return Option(option);
}

/// Returns the number of the first argument "--name=" or "-n=". CLI11 would take the next argument
/// as its value, or "=".
std::optional<std::size_t> find_empty_value(std::span<const char* const> arguments) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string_view word = arguments[i];
        if (word == "--") break;  // inputs follow
        if (word.starts_with('-') && word.find('=') == word.size() - 1) return i;
    }
    return std::nullopt;
}

bool any(const CLI::App* /*command*/) {
    return true;
}

/// Adds the options of every command, with our own help texts.
void add_general_options(CLI::App& command) {
    command.allow_config_extras(CLI::config_extras_mode::error);
    command.get_help_ptr()->description("Print this help and exit")->group("General");
    for (CLI::App* each : command.get_subcommands(any)) add_general_options(*each);
}

/// Only one command line is parsed in a program.
std::filesystem::path& known_settings_file() {
    static std::filesystem::path file;
    return file;
}

}  // namespace

Option Option::type_name(const std::string& name) const {
    option_->type_name(name);
    return *this;
}

Option Option::group(const std::string& title) const {
    option_->group(title);
    return *this;
}

Option Option::check(const Check& check) const {
    option_->transform(validator_of(check));
    return *this;
}

Option Option::required() const {
    option_->required();
    return *this;
}

Option Option::show_default() const {
    option_->capture_default_str();
    return *this;
}

Option Option::delimiter(char separator) const {
    option_->delimiter(separator);
    return *this;
}

Option Option::one_value_each() const {
    option_->allow_extra_args(false);
    return *this;
}

Option Option::excludes(const Option& other) const {
    option_->excludes(other.option_);
    return *this;
}

Option Option::needs(const Option& other) const {
    option_->needs(other.option_);
    return *this;
}

Command Command::add_command(const std::string& name, const std::string& summary) const {
    return Command(*app_->add_subcommand(name, summary));
}

std::string Command::name() const {
    return app_->get_name();
}

std::vector<Command> Command::commands() const {
    std::vector<Command> commands;
    for (CLI::App* each : app_->get_subcommands(any)) commands.emplace_back(*each);
    return commands;
}

void Command::require_command() const {
    app_->require_subcommand(1);
}

Option Command::add_option(const std::string& names, std::string& value,
                           const std::string& text) const {
    return filled(*app_->add_option(names, value, text));
}
Option Command::add_option(const std::string& names, double& value, const std::string& text) const {
    return filled(*app_->add_option(names, value, text));
}
Option Command::add_option(const std::string& names, std::uint32_t& value,
                           const std::string& text) const {
    return filled(*app_->add_option(names, value, text));
}
Option Command::add_option(const std::string& names, std::uint64_t& value,
                           const std::string& text) const {
    return filled(*app_->add_option(names, value, text));
}
Option Command::add_option(const std::string& names, std::filesystem::path& value,
                           const std::string& text) const {
    return filled(*app_->add_option(names, value, text));
}
Option Command::add_option(const std::string& names, std::vector<std::string>& values,
                           const std::string& text) const {
    return filled(*app_->add_option(names, values, text));
}
Option Command::add_option(const std::string& names, std::vector<std::filesystem::path>& values,
                           const std::string& text) const {
    return filled(*app_->add_option(names, values, text));
}
Option Command::add_option(const std::string& names, std::optional<double>& value,
                           const std::string& text) const {
    return filled(*app_->add_option(names, value, text));
}
Option Command::add_option(const std::string& names, std::optional<std::uint32_t>& value,
                           const std::string& text) const {
    return filled(*app_->add_option(names, value, text));
}
Option Command::add_option(const std::string& names, std::optional<std::uint64_t>& value,
                           const std::string& text) const {
    return filled(*app_->add_option(names, value, text));
}
Option Command::add_flag(const std::string& names, bool& value, const std::string& text) const {
    return Option(*app_->add_flag(names, value, text));
}
Option Command::add_flag(const std::string& names, const std::function<void()>& call,
                         const std::string& text) const {
    return Option(*app_->add_flag_callback(names, call, text));
}

std::size_t Command::count(const std::string& option) const {
    const CLI::Option* const found = app_->get_option_no_throw(option);
    return found == nullptr ? 0 : found->count();
}

void Command::callback(const std::function<void()>& run) const {
    app_->callback(run);
}

const std::filesystem::path& settings_file() {
    return known_settings_file();
}

Program::Program(const std::string& name, const std::string& version, const std::string& summary)
    : app_(std::make_unique<CLI::App>(summary, name)) {
    app_->set_version_flag("--version", version)
        ->description("Print the version and exit")
        ->group("General");
    filled(*app_->set_config("--config", "",
                             "Read options from a TOML file: bake.jobs=2 means --jobs=2 of bake"))
        .type_name("FILE")
        .group("General");
    // CLI11 calls this before the callback of the command.
    app_->parse_complete_callback([app = app_.get()] {
        const CLI::Option* const config = app->get_config_ptr();
        known_settings_file() = config->count() > 0 ? config->results().back() : "";
    });
    app_->require_subcommand(1);
}

Program::~Program() = default;

Command Program::root() const noexcept {
    return Command(*app_);
}

void Program::add_hidden(const std::string& name,
                         const std::function<Exit(const std::string& value)>& run) const {
    const auto call = [run](const std::string& value) {
        throw CLI::RuntimeError(static_cast<int>(run(value)));
    };
    filled(*app_->add_option_function<std::string>(name, call, "")->trigger_on_parse()).group("");
}

std::optional<Exit> Program::parse(int count, const char* const* arguments) const {
    add_general_options(*app_);
    use_help_text(*app_);
    const std::span words(arguments, static_cast<std::size_t>(count));
    if (const std::optional<std::size_t> empty = find_empty_value(words)) {
        std::cerr << empty_value_sentence(*app_, words.first(*empty), words[*empty]) << '\n';
        return Exit::usage;
    }
    try {
        app_->parse(count, arguments);
    } catch (const CLI::RuntimeError& ended) {
        return static_cast<Exit>(ended.get_exit_code());
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) {
            std::cerr << usage_sentence(*app_, error) << '\n';
            return Exit::usage;
        }
        app_->exit(error, std::cout, std::cerr);  // --help, --version
        return Exit::success;
    }
    return std::nullopt;
}

}  // namespace cdprep::cli
