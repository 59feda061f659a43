// SPDX-License-Identifier: MIT
#include "support/hard_distances.h"

#include <cmath>

#include "support/brute_force_distance.h"
#include "support/hard_triangles.h"

namespace cdprep::test {
namespace {

using Cases = std::vector<HardDistance>;

Placement shifted(double x, double y, double z) {
    return Placement::b_moves(Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, x, y, z}).value());
}

TestMesh mesh_of(const Corners& t) {
    return {{t[0], t[1], t[2]}, {{{0, 1, 2}}}};
}

void add_faces(Cases& all) {
    const Pose pose = Pose::from_quaternion(1, 2, 3, 4, {0.5, -0.25, 2}).value();
    for (const double gap : {0x1p-3, 0x1p-20, 0x1p-40, 1e-12}) {
        const std::string name = "X01 parallel faces, 2^" + std::to_string(std::ilogb(gap));
        const TestMesh beside = cube_beside(gap);
        HardDistance still = {name, unit_cube(), beside};
        still.gap = beside.positions[0].x - 1;
        all.push_back(std::move(still));
        all.push_back({name + ", turned", unit_cube(), beside, Placement::world(pose, pose)});
    }
}

/// Edges that cross at an angle of 2^-30, one unit apart; and others.
void add_edges(Cases& all) {
    for (const int exponent : {-30, -20, -45}) {
        const double slope = std::ldexp(1.0, exponent);
        HardDistance hard = {"X02 edges at an angle of 2^" + std::to_string(exponent),
                             mesh_of({{{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}}}),
                             mesh_of({{{-1, -slope, 1}, {1, slope, 1}, {0, 0, 2}}})};
        hard.gap = 1;
        all.push_back(std::move(hard));
        all.push_back({"X02 beside each other, 2^" + std::to_string(exponent),
                       mesh_of({{{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}}}),
                       mesh_of({{{-1, 1 - slope, 0.5}, {1, 1 + slope, 0.5}, {0, 2, 2}}})});
    }
}

void add_triangles(Cases& all) {
    const Double3 p{1.1, -7.9, 16.588}, a{2.277, -7.9, 16.318}, b{-0.57, -8.1, 16.607};
    all.push_back({"X03 a point and a segment", mesh_of({{p, p, p}}), mesh_of({{a, b, b}})});
    for (const HardPair& pair : hard_triangles()) {
        for (const double step : {0.0, 0x1p-20, -0x1p-20}) {
            TestMesh other = mesh_of(pair.b);
            for (Double3& q : other.positions) q = {q.x + step, q.y + step, q.z + step};
            all.push_back({"X04 " + pair.id, mesh_of(pair.a), other});
        }
    }
}

void add_cubes(Cases& all) {
    HardDistance equal = {"X05 cubes with four equal pairs", unit_cube(), unit_cube(),
                          shifted(0, 0, 3)};
    equal.gap = 2;
    all.push_back(std::move(equal));
    HardDistance tips = {"X05 four tips over a plate", moved_by(unit_cube(), 8, {-2, -2, -8}),
                         four_tips(), shifted(0, 0, 3)};
    tips.gap = 3;
    all.push_back(std::move(tips));
    for (const double gap : {1e-12, 1e-10, 3e-10, 1e-6}) {
        all.push_back({"X06 a gap of 1e" + std::to_string(std::lround(std::log10(gap))),
                       moved_by(unit_cube(), 1, {1e6, 1e6, 1e6}),
                       moved_by(unit_cube(), 1, {1e6 + 1 + gap, 1e6 + 0.25, 1e6 + 0.125})});
    }
    for (const double gap : {1.0, 0.5, 0x1p-10, 0x1p-30, 3 * 0x1p-20}) {
        HardDistance dyadic = {"X07 a tolerance of its own distance", unit_cube(), unit_cube(),
                               shifted(1 + gap, 0.25, 0.125)};
        dyadic.gap = gap;
        all.push_back(std::move(dyadic));
    }
    HardDistance balls = {"X08 balls, errors permitted", icosphere(2), icosphere(2)};
    balls.placement =
        Placement::b_moves(Pose::from_quaternion(5, 1, 2, 3, {2.3, 0.2, 0.1}).value());
    all.push_back(std::move(balls));
    HardDistance nested = {"X09 a cube in a cube", unit_cube(),
                           moved_by(unit_cube(), 3, {-1, -1, -1})};
    nested.gap = 1;
    nested.is_nested = true;
    all.push_back(std::move(nested));
}

}  // namespace

TestMesh four_tips() {
    TestMesh tips;
    for (const double x : {0.0, 4.0}) {
        for (const double y : {0.0, 4.0}) {
            const TestMesh tip{{{x, y, 0}, {x + 1, y, 1}, {x, y + 1, 1}}, {{{0, 1, 2}}}};
            tips = joined(tips, tip);
        }
    }
    return tips;
}

TestMesh cube_beside(double gap) {
    TestMesh beside = unit_cube();
    for (Double3& p : beside.positions) p.x += p.x == 0 ? 1 + gap : 1;
    return beside;
}

Cases hard_distances() {
    Cases all;
    add_faces(all);
    add_edges(all);
    add_triangles(all);
    add_cubes(all);
    return all;
}

ExactRational squared_distance_of(const HardDistance& hard) {
    if (hard.gap) return square(*hard.gap);
    return brute_force_distance(hard.a, hard.b, hard.placement);
}

}  // namespace cdprep::test
