// SPDX-License-Identifier: MIT
#include "support/hard_points.h"

#include <algorithm>
#include <cmath>

#include "support/brute_force.h"
#include "support/defect_zoo.h"
#include "support/exact_winding.h"

namespace cdprep::test {
namespace {

using Cases = std::vector<HardPoints>;

HardPoint on(const Double3& p) {
    return {p, true, 0, false};
}
HardPoint wound(const Double3& p, double winding) {
    return {p, false, winding, false};
}
HardPoint unknown(const Double3& p, std::optional<double> winding = std::nullopt) {
    return {p, false, winding, true};
}

/// As rays in exact numbers say.
HardPoints by_rays(std::string id, const TestMesh& mesh, const std::vector<Double3>& points) {
    std::vector<Corners> surface;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        surface.push_back(corners_of(mesh, i, nullptr));
    }
    HardPoints result = {std::move(id), mesh, {}};
    for (const Double3& p : points) {
        const auto winding = exact_winding(surface, p);
        result.points.push_back(winding ? wound(p, *winding) : on(p));
    }
    return result;
}

void add_fold(Cases& all) {
    const TestMesh mesh = folded_corner();
    std::vector<Double3> points;
    for (const double z : {-0.5, -0.25, -1.0, -2.0, 0.5, 3.0, -10.0}) points.push_back({0, 0, z});
    for (const Double3& v : mesh.positions) {
        for (const double part : {0.25, 0.5, 1.0, 1.25}) {
            points.push_back({part * v.x, part * v.y, part * v.z - 0.5});
        }
    }
    all.push_back(by_rays("P01 a folded corner", mesh, points));
}

/// By hand: who is farther out than half the side along an axis is outside.
void add_cubes(Cases& all) {
    HardPoints probes = {"P03 half integers about a cube", cube_at(-2, 2), {}};
    for (int i = 0; i < 729; ++i) {
        const Double3 p{(i % 9 - 4) * 0.75, (i / 9 % 9 - 4) * 0.75, (i / 81 - 4) * 0.75};
        const double far = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
        probes.points.push_back(wound(p, far < 2 ? 1 : 0));
    }
    all.push_back(std::move(probes));
    all.push_back({"P02 the centre of a cube", cube_at(-2, 2), {wound({0, 0, 0}, 1)}});
    all.push_back({"P02 the centre of a ball", icosphere(2), {wound({0, 0, 0}, 1)}});
    HardPoints outside = {"P04 planes of faces and lines of edges", unit_cube(), {}};
    for (const Double3& p : {Double3{-1, 0, 0}, Double3{-1, 1, 1}, Double3{-1, 0.5, 0},
                             Double3{-1, 0.5, 1}, Double3{0.5, -1, 0}, Double3{0, 0, -3},
                             Double3{2, 1, 1}, Double3{1, 2, 0}, Double3{2, 0.5, 0.5}}) {
        outside.points.push_back(wound(p, 0));
    }
    all.push_back(std::move(outside));
    HardPoints boundary = {"P05 the boundary of a cube", unit_cube(), {}};
    for (const Double3& p :
         {Double3{0.25, 0.5, 0}, Double3{1, 0.25, 0.5}, Double3{0.5, 0, 0}, Double3{1, 1, 1},
          Double3{1, 0, 0.125}, Double3{0, 0, 0}, Double3{0.5, 0.5, 1}}) {
        boundary.points.push_back(on(p));
    }
    all.push_back(std::move(boundary));
}

/// By counting shells.
void add_shells(Cases& all) {
    const Double3 core{1.5, 1.5, 1.5}, wall{0.5, 1.5, 1.5}, beyond{3.5, 1.5, 1.5};
    all.push_back({"P06 two shells",
                   joined(cube_at(0, 3), cube_at(1, 2)),
                   {wound(core, 2), wound(wall, 1), wound(beyond, 0)}});
    all.push_back({"P06 a cavity",
                   joined(cube_at(0, 3), reversed(cube_at(1, 2))),
                   {wound(core, 0), wound(wall, 1), wound(beyond, 0)}});
    all.push_back({"P09 cubes that overlap",
                   joined(unit_cube(), cube_at(0.5, 1.5)),
                   {wound({0.75, 0.75, 0.75}, 2), wound({0.25, 0.75, 0.75}, 1),
                    wound({0.25, 0.75, 1.25}, 0)}});
    all.push_back({"P09 an inverted cube",
                   reversed(cube_at(1, 2)),
                   {wound(core, -1), wound({1.25, 1.75, 1.5}, -1), wound(wall, 0)}});
    all.push_back({"P07 cubes that share an edge",
                   joined(unit_cube(), moved_by(unit_cube(), 1, {1, 1, 0})),
                   {wound({0.5, 0.5, 0.5}, 1), wound(core, 0), wound({1.5, 1.5, 0.5}, 1),
                    wound({1.5, 0.5, 0.5}, 0), on({1, 1, 0.5})}});
    all.push_back(
        {"P07 cubes that share a vertex",
         joined(cube_at(0, 1), cube_at(1, 2)),
         {wound({0.5, 0.5, 0.5}, 1), wound(core, 1), wound({1.5, 0.5, 0.5}, 0), on({1, 1, 1})}});
}

/// By symmetry five of six equal faces make 5/6; of the others nothing is known but that
/// nothing may be said.
void add_open(Cases& all) {
    TestMesh open = unit_cube();
    open.triangles.resize(10);
    all.push_back({"P08 a cube without a face",
                   open,
                   {unknown({0.5, 0.5, 0.5}, 5.0 / 6), wound({5, 5, 5}, 0), on({0.5, 0.5, 0})}});
    const TestMesh strip = moebius_strip(16);
    Double3 middle{};
    for (const Double3& p : strip.positions) {
        const auto count = static_cast<double>(strip.positions.size());
        middle = {middle.x + p.x / count, middle.y + p.y / count, middle.z + p.z / count};
    }
    all.push_back({"P08 a Moebius strip",
                   strip,
                   {unknown({std::nearbyint(middle.x), std::nearbyint(middle.y),
                             std::nearbyint(middle.z * 8) / 8})}});
    all.push_back({"P08 a soup", random_soup(5, 40, 1), {unknown({0, 0, 0})}});
}

}  // namespace

TestMesh cube_at(double low, double high) {
    return moved_by(unit_cube(), high - low, {low, low, low});
}

TestMesh folded_corner() {
    return {{{0, 0, 0}, {3, 4, -2}, {4, 5, 1}, {-5, 0, -3}, {5, -5, 0}, {-6, -6, -6}},
            {{{0, 1, 2}},
             {{0, 2, 3}},
             {{0, 3, 4}},
             {{0, 4, 1}},
             {{5, 2, 1}},
             {{5, 3, 2}},
             {{5, 4, 3}},
             {{5, 1, 4}}}};
}

Cases hard_points() {
    Cases all;
    add_fold(all);
    add_cubes(all);
    add_shells(all);
    add_open(all);
    return all;
}

}  // namespace cdprep::test
