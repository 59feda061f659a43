// SPDX-License-Identifier: MIT
#include "repair/repair.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>

#include "import/readers.h"
#include "repair/cut_crossings.h"
#include "repair/mesh_meetings.h"
#include "repair/repaired_soup.h"
#include "unit/tools/repair_preset.h"
#include "unit/tools/soup_of.h"

namespace cdprep::mesh {
namespace {

using test::has;
using test::joined;
using test::moved_by;
using test::reversed;
using test::soup_of;
using test::TestMesh;
using test::unit_cube;

Repaired repaired(const TriangleSoup& soup, const char* preset) {
    return repair(soup, test::preset_options(preset));
}

bool is_closed_manifold(const StoredVerdict& found) {
    return has(found, format::verdict_closed) && has(found, format::verdict_two_manifold) &&
           has(found, format::verdict_oriented);
}

const StepReport* step_of(const RepairReport& report, RepairStep step) {
    for (const StepReport& taken : report.steps) {
        if (taken.step == step) return &taken;
    }
    return nullptr;
}

/// The cube without its last `count` triangles.
TestMesh open_cube(std::size_t count) {
    TestMesh cube = unit_cube();
    cube.triangles.resize(cube.triangles.size() - count);
    return cube;
}

TEST(Repair, ACleanMeshStaysAsItIs) {
    const TestMesh cube = unit_cube();
    for (const char* preset : {"safe", "closed", "solid"}) {
        const Repaired mended = repaired(soup_of(cube), preset);
        EXPECT_EQ(mended.mesh.positions, cube.positions);
        EXPECT_EQ(mended.mesh.triangles, cube.triangles);
        EXPECT_TRUE(mended.report.steps.empty()) << preset;
        EXPECT_EQ(mended.report.input_to_output.upper, 0.0);
        EXPECT_EQ(mended.report.output_to_input.upper, 0.0);
        EXPECT_TRUE(mended.report.settled);
    }
}

TEST(Repair, AnInsideOutCubeIsTurned) {
    const Repaired mended = repaired(soup_of(reversed(unit_cube())), "safe");
    EXPECT_EQ(mended.report.counts.reversed, 12U);
    EXPECT_EQ(mended.report.after.verdict.volume, 1.0);
}

// A cavity is wound inwards, and lies within one other component.
TEST(Repair, ACavityStaysInsideOut) {
    const TestMesh hollow =
        joined(unit_cube(), reversed(moved_by(unit_cube(), 0.5, {0.25, 0.25, 0.25})));
    const Repaired mended = repaired(soup_of(hollow), "safe");
    EXPECT_EQ(mended.report.counts.kept, 24U);
    EXPECT_EQ(mended.report.after.verdict.volume, 0.875);
}

TEST(Repair, OneTurnedTriangleIsTurnedBack) {
    TestMesh cube = unit_cube();
    std::swap(cube.triangles[5].vertex[1], cube.triangles[5].vertex[2]);
    const Repaired mended = repaired(soup_of(cube), "safe");
    EXPECT_EQ(mended.report.counts.reversed, 1U);
    ASSERT_NE(step_of(mended.report, RepairStep::orient), nullptr);
    EXPECT_EQ(step_of(mended.report, RepairStep::orient)->reversed, std::vector<std::uint32_t>{5});
    EXPECT_TRUE(is_closed_manifold(mended.report.after));
}

// Five of twelve: more than a third, and less than the half that would decide.
TEST(Repair, TheLargerPartDecidesTheWinding) {
    TestMesh cube = unit_cube();
    const std::vector<std::uint32_t> turned = {1, 2, 5, 8, 9};
    for (const std::uint32_t t : turned) {
        std::swap(cube.triangles[t].vertex[1], cube.triangles[t].vertex[2]);
    }
    const Repaired mended = repaired(soup_of(cube), "safe");
    ASSERT_NE(step_of(mended.report, RepairStep::orient), nullptr);
    EXPECT_EQ(step_of(mended.report, RepairStep::orient)->reversed, turned);
    EXPECT_EQ(mended.report.counts.reversed, 5U);
    EXPECT_EQ(mended.report.after.verdict.volume, 1.0);
}

TEST(Repair, BadNumbersAndRepeatedCornersAreListedAndDropped) {
    TriangleSoup soup = soup_of(unit_cube());
    soup.positions.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
    soup.triangles.push_back({{0, 1, 8}});
    soup.triangles.push_back({{0, 1, 1}});
    soup.triangles.push_back({{0, 0, 0}});
    soup.out_of_range = {{.triangle = 14, .found = 9}};
    const Repaired mended = repaired(soup, "safe");
    EXPECT_EQ(mended.report.counts.dropped, 3U);
    EXPECT_EQ(mended.report.counts.unused_vertices + mended.report.counts.merged_vertices, 1U);
    const StepReport* bad = step_of(mended.report, RepairStep::drop_bad_numbers);
    ASSERT_NE(bad, nullptr);
    ASSERT_EQ(bad->dropped.size(), 2U);
    EXPECT_EQ(bad->dropped[0].source, 12U);
    EXPECT_EQ(bad->dropped[0].reason, DropReason::not_finite);
    EXPECT_EQ(bad->dropped[1].source, 14U);
    EXPECT_EQ(bad->dropped[1].reason, DropReason::out_of_range);
    EXPECT_TRUE(is_closed_manifold(mended.report.after));
}

/// The same bad corners, as an import marks them.
TriangleSoup as_imported(TriangleSoup soup) {
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
        for (const std::uint32_t vertex : soup.triangles[t].vertex) {
            if (vertex < soup.positions.size()) continue;
            soup.out_of_range.push_back({t, vertex});
            soup.triangles[t] = {{0, 0, 0}};
            break;
        }
    }
    return soup;
}

// Importers mark such triangles; a soup made by hand has the corners themselves.
TEST(Repair, CornersOutOfRangeAreDroppedWhetherMarkedOrNot) {
    TriangleSoup bare = soup_of(unit_cube());
    bare.triangles.insert(bare.triangles.begin() + 3, {{0, 1, 8}});
    bare.triangles.push_back({{kNone, kNone - 1, 1'000'000}});
    for (const char* preset : {"safe", "closed", "solid"}) {
        const Repaired mended = repaired(bare, preset);
        const Repaired marked = repaired(as_imported(bare), preset);
        EXPECT_EQ(mended.mesh.positions, marked.mesh.positions);
        EXPECT_EQ(mended.mesh.triangles, marked.mesh.triangles);
        EXPECT_EQ(mended.mesh.triangles.size(), 12U);
        EXPECT_EQ(mended.report.counts.kept, 12U);
        EXPECT_EQ(mended.report.counts.dropped, 2U);
        const StepReport* bad = step_of(mended.report, RepairStep::drop_bad_numbers);
        ASSERT_NE(bad, nullptr) << preset;
        ASSERT_EQ(bad->dropped.size(), 2U);
        EXPECT_EQ(bad->dropped[0].source, 3U);
        EXPECT_EQ(bad->dropped[1].source, 13U);
        for (const DroppedTriangle& dropped : bad->dropped) {
            EXPECT_EQ(dropped.reason, DropReason::out_of_range);
        }
        EXPECT_TRUE(is_closed_manifold(mended.report.after));
        EXPECT_EQ(mended.report.output_to_input.upper, 0.0);
    }
}

// It is said to stand at vertex 0, which nothing else uses: that is no place of the surface.
TEST(Repair, ACornerOutOfRangeHasNoPlace) {
    TriangleSoup bare;
    bare.positions = {{100, 0, 0}};
    for (const Double3& p : unit_cube().positions) bare.positions.push_back(p);
    for (const auto& t : unit_cube().triangles) {
        bare.triangles.push_back({{t.vertex[0] + 1, t.vertex[1] + 1, t.vertex[2] + 1}});
    }
    bare.triangles.push_back({{1, 2, 9}});
    for (const TriangleSoup& soup : {bare, as_imported(bare)}) {
        const Repaired mended = repaired(soup, "safe");
        EXPECT_EQ(mended.report.counts.dropped, 1U);
        EXPECT_EQ(mended.report.input_to_output.upper, 0.0);
    }
}

// An import lists the first thousand of them for messages. No triangle uses vertex 0.
TEST(Repair, MoreThanAThousandCornersOutOfRangeAreAllDropped) {
    std::string text = "v 100 0 0\n";
    for (const Double3& p : unit_cube().positions) {
        text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) +
                "\n";
    }
    for (int i = 0; i < 1003; ++i) text += "f 2 3 99\n";
    for (const auto& t : unit_cube().triangles) {
        text += "f " + std::to_string(t.vertex[0] + 2) + " " + std::to_string(t.vertex[1] + 2) +
                " " + std::to_string(t.vertex[2] + 2) + "\n";
    }
    const auto soup = import::read_obj(import::SourceFile("bad.obj", text), {});
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    RepairOptions only_drop;
    only_drop.steps.set(static_cast<std::size_t>(RepairStep::drop_bad_numbers));
    for (const RepairOptions& options : {only_drop, test::preset_options("safe")}) {
        const Repaired mended = repair(*soup, options);
        EXPECT_EQ(mended.report.counts.dropped, 1003U);
        EXPECT_EQ(mended.report.counts.kept, 12U);
        EXPECT_EQ(mended.mesh.triangles.size(), 12U);
        EXPECT_EQ(mended.report.input_to_output.upper, 0.0);
        EXPECT_EQ(mended.report.output_to_input.upper, 0.0);
        EXPECT_TRUE(as_soup(*soup, mended.mesh).soup.out_of_range.empty());
    }
}

