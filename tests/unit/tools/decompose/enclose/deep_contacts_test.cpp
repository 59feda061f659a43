// SPDX-License-Identifier: MIT
// A body that is wholly inside another is pushed out, however its file was baked.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "cdprep/contacts.h"
#include "decompose/enclose/approximate_parts.h"
#include "support/concave_solids.h"
#include "unit/tools/tiny_hull_sections.h"
#include "unit/tools/with_pieces.h"

namespace cdprep::test {
namespace {

enum class Baked : std::uint8_t { bare, hull, parts };
constexpr std::array kAll = {Baked::bare, Baked::hull, Baked::parts};

OpenModel open_as(const TestMesh& mesh, Baked how, std::size_t parts = 8) {
    const AlignedBytes file = bake_with_pieces(mesh);
    if (how == Baked::bare) return open_tiny(with_sections(file, {}));
    convex::HullSections hulls = *convex::make_hull_sections(mesh_of(mesh), {}, 0, serial_for);
    if (how == Baked::parts) {
        convex::ApproximateOptions options;
        options.max_parts = parts;
        convex::add_parts(hulls, convex::find_approximate_parts(mesh_of(mesh), options).parts);
    }
    return open_tiny(with_sections(file, convex::tiny_sections(hulls)));
}

Pose shift(const Double3& by) {
    return Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, by.x, by.y, by.z}).value();
}

std::vector<Contact> ask(const Pair& pair, const ContactOptions& options = {},
                         ContactsVerdict* told = nullptr) {
    Workspace workspace;
    std::vector<Contact> room(500);
    const ContactsVerdict verdict = contacts(pair, workspace, room, options);
    if (told != nullptr) *told = verdict;
    room.resize(verdict.count);
    return room;
}

Pair solids(const OpenModel& a, const OpenModel& b, const Placement& placement) {
    return {a.model, b.model, placement, {.body = Body::solid}};
}

constexpr Double3 kInside = {2.5, 1.5, 1.75};

/// A cube of edge 1 in one of edge 4, whose nearest wall is 1.5 to the right.
void expect_way_out(const Contact& contact, double towards) {
    EXPECT_EQ(contact.flags, contact_overlap | contact_deep);
    EXPECT_NEAR(contact.normal.x, towards, 1e-12);
    EXPECT_NEAR(contact.lower, -1.5, 1e-12);
    EXPECT_LE(contact.lower, -1.5);
    // By a vertex of the cube, which is between half and 1.5 from the nearest wall.
    EXPECT_LE(contact.upper, -0.5);
    EXPECT_GE(contact.upper, -1.5);
    EXPECT_NEAR(contact.point_b.x - contact.point_a.x, -1.5 * towards, 1e-12);
    EXPECT_NEAR(contact.point_b.y, contact.point_a.y, 1e-12);
    EXPECT_NEAR(contact.point_b.z, contact.point_a.z, 1e-12);
    EXPECT_EQ(contact.members, 1U);
}

// By hand, and the same by box, hull and parts.
TEST(DeepContacts, ACubeInACubeLeavesByTheNearestWall) {
    for (const Baked how : kAll) {
        SCOPED_TRACE(static_cast<int>(how));
        const OpenModel outer = open_as(moved_by(unit_cube(), 4, {0, 0, 0}), how);
        const OpenModel inner = open_as(unit_cube(), how);
        const auto out = ask(solids(outer, inner, Placement::b_moves(shift(kInside))));
        ASSERT_EQ(out.size(), 1U);
        expect_way_out(out[0], 1);
        EXPECT_EQ(out[0].id >> 32, 0xffffffffU);
        EXPECT_NEAR(out[0].point_b.x, 2.5, 1e-12);
        EXPECT_EQ(out[0].point_count, 0U);
        // The other way about, and whichever of the two moves.
        const auto in = ask(solids(inner, outer, Placement::a_moves(shift(kInside))));
        ASSERT_EQ(in.size(), 1U);
        expect_way_out(in[0], -1);
        EXPECT_EQ(in[0].id & 0xffffffffU, 0xffffffffU);
        EXPECT_NEAR(in[0].point_a.x, 2.5, 1e-12);
        const Double3 back = {-kInside.x, -kInside.y, -kInside.z};
        const auto still = ask(solids(outer, inner, Placement::a_moves(shift(back))));
        ASSERT_EQ(still.size(), 1U);
        expect_way_out(still[0], 1);
        const Double3 far = {kInside.x + 10, kInside.y, kInside.z};
        const auto both =
            ask(solids(outer, inner, Placement::world(shift({10, 0, 0}), shift(far))));
        ASSERT_EQ(both.size(), 1U);
        expect_way_out(both[0], 1);
    }
}

