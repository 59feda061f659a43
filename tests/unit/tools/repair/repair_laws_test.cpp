// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <string>

#include "exact/point_triangle_distance.h"
#include "exact/winding.h"
#include "import/import_file.h"
#include "repair/mesh_meetings.h"
#include "repair/repair.h"
#include "support/exact_winding.h"
#include "support/rounds.h"
#include "support/shared_models.h"
#include "unit/tools/repair_preset.h"
#include "unit/tools/soup_of.h"

namespace cdprep::mesh {
namespace {

using test::has;
using test::preset_options;

constexpr std::uint32_t kSeed = 20261121;
const auto kRounds = static_cast<std::uint32_t>(test::rounds(40, 2));

TriangleSoup as_soup(const RepairMesh& mesh) {
    TriangleSoup soup;
    soup.positions = mesh.positions;
    soup.triangles = mesh.triangles;
    soup.single_precision = mesh.single_precision;
    return soup;
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
        const RepairOptions options = preset_options(preset);
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
        const Repaired mended = repair(soup, preset_options("safe"));
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
        const Repaired mended = repair(test::soup_of(boxes), preset_options("solid"));
        SCOPED_TRACE(seed);
        EXPECT_TRUE(has(mended.report.after, format::verdict_two_manifold));
        EXPECT_TRUE(has(mended.report.after, format::verdict_closed));
        if (!find_meetings(mended.mesh, {}).pairs.empty()) continue;
        ++solid;
        const bool resolved = std::any_of(
            mended.report.steps.begin(), mended.report.steps.end(), [](const StepReport& step) {
                return step.step == RepairStep::resolve_self_intersections;
            });
        if (!resolved) continue;
        ++crossing;
        EXPECT_NEAR(mended.report.after.verdict.volume, static_cast<double>(cells.size()), 1e-9);
    }
    EXPECT_EQ(solid, static_cast<int>(kRounds));
    EXPECT_GT(crossing * 10, 3 * static_cast<int>(kRounds));
}

std::vector<Corners> corners_of(const RepairMesh& mesh) {
    std::vector<Corners> all;
    for (const Triangle& t : mesh.triangles) {
        all.push_back({mesh.positions[t.vertex[0]], mesh.positions[t.vertex[1]],
                       mesh.positions[t.vertex[2]]});
    }
    return all;
}

/// Nothing on the surface. Large meshes are asked by the library's own exact rays, which
/// have their own test against these numbers.
std::optional<int> winding_at(const std::vector<Corners>& surface, const Double3& q) {
    constexpr std::size_t kFew = 500;
    if (surface.size() < kFew) return test::exact_winding(surface, q);
    int number = 0;
    for (const Corners& t : surface) {
        const WindingTerm term = winding_term({q.x - 1e3, q.y, q.z}, q, t);
        if (term.on_surface) return std::nullopt;
        number += term.crossings;
    }
    return number;
}

double shape_distance(const std::vector<Corners>& surface, const Double3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const Corners& t : surface) least = std::min(least, point_triangle_distance(p, t).lower);
    return least;
}

struct Samples {
    int outer = 0, inner = 0;
};