// Nobody asked to drop it: it keeps its place, with nowhere to be.
TEST(Repair, ACornerOutOfRangeStaysWhereNothingDropsIt) {
    TriangleSoup bare = soup_of(unit_cube());
    bare.triangles.push_back({{0, 1, 8}});
    RepairOptions only_weld;
    only_weld.steps.set(static_cast<std::size_t>(RepairStep::weld));
    const Repaired mended = repair(bare, only_weld);
    const Repaired marked = repair(as_imported(bare), only_weld);
    ASSERT_EQ(mended.mesh.triangles.size(), 13U);
    EXPECT_EQ(mended.mesh.triangles, marked.mesh.triangles);
    EXPECT_EQ(mended.mesh.triangles.back(), (test::Triangle{{0, 0, 0}}));
}

// No other step accepts them, so they are dropped first, and that is told.
TEST(Repair, NumbersThatAreNotFiniteAreDroppedWhateverTheSteps) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        TriangleSoup soup = soup_of(unit_cube());
        soup.positions.push_back({0, bad, 0});
        soup.triangles.push_back({{0, 1, 8}});
        for (std::size_t step = 0; step < kRepairStepCount; ++step) {
            RepairOptions options;
            options.steps.set(step);
            const Repaired mended = repair(soup, options);
            EXPECT_EQ(mended.mesh.triangles, unit_cube().triangles);
            EXPECT_EQ(mended.mesh.positions, unit_cube().positions);
            const StepReport* dropping = step_of(mended.report, RepairStep::drop_bad_numbers);
            ASSERT_NE(dropping, nullptr) << name_of(static_cast<RepairStep>(step));
            ASSERT_EQ(dropping->dropped.size(), 1U);
            EXPECT_EQ(dropping->dropped[0].reason, DropReason::not_finite);
            EXPECT_EQ(mended.report.input_to_output.upper, 0.0);
        }
    }
}

