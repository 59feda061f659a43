// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace cdprep::cli {

/// The message about an empty value, without the name of its option.
inline constexpr const char* kEmptyValue = "the value is empty.";

/// Returns a message that explains an invalid command line and how to correct it:
/// "cdprep query: 'colide' is not a command. Did you mean 'collide'? ...".
[[nodiscard]] std::string usage_sentence(const CLI::App& app, const CLI::ParseError& error);

/// Returns the message about the argument "--name=" after such words: "cdprep bake: --name: the
/// value is empty.".
[[nodiscard]] std::string empty_value_sentence(const CLI::App& app,
                                               std::span<const char* const> before,
                                               std::string_view argument);

/// Returns a printable word in quotes.
[[nodiscard]] std::string in_quotes(const std::string& word);

/// Returns "a, b or c", with that conjunction.
[[nodiscard]] std::string listed(const std::vector<std::string>& words, const char* conjunction);

}  // namespace cdprep::cli
