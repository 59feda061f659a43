// SPDX-License-Identifier: MIT
#include "support/hard_hulls.h"

#include <cmath>
#include <numbers>

#include "support/meshes.h"
#include "support/small_hull.h"

namespace cdprep::test {
namespace {

using Cases = std::vector<HardHulls>;
using Exact = SquaredLength<ExactNumber>;

constexpr std::array<double, 9> kStill = {1, 0, 0, 0, 1, 0, 0, 0, 1};

Points shifted(Points points, const Double3& t) {
    for (Double3& p : points) p = {p.x + t.x, p.y + t.y, p.z + t.z};
    return points;
}

Points scaled(Points points, double scale) {
    for (Double3& p : points) p = {scale * p.x, scale * p.y, scale * p.z};
    return points;
}

/// G03: displaced along edges and diagonals the origin lies on faces, edges and corners of the
/// difference, and of every simplex within it.
void add_displaced_boxes(Cases& all) {
    const Points box = box_corners(1, 1, 1);
    for (int i = 0; i < 343; ++i) {
        const Double3 t = {double(i % 7 - 3), double(i / 7 % 7 - 3), double(i / 49 - 3)};
        HardHulls hard = {"G03 displaced by " + std::to_string(i % 7 - 3) + " " +
                              std::to_string(i / 7 % 7 - 3) + " " + std::to_string(i / 49 - 3),
                          box, shifted(box, t)};
        hard.is_integral = true;
        const double most = std::max({std::fabs(t.x), std::fabs(t.y), std::fabs(t.z)});
        if (most <= 2) hard.depth = 2 - most;
        all.push_back(std::move(hard));
    }
}

void add_point_queries(Cases& all) {
    for (const Double3& q : {Double3{1, 1, 1}, Double3{0.5, 0.5, 0.5}, Double3{0, 0.4, -0.5},
                             Double3{0.3, 0.3, 0.3}, Double3{0.2, 0.1, 0}}) {
        all.push_back(
            {"G04 a polytope and the point " + std::to_string(q.x), polytope_of_24_corners(), {q}});
    }
}

void add_random_poses(Cases& all, bool full) {
    std::mt19937 random(3383);
    const Points a = normal_points(random, 60), b = normal_points(random, 80);
    for (int i = 0; i < (full ? 3000 : 150); ++i) {
        HardHulls hard = {"G05 pose " + std::to_string(i), a, b,
                          Placement::b_moves(random_pose(random, 4))};
        hard.is_large = true;
        all.push_back(std::move(hard));
    }
}

/// By construction: the caps are so far apart, together, or in each other.
void add_prisms(Cases& all, bool full) {
    constexpr double kGap = 0x1p-30;
    const Points points = prism(full ? 1000 : 100);
    for (const double gap : {kGap, 0.0, -kGap}) {
        HardHulls hard = {"G06 coaxial prisms, gap " + std::to_string(gap < 0   ? -1
                                                                      : gap > 0 ? 1
                                                                                : 0),
                          points, shifted(points, {0, 0, 1 + gap})};
        hard.is_large = true;
        (gap > 0 ? hard.gap : hard.depth) = std::fabs(gap);
        all.push_back(std::move(hard));
    }
}

/// By hand: a cube turned by 3-4-5 has its foremost edge at x = 7, y = 1.
void add_many_witnesses(Cases& all) {
    const Points cube = box_corners(5, 5, 5);
    HardHulls faces = {"G07 parallel faces", cube, shifted(cube, {13, 2, 3})};
    faces.gap = 3;
    Points turned;
    for (const Double3& p : cube) {
        turned.push_back({(3 * p.x - 4 * p.y) / 5, (4 * p.x + 3 * p.y) / 5, p.z});
    }
    const Points mirrored = moved_points(turned, pose_of({-1, 0, 0, 0, -1, 0, 0, 0, 1}, {}));
    HardHulls edges = {"G07 parallel edges", turned, shifted(mirrored, {24, 2, 3})};
    edges.gap = 10;
    for (HardHulls* hard : {&faces, &edges}) {
        hard->is_integral = true;
        all.push_back(std::move(*hard));
    }
}

/// By symmetry and by hand: a box is as deep in itself as it is thin; the simplex as its least
/// width, between opposite edges, 2.
void add_coincident(Cases& all) {
    const Points box = box_corners(3, 1, 2);
    const Points simplex = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    for (const Points& points : {box, simplex}) {
        HardHulls hard = {"G08 " + std::to_string(points.size()) + " corners in themselves", points,
                          points};
        hard.depth = 2;
        hard.is_integral = true;
        all.push_back(std::move(hard));
    }
}

/// A square, a segment and a point through, on and off a cube.
void add_flat(Cases& all, bool full) {
    const Points cube = box_corners(2, 2, 2);
    const std::array<Points, 3> flat = {
        {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{-3, 0, 0}, {3, 1, 0}}, {{0, 0, 0}}}};
    const auto add = [&](const std::string& name, const Points& a, const Points& b) {
        HardHulls hard = {"G09 " + name, a, b};
        hard.is_integral = true;
        all.push_back(std::move(hard));
    };
    for (std::size_t k = 0; k < flat.size(); ++k) {
        for (int i = static_cast<int>(k); i < 216; i += full ? 1 : 5) {
            const Double3 t = {double(i % 6), double(i / 6 % 6), double(i / 36)};
            const std::string name = "dimension " + std::to_string(2 - k);
            add(name + " and a cube", cube, shifted(flat[k], t));
            add(name + " and a segment", flat[k], shifted(flat[1], {t.x - 2, t.y - 2, t.z - 2}));
        }
    }
}

/// By construction: so far between two points on the axis, as doubles have it.
void add_balls(Cases& all, bool full) {
    constexpr double kScale = 1.0 / 1024;
    const int radius = full ? 1001 : 195;
    const Points ball = lattice_ball(radius, kScale);
    const double top = radius * kScale, shift = 2 * top + 1e-9;
    HardHulls fine = {"G10 fine balls 1e-9 apart", ball, ball,
                      Placement::b_moves(pose_of(kStill, {shift, 0, 0}))};
    // Every x of B is rounded by itself; the nearest is that of its foremost point.
    fine.gap = transform_point(fine.placement.pose_b(), {-top, 0, 0}).x - top;
    fine.is_large = true;
    all.push_back(std::move(fine));

    const Points ties = lattice_ball(65, 1);
    for (const double x : {129.0, 130.0, std::nextafter(130.0, 200.0), 131.0}) {
        HardHulls hard = {"G13 ties along an axis, " + std::to_string(x), ties, ties,
                          Placement::b_moves(pose_of(kStill, {x, 0, 0}))};
        if (x > 130) hard.gap = transform_point(hard.placement.pose_b(), {-65, 0, 0}).x - 65;
        if (x == 130) hard.depth = 0;
        hard.is_large = true;
        all.push_back(std::move(hard));
    }
    for (const double x : {75.0, 80.0}) {
        HardHulls hard = {"G13 ties along a diagonal, " + std::to_string(x), ties,
                          shifted(ties, {x, x, x})};
        hard.is_large = true;
        all.push_back(std::move(hard));
    }
}

/// Side 1 and 2^-20; 2^20 sides apart; and scales up to the ends of doubles.
void add_scales(Cases& all, bool full) {
    constexpr double kSmall = 0x1p-21, kFar = 0x1p20;
    const Points large = box_corners(0.5, 0.5, 0.5), small = box_corners(kSmall, kSmall, kSmall);
    all.push_back({"G11 sides 1 and 2^-20", large, shifted(small, {1, 0.25, 0.125})});
    all.push_back({"G11 2^20 sides apart", large, shifted(large, {kFar, -kFar / 4, 0})});
    for (const double scale : {0x1p-500, 0x1p500, 0x1p-1040, 0x1p990}) {
        if (!full && std::fabs(std::log2(scale)) > 1000) continue;
        const Points box = box_corners(scale, scale, scale);
        for (const double x : {2.5, 2.0, 0.5}) {
            all.push_back({"G11 boxes of 2^" + std::to_string(std::ilogb(scale)), box,
                           shifted(box, {x * scale, scale, 0})});
        }
    }
}

void add_needles(Cases& all) {
    const Points needle = box_corners(0.5, 0x1p-11, 0x1p-11);
    const Points cube = box_corners(0.5, 0.5, 0.5);
    HardHulls centred = {"G12 a needle in the middle of a cube", cube, needle};
    centred.depth = 0.5 + 0x1p-11;
    all.push_back(std::move(centred));
    std::mt19937 random(12);
    all.push_back(
        {"G12 a needle turned", cube, needle, Placement::b_moves(random_pose(random, 0.1))});
}

Points placed(const Points& points, const Pose& pose, bool is_moved) {
    return is_moved ? moved_points(points, pose) : points;
}

Exact square_of(double length) {
    return {ExactNumber(length) * ExactNumber(length), ExactNumber(1)};
}

template <class Number>
HullTruth by_definition(const HardHulls& hard) {
    const ExactHullPair<Number> exact(
        placed(hard.a, hard.placement.pose_a(), hard.placement.a_is_moved()),
        placed(hard.b, hard.placement.pose_b(), hard.placement.b_is_moved()));
    const auto in_exact = [](const SquaredLength<Number>& squared) {
        return Exact{exact_number(squared.numerator), exact_number(squared.denominator)};
    };
    HullTruth truth;
    if (const auto distance = exact.squared_distance()) {
        truth.distance = in_exact(*distance);
    } else {
        truth.depth = in_exact(exact.squared_depth());
    }
    return truth;
}

}  // namespace

