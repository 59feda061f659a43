// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>

#include "cdprep/build_bvh.h"

namespace cdprep::build {

inline constexpr std::size_t kItemsPerTask = 4096;  ///< triangles
inline constexpr std::size_t kLeavesPerTask = kItemsPerTask / format::kBvhWidth;

/// Runs body(i) for each i below count, without the allocation that handing over
/// a closure would need.
template <class Body>
void for_each_task(std::size_t count, const ParallelFor& parallel_for, const Body& body) {
    parallel_for(count, std::cref(body));
}

/// Runs body(first, last) over consecutive parts of [0, count), `size` items each.
template <class Body>
void for_chunks(std::size_t count, std::size_t size, const ParallelFor& parallel_for,
                const Body& body) {
    for_each_task((count + size - 1) / size, parallel_for, [&](std::size_t chunk) {
        const std::size_t first = chunk * size;
        body(first, std::min(count, first + size));
    });
}

}  // namespace cdprep::build
