// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "core/moved_model.h"
#include "exact/triangle_distance.h"
#include "hull/exact_nearest.h"
#include "pieces/contact_side.h"
#include "pieces/contact_steps.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/rounds.h"

namespace cdprep {
namespace {

/// Solids with corners at whole numbers, so that many pairs of triangles are equally far apart.
test::TestMesh cube() {
    return test::moved_by(test::unit_cube(), 2, {-1, -1, -1});
}
test::TestMesh octahedron() {
    test::TestMesh mesh;
    mesh.positions = {{2, 0, 0}, {-2, 0, 0}, {0, 2, 0}, {0, -2, 0}, {0, 0, 2}, {0, 0, -2}};
    mesh.triangles = {{{0, 2, 4}}, {{2, 1, 4}}, {{1, 3, 4}}, {{3, 0, 4}},
                      {{2, 0, 5}}, {{1, 2, 5}}, {{3, 1, 5}}, {{0, 3, 5}}};
    return mesh;
}

test::OpenModel piece_of(const test::TestMesh& mesh, double scale) {
    const test::TestMesh scaled = test::moved_by(mesh, scale, {0, 0, 0});
    return test::open_tiny(test::with_contacts(test::with_one_piece(
        test::bake_tiny(scaled.positions, scaled.triangles, {.double_precision = true}))));
}

/// As nearest_triangles() is defined: all pairs, and the first of those that are equally near. Also
/// returns bounds of their distance.
std::pair<TreePair, DistanceBounds> nearest_of_all(const ContactSide& a, const ContactSide& b) {
    std::vector<std::pair<TriangleDistance, TreePair>> all;
    const bool b_is_large = b.triangles().size() > a.triangles().size();
    const std::size_t large = (b_is_large ? b : a).triangles().size();
    const std::size_t small = (b_is_large ? a : b).triangles().size();
    for (std::uint32_t i = 0; i < large; ++i) {
        for (std::uint32_t j = 0; j < small; ++j) {
            const TreePair pair = b_is_large ? TreePair{j, i} : TreePair{i, j};
            all.push_back(
                {triangle_distance(a.model().corners(pair.a), b.model().corners(pair.b), false),
                 pair});
        }
    }
    const auto by = [](auto member) {
        return [member](const auto& x, const auto& y) { return x.first.*member < y.first.*member; };
    };
    const double upper = std::ranges::min(all, by(&TriangleDistance::upper)).first.upper;
    const double lower = std::ranges::min(all, by(&TriangleDistance::lower)).first.lower;
    const auto first = std::ranges::find_if(
        all, [&](const auto& one) { return one.first.upper <= upper * (1 + 0x1p-41); });
    return {first->second, {lower, upper}};
}

// Scales reach from the smallest numbers, where products round to nothing, to large ones.
TEST(NearestTriangles, AreTheFirstOfTheNearestFromAnyStart) {
    const std::vector<test::TestMesh> meshes = {cube(), octahedron()};
    std::mt19937 random(8);
    std::uniform_int_distribution<int> aside(-6, 6), away(4, 9);
    Workspace workspace;
    for (const double scale : {0x1p-1074, 0x1p-1060, 0x1p-500, 1.0, 0x1p500, 0x1p900}) {
        for (const test::TestMesh& first : meshes) {
            for (const test::TestMesh& second : meshes) {
                const test::OpenModel model_a = piece_of(first, scale);
                const test::OpenModel model_b = piece_of(second, scale);
                for (int round = 0; round < test::rounds(200, 5); ++round) {
                    const Pose pose =
                        Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, scale * away(random),
                                         scale * aside(random), scale * aside(random)})
                            .value();
                    const MovedModel moved_a(model_a.model, nullptr), moved_b(model_b.model, &pose);
                    const ContactSide a(moved_a, 0, nullptr, workspace.storage());
                    const ContactSide b(moved_b, 0, nullptr, workspace.storage());
                    const std::size_t triangles_a = a.triangles().size(),
                                      triangles_b = b.triangles().size();
                    const TreePair start = {static_cast<std::uint32_t>(random() % triangles_a),
                                            static_cast<std::uint32_t>(random() % triangles_b)};
                    const auto [found, least] = nearest_triangles(a, b, start, Degenerate::keep);
                    const auto [expected, bounds] = nearest_of_all(a, b);
                    ASSERT_EQ(found.a, expected.a) << scale;
                    ASSERT_EQ(found.b, expected.b) << scale;
                    ASSERT_LE(least, bounds.upper) << scale;
                    ASSERT_GE(least, bounds.lower * (1 - 0x1p-40)) << scale;
                }
            }
        }
    }
}

}  // namespace
}  // namespace cdprep