Cases kissing_boxes() {
    const std::array<double, 9> turn = {
        0.96193976625564348026,  0.15401279915737359216,  0.22572537250328919556,
        -0.19134171618254486313, 0.96936494951283913579,  0.15401279915737359216,
        -0.19509032201612822033, -0.19134171618254486313, 0.96193976625564348026};
    const Pose first =
        pose_of(turn, {2.0770063995786869349, 0.48468247475641951239, 1.1543291419087275962});
    const std::array<double, 9> other = {
        0.94096063217417758029,  0.29296840037289501035, 0.16959541586174811667,
        -0.23569836841299879326, 0.92661523595848427348, -0.29296840037289506586,
        -0.2429801799032638987,  0.23569836841299884878, 0.94096063217417758029};
    const Pose second =
        pose_of(other, {0.073242100093223821977, 0.2316538089896212349, 1.3089245921032497399});
    const Points half = box_corners(0.25, 0.25, 0.25), quarter = box_corners(0.125, 0.125, 0.125);
    return {{"G01 kissing boxes", half, half, Placement::world(first, pose_of(turn, {2, 0, 1.25}))},
            {"G01 boxes all but touching", quarter, quarter,
             Placement::world(second, pose_of(other, {0, 0, 1.25}))}};
}

HardHulls plate_and_tilted_box() {
    const std::array<double, 9> turn = {
        0.10758262492983036718,  -0.6624881850015212903,  -0.74130653817877356637,
        0.22682184885125472595,  -0.709614040775253474,   0.6670830248314786326,
        -0.96797615037608542021, -0.23991106241273435495, 0.07392465377049164954};
    const Pose plate =
        pose_of(kStill, {-0.72099999999999997424, -0.77200000000000001954, 0.81000000000000005329});
    const Pose tilted =
        pose_of(turn, {-0.42677133002999478872, -0.76596851247746788882, 0.80746731400091054098});
    return {"G02 a plate and a tilted box", box_corners(0.23, 0.24, 0.005),
            box_corners(0.049521 / 2, 0.146 / 2, 0.0725 / 2), Placement::world(plate, tilted)};
}

