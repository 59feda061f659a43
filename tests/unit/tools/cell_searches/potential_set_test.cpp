// SPDX-License-Identifier: MIT
#include "cell_searches/potential_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/moved_model.h"
#include "support/brute_force.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::study {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

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

/// Triangles of B that the set keeps, source numbers; and those in leaves that it keeps are no
/// fewer.
std::vector<bool> kept(const Model& a, const Model& b, const Placement& placement) {
    const PotentialSet set(a, b, placement);
    std::vector<bool> result(b.triangle_count());
    const MovedModel stored(b, nullptr);
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < b.triangle_count(); ++i) {
        const bool holds = set.holds(stored.corners(i));
        result[b.source().triangle[i]] = holds;
        count += holds ? 1 : 0;
    }
    const std::size_t in_leaves = set.groups(kLeaf).triangles_of(b);
    EXPECT_LE(count, in_leaves);
    EXPECT_LE(in_leaves, set.groups(kCluster).triangles_of(b));
    EXPECT_LE(set.groups(kCluster).triangles_of(b), b.triangle_count());
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
                    const auto in_set = kept(box->model, of_b->model, placement);
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
        const auto in_set = kept(model.model, model.model, placement);
        return std::count(in_set.begin(), in_set.end(), true);
    };
    EXPECT_GE(count(1), 6);  // a face and all that share its edges
    EXPECT_LT(count(1), 12);
    EXPECT_EQ(count(1.01), 0);
    const Placement apart =
        Placement::b_moves(Pose::from_quaternion(1, 0, 0, 0, {1.01, 0, 0}).value());
    const GroupsOfBoth groups = groups_in_boxes(model.model, model.model, apart, kLeaf);
    EXPECT_TRUE(groups.a.numbers.empty() && groups.b.numbers.empty());
    EXPECT_EQ(count(0), 12);
}

/// The triangles of a model in groups, by source number.
std::vector<bool> in_groups(const Model& model, const TriangleGroups& groups) {
    std::vector<bool> result(model.triangle_count());
    for (std::uint32_t i = 0; i < model.triangle_count(); ++i) {
        result[model.source().triangle[i]] = groups.has(i);
    }
    return result;
}

// A law: groups in boxes and in slabs keep both triangles of each pair, and slabs leave out more.
TEST(GroupsOfBoth, KeepEveryPairThatOverlaps) {
    std::mt19937 random(43);
    const OpenModel a = with_bounds(icosphere(4), false);
    const OpenModel b = with_bounds(torus(1.5, 0.3, 60, 24), false);
    Workspace workspace;
    std::size_t all = 0, in_boxes = 0, in_slabs = 0, overlapping = 0;
    for (int round = 0; round < 60; ++round) {
        const Pose p = random_pose(random, 2), q = random_pose(random, 1);
        const Placement placement = std::array{Placement::b_moves(p), Placement::a_moves(p),
                                               Placement::world(p, q)}[round % 3];
        const auto pairs = all_pairs(a.model, b.model, placement, workspace);
        overlapping += pairs.size();
        for (const std::uint32_t height : {kLeaf, kCluster}) {
            const GroupsOfBoth boxes = groups_in_boxes(a.model, b.model, placement, height);
            const GroupsOfBoth slabs = groups_in_slabs(a.model, b.model, placement, boxes);
            for (const GroupsOfBoth* groups : {&boxes, &slabs}) {
                const auto of_a = in_groups(a.model, groups->a);
                const auto of_b = in_groups(b.model, groups->b);
                for (const TrianglePair& pair : pairs) {
                    ASSERT_TRUE(of_a[pair.a] && of_b[pair.b]) << round << ", height " << height;
                }
            }
            all += a.model.triangle_count() + b.model.triangle_count();
            in_boxes += boxes.a.triangles_of(a.model) + boxes.b.triangles_of(b.model);
            in_slabs += slabs.a.triangles_of(a.model) + slabs.b.triangles_of(b.model);
        }
    }
    EXPECT_GT(overlapping, 5'000U);
    EXPECT_LT(in_boxes * 10, all * 8);
    EXPECT_LT(in_slabs * 10, in_boxes * 9);
}

// A model with less than a leaf, and one with nothing, have one group and none.
TEST(GroupsOfBoth, SmallModelsAreOneGroup) {
    const TestMesh triangle = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{{0, 1, 2}}}};
    const OpenModel one = open_tiny(triangle), cube = open_tiny(unit_cube()),
                    none = open_tiny(TestMesh());
    const Placement still = Placement::b_moves(Pose());
    for (const std::uint32_t height : {kLeaf, kCluster}) {
        const GroupsOfBoth groups = groups_in_boxes(one.model, cube.model, still, height);
        EXPECT_EQ(groups.a.numbers, std::vector<std::uint32_t>{0});
        EXPECT_EQ(groups.b.triangles_of(cube.model), 12U);
        EXPECT_EQ(groups_in_slabs(one.model, cube.model, still, groups).a.numbers.size(), 1U);
        const GroupsOfBoth empty = groups_in_boxes(one.model, none.model, still, height);
        EXPECT_TRUE(empty.b.numbers.empty());
        EXPECT_TRUE(groups_in_slabs(one.model, none.model, still, empty).a.numbers.empty());
    }
}

}  // namespace
}  // namespace cdprep::study