// Far from the origin, rounding moves corners by a share of the way out: the search ends all the
// same.
TEST(DeepContacts, SmallBodiesFarAwayLeaveToo) {
    constexpr double kSize = 0x1p-10, kFar = 0x1p30;
    for (const Baked how : kAll) {
        SCOPED_TRACE(static_cast<int>(how));
        const OpenModel outer = open_as(moved_by(unit_cube(), 4 * kSize, {0, 0, 0}), how);
        const OpenModel inner = open_as(moved_by(unit_cube(), kSize, {0, 0, 0}), how);
        const Pose turn_a = Pose::from_quaternion(1, 2, 3, 4, {kFar, kFar, -kFar}).value();
        const Pose in_a = shift({2.5 * kSize, 1.5 * kSize, 1.75 * kSize});
        const Pose turn_b = composed_pose(turn_a, in_a).value();
        const auto found = ask(solids(outer, inner, Placement::world(turn_a, turn_b)));
        ASSERT_EQ(found.size(), 1U);
        EXPECT_NEAR(found[0].lower, -1.5 * kSize, 0x1p-18);
    }
}

TEST(DeepContacts, SurfacesThatAreOnlySurfacesHaveNone) {
    const OpenModel outer = open_as(moved_by(unit_cube(), 4, {0, 0, 0}), Baked::parts);
    const OpenModel inner = open_as(unit_cube(), Baked::bare);
    const Placement placement = Placement::b_moves(shift(kInside));
    EXPECT_TRUE(ask({outer.model, inner.model, placement}).empty());
    // Nothing is enclosed by a cube without a side, nor where triangles touch, nor outside.
    TestMesh open = moved_by(unit_cube(), 4, {0, 0, 0});
    open.triangles.pop_back();
    EXPECT_TRUE(ask(solids(open_as(open, Baked::hull), inner, placement)).empty());
    for (const Contact& c : ask(solids(outer, inner, Placement::b_moves(shift({3, 1, 1}))))) {
        EXPECT_EQ(c.flags & contact_deep, 0U);
    }
    EXPECT_TRUE(ask(solids(outer, inner, Placement::b_moves(shift({4.5, 1, 1})))).empty());
}

// By hand: the arm of an L is 1 wide, and its notch is beside it; the hull covers the notch.
TEST(DeepContacts, PartsLeadIntoANotch) {
    TestMesh tall = l_prism();
    for (Double3& p : tall.positions) p.z *= 10;
    const OpenModel inner = open_as(moved_by(unit_cube(), 0.125, {0, 0, 0}), Baked::bare);
    const Placement placement = Placement::b_moves(shift({0.625, 1.5, 5}));
    const auto by_parts = ask(solids(open_as(tall, Baked::parts, 2), inner, placement));
    ASSERT_EQ(by_parts.size(), 1U);
    EXPECT_NEAR(by_parts[0].normal.x, 1, 1e-9);
    EXPECT_NEAR(by_parts[0].lower, -0.375, 1e-9);
    const auto by_hull = ask(solids(open_as(tall, Baked::hull), inner, placement));
    ASSERT_EQ(by_hull.size(), 1U);
    EXPECT_NEAR(by_hull[0].lower, -0.5, 1e-9);
    EXPECT_NEAR(by_hull[0].normal.y, 1, 1e-9);
}

// Each component by itself; a list has the deepest first; a budget ends it.
TEST(DeepContacts, EveryEnclosedComponentHasOne) {
    const TestMesh two = joined(unit_cube(), moved_by(unit_cube(), 0.5, {1.5, 1.5, 1.25}));
    for (const Baked how : kAll) {
        SCOPED_TRACE(static_cast<int>(how));
        const OpenModel outer = open_as(moved_by(unit_cube(), 8, {-3, -3, -3.5}), how);
        const OpenModel inner = open_as(two, how);
        const Pair pair = solids(outer, inner, Placement::b_moves(Pose()));
        ContactsVerdict verdict{};
        const auto all = ask(pair, {}, &verdict);
        ASSERT_EQ(all.size(), 2U);
        EXPECT_NE(all[0].id, all[1].id);
        EXPECT_EQ(verdict.found, 2U);
        EXPECT_EQ(verdict.computed, 2U);
        EXPECT_EQ(verdict.work, 2 * kWorkOfContact);
        EXPECT_TRUE(verdict.complete);
        const auto list = ask(pair, {.manifold = Manifold::four, .most = 1}, &verdict);
        ASSERT_EQ(list.size(), 1U);
        EXPECT_EQ(list[0].upper, std::min(all[0].upper, all[1].upper));
        ASSERT_EQ(list[0].point_count, 1U);
        EXPECT_EQ(list[0].points[0].distance, list[0].lower);
        EXPECT_FALSE(verdict.complete);
        EXPECT_EQ(ask(pair, {.most = 9}).size(), 2U);
        EXPECT_EQ(ask(pair, {.work = 1}, &verdict).size(), 1U);
        EXPECT_FALSE(verdict.complete);
        Workspace workspace;
        std::vector<std::uint64_t> ids;
        const auto note = [&](const Contact& contact) {
            ids.push_back(contact.id);
            return true;
        };
        EXPECT_TRUE(visit_contacts(pair, workspace, note));
        EXPECT_EQ(ids, (std::vector<std::uint64_t>{all[0].id, all[1].id}));
        EXPECT_EQ(contacts(pair, workspace, {}).found, 2U);
    }
}

