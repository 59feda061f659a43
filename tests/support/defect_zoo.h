// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "support/meshes.h"

namespace cdprep::test {

/// A mesh with one defect, and all expected findings: a defect causes other findings too. They
/// are known by hand. Coordinates are multiples of 1/8 below 2^36, so that moving and scaling
/// are exact.
struct ZooAnimal {
    std::string name;
    TestMesh mesh;
    std::map<int, std::uint64_t> found;  ///< rule number to count, without 404
    std::uint64_t components = 1;
};

/// The distance for the search for near vertices and seams in the zoo.
inline constexpr double kZooWidth = 0.25;

/// Returns a mesh for every single defect, and a sound mesh.
[[nodiscard]] std::vector<ZooAnimal> defect_zoo();

/// Returns both, the second beside the first. The findings are those of each, with none between
/// them.
[[nodiscard]] ZooAnimal side_by_side(const ZooAnimal& first, const ZooAnimal& second);

/// Returns the mesh with every coordinate multiplied by 2^exponent.
[[nodiscard]] ZooAnimal scaled_by(ZooAnimal animal, int exponent);

/// Returns a closed strip with half a twist, of `count` pieces of two triangles each.
/// Coordinates are multiples of 1/8. `count` must be at least 8.
[[nodiscard]] TestMesh moebius_strip(int count);

}  // namespace cdprep::test
