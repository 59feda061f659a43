// SPDX-License-Identifier: MIT
// The tables of a comparison over small meshes: complete, and true where that is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "cdprep/cells.h"
#include "cdprep/cells/overlap_through.h"
#include "cell_searches/spatial_tables.h"
#include "compare/pair_tables.h"
#include "compare/peer_tables.h"
#include "compare/preparation.h"
#include "compare/pruning.h"
#include "compare/strategy.h"
#include "support/meshes.h"
#include "unit/tools/soup_of.h"

namespace cdprep::study {
namespace {

StudyMesh study_mesh(const std::string& name, const test::TestMesh& mesh) {
    return make_study_mesh(name, name + ".obj", test::soup_of(mesh));
}

void expect_complete(const Table& table) {
    EXPECT_FALSE(table.rows.empty()) << table.key;
    for (const Row& row : table.rows) {
        ASSERT_EQ(row.cells.size(), table.columns.size()) << table.key << " " << row.label;
        for (std::size_t c = 0; c < row.cells.size(); ++c) {
            EXPECT_NE(row.cells[c].is_filled(), !row.cells[c].reason.empty())
                << table.key << " " << row.label << " " << table.columns[c].key;
        }
    }
}

const Cell& cell_of(const Table& table, std::size_t row, const std::string& key) {
    const auto at = std::ranges::find(table.columns, key, &Column::key);
    return table.rows[row].cells[static_cast<std::size_t>(at - table.columns.begin())];
}

struct Compared {
    std::vector<StudyMesh> meshes;
    std::vector<ModelForms> forms;
    std::vector<PairStudy> studies;
};

const Compared& compared() {
    static const Compared made = [] {
        Compared all;
        all.meshes.push_back(study_mesh("torus", test::torus(1, 0.4, 48, 24)));
        all.meshes.push_back(study_mesh("ball", test::icosphere(3)));
        for (const StudyMesh& mesh : all.meshes) {
            all.forms.push_back(make_model_forms(mesh, serial_for).value());
        }
        all.studies.push_back(study_pair(
            all.forms[0], all.forms[1],
            make_pose_set(all.forms[0].swept.model, all.forms[1].swept.model, {.per_stratum = 3}),
            {.timing = {.rounds = 1, .least_sample_s = 0}}));
        all.studies[0].a = 0;
        all.studies[0].b = 1;
        return all;
    }();
    return made;
}

// By hand: fitted to a diagonal of 1 and centred.
TEST(StudyMesh, IsFittedToADiagonalOfOne) {
    const StudyMesh ball = study_mesh("ball", test::icosphere(2));
    EXPECT_EQ(ball.read_triangles, 320U);
    EXPECT_FALSE(ball.likeness.model);
    Double3 high = ball.mesh.positions[0];
    for (const Double3& p : ball.mesh.positions) {
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    EXPECT_NEAR(high.x * high.x + high.y * high.y + high.z * high.z, 0.25, 1e-6);
}

TEST(SpatialTables, AreComplete) {
    const Compared& all = compared();
    std::vector<SpatialMesh> measured;
    for (const StudyMesh& mesh : all.meshes) {
        measured.push_back({&mesh, measure_spatial_builds(mesh, {.rounds = 1})});
    }
    expect_complete(spatial_table(measured));
    expect_complete(spatial_details(measured[0]));
    // 512 leaf cells are all that level 3 can give.
    for (const SpatialBuild& build : measured[0].builds) {
        if (build.setting != "paper") continue;
        EXPECT_EQ(build.limits.level, 3U);
        EXPECT_LE(build.figures.leaves, 512U);
        EXPECT_GE(build.figures.references, all.meshes[0].mesh.triangles.size());
        EXPECT_GE(build.figures.formula_all, build.figures.formula);
    }
    const std::vector<Check> checks = spatial_checks(measured);
    ASSERT_EQ(checks.size(), measured.size());  // nothing was published of these
    for (const Check& check : checks) EXPECT_NE(check.verdict, Verdict::not_asked);
}

TEST(PreparationTables, AreCompleteAndNameTheReasonOfWhatIsLeftOut) {
    const Compared& all = compared();
    std::vector<Preparation> prepared;
    for (std::size_t i = 0; i < all.meshes.size(); ++i) {
        prepared.push_back(measure_preparation(all.meshes[i], all.forms[i],
                                               {.rounds = 1, .pieces_alone = i == 0}));
    }
    const Table table = preparation_table(all.meshes, prepared);
    expect_complete(table);
    expect_complete(preparation_details(all.meshes, prepared));
    EXPECT_TRUE(cell_of(table, 0, "pieces_s").is_filled());
    EXPECT_FALSE(cell_of(table, 1, "pieces_s").is_filled());
    // Every corner of the ball is a vertex of its hull, and by Euler 2 v - 4 facets are.
    EXPECT_EQ(prepared[1].hull.vertices, all.meshes[1].mesh.positions.size());
    EXPECT_EQ(prepared[1].hull.facets, 2 * prepared[1].hull.vertices - 4);
    EXPECT_EQ(prepared[1].pieces.border_edges, 0U);
    EXPECT_EQ(preparation_checks(all.meshes, prepared).size(), 1U);
}

TEST(PairTables, AreCompleteAndEveryExactStrategyAgrees) {
    const Compared& all = compared();
    const PairStudy& study = all.studies[0];
    expect_complete(pair_table(all.meshes, all.studies));
    expect_complete(pair_details(all.meshes, study));
    std::size_t exact = 0;
    for (const Contender& contender : study.contenders) {
        EXPECT_GT(contender.answers, 0U);
        if (contender.is_approximate) continue;
        ++exact;
        EXPECT_EQ(contender.agreeing, contender.answers) << title_of(contender);
        EXPECT_EQ(contender.found, contender.pairs) << title_of(contender);
    }
    EXPECT_EQ(exact, 9U);
    EXPECT_GT(std::ranges::count(study.exact.hits, true), 3);
    EXPECT_GT(std::ranges::count(study.exact.hits, false), 3);
    // Boxes are tested, and the hierarchy has no cells.
    const QueryCounts& collide = study.contenders.back().counts[0][0];
    const QueryCounts& overlap = study.contenders.back().counts[1][0];
    EXPECT_GT(collide.box_pairs, 0U);
    EXPECT_EQ(collide.cell_pairs, 0U);
    EXPECT_GT(overlap.triangle_pairs, collide.triangle_pairs);  // it does not end at the first
}

TEST(StrategyPair, OfHullsNeedsThatOfBothModels) {
    const StudyMesh ball = study_mesh("ball", test::icosphere(1));
    const ModelForms whole = make_model_forms(ball, serial_for).value();
    ModelForms bare = make_model_forms(ball, serial_for).value();
    bare.plain = make_memory_model(ball.mesh, {}).value();
    const auto of_hulls = std::ranges::find(strategies(), true, &Strategy::of_hulls);
    ASSERT_NE(of_hulls, strategies().end());
    EXPECT_EQ(StrategyPair(*of_hulls, whole, whole).find_reason(Asked::collide), "");
    EXPECT_EQ(StrategyPair(*of_hulls, whole, bare).find_reason(Asked::collide),
              "a model has no hull");
    EXPECT_EQ(StrategyPair(*of_hulls, bare, whole).find_reason(Asked::collide),
              "a model has no hull");
}

TEST(PairChecks, OneWrongAnswerBreaksThePromise) {
    const Compared& all = compared();
    std::vector<PairStudy> studies = all.studies;
    const auto promise = [&] {
        const std::vector<Check> checks = pair_checks(all.meshes, studies);
        return *std::ranges::find(checks, true, &Check::is_promise);
    };
    EXPECT_EQ(promise().verdict, Verdict::holds);
    --studies[0].contenders.back().agreeing;
    EXPECT_EQ(promise().verdict, Verdict::fails);
}

// As quick as collide is no contradiction, and not even worth a word.
TEST(PairChecks, OverlapMayTakeAsLongAsCollide) {
    const Compared& all = compared();
    std::vector<PairStudy> studies = all.studies;
    const auto set_times = [&](double collide, double overlap) {
        for (Contender& contender : studies[0].contenders) {
            for (const auto& [asked, value] :
                 {std::pair{Asked::collide, collide}, std::pair{Asked::overlap, overlap}}) {
                auto& seconds = contender.timings[static_cast<std::size_t>(asked)].seconds;
                for (std::vector<double>& rounds : seconds) {
                    std::ranges::fill(rounds, value);
                }
            }
        }
    };
    const auto check = [&] {
        const std::vector<Check> checks = pair_checks(all.meshes, studies);
        return *std::ranges::find_if(checks, [](const Check& c) {
            return c.claim.find("overlap takes at least as long") != std::string::npos;
        });
    };
    set_times(1, 1);
    EXPECT_EQ(check().evidence, "for every strategy, at deep and shallow poses");
    set_times(1, std::nextafter(1, 0));
    EXPECT_EQ(check().verdict, Verdict::fails);
}

// One large triangle through a small ball: no corner of it lies in a cell of the ball, so that
// the talk's search finds nothing of what overlaps.
TEST(Pruning, ACornerSearchMissesALargeTriangle) {
    test::TestMesh flat;
    flat.positions = {{-9, -9, 0.01}, {9, -9, 0.01}, {0, 12, 0.01}};
    flat.triangles = {{{0, 1, 2}}};
    MemoryParts parts;
    parts.octree = build::OctreeOptions{.level = 5, .threshold = 8};
    const MemoryModel little = make_memory_model(test::mesh_of(test::icosphere(3)), parts).value();
    const MemoryModel large = make_memory_model(test::mesh_of(flat), parts).value();
    Workspace workspace(cells());
    std::vector<TrianglePair> missed;
    const Pruning pruning =
        prune(little.model, large.model, Pose(), CellSearch::modulus, workspace, missed);
    EXPECT_GT(pruning.pairs, 10);
    EXPECT_EQ(pruning.found, 0);
    EXPECT_EQ(missed.size(), static_cast<std::size_t>(pruning.pairs));
    EXPECT_EQ(pruning.pcs_b, 1);
    EXPECT_EQ(pruning.cs_b, 1);
}

// By hand. Two balls of radius 1 are beside each other on a diagonal: their boxes meet, and their
// hulls do not. A cube is turned by 45 degrees about z: along x, it reaches the root of 2.
TEST(Pruning, WholeModelsAreRuledOutByTheTighterSteps) {
    MemoryParts parts;
    parts.hulls = true;
    const MemoryModel ball = make_memory_model(test::mesh_of(test::icosphere(3)), parts).value();
    const auto steps_at = [&](const Double3& shift) {
        return prune_objects(ball.model, ball.model,
                             Pose::from_quaternion(1, 0.3, 0.2, 0.1, shift).value());
    };
    const ObjectPruning deep = steps_at({0.5, 0, 0});
    EXPECT_EQ(deep.boxes + deep.oriented + deep.hulls, 3);
    const ObjectPruning diagonal = steps_at({1.5, 1.5, 1.5});
    EXPECT_EQ(diagonal.boxes, 1);
    EXPECT_EQ(diagonal.hulls, 0);
    const ObjectPruning far = steps_at({9, 0, 0});
    EXPECT_EQ(far.boxes + far.oriented + far.hulls, 0);

    const test::TestMesh both = test::moved_by(test::unit_cube(), 2, {-1, -1, -1});
    const MemoryModel cube = make_memory_model(test::mesh_of(both), parts).value();
    const Pose turned = Pose::from_quaternion(std::cos(std::numbers::pi / 8), 0, 0,
                                              std::sin(std::numbers::pi / 8), {1.75, 1.75, 0})
                            .value();
    const ObjectPruning corner = prune_objects(cube.model, cube.model, turned);
    EXPECT_EQ(corner.boxes, 1);
    EXPECT_EQ(corner.oriented, 0);
    EXPECT_EQ(corner.hulls, 0);
}

TEST(Pruning, ModelsAreLostByAnyStep) {
    EXPECT_TRUE(keeps_models({.boxes = 1, .oriented = 1, .hulls = 1}));
    EXPECT_FALSE(keeps_models({.boxes = 0, .oriented = 1, .hulls = 1}));
    EXPECT_FALSE(keeps_models({.boxes = 1, .oriented = 0, .hulls = 1}));
    EXPECT_FALSE(keeps_models({.boxes = 1, .oriented = 1, .hulls = 0}));
}

TEST(Pruning, EachStepKeepsWhatOverlaps) {
    const Compared& all = compared();
    const std::vector<const ModelForms*> forms = {&all.forms[0], &all.forms[1]};
    const Table table = pruning_table(all.meshes, all.studies, forms);
    const PairStudy& study = all.studies[0];
    expect_complete(table);
    constexpr std::array strata = {Stratum::deep, Stratum::shallow, Stratum::near};
    ASSERT_EQ(table.rows.size(), strata.size());
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        const auto at = [&](const char* key) { return *cell_of(table, r, key).value; };
        // Where triangles overlap, no step about whole models says that nothing meets.
        EXPECT_GE(at("boxes"), at("oriented"));
        EXPECT_GE(at("oriented"), at("hulls"));
        const std::vector<std::size_t> poses = study.poses.of(strata[r]);
        const auto touching = std::ranges::count_if(
            poses, [&](std::size_t pose) { return study.exact.pairs[pose] > 0; });
        EXPECT_GE(at("hulls"), static_cast<double>(touching) / static_cast<double>(poses.size()));
        EXPECT_GE(at("all_b"), at("cluster_b"));
        EXPECT_GE(at("cluster_b"), at("slab_b"));
        EXPECT_GE(at("slab_b"), at("cs_b"));
        EXPECT_GE(at("cluster_b"), at("leaf_b"));
        EXPECT_GE(at("leaf_b"), at("pcs_b"));
        EXPECT_GE(at("pcs_b"), at("cs_b"));
        EXPECT_GE(at("cs_a"), at("literal_cs_a"));
        double pairs = 0;
        for (const std::size_t pose : poses) pairs += static_cast<double>(study.exact.pairs[pose]);
        EXPECT_DOUBLE_EQ(at("pairs"), pairs / static_cast<double>(poses.size())) << r;
    }
    const std::vector<Check> checks = pruning_checks(table);
    ASSERT_EQ(checks.size(), 2U);
    EXPECT_EQ(checks[1].verdict, Verdict::holds) << checks[1].evidence;
}

/// What a peer would say that is always right.
PeerAnswers right_answers(const PairStudy& study) {
    PeerAnswers peer;
    peer.key = "fcl";
    peer.name = "Oracle";
    for (const Asked asked : {Asked::collide, Asked::overlap, Asked::distance, Asked::within}) {
        for (const std::size_t pose : cases_of(asked, study.poses)) {
            PeerAnswered& answered = peer.asked[static_cast<std::size_t>(asked)];
            answered.seconds.push_back({1e-3, 3e-3, 1e-3});
            answered.answers.push_back(asked == Asked::overlap ? study.exact.pairs[pose]
                                                               : study.exact.hits[pose]);
        }
    }
    return peer;
}

TEST(AddPeer, HoldsItsAnswersAgainstTheExactOnes) {
    const Compared& all = compared();
    PairStudy study = all.studies[0];
    PeerAnswers peer = right_answers(study);
    EXPECT_EQ(add_peer(peer, study), "");
    EXPECT_EQ(study.contenders.back().agreeing, study.contenders.back().answers);
    peer.asked[1].answers[0] += 1;
    EXPECT_EQ(add_peer(peer, study), "");
    EXPECT_EQ(study.contenders.back().agreeing + 1, study.contenders.back().answers);
    const Table table = pair_details(all.meshes, study);
    expect_complete(table);
    EXPECT_EQ(table.rows.back().label, "Oracle");
    EXPECT_EQ(*cell_of(table, table.rows.size() - 1, "collide_deep").value, 1e-3);
}

// Without peers every cell says why; with one its cells are filled, and the others' say why.
TEST(PeerTables, AreCompleteWithPeersAndWithout) {
    const Compared& all = compared();
    const PeerReasons nobody = all_absent("nobody was asked");
    const Table alone = peer_pair_table(all.meshes, all.studies, nobody);
    expect_complete(alone);
    EXPECT_TRUE(cell_of(alone, 0, "bvh_overlap").is_filled());
    EXPECT_EQ(cell_of(alone, 0, "fcl_collide").reason, "nobody was asked");
    std::vector<PairStudy> studies = all.studies;
    EXPECT_EQ(add_peer(right_answers(studies[0]), studies[0]), "");
    const Table table = peer_pair_table(all.meshes, studies, {{"pqp", "no package"}});
    expect_complete(table);
    EXPECT_EQ(*cell_of(table, 0, "fcl_overlap").value, 1e-3);
    EXPECT_EQ(cell_of(table, 0, "pqp_overlap").reason, "no package");
    EXPECT_FALSE(cell_of(table, 0, "ode_collide").is_filled());

    expect_complete(peer_build_table(all.meshes, {}, nobody));
    PeerRun run;
    run.builds.push_back({"qhull", "qhull", "", {2, 1, 4}, 8, 12});
    const Table built = peer_build_table(all.meshes, {run, run}, nobody);
    expect_complete(built);
    EXPECT_EQ(*cell_of(built, 1, "qhull_s").value, 2);
    EXPECT_EQ(*cell_of(built, 1, "qhull_vertices").value, 8);
    EXPECT_FALSE(cell_of(built, 1, "fcl_s").is_filled());
}

TEST(AddPeer, RefusesTooFewAnswers) {
    PairStudy study = compared().studies[0];
    PeerAnswers peer = right_answers(study);
    peer.asked[0].answers.pop_back();
    const std::size_t before = study.contenders.size();
    EXPECT_NE(add_peer(peer, study).find("collide"), std::string::npos);
    EXPECT_EQ(study.contenders.size(), before);
}

// A pose that is shallow is asked about collisions and overlap, one that is far about distance.
TEST(PeerQuestions, AreALineAPose) {
    const PairStudy& study = compared().studies[0];
    const std::string text = peer_questions(study.poses);
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(text, '\n')), study.poses.poses.size());
    EXPECT_TRUE(text.starts_with("co "));
    EXPECT_NE(text.find("\nd "), std::string::npos);
    EXPECT_NE(text.find("\ncdw "), std::string::npos);
}

}  // namespace
}  // namespace cdprep::study
