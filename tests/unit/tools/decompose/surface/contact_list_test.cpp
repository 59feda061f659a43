// SPDX-License-Identifier: MIT
#include "cdprep/contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "cdprep/pairs.h"
#include "support/brute_force.h"
#include "support/concave_solids.h"
#include "support/placements.h"
#include "unit/tools/with_pieces.h"

namespace cdprep::test {
namespace {

struct List {
    std::vector<Contact> contacts;
    ContactsVerdict verdict;
};

List ask(const Pair& pair, const ContactOptions& options, std::size_t room = 2000) {
    Workspace workspace;
    List list = {std::vector<Contact>(room), {}};
    list.verdict = contacts(pair, workspace, list.contacts, options);
    list.contacts.resize(list.verdict.count);
    return list;
}

bool is_same(const Contact& x, const Contact& y) {
    if (x.id != y.id || x.lower != y.lower || x.upper != y.upper || x.normal != y.normal ||
        x.point_a != y.point_a || x.point_b != y.point_b || x.flags != y.flags ||
        x.point_count != y.point_count) {
        return false;
    }
    for (std::uint32_t i = 0; i < x.point_count; ++i) {
        if (x.points[i].on_a != y.points[i].on_a || x.points[i].id != y.points[i].id) return false;
    }
    return true;
}

// Two rings through each other: some hundred contacts, deep and shallow.
class ContactList : public testing::Test {
protected:
    [[nodiscard]] Pair pair(Structure through = Structure::bvh) const {
        return {ring_.model, ring_.model, placement_, {.through = through}};
    }
    static ContactOptions with(std::uint32_t most) {
        return {.tolerance = 0.01, .manifold = Manifold::four, .most = most};
    }
    /// Returns what a contact counts by the definition of work.
    [[nodiscard]] std::uint64_t work_of(const Contact& contact) const {
        const auto pieces = ring_.model.pieces().of_triangle;
        const auto triangles = std::count(pieces.begin(), pieces.end(), contact.piece_a) +
                               std::count(pieces.begin(), pieces.end(), contact.piece_b);
        return kWorkOfContact + static_cast<std::uint64_t>(triangles) / kTrianglesOfWork;
    }

