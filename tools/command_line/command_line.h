// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line/exit_codes.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

// The commands and options of the program, over CLI11. Its headers take seconds to compile in each
// source, so only the sources of this folder include them.

namespace cdprep::cli {

/// A condition on the word of an option. `test` returns an error message for the word, or "" if it
/// is valid; it may replace the word. `words` names the allowed values: "{text|json}",
/// "[weld|orient]" for a list, or "1 to 4096".
struct Check {
    std::function<std::string(std::string& word)> test;
    std::string words;
};

/// Accepts one of the given words. The error for another word suggests the nearest.
[[nodiscard]] Check one_of(const std::vector<std::string>& words);

/// Accepts a comma-separated list. Help and completion show its words; the command parses it.
[[nodiscard]] Check list_of(const std::vector<std::string>& words);

/// Accepts a whole number from `least` to `most`.
[[nodiscard]] Check whole_from(std::uint64_t least,
                               std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// Accepts a finite number of 0 or more. `unit` names the number in the error message.
[[nodiscard]] Check zero_or_more(const char* unit = nullptr);

/// Accepts a finite number above 0.
[[nodiscard]] Check above_zero();

/// Accepts a size such as 500MB, from a byte to a petabyte, and replaces it by a number of bytes.
/// Units are powers of 1024.
[[nodiscard]] Check size_to_petabyte();

/// Accepts a folder that exists.
[[nodiscard]] Check existing_folder();

/// An option or an input of a command. Each function returns the same option.
class Option {
public:
    explicit Option(CLI::Option& option) noexcept : option_(&option) {}

    /// The placeholder of the value: "FILE".
    Option type_name(const std::string& name) const;  // NOLINT(modernize-use-nodiscard)
    /// The title under which help lists the option.
    Option group(const std::string& title) const;  // NOLINT(modernize-use-nodiscard)
    Option check(const Check& check) const;        // NOLINT(modernize-use-nodiscard)
    Option required() const;                       // NOLINT(modernize-use-nodiscard)
    /// Shows the current value of the variable as the default.
    Option show_default() const;  // NOLINT(modernize-use-nodiscard)
    /// Splits one word into several values.
    Option delimiter(char separator) const;  // NOLINT(modernize-use-nodiscard)
    /// Takes one value each time it is given, not all words that follow.
    Option one_value_each() const;               // NOLINT(modernize-use-nodiscard)
    Option excludes(const Option& other) const;  // NOLINT(modernize-use-nodiscard)
    Option needs(const Option& other) const;     // NOLINT(modernize-use-nodiscard)

private:
    CLI::Option* option_;
};

/// A command of the program, or the program itself. The variables that options write must outlive
/// the parse.
class Command {
public:
    explicit Command(CLI::App& app) noexcept : app_(&app) {}

    [[nodiscard]] Command add_command(const std::string& name, const std::string& summary) const;
    [[nodiscard]] std::string name() const;
    [[nodiscard]] std::vector<Command> commands() const;
    /// Refuses a command line that names none of the commands below this one.
    void require_command() const;

    /// Adds an option, or an input if `names` does not begin with '-'. Names are separated by ','.
    Option add_option(const std::string& names, std::string& value, const std::string& text) const;
    Option add_option(const std::string& names, double& value, const std::string& text) const;
    Option add_option(const std::string& names, std::uint32_t& value,
                      const std::string& text) const;
    Option add_option(const std::string& names, std::uint64_t& value,
                      const std::string& text) const;
    Option add_option(const std::string& names, std::filesystem::path& value,
                      const std::string& text) const;
    Option add_option(const std::string& names, std::vector<std::string>& values,
                      const std::string& text) const;
    Option add_option(const std::string& names, std::vector<std::filesystem::path>& values,
                      const std::string& text) const;
    Option add_option(const std::string& names, std::optional<double>& value,
                      const std::string& text) const;
    Option add_option(const std::string& names, std::optional<std::uint32_t>& value,
                      const std::string& text) const;
    Option add_option(const std::string& names, std::optional<std::uint64_t>& value,
                      const std::string& text) const;
    /// "!--name" stores false.
    Option add_flag(const std::string& names, bool& value, const std::string& text) const;
    Option add_flag(const std::string& names, const std::function<void()>& call,
                    const std::string& text) const;

    /// Returns the number of times that an option was given; 0 if the command has no such option.
    [[nodiscard]] std::size_t count(const std::string& option) const;
    /// Called after the whole command line was parsed.
    void callback(const std::function<void()>& run) const;
    /// Sets the paragraphs and the command lines that end the help.
    void set_notes(const std::string& notes, const std::vector<std::string>& examples) const;

    [[nodiscard]] const CLI::App& app() const noexcept {
        return *app_;
    }

private:
    CLI::App* app_;
};

/// Returns the path of --config, or an empty path. Known when a command is called.
[[nodiscard]] const std::filesystem::path& settings_file();

/// The whole command line.
class Program {
public:
    Program(const std::string& name, const std::string& version, const std::string& summary);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    /// The program itself, to which commands are added.
    [[nodiscard]] Command root() const noexcept;

    /// Adds an option that help does not list. It calls `run` with its value as soon as it is read,
    /// and ends the parse with the exit code.
    void add_hidden(const std::string& name,
                    const std::function<Exit(const std::string& value)>& run) const;

    /// Parses the arguments and calls the callback of the command. Returns an exit code if the
    /// program must end. This is after --help and --version, which print, and after an invalid
    /// command line. The error goes to standard error.
    [[nodiscard]] std::optional<Exit> parse(int count, const char* const* arguments) const;

private:
    std::unique_ptr<CLI::App> app_;
};

}  // namespace cdprep::cli