// The second triangle's corners are near those of the first, and none is turned.
TEST(Repair, AWeldWithinADistanceReversesNothing) {
    TriangleSoup soup;
    soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.001, 1, 0}, {1.001, 0, 0}};
    soup.triangles = {{{0, 1, 2}}, {{3, 4, 5}}};
    RepairOptions options = test::preset_options("safe");
    options.weld_distance = 0.01;
    const Repaired mended = repair(soup, options);
    EXPECT_EQ(mended.report.counts.kept, 2U);
    EXPECT_EQ(mended.report.counts.reversed, 0U);
    EXPECT_EQ(mended.report.counts.merged_vertices, 2U);
}

// A cube within another disappears, and its vertices with it: they are joined to none.
TEST(Repair, VerticesOfDroppedTrianglesAreUnusedAndNotMerged) {
    const TestMesh nested = joined(unit_cube(), moved_by(unit_cube(), 0.5, {0.5, 0.25, 0.25}));
    const Repaired mended = repaired(soup_of(nested), "solid");
    EXPECT_EQ(mended.report.after.verdict.volume, 1.0);
    EXPECT_EQ(mended.report.counts.merged_vertices, 0U);
    EXPECT_EQ(mended.report.counts.unused_vertices, 4U);
    EXPECT_EQ(mended.report.counts.reversed, 0U);
}

