// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "cdprep/advanced/parallel_for.h"

namespace cdprep::import {

/// The approximate size of the text that one parallel step reads. Its results fit the
/// second-level cache.
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 19;

/// Returns the text without the byte order mark of UTF-8, with which some editors begin a file.
constexpr std::string_view without_byte_order_mark(std::string_view text) noexcept {
    constexpr std::string_view kMark = "\xef\xbb\xbf";
    return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

constexpr bool is_blank(char c) noexcept {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/// Returns the first character at or after `at` that is not a blank, or `end`.
inline const char* skip_blanks(const char* at, const char* end) noexcept {
    while (at < end && is_blank(*at)) ++at;
    return at;
}

/// Returns the start of the line after the one that holds `at`, or `end`.
inline const char* next_line(const char* at, const char* end) noexcept {
    if (at < end && *at == '\n') return at + 1;
    const void* const feed = std::memchr(at, '\n', static_cast<std::size_t>(end - at));
    return feed ? static_cast<const char*>(feed) + 1 : end;
}

/// Returns the line at `at`, without its end and the surrounding blanks.
[[nodiscard]] std::string_view trimmed_line(const char* at, const char* end) noexcept;

/// Cuts text into consecutive chunks of about kChunkBytes, without gaps. Each chunk except the
/// first begins at a line for which `may_start(line, end)` is true.
template <class MayStart>
[[nodiscard]] std::vector<std::string_view> split_lines(std::string_view text,
                                                        MayStart&& may_start) {
    std::vector<std::string_view> chunks;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at < end) {
        const char* cut = end;
        if (static_cast<std::size_t>(end - at) > kChunkBytes) {
            cut = next_line(at + kChunkBytes, end);
            while (cut < end && !may_start(cut, end)) cut = next_line(cut, end);
        }
        chunks.emplace_back(at, static_cast<std::size_t>(cut - at));
        at = cut;
    }
    return chunks;
}

/// What cannot be read, and where it stands in the text.
struct Fault {
    const char* at;
    std::string what;
};

/// A chunk of lines with one element each, and the number of its first element.
struct RowChunk {
    std::string_view text;
    std::uint64_t first_row = 0;
    std::uint64_t row_count = 0;
};

/// Returns the first line at or after `at` that is neither blank nor a comment ('#'), or `end`.
/// The result points to the line's first character that is not a blank.
[[nodiscard]] const char* next_row(const char* at, const char* end) noexcept;

/// Cuts text into chunks of rows and numbers them. Rows are the lines that are neither blank nor
/// comments.
[[nodiscard]] std::vector<RowChunk> split_rows(std::string_view text, ParallelFor parallel_for);

}  // namespace cdprep::import
