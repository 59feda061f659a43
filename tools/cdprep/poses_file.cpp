// SPDX-License-Identifier: GPL-3.0-or-later
#include "poses_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <string_view>

namespace cdprep::cli {
namespace {

constexpr std::string_view kBlanks = " \t\r,";

/// The next word of the text, taken off its front.
std::string_view next_word(std::string_view& text) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) {
        text = {};
        return {};
    }
    const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

bool is_comment(const std::string& line) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    return begin == std::string::npos || line[begin] == '#';
}

}  // namespace

Result<Pose> parse_pose(const std::string& text, const std::string& place) {
    std::array<double, 12> rows{};
    std::size_t count = 0;
    std::string_view rest = text;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
        double value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc{} || end != word.data() + word.size()) {
            return Error{ErrorCode::unreadable,
                         place + ": '" + std::string(word) + "' is not a number."};
        }
        if (count < rows.size()) rows[count] = value;
        ++count;
    }
    if (count != rows.size()) {
        return Error{ErrorCode::unreadable, place +
                                                ": a pose has 12 numbers, R row by row and "
                                                "then T; here are " +
                                                std::to_string(count) + "."};
    }
    Result<Pose> pose = Pose::from_rows(rows);
    if (!pose) return Error{pose.error().code, place + ": " + pose.error().message};
    return pose;
}

Result<std::vector<Pose>> read_poses(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file) {
        return Error{ErrorCode::unreadable, path.string() + ": cannot be opened."};
    }
    std::vector<Pose> poses;
    std::string line;
    for (std::size_t number = 1; std::getline(file, line); ++number) {
        if (is_comment(line)) continue;
        Result<Pose> pose = parse_pose(line, path.string() + ": line " + std::to_string(number));
        if (!pose) return pose.error();
        poses.push_back(pose.value());
    }
    return poses;
}

}  // namespace cdprep::cli
