// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cdprep/live_model.h"
#include "cdprep/self.h"
#include "support/brute_force.h"
#include "support/exact_contact.h"
#include "support/exact_pairs.h"
#include "support/hard_triangles.h"
#include "support/open_tiny.h"

namespace cdprep::test {
namespace {

bool is_proper(TriangleContact contact) {
    return contact == TriangleContact::cross || contact == TriangleContact::coplanar_overlap;
}

/// The definition in exact numbers.
TriangleContact defined_contact(const Corners& a, const Corners& b) {
    return exact_contact(a, b);
}
/// The same for small integers.
TriangleContact integer_contact(const Corners& a, const Corners& b) {
    return contact_by_definition(exact<std::int64_t>(a), exact<std::int64_t>(b));
}

/// The number of pairs found, and of those that touch without overlapping properly.
struct Found {
    std::size_t closed = 0;
    std::size_t proper = 0;
    std::size_t skipped = 0;  ///< pairs with a degenerate triangle
    std::size_t asked = 0;
};

/// Every pair of a mesh and every option, against the contacts of an oracle.
template <class Contact>
void expect_own_pairs(const TestMesh& mesh, const TinyOptions& how, Contact&& contact,
                      Found& tally) {
    std::vector<TrianglePair> proper, closed, kept, proper_kept;
    closed = own_pairs(mesh, [&](const Corners& a, const Corners& b) {
        return contact(a, b) != TriangleContact::disjoint;
    });
    for (const TrianglePair& pair : closed) {
        const Corners a = corners_of(mesh, pair.a, nullptr), b = corners_of(mesh, pair.b, nullptr);
        const bool is_kept = !is_degenerate(a) && !is_degenerate(b);
        const bool crosses = is_proper(contact(a, b));
        if (crosses) proper.push_back(pair);
        if (is_kept) kept.push_back(pair);
        if (is_kept && crosses) proper_kept.push_back(pair);
    }
    const OpenModel model = open_tiny(mesh, how);
    Workspace workspace;
    const auto ask = [&](Overlap overlap, Degenerate degenerate) {
        return all_own_pairs(model.model, workspace, {overlap, degenerate});
    };
    ASSERT_EQ(ask(Overlap::closed, Degenerate::keep), closed);
    ASSERT_EQ(ask(Overlap::proper, Degenerate::keep), proper);
    ASSERT_EQ(ask(Overlap::closed, Degenerate::skip), kept);
    ASSERT_EQ(ask(Overlap::proper, Degenerate::skip), proper_kept);
    tally.closed += closed.size();
    tally.proper += proper.size();
    tally.skipped += closed.size() - kept.size();
    tally.asked += mesh.triangles.size() * (mesh.triangles.size() - 1) / 2;
}

constexpr int kCounts[] = {1, 2, 7, 8, 9, 16, 64, 65, 120};

// The oracle: the definition of contact in machine integers. On coarse grids most coincidences
// come about: common corners, edges in planes, coplanar triangles, collinear corners.
TEST(SelfOverlapsLaws, OfCoarseMeshesAreThoseOfTheDefinition) {
    Found tally;
    std::uint32_t seed = 0;
    for (const int count : kCounts) {
        for (const int grid : {2, 3, 5}) {
            for (const bool is_double : {false, true}) {
                const TestMesh soup = coarse_grid_soup(++seed, count, grid);
                const TinyOptions how = {.double_precision = is_double};
                expect_own_pairs(soup, how, integer_contact, tally);
                expect_own_pairs(with_shared_vertices(soup), how, integer_contact, tally);
            }
        }
    }
    EXPECT_GT(tally.proper, tally.asked / 50);
    EXPECT_GT(tally.closed - tally.proper, tally.asked / 200);
    EXPECT_GT(tally.skipped, 100U);
}

// The oracle: the definition in exact numbers. Doubles that are not floats, so leaves are rounded;
// sizes far from 1, and places far from the origin, where doubles are coarse.
TEST(SelfOverlapsLaws, OfRandomMeshesAreThoseOfTheDefinition) {
    Found tally;
    std::uint32_t seed = 0;
    const TinyOptions how = {.double_precision = true};
    for (const int count : {9, 40}) {
        for (const double scale : {1.0, 0x1p-40, 0x1p40, 1e-3}) {
            const TestMesh soup = random_soup(++seed, count, 1.5);
            expect_own_pairs(moved_by(soup, scale, {0, 0, 0}), how, defined_contact, tally);
        }
        for (const double away : {1e9, 1e14}) {
            const TestMesh grid = coarse_grid_soup(++seed, count, 3);
            expect_own_pairs(moved_by(grid, 0.1, {away, away, -away}), how, defined_contact, tally);
        }
    }
    EXPECT_GT(tally.proper, tally.asked / 50);
    EXPECT_GT(tally.closed, tally.proper);
}

// Slivers: two corners of each triangle are nearly one, across many powers of two.
TEST(SelfOverlapsLaws, OfSliversAreThoseOfTheDefinition) {
    std::mt19937 random(3);
    Found tally;
    for (int round = 0; round < 20; ++round) {
        TestMesh mesh = coarse_grid_soup(random(), 30, 2);
        for (const Triangle& t : mesh.triangles) {
            const Double3& from = mesh.positions[t.vertex[0]];
            const double by = std::ldexp(1, -static_cast<int>(random() % 50));
            mesh.positions[t.vertex[1]] = {from.x + by, from.y, from.z - by};
        }
        expect_own_pairs(mesh, {.double_precision = true}, defined_contact, tally);
    }
    EXPECT_GT(tally.proper, tally.asked / 200);
    EXPECT_GT(tally.closed, tally.proper);
}

/// A sheet in the plane z = 0, folded along x = `crease` onto itself.
TestMesh folded_sheet(int n, int m, double crease) {
    TestMesh sheet = grid_sheet(n, m);
    for (Double3& p : sheet.positions) p.x = std::fabs(p.x - crease);
    return sheet;
}

// Two layers in one plane: every leaf of one meets leaves of the other.
TEST(SelfOverlapsLaws, OfASheetFoldedOntoItselfAreThoseOfTheDefinition) {
    Found tally;
    const auto halved = [](const Corners& a, const Corners& b) {
        const auto twice = [](Corners t) {
            for (Double3& p : t) p = {2 * p.x, 2 * p.y, 2 * p.z};
            return t;
        };
        return integer_contact(twice(a), twice(b));
    };
    for (const double crease : {6.0, 5.5, 2.0}) {
        const TestMesh sheet = folded_sheet(12, 9, crease);
        expect_own_pairs(sheet, {}, halved, tally);
        expect_own_pairs(sheet, {.double_precision = true}, halved, tally);
    }
    EXPECT_GT(tally.proper, 500U);
    EXPECT_GT(tally.closed, 2 * tally.proper);
}

// The catalogue of hard pairs as meshes of two triangles, with every order of corners.
TEST(SelfOverlapsLaws, OfHardTrianglesAreThoseOfTheCatalogue) {
    Workspace workspace;
    std::size_t asked = 0;
    for (const HardPair& hard : hard_triangles()) {
        for (std::size_t number = 0; number < 72; ++number) {
            const HardPair pair = relabelled(hard, number);
            TestMesh mesh{{}, {{{0, 1, 2}}, {{3, 4, 5}}}};
            for (const Corners& corners : {pair.a, pair.b}) {
                mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
            }
            const OpenModel model = open_tiny(mesh, {.double_precision = true});
            EXPECT_EQ(self_overlaps(model.model, workspace, {}), pair.closed ? 1U : 0U) << pair.id;
            EXPECT_EQ(self_overlaps(model.model, workspace, {}, {.overlap = Overlap::proper}),
                      pair.proper ? 1U : 0U)
                << pair.id;
            ++asked;
        }
    }
    EXPECT_GT(asked, 1000U);
}

// Against overlaps() of the model with itself, which the definition proves elsewhere. Many leaves,
// so that leaves of a batch contend for places, and every kind of bounds in the file.
TEST(SelfOverlapsLaws, OfLargeMeshesAreOverlapsWithoutNeighbours) {
    const TestMesh ball = icosphere(5);
    const TestMesh crossed = joined(ball, turned(moved_by(ball, 1, {0.5, 0.25, 0}), 1));
    const TestMesh soup = random_soup(11, 5000, 0.2);
    Workspace workspace;
    for (const TestMesh& mesh : {crossed, soup, klein_bottle(101, 61)}) {
        for (const build::BvhBounds bounds :
             {build::BvhBounds::aligned, build::BvhBounds::oriented_and_swept}) {
            const OpenModel model = open_tiny(mesh, {.double_precision = true, .bounds = bounds});
            auto expected = all_pairs(model.model, model.model, Placement::b_moves({}), workspace);
            std::erase_if(expected, [&](const TrianglePair& pair) {
                return pair.a >= pair.b || share_a_vertex(mesh, pair.a, pair.b);
            });
            EXPECT_GT(expected.size(), 100U);
            EXPECT_TRUE(all_own_pairs(model.model, workspace) == expected);
        }
    }
}

// By definition a refitted model answers as one that is built anew. A sheet rolls up through
// itself; floats and doubles, with and without room for more triangles.
TEST(SelfOverlapsLaws, OfALiveModelAreThoseOfANewOne) {
    const TestMesh rest = grid_sheet(24, 10);
    Workspace workspace;
    for (const std::uint32_t room : {0U, 600U}) {
        const auto arrays = build::build_model(rest.positions, rest.triangles,
                                               {.bounds = build::BvhBounds::aligned});
        ASSERT_TRUE(arrays);
        const LiveLimits limits = {.triangles = room};
        AlignedBytes memory(LiveModel::bytes(arrays.value(), limits).value());
        auto live = LiveModel::in(memory.span(), arrays.value(), limits);
        ASSERT_TRUE(live);
        std::size_t found = 0;
        for (int frame = 0; frame < 12; ++frame) {
            TestMesh shape = rest;
            const double bend = 0.08 * frame;
            for (Double3& p : shape.positions) {
                const double radius = 4 + 0.3 * std::sin(p.x) + 0.1 * p.y;
                p = {radius * std::sin(bend * p.x), p.y + 0.02 * frame * p.x,
                     radius * std::cos(bend * p.x)};
            }
            ASSERT_TRUE(live.value().refit(shape.positions));
            const auto pairs = all_own_pairs(live.value().model(), workspace);
            ASSERT_EQ(pairs, own_pairs(shape)) << frame;
            const OpenModel anew = open_tiny(shape, {.double_precision = true});
            ASSERT_EQ(pairs, all_own_pairs(anew.model, workspace)) << frame;
            found += pairs.size();
        }
        EXPECT_GT(found, 300U);
    }
}

}  // namespace
}  // namespace cdprep::test