// A wall is near: its contacts stay, and no cluster takes in the deep one.
TEST(DeepContacts, StandBesideContactsOfNearWalls) {
    const OpenModel outer = open_as(torus(1, 0.5, 24, 16), Baked::hull);
    const OpenModel inner = open_as(moved_by(icosphere(1), 0.125, {0, 0, 0}), Baked::hull);
    const Pair pair = solids(outer, inner, Placement::b_moves(shift({1.3125, 0, 0.0625})));
    const auto list =
        ask(pair, {.tolerance = 0.125, .manifold = Manifold::four, .most = 8, .cluster_angle = 1});
    ASSERT_GE(list.size(), 2U);
    EXPECT_EQ(list[0].flags, contact_overlap | contact_deep);
    EXPECT_EQ(list[0].members, 1U);
    for (std::size_t i = 1; i < list.size(); ++i) EXPECT_EQ(list[i].flags & contact_deep, 0U);
}

Double3 drawn_direction(std::mt19937& random) {
    std::normal_distribution<double> side;
    const Double3 d = {side(random), side(random), side(random)};
    const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    return {d.x / length, d.y / length, d.z / length};
}

Pose moved(const Pose& pose, const Double3& normal, double length) {
    const auto& r = pose.rotation();
    const Double3& t = pose.translation();
    return Pose::from_rows({r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8],
                            t.x + length * normal.x, t.y + length * normal.y,
                            t.z + length * normal.z})
        .value();
}

// Laws, by collide(): none that collides as a solid is left without a contact that pushes; the way
// out leads out, and no shorter one does. Parts lead out no farther than the hull, nor that than
// the box.
TEST(DeepContacts, WaysOutLeadOutAndAreNoShorterThanTold) {
    std::mt19937 random(23);
    std::uniform_real_distribution<double> place(-1.6, 1.6), turn(-1, 1);
    const std::vector<TestMesh> outers = {moved_by(l_prism(), 1.5, {-1.5, -1.5, -0.75}),
                                          torus(1, 0.5, 24, 16), icosphere(2),
                                          moved_by(u_prism(), 1, {-1.5, -1.5, -0.5})};
    const std::vector<TestMesh> inners = {moved_by(icosphere(1), 0.1, {0, 0, 0}),
                                          moved_by(plus_prism(), 0.05, {0, 0, 0})};
    int enclosed = 0;
    for (const TestMesh& outer_mesh : outers) {
        const std::array outer = {open_as(outer_mesh, Baked::bare),
                                  open_as(outer_mesh, Baked::hull),
                                  open_as(outer_mesh, Baked::parts)};
        for (const TestMesh& inner_mesh : inners) {
            const OpenModel inner = open_as(inner_mesh, Baked::hull);
            for (int trial = 0; trial < 60; ++trial) {
                const Pose pose =
                    Pose::from_quaternion(turn(random), turn(random), turn(random), turn(random),
                                          {place(random), place(random), 0.5 * place(random)})
                        .value();
                Workspace workspace;
                const Pair first = solids(outer[0], inner, Placement::b_moves(pose));
                const Collision collision = collide(first, workspace);
                const bool is_deep = collision.containment.answer == Answer::yes;
                double shortest = std::numeric_limits<double>::infinity();
                for (const OpenModel& how : outer) {
                    const auto found = ask(solids(how, inner, Placement::b_moves(pose)));
                    EXPECT_EQ(found.empty(), collision.hit == Answer::no);
                    if (!is_deep) continue;
                    ASSERT_EQ(found.size(), 1U);
                    const Contact& contact = found[0];
                    EXPECT_LE(-contact.lower, shortest * (1 + 1e-9));
                    shortest = -contact.lower;
                    const Pose out = moved(pose, contact.normal, -contact.lower * (1 + 1e-12));
                    EXPECT_EQ(collide(solids(how, inner, Placement::b_moves(out)), workspace).hit,
                              Answer::no);
                    for (int way = 0; way < 8; ++way) {
                        const Pose in =
                            moved(pose, drawn_direction(random), -contact.upper * (1 - 1e-9));
                        EXPECT_EQ(
                            collide(solids(how, inner, Placement::b_moves(in)), workspace).hit,
                            Answer::yes);
                    }
                }
                enclosed += is_deep ? 1 : 0;
            }
        }
    }
    EXPECT_GT(enclosed, 60);
}

}  // namespace
}  // namespace cdprep::test
