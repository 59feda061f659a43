// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/geometry.h"
#include "core/carver.h"
#include "live/id_map.h"
#include "live/marked_nodes.h"

namespace cdprep {

/// A triangle and its number.
struct NumberedTriangle {
    format::Triangle triangle;
    std::uint32_t number;
};

/// What a live model that can tear keeps in addition.
struct TearTables {
    TearTables(Carver& carver, std::uint32_t places) noexcept
        : TearTables(carver, places, format::bvh_shape(places).node_count) {}

    std::span<std::uint8_t> lanes;  ///< per leaf: the places that have a triangle, a bit each
    IdMap ids;
    MarkedNodes marked;              ///< to be distributed anew at the end of an append()
    std::span<std::uint32_t> taken;  ///< by node: triangles below; not of the root
    std::uint32_t limit = 0;         ///< the most triangles at a time
    std::uint32_t count = 0;         ///< triangles now
    std::uint32_t next_id = 0;
    std::uint64_t hash = 0;       ///< the sum over all triangles
    std::uint32_t positions = 0;  ///< one more than the largest number with a position

private:
    TearTables(Carver& carver, std::uint32_t places, std::uint32_t nodes) noexcept
        : lanes(carver.take<std::uint8_t>(places / format::kBvhWidth), places / format::kBvhWidth),
          ids(carver, places),
          marked(carver, nodes),
          taken(carver.take<std::uint32_t>(nodes), nodes) {}
};

}  // namespace cdprep
