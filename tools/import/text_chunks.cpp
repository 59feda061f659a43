// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/text_chunks.h"

namespace cdprep::import {

std::string_view trimmed_line(const char* at, const char* end) noexcept {
    at = skip_blanks(at, end);
    const char* last = next_line(at, end);
    while (last > at && (is_blank(last[-1]) || last[-1] == '\n')) --last;
    return {at, static_cast<std::size_t>(last - at)};
}

const char* next_row(const char* at, const char* end) noexcept {
    while (at < end) {
        if (*at == '#') {
            at = next_line(at, end);
        } else if (is_blank(*at) || *at == '\n') {
            ++at;
        } else {
            return at;
        }
    }
    return end;
}

std::vector<RowChunk> split_rows(std::string_view text, ParallelFor parallel_for) {
    std::vector<RowChunk> chunks;
    for (const std::string_view part : split_lines(text, [](auto, auto) { return true; })) {
        chunks.push_back({part, 0, 0});
    }
    parallel_for(chunks.size(), [&](std::size_t i) {
        const char* at = chunks[i].text.data();
        const char* const end = at + chunks[i].text.size();
        for (at = next_row(at, end); at < end; at = next_row(next_line(at, end), end)) {
            ++chunks[i].row_count;
        }
    });
    std::uint64_t rows = 0;
    for (RowChunk& chunk : chunks) {
        chunk.first_row = rows;
        rows += chunk.row_count;
    }
    return chunks;
}

}  // namespace cdprep::import
