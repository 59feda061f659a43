// SPDX-License-Identifier: MIT
#include "cdprep/advanced/self_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "exact/triangle_contact.h"
#include "support/brute_force.h"
#include "support/meshes.h"

namespace cdprep {
namespace {

Corners corners_of(const test::TestMesh& mesh, std::uint32_t triangle) {
    const auto& v = mesh.triangles[triangle].vertex;
    return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

struct VisitedPair {
    std::uint32_t a, b;  ///< of the mesh, a < b
    bool certain;
    auto operator<=>(const VisitedPair&) const = default;
};

constexpr std::size_t kNoEnd = std::numeric_limits<std::size_t>::max();

/// Interrupts each part every so many steps.
std::vector<VisitedPair> walk(const test::TestMesh& mesh, build::Quality quality,
                              std::size_t steps = kNoEnd) {
    const build::Bvh bvh = build::build_bvh(
        mesh.positions, mesh.triangles, {.bounds = build::BvhBounds::aligned, .quality = quality});
    const SelfWalk walk(bvh, mesh.triangles, serial_for);
    Workspace workspace;
    std::vector<VisitedPair> pairs;
    for (std::size_t part = 0; part < walk.part_count(); ++part) {
        SelfWalk::Rest rest = walk.part(part);
        const auto found = [&](const SelfPair& pair) {
            EXPECT_LT(pair.a, pair.b);
            const auto [a, b] = std::minmax({bvh.order[pair.a], bvh.order[pair.b]});
            pairs.push_back({a, b, pair.certain});
        };
        while (!rest.empty()) {
            std::size_t left = steps;
            walk.run(rest, workspace, found, [&](std::size_t) { return --left == 0; });
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

struct Tally {
    std::size_t touching = 0, neighbours = 0, all = 0;
};

/// The oracle: the exact test on every pair.
void expect_all_contacts(const test::TestMesh& mesh, Tally& tally) {
    for (const build::Quality quality : {build::Quality::fast, build::Quality::best}) {
        const std::vector<VisitedPair> pairs = walk(mesh, quality);
        auto next = pairs.begin();
        for (std::uint32_t a = 0; a < mesh.triangles.size(); ++a) {
            for (std::uint32_t b = a + 1; b < mesh.triangles.size(); ++b) {
                const bool found = next != pairs.end() && next->a == a && next->b == b;
                const bool certain = found && next->certain;
                if (found) ++next;
                ++tally.all;
                if (share_a_vertex(mesh, a, b)) {
                    ASSERT_FALSE(found) << a << ' ' << b;
                    ++tally.neighbours;
                    continue;
                }
                const TriangleContact contact =
                    classify_contact(corners_of(mesh, a), corners_of(mesh, b));
                if (contact != TriangleContact::disjoint) {
                    ASSERT_TRUE(found) << a << ' ' << b;
                    ++tally.touching;
                }
                if (certain) {
                    ASSERT_EQ(contact, TriangleContact::cross);
                }
            }
        }
        ASSERT_EQ(next, pairs.end()) << "a pair twice";
    }
}

TEST(SelfWalk, FindsEveryContactOfTrianglesWithoutACommonVertexOnce) {
    Tally tally;
    for (const int count : {1, 7, 8, 9, 64, 65, 300}) {
        for (std::uint32_t seed = 1; seed < 5; ++seed) {
            for (const double scale : {1.0, 0x1p-40, 0x1p40}) {
                expect_all_contacts(
                    test::moved_by(with_shared_vertices(test::coarse_grid_soup(seed, count, 4)),
                                   scale, {0, 0, 0}),
                    tally);
                expect_all_contacts(
                    test::moved_by(test::random_soup(seed, count, 1.2), scale, {0, 0, 0}), tally);
            }
        }
    }
    EXPECT_GT(tally.touching, tally.all / 20);
    EXPECT_GT(tally.neighbours, tally.all / 200);
}

// Far from the origin doubles are coarse beside the triangles, and leaves are not exact.
TEST(SelfWalk, MissesNothingFarFromTheOrigin) {
    Tally tally;
    for (const double away : {1e3, 1e9, 1e14}) {
        expect_all_contacts(test::moved_by(test::random_soup(3, 200, 1.2), 1, {away, -away, 7}),
                            tally);
        expect_all_contacts(test::moved_by(with_shared_vertices(test::coarse_grid_soup(4, 200, 3)),
                                           0.1, {away, away, -away}),
                            tally);
    }
    EXPECT_GT(tally.touching, tally.all / 20);
}

TEST(SelfWalk, FewPairsAreLeftOpenOnASmoothSurface) {
    EXPECT_LT(walk(test::icosphere(4), build::Quality::fast).size(), 20u * 256 / 100);
}

// A part goes on where it was interrupted: by definition the pairs are those of one run.
TEST(SelfWalk, InterruptedAnywhereItFindsTheSamePairs) {
    const test::TestMesh mesh = test::random_soup(5, 3000, 1.2);
    const std::vector<VisitedPair> whole = walk(mesh, build::Quality::fast);
    EXPECT_GT(whole.size(), 1000u);
    for (const std::size_t steps : {1, 2, 7}) {
        EXPECT_EQ(walk(mesh, build::Quality::fast, steps), whole) << steps;
    }
}

TEST(SelfWalk, OfNothingFindsNothing) {
    EXPECT_TRUE(walk({}, build::Quality::fast).empty());
}

// By the header: numbers end at part_count(), and the BVH is of these triangles.
TEST(SelfWalkDeathTest, APartOrTrianglesThatDoNotExistStopTheProgram) {
    const test::TestMesh mesh = test::icosphere(1);
    const build::Bvh bvh =
        build::build_bvh(mesh.positions, mesh.triangles, {.bounds = build::BvhBounds::aligned});
    const SelfWalk walk(bvh, mesh.triangles, serial_for);
    EXPECT_FALSE(walk.part(walk.part_count() - 1).empty());
    EXPECT_DEATH((void)walk.part(walk.part_count()), "no part with this number");
    EXPECT_DEATH(SelfWalk(bvh, std::span(mesh.triangles).first(7), serial_for),
                 "not built over these triangles");
}

}  // namespace
}  // namespace cdprep
