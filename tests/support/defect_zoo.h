// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "support/meshes.h"

namespace cdprep::test {

/// A mesh with one thing wrong with it, and all that must be found: what is wrong brings
/// other findings with it. Known by hand. Coordinates are multiples of 1/8 below 2^36, so
/// that moving and scaling lose nothing.
struct ZooAnimal {
    std::string name;
    TestMesh mesh;
    std::map<int, std::uint64_t> found;  ///< rule number to count, without 404
    std::uint64_t components = 1;
};

/// What near vertices and seams in the zoo are looked for with.
inline constexpr double kZooWidth = 0.25;

/// Every defect alone, and a sound one.
[[nodiscard]] std::vector<ZooAnimal> defect_zoo();

/// Both, the second beside the first: everything is found of each, and nothing between.
[[nodiscard]] ZooAnimal side_by_side(const ZooAnimal& first, const ZooAnimal& second);

/// Every coordinate multiplied by 2^exponent.
[[nodiscard]] ZooAnimal scaled_by(ZooAnimal animal, int exponent);

/// A closed strip of `count` pieces with half a twist, of two triangles each, in
/// multiples of 1/8. `count` >= 8.
[[nodiscard]] TestMesh moebius_strip(int count);

}  // namespace cdprep::test
