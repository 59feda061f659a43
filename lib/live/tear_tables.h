// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/geometry.h"
#include "core/carver.h"
#include "live/id_map.h"

namespace cdprep {

/// The lowest level of nodes whose triangles are counted: subtrees of 512 leaves.
inline constexpr std::uint32_t kCountedLevel = 2;

/// A triangle and its number.
struct NumberedTriangle {
    format::Triangle triangle;
    std::uint32_t number;
};

/// A triangle that is being appended, and the leaf whose box grows least with it.
struct NewTriangle {
    std::uint32_t leaf;
    NumberedTriangle added;
};

/// What a live model that can tear keeps in addition.
struct TearTables {
    TearTables(Carver& carver, std::uint32_t places) noexcept
        : lanes(carver.take<std::uint8_t>(places / format::kBvhWidth), places / format::kBvhWidth),
          ids(carver, places),
          fresh(carver.take<NewTriangle>(places), places) {
        const format::BvhShape shape = format::bvh_shape(places);
        const std::size_t nodes = shape.levels > kCountedLevel ? shape.first[kCountedLevel - 1] : 0;
        taken = {carver.take<std::uint32_t>(nodes), nodes};
    }

    std::span<std::uint8_t> lanes;  ///< per leaf: the places that have a triangle, a bit each
    IdMap ids;
    std::span<NewTriangle> fresh;    ///< of the present append()
    std::span<std::uint32_t> taken;  ///< by node, from kCountedLevel on: triangles below
    std::uint32_t limit = 0;         ///< the most triangles at a time
    std::uint32_t count = 0;         ///< triangles now
    std::uint32_t next_id = 0;
    std::uint64_t hash = 0;       ///< the sum over all triangles
    std::uint32_t positions = 0;  ///< one more than the largest number with a position
};

}  // namespace cdprep
