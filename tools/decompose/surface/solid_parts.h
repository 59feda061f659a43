// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "decompose/surface/box_pyramid.h"
#include "hull/growing_hull.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

/// The obstacles for a hull over some triangles of a mesh. A hull that avoids them stays in the
/// solid that the triangles bound. Obstacles are triangles of their own component, and of cavities:
/// balanced components wound inwards. The mesh's triangles must be in tree order, and the mesh must
/// outlive this.
class SolidParts {
public:
    explicit SolidParts(const mesh::Mesh& mesh);

    /// Returns true if the triangle's component is balanced, so that containment is defined.
    [[nodiscard]] bool is_solid(std::uint32_t triangle) const {
        return balanced_[component_of(triangle)] != 0;
    }

    /// Returns true if only own triangles have a point strictly inside the hull of a patch to which
    /// `triangle` belongs. Exact. Triangles with is_own(triangle) are own ones; they lie on the
    /// hull. Also returns false if that takes more than `most_tests` tests of a point against a
    /// plane. Subtracts the tests made from `most_tests`.
    template <class IsOwn>
    bool contains(const GrowingHull& hull, std::uint32_t triangle, IsOwn is_own,
                  std::uint64_t& most_tests) const {
        const std::uint32_t component = component_of(triangle);
        constexpr std::uint64_t kTestsOfAFacet = 8;  // three corners, exactly
        const std::uint64_t tests = kTestsOfAFacet * hull.facets().size();
        return boxes_.visit(box_of(hull.points()), [&](std::uint32_t other) {
            if (most_tests < tests) return false;
            if (is_own(other) || !is_obstacle(other, component)) {
                --most_tests;
                return true;
            }
            most_tests -= tests;
            return !hull.has_inside(corners_of(other));
        });
    }

    [[nodiscard]] Corners corners_of(std::uint32_t triangle) const {
        const auto& v = mesh_.triangles[triangle].vertex;
        return {mesh_.positions[v[0]], mesh_.positions[v[1]], mesh_.positions[v[2]]};
    }

private:
    [[nodiscard]] std::uint32_t component_of(std::uint32_t triangle) const {
        return component_of_vertex_[mesh_.triangles[triangle].vertex[0]];
    }
    [[nodiscard]] bool is_obstacle(std::uint32_t triangle, std::uint32_t component) const {
        const std::uint32_t other = component_of(triangle);
        return other == component || cavity_[other] != 0;
    }

    const mesh::Mesh& mesh_;
    BoxPyramid boxes_;
    std::vector<std::uint32_t> component_of_vertex_;
    std::vector<std::uint8_t> balanced_;
    std::vector<std::uint8_t> cavity_;
};

}  // namespace cdprep::convex
