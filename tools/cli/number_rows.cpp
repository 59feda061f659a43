// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/number_rows.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iostream>

namespace cdprep::cli {
namespace {

constexpr std::string_view kBlanks = " \t\r,";

/// Removes the next word from the front of the text and returns it; empty at the end.
std::string_view next_word(std::string_view& text) {
    const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
    const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

bool parse_number(std::string_view word, double& value) {
    if (word.starts_with('+')) word.remove_prefix(1);  // from_chars accepts no plus
    const char* last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, value);
    return error == std::errc{} && end == last && std::isfinite(value);
}

std::string_view without_blanks(std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
    text.remove_prefix(begin);
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

}  // namespace

Result<Done> parse_row(std::string_view text, const std::string& place, std::span<double> row) {
    std::size_t count = 0;
    for (std::string_view word = next_word(text); !word.empty(); word = next_word(text)) {
        double value = 0;
        if (!parse_number(word, value)) {
            return Error{ErrorCode::unreadable,
                         place + ": '" + std::string(word) + "' is not a finite number."};
        }
        if (count < row.size()) row[count] = value;
        ++count;
    }
    if (count != row.size()) {
        return Error{ErrorCode::unreadable, place + ": found " + std::to_string(count) +
                                                " numbers; expected " + std::to_string(row.size()) +
                                                "."};
    }
    return Done{};
}

Result<Done> for_each_line(
    const std::filesystem::path& path,
    const std::function<Result<Done>(const std::string& line, const std::string& place)>& take,
    const std::function<void(std::string_view note)>& note) {
    std::ifstream opened;
    if (path != "-") opened.open(path);
    std::istream& file = path == "-" ? std::cin : opened;
    if (!file) return Error{ErrorCode::unreadable, path.string() + ": cannot be opened."};
    std::string line;
    for (std::size_t number = 1; std::getline(file, line); ++number) {
        const std::string_view text = without_blanks(line);
        if (text.empty()) continue;
        if (text.front() == '#') {
            if (note) note(without_blanks(text.substr(1)));
            continue;
        }
        Result<Done> taken = take(line, path.string() + ": line " + std::to_string(number));
        if (!taken) return taken;
    }
    if (file.bad()) return Error{ErrorCode::unreadable, path.string() + ": cannot be read."};
    return Done{};
}

}  // namespace cdprep::cli
