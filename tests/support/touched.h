// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "cdprep/points.h"
#include "support/open_tiny.h"

namespace cdprep::test {

using Numbers = std::vector<std::uint32_t>;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Returns all triangles of the mesh that the shape touches.
template <class Shape>
Numbers touched(const TestMesh& mesh, const Shape& shape, const ShapeOptions& options = {}) {
    const OpenModel model = open_tiny(mesh, {.double_precision = true});
    Workspace workspace;
    Numbers triangles(mesh.triangles.size());
    triangles.resize(touching_triangles(model.model, shape, workspace, triangles, options));
    EXPECT_EQ(touches(model.model, shape, workspace, options), !triangles.empty());
    return triangles;
}

/// Returns 0 ... count - 1.
inline Numbers first_numbers(std::uint32_t count) {
    Numbers numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
}

}  // namespace cdprep::test
