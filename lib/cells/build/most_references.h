// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

#include "cdprep/cells/build_octree.h"

namespace cdprep::build {

/// Returns the maximum number of references of an octree of either kind; see build_octree().
inline std::uint64_t most_references(std::uint64_t triangle_count) noexcept {
    constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
    return std::min(kMostFreeReferences + kMostReferencesPerTriangle * triangle_count, kMost);
}

}  // namespace cdprep::build
