// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "cdprep/format/bvh_shape.h"
#include "core/carver.h"
#include "live/id_map.h"

namespace cdprep {

/// The lowest level of nodes whose triangles are counted: subtrees of 512 leaves.
inline constexpr std::uint32_t kCountedLevel = 2;

/// What a live model that can tear keeps in addition.
struct TearTables {
    TearTables(Carver& carver, std::uint32_t places) noexcept
        : lanes(carver.take<std::uint8_t>(places / format::kBvhWidth), places / format::kBvhWidth),
          ids(carver, places) {
        const format::BvhShape shape = format::bvh_shape(places);
        const std::size_t nodes = shape.levels > kCountedLevel ? shape.first[kCountedLevel - 1] : 0;
        taken = {carver.take<std::uint32_t>(nodes), nodes};
    }

    std::span<std::uint8_t> lanes;  ///< per leaf: the places that have a triangle, a bit each
    IdMap ids;
    std::span<std::uint32_t> taken;  ///< by node, from kCountedLevel on: triangles below
    std::uint32_t limit = 0;         ///< the most triangles at a time
    std::uint32_t count = 0;         ///< triangles now
    std::uint32_t next_id = 0;
    std::uint64_t hash = 0;       ///< the sum over all triangles
    std::uint32_t positions = 0;  ///< one more than the largest number with a position
};

}  // namespace cdprep
