// SPDX-License-Identifier: MIT
// A scene asks about solids through their enclosing parts, where a plan permits an error.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "cdprep/hulls.h"
#include "cdprep/live_model.h"
#include "cdprep/scene.h"
#include "decompose/enclose/approximate_parts.h"
#include "support/concave_solids.h"
#include "support/guarded_pages.h"
#include "support/random_pose.h"
#include "unit/tools/tiny_hull_sections.h"
#include "unit/tools/with_pieces.h"

namespace cdprep::test {
namespace {

AlignedBytes file_with_parts(const TestMesh& mesh, std::size_t parts) {
    const AlignedBytes bare = bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true});
    convex::HullSections hulls = *convex::make_hull_sections(mesh_of(mesh), {}, 0, serial_for);
    convex::ApproximateOptions options;
    options.max_parts = parts;
    options.work = 2'000'000;  // less than the best parts, in little time
    convex::add_parts(hulls, convex::find_approximate_parts(mesh_of(mesh), options).parts);
    return with_sections(bare, convex::tiny_sections(hulls));
}

OpenModel open_with_parts(const TestMesh& mesh, std::size_t parts) {
    return open_tiny(file_with_parts(mesh, parts));
}

ModelUse use_of(const Model& model, std::uint32_t layers = 1) {
    return {"m", model.asks(), layers, enclosing_parts(model)};
}

