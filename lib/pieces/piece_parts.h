// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/model.h"

namespace cdprep {

/// Returns the part of a section that belongs to a piece. It ends before the first entry of the
/// next piece, or at the end of the section.
template <class T>
std::span<const T> part_of_piece(std::span<const T> section, const Model& model,
                                 std::uint32_t piece,
                                 std::uint32_t format::Piece::*first) noexcept {
    const std::span<const format::Piece> pieces = model.pieces().pieces;
    assert(piece < pieces.size());
    const std::size_t next = std::size_t{piece} + 1;
    const std::size_t begin = pieces[piece].*first;
    const std::size_t end =
        next < pieces.size() ? std::size_t{pieces[next].*first} : section.size();
    assert(begin <= end && end <= section.size());
    return section.subspan(begin, end - begin);
}

}  // namespace cdprep