/// Draws points of the triangles before crossings were resolved and looks `step` off them,
/// on either side. Where the winding number is 0 on one side only, the point is of the outer
/// surface: there must be surface within the step, and the same sides must be outside. Inner
/// points must be within the solid.
void expect_same_solid(const RepairMesh& before, const RepairMesh& after, double step, int count,
                       Samples& samples) {
    const std::vector<Corners> was = corners_of(before), is = corners_of(after);
    std::mt19937 random(kSeed);
    for (int i = 0; i < count; ++i) {
        const Corners& t = was[random() % was.size()];
        const double b = 0.1 + 0.01 * static_cast<double>(random() % 40), c = (0.95 - b) / 2;
        const Double3 u{t[1].x - t[0].x, t[1].y - t[0].y, t[1].z - t[0].z};
        const Double3 v{t[2].x - t[0].x, t[2].y - t[0].y, t[2].z - t[0].z};
        const Double3 n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
        const double length = std::hypot(n.x, n.y, n.z);
        if (length == 0) continue;
        const Double3 p{t[0].x + b * u.x + c * v.x, t[0].y + b * u.y + c * v.y,
                        t[0].z + b * u.z + c * v.z};
        std::array<bool, 2> solid{};
        bool decided = true;
        for (std::size_t side = 0; side < 2; ++side) {
            const double far = (side == 0 ? step : -step) / length;
            const Double3 q{p.x + far * n.x, p.y + far * n.y, p.z + far * n.z};
            const std::optional<int> old = winding_at(was, q), now = winding_at(is, q);
            if (!old || !now) {
                decided = false;
                continue;
            }
            solid[side] = *old != 0;
            EXPECT_EQ(*now, *old != 0 ? 1 : 0) << q.x << ' ' << q.y << ' ' << q.z;
        }
        if (!decided) continue;
        if (solid[0] != solid[1]) {
            EXPECT_LE(shape_distance(is, p), 2 * step);
        }
        ++(solid[0] != solid[1] ? samples.outer : samples.inner);
    }
}

/// What goes into resolve_self_intersections: all other steps of the preset.
RepairMesh without_resolving(const TriangleSoup& soup) {
    RepairOptions options = preset_options("solid");
    options.steps.reset(static_cast<std::size_t>(RepairStep::resolve_self_intersections));
    return repair(soup, options).mesh;
}

// Boxes at odd places, so that cuts are rounded.
TEST(RepairLaws, UnionsOfBoxesLoseNothingOfTheirOuterSurface) {
    Samples samples;
    int resolved = 0;
    for (std::uint32_t seed = 1; seed <= kRounds; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        const auto within = [&] { return static_cast<double>(random() % 1000003) / 1000003; };
        test::TestMesh boxes;
        for (int box = 0; box < 4; ++box) {
            const double size = 0.5 + within();
            test::TestMesh skewed =
                test::moved_by(test::unit_cube(), size, {within(), within(), within()});
            const double shear = within() - 0.5;
            for (Double3& p : skewed.positions) p = {p.x + shear * p.y, p.y, p.z + shear * p.x};
            boxes = test::joined(boxes, skewed);
        }
        const Repaired mended = repair(test::soup_of(boxes), preset_options("solid"));
        if (!find_meetings(mended.mesh, {}).pairs.empty()) continue;
        ++resolved;
        expect_same_solid(without_resolving(test::soup_of(boxes)), mended.mesh, 1e-9, 30, samples);
    }
    EXPECT_GT(resolved * 10, 9 * static_cast<int>(kRounds));
    const int all = samples.outer + samples.inner;
    EXPECT_GT(samples.outer * 10, all * 3);
    EXPECT_LT(samples.outer * 10, all * 9);
}

TEST(RepairLaws, HardModelsLoseNothingOfTheirOuterSurface) {
    const auto folder = test::shared_models("hard");
    if (!folder) GTEST_SKIP() << "no test models beside the checkout (set CDPREP_SHARED)";
    Samples samples;
    for (const char* name : {"Spider_ascii.stl", "al.obj", "hips.obj"}) {
        SCOPED_TRACE(name);
        const Result<TriangleSoup> soup = import::import_file(*folder / "hard" / name, {});
        ASSERT_TRUE(soup) << soup.error().message;
        const Repaired mended = repair(soup.value(), preset_options("solid"));
        ASSERT_TRUE(find_meetings(mended.mesh, {}).pairs.empty());
        expect_same_solid(without_resolving(soup.value()), mended.mesh,
                          1e-7 * std::sqrt(mended.report.before.verdict.area), 100, samples);
    }
    EXPECT_GT(samples.outer, 50);
    EXPECT_GT(samples.inner, 10);
}

}  // namespace
}  // namespace cdprep::mesh
