// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "command_line/command_line.h"
#include "command_line/usage.h"
#include "text/nearest_word.h"

namespace cdprep::cli {
namespace {

std::string joined(const std::vector<std::string>& words, const char* separator) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
    return text;
}

/// Returns the number that consists of these digits, or nothing.
std::optional<std::uint64_t> decimal(const std::string& word) {
    std::uint64_t number = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, number);
    if (error != std::errc() || stop != end) return std::nullopt;
    return number;
}

Check number_above(double limit, bool may_be_equal, const std::string& wanted) {
    return {[=](std::string& word) -> std::string {
                double number = 0;
                const bool is_number =
                    CLI::detail::lexical_cast(word, number) && std::isfinite(number);
                if (is_number && (number > limit || (may_be_equal && number == limit))) return "";
                return in_quotes(word) + " is not " + wanted + ".";
            },
            may_be_equal ? "0 or more" : "above 0"};
}

}  // namespace

Check one_of(const std::vector<std::string>& words) {
    const std::string all = listed(words, "or");
    return {[words, all](std::string& word) -> std::string {
                if (std::find(words.begin(), words.end(), word) != words.end()) return "";
                return in_quotes(word) + " is not " + all + "." + report::suggestion(word, words);
            },
            "{" + joined(words, "|") + "}"};
}

Check list_of(const std::vector<std::string>& words) {
    return {[](std::string&) { return std::string(); }, "[" + joined(words, "|") + "]"};
}

Check whole_from(std::uint64_t least, std::uint64_t most) {
    const bool is_open = most == std::numeric_limits<std::uint64_t>::max();
    const std::string wanted =
        is_open ? "a whole number of " + std::to_string(least) + " or more"
                : "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
    return {[=](std::string& word) -> std::string {
                const std::optional<std::uint64_t> number = decimal(word);
                if (!number || *number < least || *number > most) {
                    return in_quotes(word) + " is not " + wanted + ".";
                }
                word = std::to_string(*number);  // CLI11 would read "010" as octal
                return "";
            },
            is_open ? std::to_string(least) + " or more"
                    : std::to_string(least) + " to " + std::to_string(most)};
}

Check zero_or_more(const char* unit) {
    const std::string wanted = unit == nullptr
                                   ? "a finite number of 0 or more"
                                   : "a finite number of " + std::string(unit) + ", 0 or more";
    return number_above(0, true, wanted);
}

Check size_to_petabyte() {
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

Check above_zero() {
    return number_above(0, false, "a finite number above 0");
}

Check existing_folder() {
    return {[](std::string& word) -> std::string {
                if (std::filesystem::is_directory(word)) return "";
                return in_quotes(word) + " is not a folder.";
            },
            ""};
}

}  // namespace cdprep::cli
