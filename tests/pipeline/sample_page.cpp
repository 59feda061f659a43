// SPDX-License-Identifier: GPL-3.0-or-later
// Writes pages of meshes whose findings are known by hand, for html_report.py to open.
// Usage: sample_page cube|scaled|several|many|partial EXPONENT OUTPUT
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "validate/html_page.h"

namespace {

using namespace cdprep;
using mesh::Double3;
using mesh::Rule;
using mesh::Triangle;

struct Sample {
    report::ValidationReport report;
    std::vector<Double3> positions;
    std::vector<Triangle> triangles;
};

mesh::Place place(std::vector<std::uint32_t> triangles, std::vector<std::uint32_t> vertices,
                  const Double3& at, double measure) {
    return {std::move(triangles), std::move(vertices), at, measure};
}

// The cube from -1 to 1 without its side at z = 1: one hole of four edges. Scaled by
// 2^exponent, and moved so that its centre is (4, 0, 0) times that.
Sample open_cube(int exponent) {
    Sample cube;
    const auto at = [exponent](double x, double y, double z) {
        return Double3{std::ldexp(x + 4, exponent), std::ldexp(y, exponent),
                       std::ldexp(z, exponent)};
    };
    for (const double z : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) {
            for (const double x : {-1.0, 1.0}) cube.positions.push_back(at(x, y, z));
        }
    }
    cube.positions.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
    for (const auto& corners : std::vector<std::array<std::uint32_t, 3>>{{0, 2, 3},
                                                                         {0, 3, 1},
                                                                         {0, 1, 5},
                                                                         {0, 5, 4},
                                                                         {2, 6, 7},
                                                                         {2, 7, 3},
                                                                         {0, 4, 6},
                                                                         {0, 6, 2},
                                                                         {1, 3, 7},
                                                                         {1, 7, 5}}) {
        cube.triangles.push_back({corners});
    }
    report::ValidationReport& report = cube.report;
    report.input = "open </script><b>cube</b> & \"more\"\xff.obj";
    report.triangles = cube.triangles.size();
    report.vertices = cube.positions.size();
    report.node_of_triangle_run = {"root/<!--<script>alert(1)</script>"};
    report.first_triangle = {0};
    const double length = std::ldexp(2, exponent);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    report.defects.findings = {
        {Rule::non_finite_coordinate, 1, {place({}, {8}, {nan, 0, 0}, 0)}},
        {Rule::sliver, 1, {place({0}, {0, 2, 3}, at(-1.0 / 3, 1.0 / 3, -1), 0.25)}},
        {Rule::boundary_edge,
         4,
         {place({3}, {5, 4}, at(0, -1, 1), length), place({4}, {6, 7}, at(0, 1, 1), length),
          place({6}, {4, 6}, at(-1, 0, 1), length), place({9}, {7, 5}, at(1, 0, 1), length)}},
        {Rule::boundary_loop,
         1,
         {place({3, 4, 6, 9}, {4, 5, 7, 6}, at(0, 0, 1), length * std::sqrt(2.0))}},
        {Rule::non_manifold_vertex, 1, {place({0, 6, 2}, {0}, at(-1, -1, -1), 2)}},
    };
    const double area = std::ldexp(20, 2 * exponent);
    report.defects.verdicts = {
        {2 | 4 | 8, 1, 10, 0, 1, 1, -1, 0, area, 0},
        {2 | 4 | 8, 1, 10, 0, 1, 1, -1, 0, area, 0},
    };
    return cube;
}

// A sheet of side x side squares with a finding in every square: more places than kept.
Sample sheet(std::uint32_t side) {
    Sample sheet;
    for (std::uint32_t y = 0; y <= side; ++y) {
        for (std::uint32_t x = 0; x <= side; ++x) {
            sheet.positions.push_back(
                {static_cast<double>(x), static_cast<double>(y), std::sin(0.05 * x) * 5});
        }
    }
    mesh::Finding slivers{Rule::sliver, 0, {}};
    mesh::Finding crossings{Rule::crossing_triangles, 0, {}};
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t a = y * (side + 1) + x;
            const auto next = static_cast<std::uint32_t>(sheet.triangles.size());
            sheet.triangles.push_back({{a, a + 1, a + side + 2}});
            sheet.triangles.push_back({{a, a + side + 2, a + side + 1}});
            for (mesh::Finding* finding : {&slivers, &crossings}) {
                if (++finding->count > 1000) continue;
                finding->places.push_back(
                    place({next, next + 1}, {}, sheet.positions[a], 1.0 / (x + 1)));
            }
        }
    }
    sheet.report.input = "sheet.obj";
    sheet.report.triangles = sheet.triangles.size();
    sheet.report.vertices = sheet.positions.size();
    sheet.report.defects.findings = {slivers, crossings};
    return sheet;
}

Sample unreadable() {
    Sample sample;
    sample.report.input = "broken.obj";
    sample.report.error = "broken.obj: line 3 has 2 coordinates, not 3.";
    return sample;
}

std::vector<Sample> samples_of(const std::string& name, int exponent) {
    if (name == "cube") return {open_cube(exponent)};
    if (name == "several") return {sheet(3), open_cube(exponent), unreadable()};
    if (name == "many" || name == "partial") return {sheet(120)};
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    const std::string name = argv[1];
    const std::vector<Sample> samples = samples_of(name, std::atoi(argv[2]));
    std::vector<report::PageMesh> meshes;
    for (const Sample& sample : samples) {
        meshes.push_back({&sample.report, sample.positions, sample.triangles, {}});
    }
    report::PageOptions options;
    options.version = "0";
    if (name == "partial") options.max_triangles = 3000;
    std::ofstream file(argv[3], std::ios::binary);
    file << report::html_page(meshes, options);
    return file ? 0 : 1;
}