constexpr double kReach = 0.75;  ///< LayerPair::max_distance
constexpr SceneLimits kLimits = {.objects = 12, .pairs = 80, .triangle_pairs = 20'000};

/// Both effects, of solids in one layer.
LayerPair solids(double max_error) {
    return {.effects = Ask::collide | Ask::distance,
            .max_distance = kReach,
            .max_error = max_error,
            .body = Body::solid};
}

Plan plan_of(const LayerPair& pair, const std::vector<ModelUse>& uses) {
    auto made = Plan::compile({.pairs = {&pair, 1}, .models = uses, .limits = kLimits});
    for (const std::string& refusal : made.refusals) ADD_FAILURE() << refusal;
    return *made.plan;
}

/// The rounding that plan.h permits. Coordinates of these tests are below 8.
double rounding_at(double upper) {
    return 3e-12 * upper + 1e-13 * 8;
}

/// What the answers about many objects were.
struct Seen {
    int pairs = 0, apart = 0, near = 0, wrong_hits = 0, wrong_finds = 0;
    int by_walk = 0, by_parts = 0;
};

/// The results of a scene about two objects.
struct Found {
    const SceneHit* hit = nullptr;
    const SceneDistance* distance = nullptr;

    Found(const Scene& scene, ObjectId a, ObjectId b) {
        for (const SceneHit& one : scene.hits()) {
            if (one.a == a && one.b == b) hit = &one;
        }
        for (const SceneDistance& one : scene.distances()) {
            if (one.a == a && one.b == b) distance = &one;
        }
    }
    [[nodiscard]] bool holds(Ask effect) const {
        return hit != nullptr && contains(hit->holds, effect);
    }
};

/// Holds the answers about two objects to the exact distance of the solids.
void expect_within_error(const Found& found, const Distance& exact, double error, Seen& seen) {
    const double far = error + rounding_at(exact.upper);
    ++seen.pairs;
    // A hit that is not told would be further wrong than the header allows.
    if (exact.upper == 0) {
        EXPECT_TRUE(found.holds(Ask::collide));
    } else if (found.holds(Ask::collide)) {
        EXPECT_LE(exact.lower, far);
        ++seen.wrong_hits;
    }
    ASSERT_EQ(found.holds(Ask::distance), found.distance != nullptr);
    if (found.distance == nullptr) {
        EXPECT_GT(exact.upper, kReach);
        ++seen.apart;
        return;
    }
    EXPECT_LE(exact.lower, kReach + far);
    seen.wrong_finds += exact.lower > kReach ? 1 : 0;
    const Distance& bounds = found.distance->distance;
    EXPECT_LE(bounds.lower, exact.upper);
    EXPECT_GE(bounds.upper, exact.lower);
    EXPECT_LE(bounds.upper - bounds.lower, error + rounding_at(bounds.upper));
    EXPECT_LE(bounds.lower, kReach);
    EXPECT_GE(bounds.lower, 0);
    seen.near += bounds.lower > 0 ? 1 : 0;
    if (bounds.triangle_a != kNoTriangleNumber) {
        ++seen.by_walk;
        return;
    }
    ++seen.by_parts;
    EXPECT_EQ(bounds.triangle_b, kNoTriangleNumber);
    // The witnesses are as far apart as the parts.
    const Double3 &p = bounds.witness_a, &q = bounds.witness_b;
    const double gap = std::hypot(p.x - q.x, p.y - q.y, p.z - q.z);
    EXPECT_GE(gap, bounds.lower - rounding_at(1));
    EXPECT_LE(gap, bounds.upper + rounding_at(1));
    EXPECT_EQ(found.hit->collision.containment.answer, Answer::no);
}

/// Runs steps of a scene of 12 objects at random places, and asks each pair exactly as well.
Seen run(const Plan& plan, const std::vector<const Model*>& models, int steps) {
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    std::mt19937 random(7);
    std::vector<ObjectId> ids;
    for (std::uint32_t i = 0; i < kLimits.objects; ++i) {
        ids.push_back(*scene.add({models[i % models.size()], 0, Pose()}));
    }
    Seen seen;
    Workspace workspace;
    for (int step = 0; step < steps; ++step) {
        std::vector<Pose> poses;
        for (const ObjectId& id : ids) {
            poses.push_back(random_pose(random, 2.5));
            scene.set_pose(id, poses.back());
        }
        EXPECT_TRUE(scene.step(workspaces).complete);
        for (std::size_t i = 0; i < ids.size(); ++i) {
            for (std::size_t j = i + 1; j < ids.size(); ++j) {
                const Pair pair = {*models[i % models.size()],
                                   *models[j % models.size()],
                                   Placement::world(poses[i], poses[j]),
                                   {.body = Body::solid}};
                expect_within_error(Found(scene, ids[i], ids[j]), *distance(pair, workspace),
                                    plan.rungs()[0].error, seen);
            }
        }
    }
    return seen;
}

/// Models with few crude parts, so that their errors matter. They are made once.
struct PartModels {
    OpenModel torus = open_with_parts(test::torus(1, 0.3, 16, 8), 2);
    OpenModel star = open_with_parts(test::star(), 2);
    OpenModel ball = open_with_parts(moved_by(icosphere(1), 0.3, {0, 0, 0}), 1);
};

class SceneParts : public testing::Test {
protected:
    SceneParts() {
        static const PartModels kMade;
        for (const OpenModel* one : {&kMade.torus, &kMade.star, &kMade.ball}) {
            models_.push_back(&one->model);
            uses_.push_back(use_of(one->model));
            error_ = std::max(error_, enclosing_parts(one->model).error);
        }
    }
    std::vector<const Model*> models_;  ///< a torus, a star and a ball
    std::vector<ModelUse> uses_;
    double error_ = 0;
};

TEST_F(SceneParts, IntervalsHoldTheDistanceOfTheSolids) {
    ASSERT_GT(error_, 0.01);
    const Plan plan = plan_of(solids(2 * error_), uses_);
    ASSERT_EQ(plan.rungs()[0].rung, Rung::parts);
    EXPECT_EQ(plan.rungs()[0].error, 2 * error_);
    const Seen seen = run(plan, models_, 60);
    EXPECT_EQ(seen.pairs, 60 * 66);
    // Each kind of answer occurs, also those that only an error permits.
    EXPECT_GT(seen.apart, 100);
    EXPECT_GT(seen.near, 100);
    EXPECT_GT(seen.wrong_hits, 0);
    EXPECT_GT(seen.wrong_finds, 0);
    EXPECT_EQ(seen.by_walk, 0);
}

// A smaller error needs the walk, which ends early.
TEST_F(SceneParts, TheWalkHoldsASmallerError) {
    const double error = std::nextafter(2 * error_, 0);
    const Plan plan = plan_of(solids(error), uses_);
    EXPECT_EQ(plan.rungs()[0].rung, Rung::walk);
    EXPECT_EQ(plan.rungs()[0].error, error);
    EXPECT_FALSE(contains(plan.asks_of(0), Ask::hulls));
    const Seen seen = run(plan, models_, 5);
    EXPECT_EQ(seen.wrong_hits + seen.wrong_finds, 0);
    EXPECT_GT(seen.by_walk, 50);
}

TEST_F(SceneParts, AnyErrorIsAllowed) {
    for (const double error : {1e3, 1e300}) {
        const Plan plan = plan_of(solids(error), uses_);
        EXPECT_EQ(plan.rungs()[0].rung, Rung::parts);
        EXPECT_EQ(plan.rungs()[0].error, 2 * error_);
        EXPECT_GT(run(plan, models_, 1).near, 0);
        const Plan walk = plan_of(solids(error), {});
        EXPECT_EQ(walk.rungs()[0].rung, Rung::walk);
        EXPECT_GT(run(walk, models_, 1).by_walk, 0);
    }
}

// The plan has seen finer parts than those of one object, and none of another.
TEST_F(SceneParts, ObjectsWhosePartsDoNotCertifyTakeTheWalk) {
    const OpenModel crude = open_with_parts(torus(2, 0.3, 16, 8), 1);
    const OpenModel bare = open_tiny(with_hulls(
        bake_tiny(unit_cube().positions, unit_cube().triangles, {.double_precision = true})));
    const Plan plan = plan_of(solids(2 * error_), uses_);
    ASSERT_GT(enclosing_parts(crude.model).error, error_);
    ASSERT_EQ(enclosing_parts(bare.model).count, 0U);
    const Seen seen = run(plan, {models_[0], &crude.model, &bare.model}, 5);
    EXPECT_GT(seen.by_walk, 50);
    EXPECT_GT(seen.by_parts, 0);
}

// By hand: the ball is in the hole of the torus, 0.4 from it. A hull fills the hole. Without a
// distance, the exact query tells that they do not collide.
TEST_F(SceneParts, CollideIsExactWhileDistanceIsPaused) {
    const Plan plan = plan_of(solids(2 * error_), uses_);
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    const ObjectId ring = *scene.add({models_[0], 0, Pose()});
    const ObjectId ball = *scene.add({models_[2], 0, Pose()});
    ASSERT_TRUE(scene.step(workspaces).complete);
    const Found crude(scene, ring, ball);
    EXPECT_TRUE(crude.holds(Ask::collide));
    ASSERT_TRUE(crude.holds(Ask::distance));
    EXPECT_EQ(crude.distance->distance.lower, 0);
    EXPECT_GE(crude.distance->distance.upper, 0.4);
    EXPECT_EQ(scene.counts().calls_of(Ask::collide), 0U);
    scene.set_paused(Ask::distance);  // nothing moves
    ASSERT_TRUE(scene.step(workspaces).complete);
    EXPECT_FALSE(Found(scene, ring, ball).holds(Ask::collide));
    EXPECT_EQ(scene.counts().calls_of(Ask::collide), 1U);
}

// The walk permits an error of `distance` and of `within`, which it tells. `collide` stays exact.
TEST_F(SceneParts, SurfacesAreMeasuredWithinTheError) {
    LayerPair pair = {.effects = Ask::collide | Ask::distance | Ask::within,
                      .tolerance = 0.25,
                      .max_distance = kReach,
                      .max_error = 0.3};
    const Plan plan = plan_of(pair, uses_);
    EXPECT_EQ(plan.rungs()[0].rung, Rung::walk);
    EXPECT_EQ(plan.rungs()[0].error, 0.3);
    std::vector<Workspace> workspaces(1);
    Workspace workspace;
    std::mt19937 random(11);
    int apart = 0, wrong = 0, wide = 0;
    for (int i = 0; i < 400; ++i) {
        const Model &a = *models_[i % 3], &b = *models_[i % 2];
        const Pose pose_a = random_pose(random, 1.5), pose_b = random_pose(random, 1.5);
        Scene scene(plan);
        const ObjectId id_a = *scene.add({&a, 0, pose_a}), id_b = *scene.add({&b, 0, pose_b});
        ASSERT_TRUE(scene.step(workspaces).complete);
        const Found found(scene, id_a, id_b);
        const Distance exact = *distance({a, b, Placement::world(pose_a, pose_b)}, workspace);
        EXPECT_EQ(found.holds(Ask::collide), exact.upper == 0);
        EXPECT_EQ(found.holds(Ask::distance), exact.lower <= kReach);
        if (exact.upper <= pair.tolerance) {
            EXPECT_TRUE(found.holds(Ask::within));
        } else if (found.holds(Ask::within)) {
            EXPECT_LE(exact.lower, pair.tolerance + 0.3 + rounding_at(1));
            ++wrong;
        }
        apart += exact.upper > 0 ? 1 : 0;
        if (found.distance == nullptr) continue;
        const Distance& bounds = found.distance->distance;
        EXPECT_LE(bounds.lower, exact.upper);
        EXPECT_GE(bounds.upper, exact.lower);
        EXPECT_LE(bounds.upper - bounds.lower, 0.3 + rounding_at(1));
        EXPECT_NE(bounds.triangle_a, kNoTriangleNumber);
        wide += bounds.upper - bounds.lower > 0.01 ? 1 : 0;
    }
    EXPECT_GT(apart, 50);
    EXPECT_GT(wide, 10);
    EXPECT_GT(wrong, 0);
}

// By hand: two unit cubes, whose only part is themselves. They touch, cross, or are apart.
TEST(SceneOfCubes, TouchingPartsCollide) {
    const OpenModel cube = open_with_parts(unit_cube(), 1);
    const EnclosingParts parts = enclosing_parts(cube.model);
    ASSERT_EQ(parts.count, 1U);
    EXPECT_EQ(parts.error, 0);
    EXPECT_GE(parts.size, 3);
    const Plan plan = plan_of(solids(1e-9), {use_of(cube.model)});
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    const auto at = [](double x) {
        return Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, x, 0.25, 0.25}).value();
    };
    const ObjectId a = *scene.add({&cube.model, 0, Pose()});
    const ObjectId b = *scene.add({&cube.model, 0, at(1)});
    for (const auto& [x, gap] : {std::array{1.0, 0.0}, {1.5, 0.5}, {0.5, 0.0}, {1.75, 0.75}}) {
        scene.set_pose(b, at(x));
        ASSERT_TRUE(scene.step(workspaces).complete);
        const Found found(scene, a, b);
        ASSERT_TRUE(found.holds(Ask::distance)) << x;
        EXPECT_EQ(found.holds(Ask::collide), gap == 0);
        EXPECT_LE(found.distance->distance.lower, gap);
        EXPECT_GE(found.distance->distance.upper, gap);
        EXPECT_NEAR(found.distance->distance.lower, gap, 1e-13);
        EXPECT_NEAR(found.distance->distance.upper, gap, 1e-13);
    }
    scene.set_pose(b, at(1.75 + 1e-9));
    ASSERT_TRUE(scene.step(workspaces).complete);
    EXPECT_FALSE(Found(scene, a, b).holds(Ask::distance));
}

