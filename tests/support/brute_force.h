// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "support/meshes.h"

#include "cdprep/pairs.h"
#include "cdprep/self.h"
#include "core/moved_model.h"
#include "exact/triangle_contact.h"

namespace cdprep::test {

/// Returns the corners of triangle `index` after moving them by transform_point().
inline Corners corners_of(const TestMesh& mesh, std::size_t index, const Pose* pose) {
    Corners corners{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3& p = mesh.positions[mesh.triangles[index].vertex[i]];
        corners[i] = pose == nullptr ? p : transform_point(*pose, p);
    }
    return corners;
}

[[nodiscard]] inline std::vector<Corners> surface_of(const TestMesh& mesh,
                                                     const Pose* pose = nullptr) {
    std::vector<Corners> surface;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        surface.push_back(corners_of(mesh, i, pose));
    }
    return surface;
}

/// Returns every overlapping pair from all n m six-segment tests, without boxes or trees.
inline std::vector<TrianglePair> brute_force_pairs(const TestMesh& a, const TestMesh& b,
                                                   const Placement& placement) {
    const Pose* pose_a = placement.a_is_moved() ? &placement.pose_a() : nullptr;
    const Pose* pose_b = placement.b_is_moved() ? &placement.pose_b() : nullptr;
    std::vector<TrianglePair> pairs;
    for (std::uint32_t i = 0; i < a.triangles.size(); ++i) {
        const Corners at_a = corners_of(a, i, pose_a);
        for (std::uint32_t j = 0; j < b.triangles.size(); ++j) {
            if (triangles_touch_by_segments(at_a, corners_of(b, j, pose_b))) {
                pairs.push_back({i, j});
            }
        }
    }
    return pairs;
}

inline Box3 box_of(const Corners& t) {
    const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
    const auto [z0, z1] = std::minmax({t[0].z, t[1].z, t[2].z});
    return {{x0, y0, z0}, {x1, y1, z1}};
}

/// Returns every pair for which `touch(a, b)` is true. Calls it only if the boxes of the two
/// triangles meet. Serves meshes too large for brute_force_pairs(), and slower tests.
template <class Touch>
std::vector<TrianglePair> boxed_pairs(const TestMesh& a, const TestMesh& b,
                                      const Placement& placement, Touch&& touch) {
    const Pose* pose_a = placement.a_is_moved() ? &placement.pose_a() : nullptr;
    const Pose* pose_b = placement.b_is_moved() ? &placement.pose_b() : nullptr;
    std::vector<Corners> all_b;
    std::vector<Box3> boxes_b;
    for (std::uint32_t j = 0; j < b.triangles.size(); ++j) {
        all_b.push_back(corners_of(b, j, pose_b));
        boxes_b.push_back(box_of(all_b.back()));
    }
    std::vector<TrianglePair> pairs;
    for (std::uint32_t i = 0; i < a.triangles.size(); ++i) {
        const Corners at_a = corners_of(a, i, pose_a);
        const Box3 box_a = box_of(at_a);
        for (std::uint32_t j = 0; j < b.triangles.size(); ++j) {
            if (overlap(box_a, boxes_b[j]) && touch(at_a, all_b[j])) pairs.push_back({i, j});
        }
    }
    return pairs;
}

inline bool share_a_vertex(const TestMesh& mesh, std::uint32_t a, std::uint32_t b) {
    const auto& v = mesh.triangles[a].vertex;
    const auto& w = mesh.triangles[b].vertex;
    return std::find_first_of(v.begin(), v.end(), w.begin(), w.end()) != v.end();
}

/// Returns the pairs a < b of triangles of a mesh that share no vertex and `touch(a, b)`. Calls
/// `touch` only if their boxes meet.
template <class Touch>
std::vector<TrianglePair> own_pairs(const TestMesh& mesh, Touch&& touch) {
    std::vector<TrianglePair> pairs;
    for (const TrianglePair& pair :
         boxed_pairs(mesh, mesh, Placement::b_moves({}), std::forward<Touch>(touch))) {
        if (pair.a < pair.b && !share_a_vertex(mesh, pair.a, pair.b)) pairs.push_back(pair);
    }
    return pairs;
}
/// The same for the six-segment test.
inline std::vector<TrianglePair> own_pairs(const TestMesh& mesh) {
    return own_pairs(mesh, triangles_touch_by_segments);
}

/// Returns all pairs of one model that the library finds.
inline std::vector<TrianglePair> all_own_pairs(const Model& model, Workspace& workspace,
                                               const SelfOptions& options = {}) {
    std::vector<TrianglePair> pairs(self_overlaps(model, workspace, {}, options));
    pairs.resize(self_overlaps(model, workspace, pairs, options));
    return pairs;
}

/// Returns all pairs that the library finds.
inline std::vector<TrianglePair> all_pairs(const Model& a, const Model& b,
                                           const Placement& placement, Workspace& workspace,
                                           const PairOptions& options = {}) {
    std::vector<TrianglePair> pairs(overlaps({a, b, placement, options}, workspace, {}));
    pairs.resize(overlaps({a, b, placement, options}, workspace, pairs));
    return pairs;
}

}  // namespace cdprep::test