    OpenModel ring_ = open_with_pieces(torus(1, 0.4, 40, 24));
    Placement placement_ =
        Placement::b_moves(Pose::from_quaternion(1, 2, 3, 4, {0.5, 0.25, 0.125}).value());
    List all_ = ask(pair(), with(0));
};

// By the full list: each listed contact is one of it, none is listed twice, and nothing is deeper
// than the first.
TEST_F(ContactList, HoldsTheDeepestFirst) {
    ASSERT_GT(all_.contacts.size(), 60U);
    double deepest = 0;
    for (const Contact& contact : all_.contacts) deepest = std::min(deepest, contact.upper);
    for (const std::uint32_t most : {1U, 2U, 7U, 40U}) {
        SCOPED_TRACE(most);
        const List list = ask(pair(), with(most));
        ASSERT_EQ(list.contacts.size(), most);
        EXPECT_EQ(list.verdict.found, all_.contacts.size());
        EXPECT_LE(list.verdict.computed, all_.contacts.size());
        EXPECT_TRUE(list.verdict.searched);
        EXPECT_FALSE(list.verdict.complete);
        EXPECT_EQ(list.contacts[0].upper, deepest);
        for (std::size_t i = 0; i < most; ++i) {
            EXPECT_EQ(std::count_if(all_.contacts.begin(), all_.contacts.end(),
                                    [&](const Contact& c) { return is_same(c, list.contacts[i]); }),
                      1);
            if (i > 0) {
                EXPECT_GE(list.contacts[i].upper, list.contacts[i - 1].upper);
                EXPECT_NE(list.contacts[i].id, list.contacts[i - 1].id);
            }
        }
    }
}

// By the rule: of a list of 2 n - 1, at least n are no shallower than the n-th deepest of all,
// because every second one is the deepest left.
TEST_F(ContactList, HalfOfItIsTheDeepest) {
    std::vector<double> depths;
    for (const Contact& contact : all_.contacts) depths.push_back(contact.upper);
    std::sort(depths.begin(), depths.end());
    for (const std::uint32_t n : {1U, 3U, 10U}) {
        SCOPED_TRACE(n);
        const List list = ask(pair(), with(2 * n - 1));
        EXPECT_GE(std::count_if(list.contacts.begin(), list.contacts.end(),
                                [&](const Contact& c) { return c.upper <= depths[n - 1]; }),
                  n);
    }
}

TEST_F(ContactList, FewComputedContactsAreEnough) {
    const List list = ask(pair(), with(4));
    EXPECT_LT(list.verdict.computed, all_.contacts.size() / 2);
    EXPECT_GE(list.verdict.computed, 4U);
}

// A budget for all contacts ends nothing, so the list is the same, and so is the work.
TEST_F(ContactList, ABudgetForAllChangesNothing) {
    const List free = ask(pair(), with(4));
    ContactOptions options = with(4);
    options.work = 2 * all_.verdict.work;
    const List limited = ask(pair(), options);
    EXPECT_EQ(limited.verdict.work, free.verdict.work);
    EXPECT_EQ(limited.verdict.computed, free.verdict.computed);
    ASSERT_EQ(limited.contacts.size(), free.contacts.size());
    for (std::size_t i = 0; i < free.contacts.size(); ++i) {
        EXPECT_TRUE(is_same(limited.contacts[i], free.contacts[i])) << i;
    }
}

TEST_F(ContactList, IsTheSameThroughEitherHierarchy) {
    const List by_boxes = ask(pair(), with(20)), by_pieces = ask(pair(Structure::pieces), with(20));
    ASSERT_EQ(by_boxes.contacts.size(), by_pieces.contacts.size());
    for (std::size_t i = 0; i < by_boxes.contacts.size(); ++i) {
        EXPECT_TRUE(is_same(by_boxes.contacts[i], by_pieces.contacts[i])) << i;
    }
}

TEST_F(ContactList, IsCompleteWhereEverythingFits) {
    const List list = ask(pair(), with(kMostListedContacts));
    ASSERT_LT(all_.contacts.size(), kMostListedContacts);
    EXPECT_EQ(list.contacts.size(), all_.contacts.size());
    EXPECT_TRUE(list.verdict.complete);
    EXPECT_TRUE(all_.verdict.complete);
    const List few = ask(pair(), with(kMostListedContacts), 5);
    EXPECT_EQ(few.contacts.size(), 5U);
    EXPECT_FALSE(few.verdict.complete);
    EXPECT_TRUE(is_same(few.contacts[4], list.contacts[4]));
}

TEST_F(ContactList, WithoutRoomThereIsACount) {
    const List list = ask(pair(), with(0), 0);
    EXPECT_EQ(list.verdict.found, all_.contacts.size());
    EXPECT_EQ(list.verdict.computed, 0U);
    EXPECT_FALSE(list.verdict.complete);
}

// By the definition of work, from the pairs of triangles and the contacts.
TEST_F(ContactList, WorkCountsTrianglesAndContacts) {
    Workspace workspace;
    std::uint64_t work = pairs_within(pair(), with(0).tolerance, workspace, {});
    for (const Contact& contact : all_.contacts) work += work_of(contact);
    EXPECT_EQ(all_.verdict.work, work);
}

// By the definition of work: half of it at most goes into the search, and each contact takes its
// share of the rest. The last one may exceed it.
TEST_F(ContactList, ABudgetEndsIt) {
    std::uint64_t most_of_contact = 0;
    for (const Contact& contact : all_.contacts) {
        most_of_contact = std::max(most_of_contact, work_of(contact));
    }
    std::size_t last = 0, unsearched = 0, uncomputed = 0;
    for (std::uint64_t work = 1; work < 2 * all_.verdict.work; work += work / 3 + 1) {
        SCOPED_TRACE(work);
        for (const std::uint32_t most : {0U, kMostListedContacts}) {
            ContactOptions options = with(most);
            options.work = work;
            const List list = ask(pair(), options);
            EXPECT_LT(list.verdict.work, work + most_of_contact);
            EXPECT_EQ(list.contacts.size(), list.verdict.computed);
            EXPECT_EQ(list.verdict.complete, list.contacts.size() == all_.contacts.size());
            EXPECT_EQ(list.verdict.complete,
                      list.verdict.searched && list.verdict.computed == list.verdict.found);
            unsearched += list.verdict.searched ? 0 : 1;
            uncomputed += list.verdict.searched && !list.verdict.complete ? 1 : 0;
            if (most == 0) {
                EXPECT_GE(list.contacts.size(), last);
                last = list.contacts.size();
            }
        }
    }
    EXPECT_EQ(last, all_.contacts.size());
    EXPECT_GT(unsearched, 3U);
    EXPECT_GT(uncomputed, 0U);
}

// By the definition: what was computed before the work ended is listed, as much as was asked for.
TEST_F(ContactList, ABudgetKeepsWhatWasComputed) {
    std::size_t limited = 0;
    for (std::uint64_t work = 40; work < 2 * all_.verdict.work; work += 100) {
        SCOPED_TRACE(work);
        ContactOptions options = with(4);
        options.work = work;
        const List list = ask(pair(), options);
        EXPECT_EQ(list.contacts.size(), std::min<std::uint64_t>(4, list.verdict.computed));
        EXPECT_GT(list.contacts.size(), 0U);
        EXPECT_LE(list.verdict.work, work + kWorkOfContact + ring_.model.triangle_count());
        limited += list.contacts.size() < 4 ? 1 : 0;
    }
    EXPECT_GT(limited, 0U);
}

TEST_F(ContactList, ABudgetEndsAVisitToo) {
    Workspace workspace;
    std::size_t seen = 0;
    const auto visit = [&](const Contact& contact) {
        EXPECT_TRUE(is_same(contact, all_.contacts[seen]));
        return ++seen > 0;
    };
    ContactOptions options = with(0);
    options.work = all_.verdict.work - work_of(all_.contacts.back());
    EXPECT_FALSE(visit_contacts(pair(), workspace, visit, options));
    EXPECT_LT(seen, all_.contacts.size());
    EXPECT_GT(seen, 0U);
}

// By the full list: `most` beyond the greatest length means that length, and bounds still spare the
// contacts that cannot be among the deepest.
TEST(ContactLists, HaveAGreatestLength) {
    const OpenModel ring = open_with_pieces(torus(1, 0.4, 32, 18), PiecesOf::triangles);
    const Pose turned = Pose::from_quaternion(1, 2, 3, 4, {0.5, 0.25, 0.125}).value();
    const Pair pair = {ring.model, ring.model, Placement::b_moves(turned)};
    const List all = ask(pair, {.tolerance = 0.01});
    ASSERT_GT(all.contacts.size(), kMostListedContacts + 100);
    ASSERT_LT(all.contacts.size(), 2 * kMostListedContacts);
    const List list = ask(pair, {.tolerance = 0.01, .most = 1000});
    EXPECT_EQ(list.contacts.size(), kMostListedContacts);
    EXPECT_EQ(list.verdict.found, all.contacts.size());
    EXPECT_LT(list.verdict.computed, list.verdict.found);
    EXPECT_FALSE(list.verdict.complete);
    const auto deepest =
        std::min_element(all.contacts.begin(), all.contacts.end(),
                         [](const Contact& x, const Contact& y) { return x.upper < y.upper; });
    EXPECT_EQ(list.contacts[0].upper, deepest->upper);
}

// A tilted bar floats over a box in small triangles, and cubes are inside the box. They take places
// of a list that would hold all pairs of pieces: bounds still spare the shallow ones.
TEST(ContactLists, EnclosedComponentsTakePlaces) {
    constexpr std::uint32_t kCubes = 12;
    TestMesh mesh = unit_cube();
    for (Double3& p : mesh.positions) p = {14 * p.x + 1, p.y + 0.5, p.z + 0.03125 * (1 + p.x)};
    for (std::uint32_t i = 0; i < kCubes; ++i) {
        mesh = joined(mesh, moved_by(unit_cube(), 0.25, {1.0 + i, 1, -0.75}));
    }
    const OpenModel floor = open_with_pieces(box_with_a_fine_side(16, 2), PiecesOf::triangles);
    const OpenModel bar_and_cubes = open_with_pieces(mesh);
    const Pair pair = {floor.model, bar_and_cubes.model, shifted({0, 0, 0}), {.body = Body::solid}};
    ContactOptions options = {.tolerance = 0.125};
    const List all = ask(pair, options);
    options.most = static_cast<std::uint32_t>(all.contacts.size()) - kCubes;
    ASSERT_GT(options.most, 2 * kCubes);
    const List list = ask(pair, options);
    EXPECT_EQ(list.contacts.size(), options.most);
    EXPECT_EQ(list.verdict.found, all.contacts.size());
    EXPECT_LT(list.verdict.computed, list.verdict.found);
    EXPECT_FALSE(list.verdict.complete);
    EXPECT_EQ(std::count_if(list.contacts.begin(), list.contacts.end(),
                            [](const Contact& c) { return (c.flags & contact_deep) != 0; }),
              kCubes);
}

// By hand: a bar lies on a floor in small triangles, one end deeper than the other. The two deepest
// contacts are at that end, and the one farthest from them is at the other.
TEST(ContactLists, SpreadOverTheSurface) {
    const OpenModel floor = open_with_pieces(grid_sheet(16, 2), PiecesOf::triangles);
    TestMesh bar = unit_cube();
    for (Double3& p : bar.positions) p = {14 * p.x, 0.5 * p.y, p.z - 0.03125 * p.x};
    const OpenModel lying = open_with_pieces(bar);
    const Pair pair = {floor.model, lying.model, shifted({1.25, 0.625, -0.0078125})};
    const List list = ask(pair, {.tolerance = 0, .most = 4});
    ASSERT_EQ(list.contacts.size(), 4U);
    double left = 16, right = 0;
    for (const Contact& contact : list.contacts) {
        left = std::min(left, contact.point_a.x);
        right = std::max(right, contact.point_a.x);
    }
    EXPECT_GT(list.verdict.found, 20U);
    EXPECT_LT(left, 3);
    EXPECT_GT(right, 13);
}

// By hand: a cube on a floor of triangles has one contact with each, all upwards. They become one,
// with the corners of the cube's base.
TEST(ContactLists, OneClusterHasTheCornersOfAll) {
    const OpenModel floor = open_with_pieces(grid_sheet(8, 8), PiecesOf::triangles);
    const OpenModel cube = open_with_pieces(moved_by(unit_cube(), 3, {0, 0, 0}));
    const Pair pair = {floor.model, cube.model, shifted({2.25, 2.5, -0.015625})};
    ContactOptions options = {.tolerance = 0.01, .manifold = Manifold::four, .most = 256};
    const List apart = ask(pair, options);
    ASSERT_GT(apart.contacts.size(), 18U);
    options.cluster_angle = 0.25;
    const List list = ask(pair, options);
    ASSERT_EQ(list.contacts.size(), 1U);
    EXPECT_EQ(list.contacts[0].members, apart.contacts.size());
    EXPECT_EQ(list.verdict.computed, apart.verdict.computed);
    EXPECT_TRUE(list.verdict.complete);
    EXPECT_EQ(list.contacts[0].id,
              std::min_element(apart.contacts.begin(), apart.contacts.end(),
                               [](const Contact& x, const Contact& y) { return x.id < y.id; })
                  ->id);
    ASSERT_EQ(list.contacts[0].point_count, 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            EXPECT_NE(list.contacts[0].points[i].id, list.contacts[0].points[k].id);
        }
    }
    for (const ManifoldPoint& point : list.contacts[0].points) {
        EXPECT_TRUE(point.on_b.x == 2.25 || point.on_b.x == 5.25) << point.on_b.x;
        EXPECT_TRUE(point.on_b.y == 2.5 || point.on_b.y == 5.5) << point.on_b.y;
        EXPECT_NEAR(point.distance, -0.015625, 1e-12);
    }
}

// Half of the work is for the search: half of the greatest number must not wrap around.
TEST(ContactLists, TheGreatestWorkIsNoLimit) {
    const OpenModel floor = open_with_pieces(grid_sheet(8, 8), PiecesOf::triangles);
    const OpenModel cube = open_with_pieces(moved_by(unit_cube(), 3, {0, 0, 0}));
    const Pair pair = {floor.model, cube.model, shifted({2.25, 2.5, -0.015625})};
    for (const std::uint32_t most : {0U, 16U}) {
        const List all = ask(pair, {.tolerance = 0.01, .most = most});
        const List list = ask(
            pair,
            {.tolerance = 0.01, .most = most, .work = std::numeric_limits<std::uint64_t>::max()});
        ASSERT_GT(all.contacts.size(), 15U);
        EXPECT_EQ(list.contacts.size(), all.contacts.size());
        EXPECT_EQ(list.verdict.work, all.verdict.work);
        EXPECT_TRUE(list.verdict.searched);
    }
}

// By hand: a cube in the notch of an L leans on both arms. Their normals are square to each other.
TEST(ContactLists, ClustersKeepNormalsApart) {
    const OpenModel arms = open_with_pieces(prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
                                                  {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}));
    const OpenModel cube = open_with_pieces(unit_cube());
    const Pair pair = {arms.model, cube.model, shifted({1.0625, 1.125, 0})};
    ContactOptions options = {.tolerance = 0.25, .manifold = Manifold::four, .most = 64};
    const std::size_t before = ask(pair, options).contacts.size();
    for (const double angle : {0.25, 3.2}) {
        options.cluster_angle = angle;
        const List list = ask(pair, options);
        std::size_t members = 0;
        for (const Contact& contact : list.contacts) members += contact.members;
        EXPECT_EQ(members, before);
        if (angle > 3) {
            EXPECT_EQ(list.contacts.size(), 1U);
        } else {
            EXPECT_GE(list.contacts.size(), 2U);
            EXPECT_LE(list.contacts.size(), before);
        }
    }
}

// By hand: without manifolds, a cluster has the points of its contacts.
TEST(ContactLists, ClustersTakePointsOfContactsWithoutManifold) {
    const OpenModel floor = open_with_pieces(grid_sheet(8, 8), PiecesOf::triangles);
    const OpenModel cube = open_with_pieces(moved_by(unit_cube(), 3, {0, 0, 0}));
    const Pair pair = {floor.model, cube.model, shifted({2.25, 2.5, 0})};
    const List list = ask(pair, {.tolerance = 0.01, .most = 256, .cluster_angle = 0.25});
    ASSERT_EQ(list.contacts.size(), 1U);
    EXPECT_GE(list.contacts[0].point_count, 3U);
    for (std::uint32_t i = 0; i < list.contacts[0].point_count; ++i) {
        EXPECT_NEAR(list.contacts[0].points[i].distance, 0, 1e-12);
    }
}

}  // namespace
}  // namespace cdprep::test