// By hand: two unit cubes that share a part of an edge touch, but do not cross. The exact query
// tells.
TEST(SceneOfCubes, TouchingPartsDoNotCross) {
    const OpenModel cube = open_with_parts(unit_cube(), 1);
    LayerPair pair = solids(1e-9);
    pair.overlap = Overlap::proper;
    const Plan plan = plan_of(pair, {use_of(cube.model)});
    ASSERT_EQ(plan.rungs()[0].rung, Rung::parts);
    Scene scene(plan);
    std::vector<Workspace> workspaces(1);
    const ObjectId a = *scene.add({&cube.model, 0, Pose()});
    const ObjectId b = *scene.add({&cube.model, 0, Pose()});
    struct Case {
        double x, y;
        bool crosses;
        std::size_t exact_queries;
    };
    for (const Case& c :
         {Case{1, 1, false, 1}, Case{0.5, 0.25, true, 1}, Case{1.5, 0.25, false, 0}}) {
        scene.set_pose(b, Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, c.x, c.y, 0.25}).value());
        ASSERT_TRUE(scene.step(workspaces).complete);
        EXPECT_EQ(Found(scene, a, b).holds(Ask::collide), c.crosses) << c.x;
        EXPECT_EQ(scene.counts().calls_of(Ask::collide), c.exact_queries) << c.x;
    }
}

