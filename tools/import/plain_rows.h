// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "import/parse_number.h"
#include "import/polygon_chunk.h"
#include "import/text_chunks.h"

namespace cdprep::import {

/// Reads the three numbers at the start of a vertex row and appends them. Returns the place after
/// them, or null with nothing appended if the row does not begin with three numbers.
[[nodiscard]] inline const char* take_vertex(const char* at, const char* end, PolygonChunk& chunk) {
    std::array<double, 3> x{};
    bool single = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        at = skip_blanks(at, end);
        const Number number = parse_number(at, end);
        if (!number.next) return nullptr;
        x[axis] = number.value;
        single = single && number.single;
        at = number.next;
    }
    chunk.positions.push_back({x[0], x[1], x[2]});
    chunk.single_precision = chunk.single_precision && single;
    return at;
}

/// Reads the row "3 A B C" of three plain vertex numbers counted from 0 and appends the face.
/// Returns the place after it, or null with nothing appended for any other row.
[[nodiscard]] inline const char* take_triangle(const char* at, const char* end,
                                               PolygonChunk& chunk) {
    constexpr std::ptrdiff_t kMaxDigits = 9;  // below PolygonChunk::kFromChunkStart
    if (end - at < 2 || at[0] != '3' || at[1] != ' ') return nullptr;
    at += 2;
    std::array<std::uint32_t, 3> corners{};
    for (std::uint32_t& corner : corners) {
        while (at < end && *at == ' ') ++at;
        std::uint64_t index = 0;
        const char* const digits = at;
        at = take_digits(at, end, index);
        if (at == digits || at - digits > kMaxDigits) return nullptr;
        if (at < end && !detail::ends_number(*at)) return nullptr;
        corner = static_cast<std::uint32_t>(index);
    }
    chunk.corners.insert(chunk.corners.end(), corners.begin(), corners.end());
    chunk.end_face(3);
    return at;
}

}  // namespace cdprep::import