TEST(Repair, TrianglesWithoutAnyVertexAreDropped) {
    TriangleSoup bare;
    bare.triangles = {{{0, 0, 0}}, {{0, 1, 2}}};
    for (const char* preset : {"safe", "closed", "solid"}) {
        const Repaired mended = repaired(bare, preset);
        EXPECT_TRUE(mended.mesh.triangles.empty());
        EXPECT_EQ(mended.report.counts.source_triangles, 2U);
        EXPECT_EQ(mended.report.counts.dropped, 2U);
        const StepReport* bad = step_of(mended.report, RepairStep::drop_bad_numbers);
        ASSERT_NE(bad, nullptr);
        EXPECT_EQ(bad->dropped.size(), 2U);
        EXPECT_EQ(repaired(TriangleSoup{}, preset).report.counts.dropped, 0U);
    }
}

TEST(Repair, ADuplicateNamesTheTriangleThatStays) {
    const TestMesh sheet = test::grid_sheet(2, 2);
    for (std::uint32_t t = 0; t < sheet.triangles.size(); ++t) {
        TestMesh twice = sheet;
        twice.triangles.push_back(sheet.triangles[t]);
        const Repaired mended = repaired(soup_of(twice), "safe");
        const StepReport* step = step_of(mended.report, RepairStep::drop_duplicates);
        ASSERT_NE(step, nullptr);
        ASSERT_EQ(step->dropped.size(), 1U);
        EXPECT_EQ(step->dropped[0].source, 8U);
        EXPECT_EQ(step->dropped[0].because, t);
        EXPECT_EQ(mended.report.input_to_output.upper, 0.0);
    }
}

// Cubes that share an edge: four triangles around it. Both stay whole and closed.
TEST(Repair, CubesThatShareAnEdgeArePartedIntoTwo) {
    const TestMesh cubes = joined(unit_cube(), moved_by(unit_cube(), 1, {1, 1, 0}));
    const Repaired mended = repaired(soup_of(cubes), "safe");
    EXPECT_EQ(mended.report.before.non_manifold_edges, 1U);
    EXPECT_TRUE(is_closed_manifold(mended.report.after));
    EXPECT_EQ(mended.report.after.components, 2U);
    EXPECT_EQ(mended.report.after.verdict.volume, 2.0);
    EXPECT_EQ(mended.report.counts.kept, 24U);
    EXPECT_EQ(mended.report.input_to_output.upper, 0.0);
}

/// The boundary of unit cells.
TestMesh solid_of(const std::set<std::array<int, 3>>& cells) {
    TestMesh solid;
    std::map<std::array<int, 3>, std::uint32_t> numbers;
    const auto number_of = [&](const std::array<int, 3>& at) {
        const auto [found, is_new] =
            numbers.try_emplace(at, static_cast<std::uint32_t>(solid.positions.size()));
        if (is_new) solid.positions.push_back({1.0 * at[0], 1.0 * at[1], 1.0 * at[2]});
        return found->second;
    };
    for (const std::array<int, 3>& cell : cells) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const int side : {0, 1}) {
                std::array<int, 3> beside = cell;
                beside[axis] += 2 * side - 1;
                if (cells.contains(beside)) continue;
                std::array<int, 3> at = cell;
                at[axis] += side;
                std::array<std::uint32_t, 4> corners{number_of(at)};
                ++at[(axis + 1) % 3];
                corners[1] = number_of(at);
                ++at[(axis + 2) % 3];
                corners[2] = number_of(at);
                --at[(axis + 1) % 3];
                corners[3] = number_of(at);
                if (side == 0) std::swap(corners[1], corners[3]);
                solid.triangles.push_back({{corners[0], corners[1], corners[2]}});
                solid.triangles.push_back({{corners[0], corners[2], corners[3]}});
            }
        }
    }
    return solid;
}

// Two posts that share an edge, and a floor and a roof that join them at both of its ends: one
// fan at each, so that copies of the ends do not part the pairs. One pair gets a vertex between.
TEST(Repair, PostsThatShareAnEdgeGetAVertexInItsMiddle) {
    const TestMesh posts = solid_of(
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 1}, {1, 1, 1}, {0, 0, 2}, {1, 0, 2}, {1, 1, 2}});
    const Repaired mended = repaired(soup_of(posts), "safe");
    EXPECT_EQ(mended.report.before.non_manifold_edges, 1U);
    const StepReport* step = step_of(mended.report, RepairStep::split_non_manifold);
    ASSERT_NE(step, nullptr);
    EXPECT_EQ(step->undone, "");
    EXPECT_EQ(step->added_vertices, 1U);
    EXPECT_EQ(step->cut.size(), 2U);
    EXPECT_EQ(mended.mesh.triangles.size(), posts.triangles.size() + 2);
    EXPECT_TRUE(is_closed_manifold(mended.report.after));
    EXPECT_EQ(mended.report.after.components, 1U);
    EXPECT_EQ(mended.report.after.verdict.volume, 8.0);
}

