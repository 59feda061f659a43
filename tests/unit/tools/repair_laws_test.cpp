// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>

#include "mesh/mesh_meetings.h"
#include "mesh/repair.h"
#include "unit/tools/soup_of.h"

namespace cdprep::mesh {
namespace {

constexpr std::uint32_t kSeed = 20261121;
constexpr int kRounds = 40;

RepairOptions options_of(const char* preset) {
    RepairOptions options;
    options.steps = *find_repair_preset(preset);
    return options;
}

TriangleSoup as_soup(const RepairMesh& mesh) {
    TriangleSoup soup;
    soup.positions = mesh.positions;
    soup.triangles = mesh.triangles;
    soup.single_precision = mesh.single_precision;
    return soup;
}

bool has(const StoredVerdict& found, format::VerdictFacts fact) {
    return (found.verdict.facts & fact) != 0;
}

/// Every source triangle is in the output, or listed as dropped; and each is counted once.
void expect_accounted(const TriangleSoup& soup, const Repaired& mended) {
    std::set<std::uint32_t> there, dropped;
    for (const Origin& origin : mended.mesh.triangle_origin) {
        if (origin.source != kNone) there.insert(origin.source);
        EXPECT_TRUE(origin.source != kNone || origin.step) << "neither a source nor a step";
    }
    for (const StepReport& step : mended.report.steps) {
        if (!step.undone.empty()) continue;
        for (const DroppedTriangle& triangle : step.dropped) dropped.insert(triangle.source);
    }
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
        EXPECT_TRUE(there.contains(t) || dropped.contains(t)) << "triangle " << t;
    }
    const RepairCounts& counts = mended.report.counts;
    EXPECT_EQ(counts.kept + counts.reversed + counts.cut + counts.dropped, soup.triangles.size());
    EXPECT_EQ(mended.mesh.positions.size() - counts.parted_vertices - counts.made_vertices +
                  counts.merged_vertices + counts.unused_vertices,
              soup.positions.size());
}

void expect_idempotent(const Repaired& mended, const RepairOptions& options) {
    if (!mended.report.settled) return;
    const Repaired again = repair(as_soup(mended.mesh), options);
    EXPECT_EQ(again.mesh.positions, mended.mesh.positions);
    EXPECT_EQ(again.mesh.triangles, mended.mesh.triangles);
    EXPECT_EQ(again.report.input_to_output.upper, 0.0);
}

// Triangles on a coarse grid: corners, edges and whole triangles often coincide.
TEST(RepairLaws, GridSoupsComeOutManifoldAccountedForAndNotWorse) {
    int non_manifold = 0, settled = 0, all = 0;
    for (const char* preset : {"safe", "closed"}) {
        const RepairOptions options = options_of(preset);
        for (std::uint32_t seed = kSeed; seed < kSeed + kRounds; ++seed) {
            SCOPED_TRACE(std::string(preset) + ", seed " + std::to_string(seed));
            const int count = 6 + static_cast<int>(seed % 30);
            const TriangleSoup soup = test::soup_of(test::coarse_grid_soup(seed, count, 1));
            const Repaired mended = repair(soup, options);
            EXPECT_TRUE(has(mended.report.after, format::verdict_two_manifold));
            EXPECT_TRUE(has(mended.report.after, format::verdict_oriented));
            EXPECT_FALSE(is_worse(mended.report.after, mended.report.before));
            expect_accounted(soup, mended);
            expect_idempotent(mended, options);
            non_manifold += has(mended.report.before, format::verdict_two_manifold) ? 0 : 1;
            settled += mended.report.settled ? 1 : 0;
            ++all;
        }
    }
    EXPECT_GT(non_manifold * 10, all * 3) << "too few soups were not 2-manifold";
    EXPECT_EQ(settled, all);
}

// Where nothing moves, both distances are 0 exactly, or the rounding of a middle.
TEST(RepairLaws, TheSafePresetMovesNothing) {
    for (std::uint32_t seed = kSeed; seed < kSeed + kRounds; ++seed) {
        const TriangleSoup soup = test::soup_of(test::coarse_grid_soup(seed, 25, 1));
        const Repaired mended = repair(soup, options_of("safe"));
        EXPECT_LT(mended.report.output_to_input.upper, 1e-14) << "seed " << seed;
    }
}

// The union of boxes: overlapping, touching and nested ones, against counted unit cells.
TEST(RepairLaws, UnionsOfGridBoxesHaveTheVolumeOfTheirCells) {
    int solid = 0, crossing = 0;
    for (std::uint32_t seed = 1; seed <= kRounds; ++seed) {
        std::uint32_t state = seed * 2654435761U;
        const auto pick = [&](std::uint32_t most) {
            state = state * 1664525U + 1013904223U;
            return static_cast<int>((state >> 16U) % most);
        };
        test::TestMesh boxes;
        std::set<std::array<int, 3>> cells;
        for (int box = 0; box < 3; ++box) {
            const std::array<int, 3> low = {pick(4), pick(4), pick(4)};
            const int size = 1 + pick(3);
            const auto at = [](int x) { return static_cast<double>(x); };
            boxes = test::joined(boxes, test::moved_by(test::unit_cube(), size,
                                                       {at(low[0]), at(low[1]), at(low[2])}));
            for (int i = 0; i < size * size * size; ++i) {
                cells.insert(
                    {low[0] + i % size, low[1] + i / size % size, low[2] + i / (size * size)});
            }
        }
        const Repaired mended = repair(test::soup_of(boxes), options_of("solid"));
        SCOPED_TRACE(seed);
        EXPECT_TRUE(has(mended.report.after, format::verdict_two_manifold));
        EXPECT_TRUE(has(mended.report.after, format::verdict_closed));
        if (!find_meetings(mended.mesh, serial_for).empty()) continue;
        ++solid;
        const bool resolved = std::any_of(
            mended.report.steps.begin(), mended.report.steps.end(), [](const StepReport& step) {
                return step.step == RepairStep::resolve_self_intersections;
            });
        if (!resolved) continue;
        ++crossing;
        EXPECT_NEAR(mended.report.after.verdict.volume, static_cast<double>(cells.size()), 1e-9);
    }
    EXPECT_EQ(solid, kRounds);
    EXPECT_GT(crossing * 10, kRounds * 3);
}

}  // namespace
}  // namespace cdprep::mesh
