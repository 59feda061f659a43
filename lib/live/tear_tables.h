// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "core/carver.h"
#include "live/id_map.h"

namespace cdprep {

/// What a live model that can tear keeps in addition.
struct TearTables {
    TearTables(Carver& carver, std::uint32_t places) noexcept
        : lanes(carver.take<std::uint8_t>(places / format::kBvhWidth), places / format::kBvhWidth),
          ids(carver, places) {}

    std::span<std::uint8_t> lanes;  ///< per leaf: the places that have a triangle, a bit each
    IdMap ids;
    std::uint32_t limit = 0;  ///< the most triangles at a time
    std::uint32_t count = 0;  ///< triangles now
    std::uint32_t next_id = 0;
    std::uint64_t hash = 0;       ///< the sum over all triangles
    std::uint32_t positions = 0;  ///< one more than the largest number with a position
};

}  // namespace cdprep
