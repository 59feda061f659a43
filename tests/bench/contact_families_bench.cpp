// SPDX-License-Identifier: MIT
// What a reported pair costs where triangles touch, lie in one plane or stand on a
// grid, beside what it costs where they cross anyhow: families of placements in which
// the float filter leaves little, much or all to the exact stage. One thread;
// families take turns, the time of each is the median of its rounds.
//
// Usage: contact_families_bench BAKES [ROUNDS [FAMILY]]
// BAKES holds armadillo, bunny and horse.cdp.h5, baked with --normalize. With FAMILY
// that one alone is asked: for callgrind.
//
// Prints a CSV table; the spread is that of the middle half of the rounds, `times` the
// cost of a reported pair by that of the generic family; then how many pairs of
// triangles had to be decided for it, in float, by a common corner, in double and
// exactly, and what one of those costs. Where rounding takes triangles of one plane
// apart, most of those are in contact no more.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "bench_input.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/pairs.h"
#include "exact/triangle_contact.h"
#include "support/open_tiny.h"

namespace cdprep::test {
namespace {

struct Family {
    const char* name;
    const Model& a;
    const Model& b;
    Placement placement;
    std::vector<double> us = {};
    std::size_t pairs = 0;
    QueryCounts counts = {};
};

Pose shift(double x, double y, double z) {
    return Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, x, y, z}).value();
}

/// The model's triangles with every coordinate rounded to a multiple of `step`, but
/// for those that become collinear.
TestMesh snapped(const Model& model, double step) {
    TestMesh mesh;
    const auto near = [step](double x) { return step * std::nearbyint(x / step); };
    for (const format::Float3& p : model.mesh().positions_f32) {
        mesh.positions.push_back({near(p.x), near(p.y), near(p.z)});
    }
    for (const Triangle& t : model.mesh().triangles) {
        const auto at = [&](std::size_t i) { return mesh.positions[t.vertex[i]]; };
        if (!is_degenerate({at(0), at(1), at(2)})) mesh.triangles.push_back(t);
    }
    return mesh;
}

/// Out of the plane z = 0, and still in one.
TestMesh sloping(TestMesh sheet) {
    for (Double3& p : sheet.positions) p.z = 0.5 * p.x + 0.75 * p.y;
    return sheet;
}

void ask(Family& family, Workspace& workspace, std::vector<TrianglePair>& pairs) {
    const auto begun = std::chrono::steady_clock::now();
    family.pairs = overlaps({family.a, family.b, family.placement}, workspace, pairs);
    const std::chrono::duration<double, std::micro> taken =
        std::chrono::steady_clock::now() - begun;
    family.us.push_back(taken.count());
}

void count(Family& family, Workspace& workspace) {
    workspace.count_into(&family.counts);
    static_cast<void>(overlaps({family.a, family.b, family.placement}, workspace, {}));
    workspace.count_into(nullptr);
}

double median_ns(const Family& family) {
    return median(family.us) * 1000;
}

void print(const Family& family, double generic_ns_per_pair) {
    const QueryCounts& c = family.counts;
    const double ns = median_ns(family);
    const auto pairs = static_cast<double>(family.pairs);
    const double per_pair = ns / pairs;
    const auto decided = static_cast<double>(c.by_kernel + c.by_corner + c.by_filter + c.by_exact);
    std::printf("%s,%zu,%.1f,%.1f,%.2f,%llu,%llu,%llu,%llu,%.1f\n", family.name, family.pairs,
                per_pair, spread(family.us) * 1000 / pairs, per_pair / generic_ns_per_pair,
                static_cast<unsigned long long>(c.by_kernel),
                static_cast<unsigned long long>(c.by_corner),
                static_cast<unsigned long long>(c.by_filter),
                static_cast<unsigned long long>(c.by_exact), ns / decided);
}

void run(const std::filesystem::path& bakes, int rounds, const std::string& only) {
    const Model horse = open_or_stop(bakes / "horse.cdp.h5");
    const Model bunny = open_or_stop(bakes / "bunny.cdp.h5");
    const Model armadillo = open_or_stop(bakes / "armadillo.cdp.h5");
    const OpenModel grid = open_tiny(snapped(horse, 1.0 / 64));
    const OpenModel sheet = open_tiny(grid_sheet(20, 20));
    const OpenModel beside = open_tiny(moved_by(grid_sheet(20, 20), 1, {0.25, 0.25, 0}));
    const OpenModel slope = open_tiny(sloping(grid_sheet(20, 20)));
    const OpenModel slope_tenths = open_tiny(moved_by(sloping(grid_sheet(20, 20)), 0.1, {}));
    const Pose turned = Pose::from_quaternion(5, 1, 2, 3, {0.25, -0.5, 0.125}).value();
    const Pose deep = Pose::from_quaternion(5, 1, 2, 3, {0.05, 0.02, 0.03}).value();
    std::vector<Family> families = {
        {"generic", armadillo, horse, Placement::b_moves(deep)},
        {"generic_alike", armadillo, armadillo, Placement::b_moves(deep)},
        {"horse_on_itself", horse, horse, Placement::b_moves(Pose())},
        {"horse_on_itself_turned", horse, horse, Placement::world(turned, turned)},
        {"horse_snapped_shifted", grid.model, grid.model, Placement::b_moves(shift(1. / 64, 0, 0))},
        {"sheets_coplanar", sheet.model, sheet.model, Placement::b_moves(shift(0.25, 0.25, 0))},
        {"sheets_sloping", slope.model, slope.model, Placement::b_moves(shift(0.25, 0.25, 0.3125))},
        {"sheets_in_tenths", slope_tenths.model, slope_tenths.model,
         Placement::b_moves(shift(0.1, 0.1, 0.125))},
        {"sheets_turned_apart", sheet.model, beside.model, Placement::world(turned, turned)},
        {"sheets_turned", sheet.model, sheet.model, Placement::world(turned, turned)},
        {"bunny_on_itself", bunny, bunny, Placement::b_moves(Pose())},
        {"bunny_on_itself_turned", bunny, bunny, Placement::world(turned, turned)},
    };
    Workspace workspace;
    std::vector<TrianglePair> pairs(std::size_t{1} << 21);
    for (int round = 0; round < rounds; ++round) {
        for (Family& family : families) {
            if (only.empty() || only == family.name) ask(family, workspace, pairs);
        }
    }
    if (!only.empty()) return;
    std::printf(
        "family,pairs,ns_per_pair,spread_ns,times,by_kernel,by_corner,by_filter,by_exact,"
        "ns_per_decided\n");
    const Family& generic = families.front();
    const double ns = median_ns(generic) / static_cast<double>(generic.pairs);
    for (Family& family : families) {
        count(family, workspace);
        print(family, ns);
    }
}

}  // namespace
}  // namespace cdprep::test

int main(int count, char** arguments) {
    if (count < 2) {
        std::fprintf(stderr, "usage: %s BAKES [ROUNDS [FAMILY]]\n", arguments[0]);
        return 2;
    }
    const int rounds = count > 2 ? std::max(1, std::atoi(arguments[2])) : 15;
    cdprep::test::run(arguments[1], rounds, count > 3 ? arguments[3] : "");
}