TEST(Repair, CubesThatShareACornerArePartedIntoTwo) {
    const TestMesh cubes = joined(unit_cube(), moved_by(unit_cube(), 1, {1, 1, 1}));
    const Repaired mended = repaired(soup_of(cubes), "safe");
    EXPECT_EQ(mended.report.before.non_manifold_vertices, 1U);
    EXPECT_TRUE(is_closed_manifold(mended.report.after));
    EXPECT_EQ(mended.report.after.components, 2U);
}

// A sheet of two sides is balanced: it stays closed, around nothing.
TEST(Repair, ATwoSidedTriangleStaysClosed) {
    TriangleSoup soup;
    soup.positions = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}};
    soup.triangles = {{{0, 1, 2}}, {{1, 0, 2}}};
    const Repaired mended = repaired(soup, "safe");
    EXPECT_TRUE(is_closed_manifold(mended.report.after));
    EXPECT_EQ(mended.report.counts.cut, 1U);
    EXPECT_EQ(mended.report.input_to_output.upper, 0.0);
    const Repaired solid = repaired(soup, "solid");
    const StepReport* step = step_of(solid.report, RepairStep::resolve_self_intersections);
    ASSERT_NE(step, nullptr);
    ASSERT_EQ(step->refused.size(), 1U);
    EXPECT_EQ(step->refused[0].triangles, (std::vector<std::uint32_t>{0, 1}));
}

// Corner 1 lies on the edge from 0 to 2: the triangle has no area. Its neighbour is cut there.
TEST(Repair, AFlatTriangleGivesItsCornerToItsNeighbour) {
    TriangleSoup soup;
    soup.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, -2, 0}};
    soup.triangles = {{{0, 1, 2}}, {{0, 2, 3}}, {{0, 4, 1}}, {{1, 4, 2}}};
    const Repaired mended = repaired(soup, "safe");
    EXPECT_EQ(mended.mesh.triangles.size(), 4U);
    EXPECT_EQ(mended.report.counts.cut, 1U);
    EXPECT_EQ(mended.report.counts.dropped, 1U);
    // What has no area lies across two triangles: its bound is found by cutting it.
    EXPECT_LT(mended.report.input_to_output.upper, 1e-14);
    EXPECT_EQ(mended.report.output_to_input.upper, 0.0);
}

TEST(Repair, AMoebiusStripIsCutOnce) {
    TriangleSoup soup;
    constexpr int kCount = 12;
    for (int i = 0; i < kCount; ++i) {
        const double turn = 3.14159265358979 * i / kCount;
        const double c = std::cos(2 * turn), s = std::sin(2 * turn), w = std::cos(turn) / 2;
        for (const double side : {-1.0, 1.0}) {
            soup.positions.push_back(
                {c * (2 + side * w), s * (2 + side * w), side * std::sin(turn) / 2});
        }
    }
    const auto vertex = [](int i, int side) {
        const bool round = i == kCount;  // after one turn the sides have changed places
        return static_cast<std::uint32_t>(2 * (round ? 0 : i) + (round ? 1 - side : side));
    };
    for (int i = 0; i < kCount; ++i) {
        soup.triangles.push_back({{vertex(i, 0), vertex(i + 1, 0), vertex(i, 1)}});
        soup.triangles.push_back({{vertex(i, 1), vertex(i + 1, 0), vertex(i + 1, 1)}});
    }
    const Repaired mended = repaired(soup, "safe");
    EXPECT_FALSE(has(mended.report.before, format::verdict_oriented));
    EXPECT_TRUE(has(mended.report.after, format::verdict_oriented));
    EXPECT_TRUE(has(mended.report.after, format::verdict_two_manifold));
    EXPECT_EQ(mended.report.counts.parted_vertices, 2U);
    EXPECT_EQ(mended.report.input_to_output.upper, 0.0);
}

