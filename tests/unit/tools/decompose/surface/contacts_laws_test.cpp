// SPDX-License-Identifier: MIT
#include "cdprep/contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "cdprep/advanced/convex_distance.h"
#include "exact/exact_within.h"
#include "pieces/contact_side.h"
#include "pieces/contact_steps.h"
#include "support/brute_force.h"
#include "support/counted_memory.h"
#include "support/exact_distance.h"
#include "support/random_pose.h"
#include "support/same_contacts.h"
#include "unit/tools/with_pieces.h"

namespace cdprep::test {
namespace {

std::vector<Contact> all_contacts(const Model& a, const Model& b, const Placement& placement,
                                  double tolerance, Structure structure = Structure::bvh) {
    Workspace workspace;
    const ContactOptions options = {.tolerance = tolerance, .manifold = Manifold::four};
    std::vector<Contact> found(
        contacts({a, b, placement, {.through = structure}}, workspace, {}, options).found);
    (void)contacts({a, b, placement, {.through = structure}}, workspace, found, options);
    return found;
}

bool is_near(const Corners& a, const Corners& b, double tolerance) {
    return triangles_touch(a, b) || (tolerance > 0 && is_within_exactly(a, b, tolerance));
}

/// How far two pieces are apart by all pairs of their triangles, squared and exactly; of pairs
/// of pieces with triangles within the tolerance.
std::map<std::uint64_t, ExactRational> truth(const Model& a, const Model& b,
                                             const Placement& placement, double tolerance) {
    const MovedModel of_a = moved_a(a, placement), of_b = moved_b(b, placement);
    std::map<std::uint64_t, ExactRational> result;
    for (std::uint32_t i = 0; i < a.triangle_count(); ++i) {
        const Corners at_a = of_a.corners(i);
        const Box3 box = box_of(at_a);
        const Box3 wide = {
            {box.lower.x - tolerance, box.lower.y - tolerance, box.lower.z - tolerance},
            {box.upper.x + tolerance, box.upper.y + tolerance, box.upper.z + tolerance}};
        for (std::uint32_t j = 0; j < b.triangle_count(); ++j) {
            const Corners at_b = of_b.corners(j);
            if (!overlap(wide, box_of(at_b)) || !is_near(at_a, at_b, tolerance)) continue;
            const std::uint64_t key =
                std::uint64_t{a.pieces().of_triangle[i]} << 32 | b.pieces().of_triangle[j];
            const ExactRational squared = exact_squared_distance(at_a, at_b);
            const auto [at, is_new] = result.emplace(key, squared);
            if (!is_new && squared < at->second) at->second = squared;
        }
    }
    return result;
}

/// True when all that is said of a contact holds, by the pieces' triangles and hulls.
void check(const Contact& contact, const ExactRational& squared, const MovedModel& of_a,
           const MovedModel& of_b, const Placement& placement, Workspace& workspace) {
    ContactSide a(of_a, contact.piece_a, nullptr, workspace.storage()),
        b(of_b, contact.piece_b, nullptr, workspace.storage());
    // By what a list of the deepest relies on: no bound is below the depth.
    const NearPieces near = {0, a.triangles()[0], b.triangles()[0], squared.sign() == 0};
    EXPECT_GE(most_depth_by_faces(a, b, near), -contact.upper);
    EXPECT_GE(most_depth_of_pieces(a, b, near), -contact.upper);
    EXPECT_LE(contact.lower, contact.upper);
    EXPECT_NEAR(std::hypot(contact.normal.x, contact.normal.y, contact.normal.z), 1, 1e-12);
    const bool overlap = (contact.flags & contact_overlap) != 0;
    const bool meet = convex_collide(a.points(), b.points(), placement);
    EXPECT_EQ(overlap, meet && ((a.is_contained() && b.is_contained()) || squared.sign() == 0));
    if (overlap) {
        EXPECT_LE(contact.upper, 0);
        // Out of each other where the normal says, by the length that the bound says.
        const double way = -contact.lower;
        double most = -INFINITY, least = INFINITY;
        a.hull().each_point([&](std::uint32_t, const Double3& p) {
            most = std::max(most, dot(contact.normal, p));
        });
        b.hull().each_point([&](std::uint32_t, const Double3& p) {
            least = std::min(least, dot(contact.normal, p));
        });
        EXPECT_LE(most, least + way + 1e-12);
    } else {
        EXPECT_GT(contact.lower, 0);
        EXPECT_LE(ExactRational(contact.lower) * ExactRational(contact.lower), squared);
        EXPECT_GE(ExactRational(contact.upper) * ExactRational(contact.upper), squared);
        EXPECT_LE(contact.upper - contact.lower, 1e-12 * contact.upper + 1e-13);
        const Double3 d = contact.point_b - contact.point_a;
        EXPECT_NEAR(std::sqrt(dot(d, d)), contact.upper, 1e-12);
    }
    EXPECT_GE(contact.point_count, 1U);
    EXPECT_LE(contact.point_count, kMostManifoldPoints);
}

struct Seen {
    std::size_t poses = 0, near = 0, contacts = 0, overlaps = 0, vertices = 0, edges = 0, faces = 0;

