// SPDX-License-Identifier: MIT
#include "cdprep/advanced/convex_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cdprep/advanced/convex_penetration.h"
#include "exact/predicates.h"
#include "exact/triangle_contact.h"
#include "support/exact_hull_pair.h"
#include "support/hard_hulls.h"
#include "support/hull_pairs.h"
#include "support/meshes.h"
#include "support/placements.h"
#include "support/small_hull.h"

namespace cdprep::test {
namespace {

/// What the four questions answer about two hulls.
struct Answered {
    bool meet;
    ConvexDistance distance;
    std::optional<Penetration> depth;
};

/// Asks all questions both ways round, and holds the answers against the definition, in
/// exact numbers.
template <class Number>
Answered ask(const Points& a, const Points& b, const Placement& placement) {
    const Points at_a = placement.a_is_moved() ? moved_points(a, placement.pose_a()) : a;
    const Points at_b = placement.b_is_moved() ? moved_points(b, placement.pose_b()) : b;
    const ExactHullPair<Number> exact(at_a, at_b);
    const auto truth = exact.squared_distance();
    const SmallHull hull_a(a), hull_b(b);
    const ConvexPoints view_a = hull_a.view(), view_b = hull_b.view();
    const Placement back = Placement::world(placement.pose_b(), placement.pose_a());
    Answered answered{};
    answered.meet = convex_collide(view_a, view_b, placement);
    EXPECT_EQ(answered.meet, !truth);
    EXPECT_EQ(convex_collide(view_b, view_a, back), !truth);
    answered.distance = convex_distance(view_a, view_b, placement).value();
    answered.depth = convex_penetration(view_a, view_b, placement);
    EXPECT_EQ(answered.depth.has_value(), !truth);
    EXPECT_EQ(convex_penetration(view_b, view_a, back).has_value(), !truth);
    if (truth) {
        EXPECT_GT(answered.distance.lower, 0);
        EXPECT_LE(compare_length(answered.distance.lower, *truth), 0);
        EXPECT_GE(compare_length(answered.distance.upper, *truth), 0);
    } else {
        EXPECT_EQ(answered.distance.upper, 0);
        const auto depth = exact.squared_depth();
        EXPECT_LE(compare_length(answered.depth->lower, depth), 0);
        EXPECT_GE(compare_length(answered.depth->upper, depth), 0);
    }
    return answered;
}

double width(const ConvexDistance& distance) {
    return distance.upper - distance.lower;
}
double width(const Penetration& depth) {
    return depth.upper - depth.lower;
}

// By hand: faces 3 apart, corner to corner (1, 2, 2) apart, one inside the other.
TEST(ConvexDistance, OfBoxesIsKnownByHand) {
    const Points box = box_corners(1, 1, 1);
    const SmallHull hull(box);
    const ConvexPoints view = hull.view();
    const auto far = convex_distance(view, view, shifted({5, 0.5, -0.5}));
    EXPECT_LE(far->lower, 3);
    EXPECT_GE(far->upper, 3);
    EXPECT_DOUBLE_EQ(far->witness_a.x, 1);
    EXPECT_DOUBLE_EQ(far->witness_b.x, 4);
    EXPECT_NEAR(convex_distance(view, view, shifted({3, 4, -4}))->upper, 3, 1e-14);
    EXPECT_TRUE(convex_within(view, view, shifted({3, 4, -4}), 3));
    EXPECT_FALSE(convex_within(view, view, shifted({3, 4, -4}), std::nextafter(3, 0)));
    const SmallHull small(box_corners(0.25, 0.25, 0.25));
    EXPECT_TRUE(convex_collide(view, small.view(), shifted({0.5, 0, 0})));
    EXPECT_EQ(convex_distance(view, small.view(), shifted({0.5, 0, 0}))->upper, 0);
    EXPECT_NEAR(convex_penetration(view, small.view(), shifted({0.5, 0, 0}))->upper, 0.75, 1e-14);
}

TEST(ConvexDistance, LimitIsInclusiveAndNothingIsBeyond) {
    const SmallHull hull(box_corners(1, 1, 1));
    const ConvexPoints view = hull.view();
    EXPECT_TRUE(convex_distance(view, view, shifted({5, 0, 0}), {.max_distance = 3}));
    EXPECT_FALSE(convex_distance(view, view, shifted({5, 0, 0}), {.max_distance = 2.99}));
    EXPECT_FALSE(convex_distance(view, view, shifted({5, 0, 0}), {.max_distance = -1}));
    EXPECT_FALSE(convex_within(view, view, shifted({0, 0, 0}), -1));
    EXPECT_FALSE(convex_within(view, view, shifted({0, 0, 0}), std::nan("")));
    EXPECT_TRUE(
        convex_within(view, view, shifted({5, 0, 0}), std::numeric_limits<double>::infinity()));
}

TEST(ConvexDistance, OfNothingIsNothing) {
    const SmallHull hull(box_corners(1, 1, 1));
    const ConvexPoints none;
    EXPECT_FALSE(convex_collide(none, hull.view(), shifted({})));
    EXPECT_FALSE(convex_distance(hull.view(), none, shifted({})));
    EXPECT_FALSE(convex_within(none, none, shifted({}), 1));
    EXPECT_FALSE(convex_penetration(none, hull.view(), shifted({})));
}

// By construction: boxes well apart are told apart in double, stacked ones in integers.
TEST(ConvexDistance, CountsSayWhetherIntegersDecided) {
    const SmallHull hull(box_corners(1, 1, 1));
    QueryCounts apart, stacked;
    EXPECT_FALSE(convex_collide(hull.view(), hull.view(), shifted({3, 0, 0}), nullptr, &apart));
    EXPECT_EQ(apart.hull_pairs, 1u);
    EXPECT_GE(apart.hull_steps, 1u);
    EXPECT_EQ(apart.hulls_by_exact, 0u);
    EXPECT_TRUE(convex_collide(hull.view(), hull.view(), shifted({0, 0, 2}), nullptr, &stacked));
    EXPECT_EQ(stacked.hull_pairs, 1u);
    EXPECT_EQ(stacked.hulls_by_exact, 1u);
}

TEST(ConvexDistance, PermittedErrorsAreKept) {
    std::mt19937 random(7);
    const SmallHull hull(lattice_sphere(65));
    for (const double error : {1e-14, 1e-6, 1e-3, 0.1, 1.0}) {
        for (int i = 0; i < 20; ++i) {
            const Placement placement = Placement::b_moves(random_pose(random, 300));
            const auto best = convex_distance(hull.view(), hull.view(), placement);
            const auto relative =
                convex_distance(hull.view(), hull.view(), placement, {.relative_error = error});
            EXPECT_LE(width(*relative), error * relative->upper);
            EXPECT_LE(relative->lower, best->upper);
            EXPECT_GE(relative->upper, best->lower);
            const auto absolute =
                convex_distance(hull.view(), hull.view(), placement, {.absolute_error = error});
            EXPECT_LE(width(*absolute), std::max(error, 1e-12));
        }
    }
}

// By definition: such an error permits nothing, so the answer is that without an error.
TEST(ConvexDistance, ErrorsThatAreNoLengthsCountAsZero) {
    std::mt19937 random(8);
    const SmallHull hull(lattice_sphere(65));
    for (int i = 0; i < 20; ++i) {
        const Placement placement = Placement::b_moves(random_pose(random, i % 2 == 0 ? 300 : 30));
        const auto apart = convex_distance(hull.view(), hull.view(), placement);
        const auto deep = convex_penetration(hull.view(), hull.view(), placement);
        for (const double error : {std::nan(""), -1.0, -1e308}) {
            for (const DistanceOptions& options : {DistanceOptions{.relative_error = error},
                                                   DistanceOptions{.absolute_error = error}}) {
                const auto found = convex_distance(hull.view(), hull.view(), placement, options);
                ASSERT_TRUE(found && apart);
                EXPECT_EQ(found->lower, apart->lower);
                EXPECT_EQ(found->upper, apart->upper);
                const auto depth = convex_penetration(hull.view(), hull.view(), placement, options);
                ASSERT_EQ(depth.has_value(), deep.has_value());
                if (!depth) continue;
                EXPECT_EQ(depth->lower, deep->lower);
                EXPECT_EQ(depth->upper, deep->upper);
            }
        }
    }
}

// G01
TEST(ConvexDistance, KissingBoxesHaveTheSignOfTheGivenDoubles) {
    for (const HardHulls& boxes : kissing_boxes()) {
        const Answered answered = ask<ExactNumber>(boxes.a, boxes.b, boxes.placement);
        EXPECT_LT(answered.meet ? answered.depth->upper : answered.distance.upper, 1e-14);
    }
}

// G02
TEST(ConvexDistance, PlateAndTiltedBoxHaveADepth) {
    const HardHulls hard = plate_and_tilted_box();
    const Answered answered = ask<ExactNumber>(hard.a, hard.b, hard.placement);
    ASSERT_TRUE(answered.meet);
    EXPECT_LT(width(*answered.depth), 1e-14);
}

// G03: displaced along edges and diagonals the origin lies on faces, edges and corners of the
// difference, and of every simplex within it.
TEST(ConvexDistance, ContactsOnFacesOfSimplicesAreKept) {
    const Points box = box_corners(1, 1, 1);
    for (int i = 0; i < 343; ++i) {
        SCOPED_TRACE(i);
        const Double3 t = {double(i % 7 - 3), double(i / 7 % 7 - 3), double(i / 49 - 3)};
        const Answered answered = ask<Integer128>(box, box, shifted(t));
        const double most = std::max({std::fabs(t.x), std::fabs(t.y), std::fabs(t.z)});
        EXPECT_EQ(answered.meet, most <= 2);
        if (!answered.meet) continue;
        EXPECT_NEAR(answered.depth->upper, 2 - most, 1e-14);
    }
}

// G04: a polytope for which a published implementation of the signed volumes was reported to
// answer a wrong distance; its faces are squares, hexagons and rectangles.
TEST(ConvexDistance, PolytopeOf24CornersIsMeasuredRightly) {
    const Points points = polytope_of_24_corners();
    for (const Double3& q : {Double3{1, 1, 1}, Double3{0.5, 0.5, 0.5}, Double3{0, 0.4, -0.5},
                             Double3{0.3, 0.3, 0.3}}) {
        const Answered answered = ask<ExactNumber>(points, {q}, shifted({}));
        EXPECT_LE(width(answered.distance), 1e-14);
    }
}

bool holds(const SmallHull& hull, const Points& at, const Double3& p) {
    return std::all_of(hull.triangles().begin(), hull.triangles().end(), [&](const auto& t) {
        return orient3d(at[t[0]], at[t[1]], at[t[2]], p) >= 0;
    });
}

bool surfaces_meet(const SmallHull& a, const Points& at_a, const SmallHull& b, const Points& at_b) {
    for (const auto& s : a.triangles()) {
        for (const auto& t : b.triangles()) {
            if (triangles_touch({at_a[s[0]], at_a[s[1]], at_a[s[2]]},
                                {at_b[t[0]], at_b[t[1]], at_b[t[2]]})) {
                return true;
            }
        }
    }
    return false;
}

// G05: a library was reported to answer 0 for hulls that were apart. Here whoever is apart has
// a direction between the witnesses that separates without rounding, and whoever is not
// has triangles that touch, or one hull inside the other.
TEST(ConvexDistance, NothingIsZeroWithoutACommonPoint) {
    std::mt19937 random(3383);
    const Points points_a = normal_points(random, 60), points_b = normal_points(random, 80);
    const SmallHull a(points_a), b(points_b);
    int apart = 0;
    for (int i = 0; i < 3000; ++i) {
        SCOPED_TRACE(i);
        const Pose pose = random_pose(random, 4);
        const auto d = convex_distance(a.view(), b.view(), Placement::b_moves(pose));
        const Points at_b = moved_points(b.points(), pose);
        if (d->lower > 0) {
            ++apart;
            const Double3 &p = d->witness_a, &q = d->witness_b;
            ASSERT_TRUE(proof_by({q.x - p.x, q.y - p.y, q.z - p.z}, a.points(), at_b));
        } else {
            ASSERT_EQ(d->upper, 0);
            ASSERT_TRUE(surfaces_meet(a, a.points(), b, at_b) || holds(a, a.points(), at_b[0]) ||
                        holds(b, at_b, a.points()[0]));
        }
    }
    EXPECT_GT(apart, 900);
    EXPECT_LT(apart, 2100);
}

// G06, by construction: the caps are g apart, together, or g in each other.
TEST(ConvexDistance, PrismsOnOneAxisAreAsFarApartAsTheirCaps) {
    const SmallHull hull(prism(1000));
    const ConvexPoints view = hull.view();
    constexpr double kGap = 0x1p-30;
    const auto apart = convex_distance(view, view, shifted({0, 0, 1 + kGap}));
    EXPECT_LE(apart->lower, kGap);
    EXPECT_GE(apart->upper, kGap);
    EXPECT_LE(width(*apart), 1e-14);
    EXPECT_TRUE(convex_within(view, view, shifted({0, 0, 1 + kGap}), kGap));
    EXPECT_FALSE(convex_within(view, view, shifted({0, 0, 1 + kGap}), std::nextafter(kGap, 0)));
    EXPECT_TRUE(convex_collide(view, view, shifted({0, 0, 1})));
    EXPECT_EQ(convex_distance(view, view, shifted({0, 0, 1}))->upper, 0);
    EXPECT_LE(convex_penetration(view, view, shifted({0, 0, 1}))->upper, 1e-14);
    const auto deep = convex_penetration(view, view, shifted({0, 0, 1 - kGap}));
    EXPECT_LE(deep->lower, kGap);
    EXPECT_GE(deep->upper, kGap);
    EXPECT_LE(width(*deep), 1e-14);
    EXPECT_NEAR(std::fabs(deep->normal.z), 1, 1e-9);
}

// G07, by hand: a cube turned by 3-4-5 has its foremost edge at x = 7, y = 1.
TEST(ConvexDistance, WitnessesLieOnParallelFacesAndEdges) {
    const Points cube = box_corners(5, 5, 5);
    const Answered faces = ask<Integer128>(cube, cube, shifted({13, 2, 3}));
    EXPECT_NEAR(faces.distance.upper, 3, 1e-13);
    EXPECT_NEAR(faces.distance.witness_a.x, 5, 1e-14);
    EXPECT_NEAR(faces.distance.witness_b.x, 8, 1e-14);
    Points turned;
    for (const Double3& p : cube) {
        turned.push_back({(3 * p.x - 4 * p.y) / 5, (4 * p.x + 3 * p.y) / 5, p.z});
    }
    const Points mirrored = moved_points(turned, pose_of({-1, 0, 0, 0, -1, 0, 0, 0, 1}, {}));
    const Answered edges = ask<Integer128>(turned, mirrored, shifted({24, 2, 3}));
    EXPECT_NEAR(edges.distance.upper, 10, 1e-13);
    EXPECT_NEAR(edges.distance.witness_a.x, 7, 1e-14);
    EXPECT_NEAR(edges.distance.witness_a.y, 1, 1e-14);
    EXPECT_LE(std::fabs(edges.distance.witness_a.z), 5 + 1e-14);
    EXPECT_NEAR(edges.distance.witness_b.x, 17, 1e-13);
}

// G08, by symmetry and by hand: a box is as deep in itself as it is thin; the simplex as its
// least width, between opposite edges, 2.
TEST(ConvexDistance, ShapesAreAsDeepInThemselvesAsTheyAreWide) {
    const Points box = box_corners(3, 1, 2);
    EXPECT_NEAR(ask<Integer128>(box, box, shifted({})).depth->upper, 2, 1e-14);
    const Points simplex = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    EXPECT_NEAR(ask<Integer128>(simplex, simplex, shifted({})).depth->upper, 2, 1e-14);
}

// G09: a square, a segment and a point through, on and off a cube.
TEST(ConvexDistance, FlatHullsAreHulls) {
    const Points cube = box_corners(2, 2, 2);
    const std::array<Points, 3> flat = {
        {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{-3, 0, 0}, {3, 1, 0}}, {{0, 0, 0}}}};
    for (const Points& points : flat) {
        for (int i = 0; i < 216; ++i) {
            SCOPED_TRACE(i);
            const Double3 t = {double(i % 6), double(i / 6 % 6), double(i / 36)};
            ask<Integer128>(cube, points, shifted(t));
            ask<Integer128>(points, flat[1], shifted({t.x - 2, t.y - 2, t.z - 2}));
        }
    }
}

// G10, by construction: 1e-9 between two lattice points on the axis; then turned, and held
// against what the direction between the hulls proves without rounding.
TEST(ConvexDistance, FineHullsASmallGapApartAreMeasured) {
    constexpr double kScale = 1.0 / 1024;
    const SmallHull hull(lattice_ball(1001, kScale));
    ASSERT_GT(hull.points().size(), 9000u);
    const double top = 1001 * kScale;
    const double shift = 2 * top + 1e-9;
    const double gap = shift - top - top;  // exact
    const auto found = convex_distance(hull.view(), hull.view(), shifted({shift, 0, 0}));
    EXPECT_LE(found->lower, gap);
    EXPECT_GE(found->upper, gap);
    EXPECT_LE(width(*found), 1e-12);

    std::mt19937 random(10);
    const Pose turn = random_pose(random, 0);
    const auto far = convex_distance(hull.view(), hull.view(),
                                     Placement::b_moves(pose_of(turn.rotation(), {3, 1, 0})));
    const Double3 &on_a = far->witness_a, &on_b = far->witness_b;
    const double share = 1 - 1e-9 / far->lower;  // of the way from B to A
    const Placement placement = Placement::b_moves(pose_of(
        turn.rotation(),
        {3 + share * (on_a.x - on_b.x), 1 + share * (on_a.y - on_b.y), share * (on_a.z - on_b.z)}));
    const auto small = convex_distance(hull.view(), hull.view(), placement);
    EXPECT_GT(small->lower, 0);
    EXPECT_NEAR(small->upper, 1e-9, 1e-14);
    EXPECT_LE(width(*small), 1e-12);
    const auto proof = proof_by({on_b.x - on_a.x, on_b.y - on_a.y, on_b.z - on_a.z}, hull.points(),
                                moved_points(hull.points(), placement.pose_b()));
    ASSERT_TRUE(proof);
    EXPECT_GE(compare_length(small->upper, *proof), 0);
    EXPECT_LE(compare_length(small->lower - 1e-13, *proof), 0);
    EXPECT_FALSE(convex_within(hull.view(), hull.view(), placement, small->lower * (1 - 1e-14)));
    EXPECT_TRUE(convex_within(hull.view(), hull.view(), placement, small->upper));
}

// G11: side 1 and 2^-20, and 2^20 sides apart.
TEST(ConvexDistance, ExtremesOfScaleKeepTheirDigits) {
    constexpr double kSmall = 0x1p-21, kFar = 0x1p20;
    const Points large = box_corners(0.5, 0.5, 0.5), small = box_corners(kSmall, kSmall, kSmall);
    const Answered near = ask<ExactNumber>(large, small, shifted({1, 0.25, 0.125}));
    EXPECT_LE(width(near.distance), 1e-12 * near.distance.upper);
    const Answered far = ask<ExactNumber>(large, large, shifted({kFar, -kFar / 3, 0}));
    EXPECT_LE(width(far.distance), 1e-12 * far.distance.upper);
    for (const double scale : {0x1p-500, 0x1p500, 0x1p-1040, 0x1p990}) {
        SCOPED_TRACE(scale);
        const Points box = box_corners(scale, scale, scale);
        ask<ExactNumber>(box, box, shifted({2.5 * scale, scale, 0}));
        ask<ExactNumber>(box, box, shifted({2 * scale, scale, 0}));
        ask<ExactNumber>(box, box, shifted({0.5 * scale, scale, 0}));
    }
}

// G12: the needle is centred, then turned.
TEST(ConvexDistance, NeedleInACubeIsAsDeepAsByDefinition) {
    const Points needle = box_corners(0.5, 0x1p-11, 0x1p-11);
    const Points cube = box_corners(0.5, 0.5, 0.5);
    const Answered centred = ask<ExactNumber>(cube, needle, shifted({}));
    EXPECT_NEAR(centred.depth->upper, 0.5 + 0x1p-11, 1e-14);
    EXPECT_LE(width(*centred.depth), 1e-14);
    std::mt19937 random(12);
    const Answered turned =
        ask<ExactNumber>(cube, needle, Placement::b_moves(random_pose(random, 0.1)));
    EXPECT_LE(width(*turned.depth), 1e-14);
}

// G13: lattice points on a sphere, asked along the axes of its symmetry: many are as far, and
// it must not matter where a search begins.
TEST(ConvexDistance, TiesDoNotDependOnTheStart) {
    const SmallHull hull(lattice_sphere(65));
    const ConvexPoints view = hull.view();
    std::mt19937 random(13);
    for (const Double3& t : {Double3{130, 0, 0}, Double3{131, 0, 0}, Double3{129, 0, 0},
                             Double3{90, 90, 0}, Double3{80, 80, 80}, Double3{75, 75, 75}}) {
        const bool meet = convex_collide(view, view, shifted(t));
        const auto first = convex_distance(view, view, shifted(t));
        for (int i = 0; i < 50; ++i) {
            ConvexCache cache;
            cache.count = 1 + random() % 4;
            for (std::size_t k = 0; k < 4; ++k) {
                cache.a[k] = random() % view.count;
                cache.b[k] = random() % view.count;
            }
            ConvexCache again = cache;
            EXPECT_EQ(convex_collide(view, view, shifted(t), &cache), meet);
            const auto other = convex_distance(view, view, shifted(t), {}, &again);
            EXPECT_NEAR(other->lower, first->lower, 1e-12);
            EXPECT_NEAR(other->upper, first->upper, 1e-12);
        }
    }
    EXPECT_TRUE(convex_collide(view, view, shifted({130, 0, 0})));
    EXPECT_FALSE(convex_collide(view, view, shifted({std::nextafter(130, 200), 0, 0})));
}

// G14: support points that all but lie in one plane: heights of 0 and g.
TEST(ConvexDistance, NearlyFlatSimplicesEndTheSearch) {
    std::mt19937 random(14);
    for (int i = 0; i < 60; ++i) {
        SCOPED_TRACE(i);
        const HardHulls hard = nearly_flat_hulls(random);
        const Answered answered = ask<ExactNumber>(hard.a, hard.b, shifted({}));
        EXPECT_LE(width(answered.distance), 1e-13);
        const SmallHull a(hard.a), b(hard.b);
        QueryCounts counts;
        (void)convex_distance(a.view(), b.view(), shifted({}), {}, nullptr, &counts);
        EXPECT_LE(counts.hull_steps + counts.exact_steps, 64u);
    }
}

}  // namespace
}  // namespace cdprep::test