TEST(Repair, AHoleIsClosedUpToTheSizeAllowed) {
    const TriangleSoup soup = soup_of(open_cube(2));
    const Repaired closed = repaired(soup, "closed");
    EXPECT_TRUE(is_closed_manifold(closed.report.after));
    EXPECT_EQ(closed.report.counts.made, 2U);
    EXPECT_EQ(closed.report.after.verdict.volume, 1.0);

    RepairOptions options;
    options.steps = *find_repair_preset("closed");
    options.hole_size = 1;  // the hole is sqrt(2) across
    const Repaired open = repair(soup, options);
    EXPECT_EQ(open.report.counts.made, 0U);
    const StepReport* step = step_of(open.report, RepairStep::fill_holes);
    ASSERT_NE(step, nullptr);
    ASSERT_EQ(step->refused.size(), 1U);
    EXPECT_EQ(step->refused[0].vertices.size(), 4U);
    EXPECT_EQ(step->refused[0].measure, std::sqrt(2.0));
}

// The vertex in the middle of one side of a quad, used from the other side only.
TEST(Repair, ATJunctionCutsTheTriangleThatItLiesOn) {
    TriangleSoup soup;
    soup.positions = {{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, 0, 0}, {1, -2, 0}};
    soup.triangles = {{{0, 1, 2}}, {{0, 4, 3}}, {{3, 4, 1}}};
    const Repaired mended = repaired(soup, "closed");
    const StepReport* step = step_of(mended.report, RepairStep::resolve_t_junctions);
    ASSERT_NE(step, nullptr);
    EXPECT_EQ(step->cut, std::vector<std::uint32_t>{0});
    EXPECT_EQ(step->moved, 0.0);
    EXPECT_EQ(mended.report.input_to_output.upper, 0.0);
}

// By hand: a triangle of area 2 with a vertex in the middle of two of its sides becomes three,
// the others, of area 3, stay, and only the five outer edges are without a neighbour.
TEST(Repair, TJunctionsOnTwoSidesCutTheTriangleTwice) {
    TriangleSoup soup;
    soup.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0, 0}, {1, -1, 0}, {1, 1, 0}, {2, 2, 0}};
    soup.triangles = {{{0, 1, 2}}, {{0, 4, 3}}, {{3, 4, 1}}, {{1, 6, 5}}, {{5, 6, 2}}};
    RepairOptions options;
    options.steps.set(static_cast<std::size_t>(RepairStep::resolve_t_junctions));
    const Repaired mended = repair(soup, options);
    EXPECT_EQ(mended.mesh.triangles.size(), 7U);
    EXPECT_EQ(mended.report.after.verdict.area, 5);
    EXPECT_EQ(mended.report.after.boundary_edges, 5U);
    EXPECT_EQ(mended.report.after.non_manifold_edges, 0U);
    EXPECT_EQ(mended.report.input_to_output.upper, 0.0);
}

TEST(Repair, ASeamIsStitchedWithinItsWidth) {
    TestMesh right = moved_by(test::grid_sheet(1, 1), 1, {1.125, 0, 0});
    RepairOptions options;
    options.steps = *find_repair_preset("closed");
    options.steps.reset(static_cast<std::size_t>(RepairStep::fill_holes));
    options.seam_width = 0.25;
    const Repaired mended = repair(soup_of(joined(test::grid_sheet(1, 1), right)), options);
    const StepReport* step = step_of(mended.report, RepairStep::stitch_seams);
    ASSERT_NE(step, nullptr);
    EXPECT_EQ(step->merged.size(), 2U);
    EXPECT_EQ(step->moved, 0.125);
    EXPECT_EQ(mended.report.after.components, 1U);
    EXPECT_GE(mended.report.input_to_output.upper, 0.0);
    EXPECT_NEAR(mended.report.output_to_input.upper, 0.0625, 0.0626);
}

// Two unit cubes half a side apart along all axes: 2 - 1/8.
TEST(Repair, CrossingCubesBecomeTheirUnion) {
    const TestMesh cubes = joined(unit_cube(), moved_by(unit_cube(), 1, {0.5, 0.5, 0.5}));
    const Repaired mended = repaired(soup_of(cubes), "solid");
    EXPECT_TRUE(is_closed_manifold(mended.report.after));
    EXPECT_EQ(mended.report.after.verdict.volume, 1.875);
    EXPECT_EQ(mended.report.after.components, 1U);
    EXPECT_TRUE(find_meetings(mended.mesh, {}).pairs.empty());
}