// With parts, `overlap` and `within` are as exact as without.
TEST_F(SceneParts, OtherEffectsStayExact) {
    LayerPair pair = solids(2 * error_);
    pair.effects = pair.effects | Ask::overlap | Ask::within;
    pair.tolerance = 0.25;
    const Plan plan = plan_of(pair, uses_);
    ASSERT_EQ(plan.rungs()[0].rung, Rung::parts);
    std::vector<Workspace> workspaces(1);
    Workspace workspace;
    std::mt19937 random(13);
    int overlaps_seen = 0, near = 0;
    for (int i = 0; i < 200; ++i) {
        const Model &a = *models_[i % 3], &b = *models_[i % 2];
        const Pose pose_a = random_pose(random, 1.5), pose_b = random_pose(random, 1.5);
        Scene scene(plan);
        const ObjectId id_a = *scene.add({&a, 0, pose_a}), id_b = *scene.add({&b, 0, pose_b});
        ASSERT_TRUE(scene.step(workspaces).complete);
        const Found found(scene, id_a, id_b);
        const Pair exact = {a, b, Placement::world(pose_a, pose_b)};
        const bool meets = overlaps(exact, workspace, {}) > 0;
        const bool is_near = within(exact, pair.tolerance, workspace);
        EXPECT_EQ(found.holds(Ask::overlap), meets);
        EXPECT_EQ(found.holds(Ask::within), is_near);
        EXPECT_TRUE(found.holds(Ask::collide) || !meets);
        overlaps_seen += meets ? 1 : 0;
        near += is_near && !meets ? 1 : 0;
    }
    EXPECT_GT(overlaps_seen, 20);
    EXPECT_GT(near, 5);
}

