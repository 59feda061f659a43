// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "support/more_sections.h"
#include "support/open_tiny.h"

#include "cdprep/advanced/structure.h"

namespace cdprep::test {

inline constexpr std::array kStructures = {Structure::bvh, Structure::octree,
                                           Structure::adaptive_octree, Structure::hashed_octree,
                                           Structure::tetra_tree};

inline std::string name_of(Structure structure) {
    constexpr std::array<const char*, 5> kNames = {"bvh", "octree", "adaptive_octree",
                                                   "hashed_octree", "tetra_tree"};
    return kNames.at(static_cast<std::size_t>(structure));
}

/// The depth to which structures divide their triangles.
struct Division {
    std::uint32_t level = 3;
    std::uint32_t threshold = 1;
    bool boxes = false;  ///< boxes bound the triangles in each octree cell
};

/// Returns the baked file with every structure that a query can use.
[[nodiscard]] AlignedBytes with_every_structure(const AlignedBytes& file,
                                                const Division& division = {});

/// Bakes such a file in double precision and opens it.
[[nodiscard]] OpenModel open_with_every_structure(const TestMesh& mesh,
                                                  const Division& division = {});

}  // namespace cdprep::test