// By hand: one triangle stands with a corner on the other, which is cut into three there.
TEST(CutCrossings, ATriangleThatIsMetButNotCutNamesNoStep) {
    RepairMesh mesh;
    mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}, {1, 1, 1}, {2, 1, 1}};
    mesh.triangles = {{{0, 1, 2}}, {{3, 4, 5}}};
    mesh.vertex_origin.resize(6);
    mesh.triangle_origin = {{0, {}}, {1, {}}};
    const CutMesh cut = cut_crossings(mesh, {}, {});
    EXPECT_EQ(cut.failed, "");
    EXPECT_FALSE(cut.left);
    ASSERT_EQ(cut.mesh.triangle_origin.size(), 4U);
    std::size_t fragments = 0;
    for (const Origin& origin : cut.mesh.triangle_origin) {
        if (origin.source == 1) {
            EXPECT_FALSE(origin.step);
        } else {
            EXPECT_EQ(origin.step, RepairStep::resolve_self_intersections);
            ++fragments;
        }
    }
    EXPECT_EQ(fragments, 3U);
}

// Two unit cubes with half a face in common: in one plane, and no crossing at all.
TEST(Repair, CubesThatShareHalfAFaceBecomeTheirUnion) {
    const TestMesh cubes = joined(unit_cube(), moved_by(unit_cube(), 1, {1, 0.5, 0}));
    const Repaired mended = repaired(soup_of(cubes), "solid");
    EXPECT_TRUE(is_closed_manifold(mended.report.after));
    EXPECT_EQ(mended.report.after.verdict.volume, 2.0);
    EXPECT_TRUE(find_meetings(mended.mesh, {}).pairs.empty());
}

TEST(Repair, AnOpenMeshThatCrossesIsRefusedByItsPair) {
    RepairOptions options;
    options.steps = *find_repair_preset("solid");
    options.steps.reset(static_cast<std::size_t>(RepairStep::fill_holes));
    const TestMesh cubes = joined(open_cube(2), moved_by(open_cube(2), 1, {0.5, 0.5, 0.5}));
    const Repaired mended = repair(soup_of(cubes), options);
    const StepReport* step = step_of(mended.report, RepairStep::resolve_self_intersections);
    ASSERT_NE(step, nullptr);
    ASSERT_EQ(step->refused.size(), 1U);
    EXPECT_EQ(step->refused[0].triangles.size(), 2U);
    EXPECT_EQ(mended.mesh.triangles.size(), 20U);
}

TEST(Repair, SmallComponentsGoOnlyWhenAskedFor) {
    const TestMesh mixed = joined(unit_cube(), moved_by(test::grid_sheet(1, 1), 1, {5, 0, 0}));
    EXPECT_EQ(repaired(soup_of(mixed), "safe").report.counts.dropped, 0U);
    RepairOptions options;
    options.steps = *find_repair_preset("safe");
    options.steps.set(static_cast<std::size_t>(RepairStep::drop_components));
    options.least_triangles = 3;
    const Repaired mended = repair(soup_of(mixed), options);
    EXPECT_EQ(mended.report.counts.dropped, 2U);
    EXPECT_EQ(mended.report.counts.unused_vertices + mended.report.counts.merged_vertices, 4U);
}

TEST(Repair, CrossingsAreLeftAsTheyAreWhenTheTimeIsOver) {
    RepairOptions options;
    options.steps = *find_repair_preset("solid");
    options.seconds = 0;
    const TestMesh crossing = joined(unit_cube(), moved_by(unit_cube(), 1, {0.5, 0.25, 0.125}));
    const Repaired mended = repair(soup_of(crossing), options);
    EXPECT_EQ(mended.mesh.triangles, crossing.triangles);
    const StepReport* step = step_of(mended.report, RepairStep::resolve_self_intersections);
    ASSERT_NE(step, nullptr);
    ASSERT_EQ(step->refused.size(), 1U);
    EXPECT_NE(step->refused[0].sentence.find("longer than the time limit"), std::string::npos);
    EXPECT_EQ(step->refused[0].triangles.size(), 2U);
}

TEST(Repair, AnInterruptEndsIt) {
    RepairOptions options;
    options.steps = *find_repair_preset("solid");
    int asked = 0;
    options.interrupted = [&] { return ++asked > 0; };
    const Repaired mended = repair(soup_of(reversed(unit_cube())), options);
    EXPECT_GT(asked, 0);
    EXPECT_TRUE(mended.report.steps.empty());
}

}  // namespace
}  // namespace cdprep::mesh