Points polytope_of_24_corners() {
    constexpr double kLong = 0.414213562373, kShort = 0.171572875254;
    Points points;
    for (std::size_t small = 0; small < 3; ++small) {
        for (unsigned sign = 0; sign < 8; ++sign) {
            std::array<double, 3> p{};
            for (std::size_t i = 0; i < 3; ++i) {
                p[i] = (i == small ? kShort : kLong) * ((sign >> i & 1) != 0 ? -1 : 1);
            }
            points.push_back({p[0], p[1], p[2]});
        }
    }
    return points;
}

Points normal_points(std::mt19937& random, std::size_t count) {
    std::normal_distribution<double> normal;
    Points points(count);
    for (Double3& p : points) p = {normal(random), normal(random), normal(random)};
    return points;
}

Points prism(int n) {
    const auto rounded = [](double x) { return std::nearbyint(x * 0x1p30) * 0x1p-30; };
    Points points;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        const double x = rounded(std::cos(angle)), y = rounded(std::sin(angle));
        points.push_back({x, y, 0});
        points.push_back({x, y, 1});
    }
    return points;
}

Points lattice_ball(int radius, double scale) {
    return scaled(lattice_sphere(radius), scale);
}

HardHulls nearly_flat_hulls(std::mt19937& random) {
    const double g = std::ldexp(1, -30 - static_cast<int>(random() % 25));
    HardHulls hard = {"G14 heights of 0 and 2^" + std::to_string(std::ilogb(g)), {}, {}};
    hard.b = {{0.5, 0.25, 1}};
    for (int k = 0; k < 6; ++k) {
        hard.a.push_back(
            {double(random() % 4), double(random() % 4), (random() & 1) != 0 ? g : 0.0});
    }
    for (int k = 0; k < 4; ++k) {
        hard.b.push_back({double(random() % 4) - 0.5, double(random() % 4) - 0.25,
                          (random() & 1) != 0 ? 2 * g : g});
    }
    return hard;
}

