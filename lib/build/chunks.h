// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/bvh_shape.h"

namespace cdprep::build {

inline constexpr std::size_t kItemsPerTask = 4096;  ///< triangles
inline constexpr std::size_t kLeavesPerTask = kItemsPerTask / format::kBvhWidth;

/// Runs body(first, last) over consecutive parts of [0, count), `size` items each.
template <class Body>
void for_chunks(std::size_t count, std::size_t size, ParallelFor parallel_for, const Body& body) {
    assert(size > 0);
    parallel_for((count + size - 1) / size, [&](std::size_t chunk) {
        const std::size_t first = chunk * size;
        body(first, std::min(count, first + size));
    });
}

}  // namespace cdprep::build