    void count(const ContactFeature& feature) {
        ++(feature.kind == FeatureKind::vertex ? vertices
           : feature.kind == FeatureKind::edge ? edges
                                               : faces);
    }
};

void compare(const Model& a, const Model& b, const Placement& placement, double tolerance,
             Seen& seen) {
    const auto expected = truth(a, b, placement, tolerance);
    const auto found = all_contacts(a, b, placement, tolerance);
    ++seen.poses;
    seen.near += found.empty() ? 0 : 1;
    ASSERT_EQ(found.size(), expected.size());
    // By what must not matter: what is walked.
    const auto through = all_contacts(a, b, placement, tolerance, Structure::pieces);
    ASSERT_EQ(found.size(), through.size());
    for (std::size_t i = 0; i < found.size(); ++i) expect_same(found[i], through[i]);
    const MovedModel of_a = moved_a(a, placement), of_b = moved_b(b, placement);
    auto at = expected.begin();
    Workspace workspace;
    for (const Contact& contact : found) {
        ASSERT_EQ(at->first, std::uint64_t{contact.piece_a} << 32 | contact.piece_b);
        check(contact, at->second, of_a, of_b, placement, workspace);
        ++at;
        ++seen.contacts;
        seen.overlaps += (contact.flags & contact_overlap) != 0 ? 1 : 0;
        seen.count(contact.feature_a);
        seen.count(contact.feature_b);
    }
}

// By all pairs of triangles, exactly: closed solids that are convex in part, an open sheet, and
// triangles of a grid where all that can touch does.
TEST(ContactsLaws, RandomPosesAnswerAsAllPairsOfTriangles) {
    std::mt19937 random(20240701);
    TestMesh cap = icosphere(2);
    std::erase_if(cap.triangles,
                  [&](const Triangle& t) { return cap.positions[t.vertex[0]].z < -0.2; });
    const std::vector<OpenModel> models = [&] {
        std::vector<OpenModel> all;
        all.push_back(open_with_pieces(torus(1, 0.4, 10, 8)));
        all.push_back(open_with_pieces(cap));
        all.push_back(open_with_pieces(unit_cube()));
        all.push_back(open_with_pieces(coarse_grid_soup(7, 30, 2)));
        all.push_back(open_with_pieces(icosphere(2), PiecesOf::surface, {.tolerance = 0.2}));
        return all;
    }();
    Seen seen;
    for (int i = 0; i < 60; ++i) {
        SCOPED_TRACE(i);
        const Model& a = models[random() % models.size()].model;
        const Model& b = models[random() % models.size()].model;
        const Pose pose = random_pose(random, 1.7);
        compare(a, b, Placement::b_moves(pose), i % 3 == 0 ? 0 : 0.15, seen);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(seen.near, seen.poses * 3 / 10);
    EXPECT_LT(seen.near, seen.poses * 9 / 10);
    EXPECT_GT(seen.overlaps, seen.contacts / 10);
    EXPECT_LT(seen.overlaps, seen.contacts * 9 / 10);
    EXPECT_GT(seen.vertices, seen.contacts / 20);
    EXPECT_GT(seen.edges, seen.contacts / 20);
    EXPECT_GT(seen.faces, seen.contacts / 20);
}

// Grids and quarter turns: coincidences are common.
TEST(ContactsLaws, CoarseGridsAnswerAsAllPairsOfTriangles) {
    std::mt19937 random(20240702);
    Seen seen;
    for (int i = 0; i < 40; ++i) {
        SCOPED_TRACE(i);
        const OpenModel a = open_with_pieces(coarse_grid_soup(random(), 12, 3));
        const OpenModel b = open_with_pieces(coarse_grid_soup(random(), 12, 3));
        const auto shift = [&] { return static_cast<double>(random() % 9) - 4; };
        const Pose pose =
            Pose::from_rows({0, -1, 0, 1, 0, 0, 0, 0, 1, shift(), shift(), shift()}).value();
        compare(a.model, b.model, Placement::b_moves(pose), i % 2, seen);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(seen.near, seen.poses * 3 / 10);
    EXPECT_LT(seen.near, seen.poses);
    EXPECT_GT(seen.overlaps, seen.contacts / 10);
}

// A model on itself, as it is: every piece touches itself and its neighbours, everywhere.
TEST(ContactsLaws, AModelOnItselfAnswersAsAllPairsOfTriangles) {
    Seen seen;
    for (const TestMesh& mesh : {torus(1, 0.4, 10, 8), unit_cube(), grid_sheet(3, 3),
                                 coarse_grid_soup(11, 20, 2), icosphere(1)}) {
        for (const PiecesOf kind : {PiecesOf::surface, PiecesOf::triangles}) {
            const OpenModel model = open_with_pieces(mesh, kind);
            const std::size_t before = seen.contacts;
            compare(model.model, model.model, Placement::b_moves(Pose()), 0, seen);
            compare(model.model, model.model, Placement::b_moves(Pose()), 0.01, seen);
            if (HasFatalFailure()) return;
            EXPECT_GE(seen.contacts - before, 2 * model.model.pieces().pieces.size());
        }
    }
    EXPECT_GT(seen.overlaps, seen.contacts / 10);
}

// By the law: asked the other way round, the same pieces touch, as far, along the other way.
TEST(ContactsLaws, SwappingMirrorsTheAnswer) {
    std::mt19937 random(20240703);
    const OpenModel ring = open_with_pieces(torus(1, 0.4, 10, 8));
    const OpenModel cube = open_with_pieces(unit_cube());
    std::size_t seen = 0;
    for (int i = 0; i < 40; ++i) {
        const Pose pose = random_pose(random, 1.5);
        auto found = all_contacts(ring.model, cube.model, Placement::b_moves(pose), 0.05);
        auto back = all_contacts(cube.model, ring.model, Placement::a_moves(pose), 0.05);
        ASSERT_EQ(found.size(), back.size());
        const auto by_ring = [](const Contact& x, const Contact& y) {
            return x.piece_b < y.piece_b;
        };
        std::stable_sort(back.begin(), back.end(), by_ring);
        for (std::size_t k = 0; k < found.size(); ++k) {
            const Contact &one = found[k], &other = back[k];
            ASSERT_EQ(one.piece_a, other.piece_b);
            ASSERT_EQ(one.piece_b, other.piece_a);
            EXPECT_EQ(one.flags & contact_overlap, other.flags & contact_overlap);
            EXPECT_NEAR(one.upper, other.upper, 1e-12);
            if ((one.flags & contact_overlap) == 0) {
                EXPECT_NEAR(dot(one.normal, other.normal), -1, 1e-9);
            }
            ++seen;
        }
    }
    EXPECT_GT(seen, 50U);
}

TEST(ContactsLaws, NothingIsAllocated) {
    const OpenModel ring = open_with_pieces(torus(1, 0.4, 10, 8));
    Workspace workspace;
    std::vector<Contact> found(1000);
    const Placement placement =
        Placement::b_moves(Pose::from_quaternion(1, 2, 3, 4, {0.5, 0.25, 0.125}).value());
    const std::size_t before = used;
    most = used;
    for (const Structure structure : {Structure::bvh, Structure::pieces}) {
        EXPECT_GT(contacts({ring.model, ring.model, placement, {.through = structure}}, workspace,
                           found, {.tolerance = 0.1, .manifold = Manifold::four})
                      .count,
                  10U);
    }
    EXPECT_EQ(used, before);
    EXPECT_EQ(most, before);
}

}  // namespace
}  // namespace cdprep::test