Cases hard_hulls(bool full) {
    Cases all = kissing_boxes();
    all.push_back(plate_and_tilted_box());
    add_displaced_boxes(all);
    add_point_queries(all);
    add_random_poses(all, full);
    add_prisms(all, full);
    add_many_witnesses(all);
    add_coincident(all);
    add_flat(all, full);
    add_balls(all, full);
    add_scales(all, full);
    add_needles(all);
    std::mt19937 random(14);
    for (int i = 0; i < (full ? 60 : 8); ++i) all.push_back(nearly_flat_hulls(random));
    return all;
}

HullTruth hull_truth(const HardHulls& hard) {
    if (hard.gap) return {square_of(*hard.gap), {}};
    if (hard.is_large && hard.depth) return {{}, square_of(*hard.depth)};
    HullTruth truth =
        hard.is_integral ? by_definition<Integer128>(hard) : by_definition<ExactNumber>(hard);
    if (hard.depth) truth.depth = square_of(*hard.depth);
    return truth;
}

std::optional<Exact> proof_by(const Double3& direction, const Points& a, const Points& b) {
    const auto along = [&](const Double3& p) {
        return ExactNumber(direction.x) * ExactNumber(p.x) +
               ExactNumber(direction.y) * ExactNumber(p.y) +
               ExactNumber(direction.z) * ExactNumber(p.z);
    };
    ExactNumber highest = along(a[0]), lowest = along(b[0]);
    for (const Double3& p : a) highest = std::max(highest, along(p));
    for (const Double3& p : b) lowest = std::min(lowest, along(p));
    const ExactNumber gap = lowest - highest;
    if (gap.sign() <= 0) return std::nullopt;
    return Exact{gap * gap, along(direction)};
}

}  // namespace cdprep::test