// A query through parts reads the hulls and the root of the BVH. All else may be closed.
TEST(ScenePartsDeathTest, ReadOnlyHullsAndBoxes) {
    const AlignedBytes file = on_pages(file_with_parts(star(), 2));
    const OpenModel whole = open_tiny(AlignedBytes(file.span()));
    const Plan plan = plan_of(solids(2), {use_of(whole.model)});
    ASSERT_EQ(plan.rungs()[0].rung, Rung::parts);
    const format::SectionSet wanted = sections_for(plan.asks_of(0));
    EXPECT_TRUE(wanted.contains(SectionId::hull_blocks));
    GuardedPages pages(file.span(), wanted);
    const auto model = Model::open(pages.bytes(), wanted);
    ASSERT_TRUE(model);
    const auto hash = [&](const Model& of) {
        Scene scene(plan);
        std::vector<Workspace> workspaces(1);
        std::mt19937 random(5);
        for (int i = 0; i < 12; ++i) scene.add({&of, 0, random_pose(random, 2)});
        EXPECT_TRUE(scene.step(workspaces).complete);
        EXPECT_GT(scene.distances().size(), 10U);
        return scene.state_hash();
    };
    for (const SectionId id : {SectionId::bvh_leaves, SectionId::triangles,
                               SectionId::positions_f64, SectionId::hull_facets}) {
        pages.close(id);
    }
    EXPECT_EQ(hash(*model), hash(whole.model));
    pages.close(SectionId::hull_blocks);
    EXPECT_DEATH(hash(*model), "");
}

TEST(EnclosingParts, AreThoseOfBalancedModelsOfOneComponent) {
    const OpenModel ring = open_with_parts(torus(1, 0.3, 16, 8), 4);
    const EnclosingParts parts = enclosing_parts(ring.model);
    EXPECT_GT(parts.count, 1U);
    EXPECT_EQ(parts.first + parts.count, ring.model.hulls().hulls.size());
    EXPECT_EQ(ring.model.hulls().hulls[parts.first].scope, format::HullScope::part);
    // Unbalanced, of two components, without sections, and the bake of nothing.
    TestMesh pierced = torus(1, 0.3, 16, 8);
    pierced.triangles.pop_back();
    const OpenModel open = open_with_parts(pierced, 6);
    EXPECT_TRUE(find_hull(open.model, format::HullScope::part));
    EXPECT_EQ(enclosing_parts(open.model).count, 0U);
    const OpenModel two =
        open_with_parts(joined(unit_cube(), moved_by(unit_cube(), 1, {3, 0, 0})), 6);
    EXPECT_TRUE(find_hull(two.model, format::HullScope::part));
    EXPECT_EQ(enclosing_parts(two.model).count, 0U);
    EXPECT_EQ(enclosing_parts(open_tiny(torus(1, 0.3, 16, 8)).model).count, 0U);
    const auto surface = Model::open(ring.bytes.span(), sections_for(Ask::distance | Ask::solid));
    EXPECT_EQ(enclosing_parts(*surface).count, 0U);
    const auto hulls = Model::open(ring.bytes.span(), sections_for(Ask::hulls));
    EXPECT_EQ(enclosing_parts(*hulls).count, 0U);
    EXPECT_EQ(enclosing_parts(open_tiny(with_hulls(bake_tiny({}, {}))).model).count, 0U);
}

// The model of a live model serves no hulls, so that no layer with parts takes it.
TEST(EnclosingParts, DoNotFollowALiveModel) {
    const OpenModel ring = open_with_parts(torus(1, 0.3, 16, 8), 2);
    AlignedBytes memory(*LiveModel::bytes(ring.model));
    const LiveModel live = *LiveModel::in(memory.span(), ring.model);
    EXPECT_FALSE(live.model().serves(Ask::hulls));
    EXPECT_EQ(enclosing_parts(live.model()).count, 0U);
}

}  // namespace
}  // namespace cdprep::test
