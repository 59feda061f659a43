// SPDX-License-Identifier: MIT
#include "cells/potential_set.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/brute_force.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "walk/contact_pairs.h"

namespace cdprep::test {
namespace {

/// The same file with the model's own box as its oriented one, turned about z by 45 degrees
/// where it is to be wider than it need be.
OpenModel with_bounds(const TestMesh& mesh, bool turned) {
    format::Bounds bounds{};
    Box3 box = box_of({mesh.positions[0], mesh.positions[0], mesh.positions[0]});
    for (const Double3& p : mesh.positions) {
        box.lower = {std::min(box.lower.x, p.x), std::min(box.lower.y, p.y),
                     std::min(box.lower.z, p.z)};
        box.upper = {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y),
                     std::max(box.upper.z, p.z)};
    }
    const double s = turned ? std::sqrt(0.5) : 0, c = turned ? std::sqrt(0.5) : 1;
    bounds.lower = box.lower;
    bounds.upper = box.upper;
    bounds.oriented_centre = {(box.lower.x + box.upper.x) / 2, (box.lower.y + box.upper.y) / 2,
                              (box.lower.z + box.upper.z) / 2};
    bounds.axis = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
    const double x = (box.upper.x - box.lower.x) / 2, y = (box.upper.y - box.lower.y) / 2;
    bounds.half_extent = {(c * x + s * y) * 1.0001, (s * x + c * y) * 1.0001,
                          (box.upper.z - box.lower.z) / 2 * 1.0001};
    return open_tiny(with_sections(
        bake_tiny(mesh.positions, mesh.triangles),
        {as_section(SectionId::bounds, std::span<const format::Bounds>(&bounds, 1))}));
}

/// Triangles of B that the set keeps, tree order, by way of the hierarchy.
std::vector<bool> kept(const Model& a, const Model& b, const Placement& placement,
                       Workspace& workspace) {
    const PotentialSet set(a, b, placement);
    std::vector<bool> result(b.triangle_count());
    if (set.is_empty()) return result;
    const MovedModel stored(b, nullptr);
    walk_nodes(
        b, workspace.storage(), [&](const format::BvhNode& node) { return set.judge(node); },
        [&](const TriangleRun& run) {
            for (std::uint32_t i = run.first; i < run.last; ++i) {
                result[source_number(b, i)] = set.holds(stored.corners(i));
            }
            return true;
        },
        [](const TriangleRun&) { return true; });
    return result;
}

// A law: what overlaps is potentially colliding; and most of what is not is left out.
TEST(PotentialSet, HoldsEveryTriangleThatOverlaps) {
    std::mt19937 random(41);
    const TestMesh a = icosphere(3), b = torus(1.5, 0.3, 40, 16);
    const OpenModel plain = open_tiny(a);
    const OpenModel straight = with_bounds(a, false), turned = with_bounds(a, true);
    const OpenModel model_b = open_tiny(b), bounded_b = with_bounds(b, true);
    Workspace workspace;
    std::size_t held = 0, overlapping = 0, asked = 0;
    for (int round = 0; round < 40; ++round) {
        const Pose p = random_pose(random, 1.5), q = random_pose(random, 1);
        for (const Placement& placement :
             {Placement::b_moves(p), Placement::a_moves(p), Placement::world(p, q)}) {
            const auto pairs = all_pairs(plain.model, model_b.model, placement, workspace);
            for (const OpenModel* box : {&plain, &straight, &turned}) {
                for (const OpenModel* of_b : {&model_b, &bounded_b}) {
                    const auto in_set = kept(box->model, of_b->model, placement, workspace);
                    for (const TrianglePair& pair : pairs) ASSERT_TRUE(in_set[pair.b]) << round;
                    held +=
                        static_cast<std::size_t>(std::count(in_set.begin(), in_set.end(), true));
                    asked += in_set.size();
                    overlapping += pairs.size();
                }
            }
        }
    }
    EXPECT_GT(overlapping, 10'000U);
    EXPECT_GT(held, asked * 3 / 10);
    EXPECT_LT(held, asked * 7 / 10);
}

// By construction: boxes a hair apart clip everything, boxes that touch keep the touch.
TEST(PotentialSet, TouchingIsKeptAndApartIsNot) {
    const TestMesh cube = unit_cube();
    const OpenModel model = with_bounds(cube, false);
    Workspace workspace;
    const auto count = [&](double x) {
        const Placement placement =
            Placement::b_moves(Pose::from_quaternion(1, 0, 0, 0, {x, 0, 0}).value());
        const auto in_set = kept(model.model, model.model, placement, workspace);
        return std::count(in_set.begin(), in_set.end(), true);
    };
    EXPECT_GE(count(1), 6);  // a face and all that share its edges
    EXPECT_LT(count(1), 12);
    EXPECT_EQ(count(1.01), 0);
    EXPECT_EQ(count(0), 12);
}

}  // namespace
}  // namespace cdprep::test
