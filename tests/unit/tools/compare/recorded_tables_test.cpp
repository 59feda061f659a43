// SPDX-License-Identifier: MIT
// Tables and checks over made-up measurements: what is written about them has recorded hashes.
#include <gtest/gtest.h>

#include <string>

#include "cell_searches/cell_search.h"
#include "cell_searches/spatial_tables.h"
#include "compare/comparison_page.h"
#include "compare/comparison_report.h"
#include "compare/feature_probes.h"
#include "compare/pair_tables.h"
#include "compare/peer_tables.h"
#include "compare/preparation.h"
#include "compare/pruning.h"
#include "study/cells.h"
#include "unit/tools/recorded_text.h"

namespace cdprep::study {
namespace {

/// A mesh with these counts and hash as read, of a few corners and triangles.
StudyMesh mesh_like(const std::string& name, std::size_t vertices, std::size_t triangles,
                    std::uint64_t hash) {
    StudyMesh mesh;
    mesh.name = name;
    mesh.file = name + ".obj";
    mesh.read_vertices = vertices;
    mesh.read_triangles = triangles;
    mesh.read_hash = hash;
    mesh.likeness = find_likeness(vertices, triangles, hash);
    mesh.mesh.positions.resize(7);
    mesh.mesh.triangles.resize(10);
    mesh.built_hash = hash ^ 0xff;
    return mesh;
}

/// One mesh of each likeness to a published model.
std::vector<StudyMesh> meshes() {
    return {mesh_like("horse", 3582, 7172, 1),
            mesh_like("stand-in", 172974, 345944, 0x98b20742e8b1d8fc),
            mesh_like("dragon", 437645, 869928, 0xf940c2d1633866df),
            mesh_like("other", 437645, 871414, 2),
            mesh_like("reduced", 49990, 99976, 0x05745eeab25131b7),
            mesh_like("bolt", 100, 196, 3),
            mesh_like("bunny", 35947, 69451, 0x904e16bea36684d3)};
}

Timing timing(double median) {
    return {.median_s = median,
            .p95_s = 1.5 * median,
            .p999_s = 2 * median,
            .spread_s = 0.125 * median,
            .low_s = 0.75 * median,
            .high_s = 1.25 * median,
            .cases = 4,
            .rounds = 5,
            .asked = 99};
}

std::string text_of(const std::vector<Table>& tables, const std::vector<Check>& checks) {
    Comparison comparison;
    comparison.settings = {"1.2", false, 7, 3, "", 0, 5, 2};
    comparison.machine = {"A processor",  4,         8ULL << 30, 16ULL << 20, "System 1",
                          "A compiler 2", "Release", "scalar"};
    comparison.tables = tables;
    comparison.checks = checks;
    return report::comparison_text(comparison) + report::comparison_csv(comparison) +
           report::comparison_page(comparison) +
           report::comparison_json({.input = "", .exit = 0, .error = "", .comparison = comparison});
}

constexpr SpatialKind kKinds[] = {SpatialKind::tetra_tree, SpatialKind::octree,
                                  SpatialKind::hashed_octree, SpatialKind::adaptive_median,
                                  SpatialKind::adaptive_area};

/// Builds of every kind; the number tells meshes apart, and which of two is the quicker.
std::vector<SpatialBuild> builds(std::size_t number) {
    std::vector<SpatialBuild> all;
    for (const char* setting : {"paper", "nearest", "tuned"}) {
        for (const SpatialKind kind : kKinds) {
            const std::string name = setting;
            if (name == "nearest" && (number % 3 == 1 || all.size() > 6)) continue;
            const auto n = static_cast<double>(all.size());
            const double octree = kind == SpatialKind::octree && number % 2 == 1 ? 0.25 : 1;
            SpatialBuild build;
            build.setting = name;
            build.kind = kind;
            build.limits = {static_cast<std::uint32_t>(3 + number),
                            static_cast<std::uint32_t>(8 + all.size())};
            const std::uint64_t nodes = 88 + 1000 * number + all.size();
            build.figures = {nodes,      nodes - 11, nodes - 40, 3 * nodes,
                             nodes / 10, 88 * nodes, 77 * nodes, 66 * nodes};
            build.one = timing(1e-3 * (1 + n) * octree);
            build.all = timing(4e-4 * (2 + n));
            all.push_back(build);
        }
    }
    return all;
}

TEST(RecordedTables, OfSpatialDecompositionsAreAsRecorded) {
    const std::vector<StudyMesh> of = meshes();
    std::vector<SpatialMesh> measured;
    for (std::size_t i = 0; i < of.size(); ++i) measured.push_back({&of[i], builds(i)});
    std::vector<Table> tables = {spatial_table(measured)};
    for (const SpatialMesh& mesh : measured) tables.push_back(spatial_details(mesh));
    const std::string text = text_of(tables, spatial_checks(measured));
    EXPECT_EQ(test::hash_of_text(text), 0xe00b30797da9f0eb) << text;
}

// By the published formula a size is whole bytes, so that these are just within and just beyond.
TEST(SpatialChecks, TheBunnysSizesLieBetweenTheirLimits) {
    const StudyMesh bunny = meshes().back();
    const auto verdict = [&](double tetra, double octree) {
        SpatialMesh mesh = {&bunny, builds(0)};
        mesh.builds[0].figures.formula_all = static_cast<std::uint64_t>(tetra * (1 << 20));
        mesh.builds[1].figures.formula_all = static_cast<std::uint64_t>(octree * (1 << 20));
        return spatial_checks({mesh}).back().verdict;
    };
    constexpr double kByte = 1.0 / (1 << 20);
    EXPECT_EQ(verdict(0.37 + kByte, 0.33 + kByte), Verdict::holds);
    EXPECT_EQ(verdict(0.43, 0.35), Verdict::holds);
    EXPECT_EQ(verdict(0.37, 0.34), Verdict::fails);  // rounded down
    EXPECT_EQ(verdict(0.43 + kByte, 0.34), Verdict::fails);
    EXPECT_EQ(verdict(0.4, 0.33), Verdict::fails);
    EXPECT_EQ(verdict(0.4, 0.35 + kByte), Verdict::fails);
}

// By hand: 0.0351 MiB without a root of 340 bytes and 7172 references of 4 hold 87 nodes of 88.
TEST(SpatialChecks, TheBoundOfNodesIsInclusive) {
    const StudyMesh horse = meshes().front();
    const auto verdict = [&](std::uint64_t nodes) {
        SpatialMesh mesh = {&horse, builds(1)};  // without a nearest one
        mesh.builds[0].figures.nodes_all = nodes;
        return spatial_checks({mesh}).back().verdict;
    };
    EXPECT_EQ(verdict(88), Verdict::holds);
    EXPECT_EQ(verdict(89), Verdict::fails);
}

std::vector<Preparation> prepared(std::size_t count) {
    std::vector<Preparation> all;
    for (std::size_t i = 0; i < count; ++i) {
        const auto n = static_cast<double>(i);
        Preparation one;
        one.hull = {.one = timing(0.01 * (1 + n)),
                    .dimension = i == 2 ? 2 : 3,
                    .vertices = 100 + i,
                    .facets = 196 + 2 * i,
                    .groups = 90 + i,
                    .enclosing_vertices = i == 2 ? 0U : 64U,
                    .enclosing_distance = 0.001 * n};
        if (i == 1) one.hull.dimension = 0, one.hull.enclosing_vertices = 1;  // a point
        one.hierarchy = {.one = timing(0.02 * (1 + n)),
                         .all = timing(0.003 * (1 + n)),
                         .swept = timing(0.04 * (1 + n)),
                         .bytes = 100'000 + i,
                         .swept_bytes = 200'000 + i};
        one.pieces = {.seconds_all = 0.5 * (1 + n),
                      .pieces = i == 4 ? 0 : 50 + i,
                      .contained = 40 + i,
                      .virtual_faces = 30 + i,
                      .bytes = 300'000 + i,
                      .border_edges = i == 1 ? 1U : 0U,
                      .non_manifold_edges = i == 2 ? 1U : 0U,
                      .inconsistent_edges = i == 3 ? 1U : 0U,
                      .flat_edges = i};
        if (i % 3 != 2) one.pieces.seconds_one = i == 3 ? 0.04 * (1 + n) : 1 + n;
        all.push_back(one);
    }
    return all;
}

TEST(RecordedTables, OfPreparationAreAsRecorded) {
    std::vector<StudyMesh> of = meshes();
    of.back().mesh.triangles.clear();
    const std::vector<Preparation> figures = prepared(of.size());
    PeerRun run;
    run.builds.push_back({"qhull", "qhull 8", "a note", {2, 1, 4}, 8, 12});
    run.builds.push_back({"fcl_swept", "FCL 0.7", "", {0.5}, 0, 0});
    run.builds.push_back({"ode", "ODE", "", {}, 0, 0});
    const std::vector<PeerRun> runs(of.size(), run);
    const std::string text =
        text_of({preparation_table(of, figures), preparation_details(of, figures),
                 peer_build_table(of, runs, {{"pqp", "no package"}}),
                 peer_build_table(of, {}, all_absent("nobody was asked"))},
                preparation_checks(of, figures));
    EXPECT_EQ(test::hash_of_text(text), 0x27280b4066d22bfc) << text;
}

/// Two poses of each stratum, or of all but those that are deep.
PoseSet poses(bool with_deep) {
    PoseSet set;
    set.seed = 7;
    set.diagonal = 1;
    for (std::size_t i = with_deep ? 0 : 2; i < 2 * kStrata; ++i) {
        StudyPose pose;
        pose.a_from_b =
            Pose::from_quaternion(1, 0, 0, 0, {0.25 * static_cast<double>(i), 0, 0}).value();
        pose.stratum = static_cast<Stratum>(i / 2);
        pose.hit = i < 5;
        set.poses.push_back(pose);
    }
    set.missing = {0, 1, 0, 0, 2};
    return set;
}

/// Every strategy, as if it had taken these times.
void add_contenders(std::size_t number, PairStudy& study) {
    for (const Strategy& strategy : strategies()) {
        const std::size_t who = study.contenders.size();
        Contender contender;
        contender.name = strategy.name;
        contender.setting = strategy.setting;
        contender.is_approximate = strategy.is_approximate();
        contender.answers = 20;
        contender.agreeing = 20 - (who == 3 + number ? 1U : 0U);
        contender.pairs = number == 2 ? 0 : 80;
        contender.found = 80 - who;
        for (std::size_t a = 0; a < kAsked; ++a) {
            if ((who + a) % 9 == 4) {
                contender.reasons[a] = "not by " + contender.name;
                continue;
            }
            const auto asked = static_cast<Asked>(a);
            // Cells of the paper are slow, and which of them is slower depends on the pair.
            const bool is_slow = who == (number % 2 == 0 ? 1U : 0U) || who == 5;
            const double base = 1e-6 * static_cast<double>((is_slow ? 64 : 1) * (20 - who));
            const double more = a == 1 && who == 7 + number ? 0.9 : 1 + static_cast<double>(a);
            for (std::size_t i = 0; i < cases_of(asked, study.poses).size(); ++i) {
                const double one = base * more * (1 + 0.25 * static_cast<double>(i));
                contender.timings[a].seconds.push_back({one, 1.125 * one, 1.0625 * one});
                contender.timings[a].times.push_back(2);
            }
            if (a >= kCounted || study.poses.of(Stratum::deep).empty()) continue;
            contender.cold[a].seconds = {{3 * base, 4 * base}, {5 * base, 6 * base}};
            contender.cold[a].times = {1, 1};
        }
        for (std::size_t a = 0; a < kCounted; ++a) {
            for (std::size_t s = 0; s < kStrata; ++s) {
                const std::uint64_t n = (1000 * (who + 1) + 10 * a + s) * (who == 0 ? 5 : 1);
                QueryCounts& counts = contender.counts[a][s];
                counts.box_pairs = number == 3 ? 0 : n;
                counts.cell_pairs = n + 1;
                counts.leaf_pairs = n + 2;
                counts.triangle_pairs = n + 3;
            }
        }
        study.contenders.push_back(contender);
    }
}

PairStudy study_of(std::size_t number, std::size_t a, std::size_t b) {
    PairStudy study;
    study.a = a;
    study.b = b;
    study.poses = poses(number != 2);
    if (number == 1) study.poses.source = "folder/a-b.pose";
    for (std::size_t i = 0; i < study.poses.poses.size(); ++i) {
        study.exact.hits.push_back(study.poses.poses[i].hit);
        study.exact.pairs.push_back(i < 5 ? 10 + i : 0);
    }
    study.itself = {1.01, number == 1 ? 1.005 : 0.98, 1.02};
    add_contenders(number, study);
    Contender peer = study.contenders.back();
    peer.name = "FCL 0.7";
    peer.is_peer = true;
    peer.peer = "fcl";
    peer.reasons = {};
    if (number != 3) study.contenders.push_back(peer);
    return study;
}

TEST(RecordedTables, OfPairsAreAsRecorded) {
    const std::vector<StudyMesh> of = meshes();
    const std::vector<PairStudy> studies = {study_of(0, 1, 0), study_of(1, 2, 6),
                                            study_of(2, 5, 0), study_of(3, 4, 0),
                                            study_of(4, 3, 1), study_of(5, 0, 6)};
    std::vector<Table> tables = {pair_table(of, studies),
                                 peer_pair_table(of, studies, {{"pqp", "no package"}})};
    for (const PairStudy& study : studies) tables.push_back(pair_details(of, study));
    const std::string text = text_of(tables, pair_checks(of, studies));
    EXPECT_EQ(test::hash_of_text(text), 0xe334d1a5b5bfd0fd) << text;
}

/// A table of these numbers; one that is not positive is a cell without a number.
Table table_of(const std::vector<std::vector<double>>& numbers) {
    Table table = {"t", "Numbers", "row", {}, {}, {}};
    for (std::size_t c = 0; c < numbers[0].size(); ++c) {
        table.columns.push_back({"c" + std::to_string(c), "column", Unit::share});
    }
    for (const std::vector<double>& row : numbers) {
        table.rows.push_back({"row " + std::to_string(table.rows.size()), {}});
        for (const double value : row) {
            table.rows.back().cells.push_back(value > 0 ? number(value) : without("none"));
        }
    }
    return table;
}

// By hand: the least recall is named, and what lost nothing is not.
TEST(PruningChecks, NameTheLeastRecall) {
    const Check some = pruning_checks(table_of({{1}, {0.5}, {0.25}, {0.75}, {0}}))[0];
    EXPECT_EQ(some.verdict, Verdict::fails);
    EXPECT_NE(some.evidence.find(
                  "in 4 sets of poses, the smallest share of pairs found is 0.2500 (row 2)"),
              std::string::npos)
        << some.evidence;
    const Check all = pruning_checks(table_of({{1}, {0}}))[0];
    EXPECT_EQ(all.verdict, Verdict::holds);
    EXPECT_EQ(all.evidence, "in 1 sets of poses, all pairs are found");
    EXPECT_EQ(pruning_checks(table_of({{0}}))[0].verdict, Verdict::not_asked);
}

// By hand: the row that loses most is named, and rows without a recall do not count.
TEST(PruningChecks, NameWhatLosesMost) {
    const auto check = [](const std::vector<double>& lost, double recall) {
        Table table = table_of(std::vector<std::vector<double>>(lost.size(), {1, recall}));
        table.columns[0].key = "lost";
        for (std::size_t i = 0; i < lost.size(); ++i) table.rows[i].cells[0] = number(lost[i]);
        return pruning_checks(table)[1];
    };
    const Check some = check({0.5, 2, 0, 1}, 1);
    EXPECT_EQ(some.verdict, Verdict::fails);
    EXPECT_EQ(some.evidence, "in 4 sets of poses, the worst loses 2 pairs per pose (row 1)");
    const Check none = check({0, 0}, 0.5);
    EXPECT_EQ(none.verdict, Verdict::holds);
    EXPECT_EQ(none.evidence, "in 2 sets of poses, no pair is lost");
    EXPECT_EQ(check({3}, 0).verdict, Verdict::not_asked);
    EXPECT_EQ(pruning_checks(table_of({{1, 1}}))[1].verdict, Verdict::not_asked);
}

// By hand: H0 to H3 take 1, 1/2, 1/4 and 1/8, K0 to K2 a fifth, a half and 1; then H0 alone is
// there, which K2 makes ten times as fast.
TEST(CellSearchChecks, CountWhatReachesTheClaimAndWhatIsSlower) {
    const std::vector<Check> checks = cell_search_checks(
        table_of({{1, 0.5, 0.25, 0.125, 0.2, 0.5, 1, 9, 9}, {1, 0, 0, 0, 0, 0, 0.1, 9, 9}}));
    ASSERT_EQ(checks.size(), 4U);
    const auto said = [](const char* counts, const char* most, const char* slower) {
        return "reached in " + std::string(counts) + " cases; hashing saves " + most +
               ", and is slower in " + slower + " cases";
    };
    EXPECT_EQ(checks[0].evidence, said("2 of 4", "at most 90 % (K2, row 1)", "0"));
    EXPECT_EQ(checks[1].evidence, said("0 of 3", "at most 60 % (K0, row 0)", "1"));
    EXPECT_EQ(checks[2].evidence, said("0 of 3", "at most 20 % (K0, row 0)", "2"));
    EXPECT_EQ(checks[3].evidence, said("0 of 3", "nothing (K0, row 0)", "3"));
    EXPECT_EQ(checks[0].verdict, Verdict::holds);
    EXPECT_EQ(checks[1].verdict, Verdict::fails);
    for (const Check& check : cell_search_checks(table_of({{0, 0, 0, 0, 0, 0, 0, 0, 0}}))) {
        EXPECT_EQ(check.verdict, Verdict::not_asked);
    }
}

}  // namespace
}  // namespace cdprep::study
