// SPDX-License-Identifier: MIT
#include "support/hard_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <random>
#include <utility>

namespace cdprep::test {
namespace {

using Points = std::vector<Double3>;
using MeshPointer = std::shared_ptr<const TestMesh>;

constexpr double kDegree = std::numbers::pi / 180;

Double3 operator+(const Double3& a, const Double3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Double3 operator-(const Double3& a, const Double3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Double3 operator*(double s, const Double3& v) {
    return {s * v.x, s * v.y, s * v.z};
}
Double3 cross(const Double3& a, const Double3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Points moved(const TestMesh& mesh, const Pose& pose) {
    Points points;
    for (const Double3& p : mesh.positions) points.push_back(transform_point(pose, p));
    return points;
}

/// A turn about an axis, then a shift.
Pose turned_by(const Double3& axis, double angle, const Double3& shift = {}) {
    const double sine = std::sin(angle / 2) / length_of(axis);
    return Pose::from_quaternion(std::cos(angle / 2), sine * axis.x, sine * axis.y, sine * axis.z,
                                 shift)
        .value();
}
Pose with_shift(const Pose& pose, const Double3& t) {
    const auto& r = pose.rotation();
    return Pose::from_rows({r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], t.x, t.y, t.z})
        .value();
}

MeshPointer shared(TestMesh mesh) {
    return std::make_shared<const TestMesh>(std::move(mesh));
}
MeshPointer box(const Double3& low, const Double3& high) {
    TestMesh mesh = unit_cube();
    for (Double3& p : mesh.positions) {
        p = {p.x == 0 ? low.x : high.x, p.y == 0 ? low.y : high.y, p.z == 0 ? low.z : high.z};
    }
    return shared(std::move(mesh));
}
/// Around the origin, `width` wide and `height` high.
MeshPointer plate(double width, double height) {
    return box({-width / 2, -width / 2, -height / 2}, {width / 2, width / 2, height / 2});
}
/// Its ridge is the x axis, its sides fall by 45 degrees.
MeshPointer roof() {
    TestMesh mesh;
    mesh.positions = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, 0, 0}, {1, 0, 0}};
    mesh.triangles = {{{0, 2, 1}}, {{0, 3, 2}}, {{0, 1, 5}}, {{0, 5, 4}},
                      {{2, 3, 4}}, {{2, 4, 5}}, {{0, 4, 3}}, {{1, 2, 5}}};
    return shared(std::move(mesh));
}
/// It stands on its tip at the origin; `steep` is its height by its half width.
MeshPointer octahedron(double steep) {
    TestMesh mesh;
    mesh.positions = {{1, 0, steep},  {-1, 0, steep},    {0, 1, steep},
                      {0, -1, steep}, {0, 0, 2 * steep}, {0, 0, 0}};
    mesh.triangles = {{{0, 2, 4}}, {{2, 1, 4}}, {{1, 3, 4}}, {{3, 0, 4}},
                      {{2, 0, 5}}, {{1, 2, 5}}, {{3, 1, 5}}, {{0, 3, 5}}};
    return shared(std::move(mesh));
}
/// What a scanner makes of a ball: no two triangles in a plane.
MeshPointer rough_ball(int level, const Double3& radii, double roughness, std::uint32_t seed) {
    TestMesh mesh = icosphere(level);
    std::mt19937 random(seed);
    for (Double3& p : mesh.positions) {
        const double unit = static_cast<double>(random()) * 0x1p-32;
        const double radius = 1 + roughness * (2 * unit - 1);
        p = {radii.x * radius * p.x, radii.y * radius * p.y, radii.z * radius * p.z};
    }
    return shared(in_floats(std::move(mesh)));
}

/// All directions in which the shortest way between two convex bodies may lead: across their faces
/// and across an edge of either. More than those do no harm: none leads out sooner.
Points candidates(const TestMesh& a, const Points& points_a, const TestMesh& b,
                  const Points& points_b) {
    Points found;
    const auto add = [&](const Double3& v) {
        const double length = length_of(v);
        // Edges as good as parallel have no direction across both.
        if (!(length > 1e-9)) return;
        found.push_back((1 / length) * v);
        found.push_back((-1 / length) * v);
    };
    const auto edges_of = [&](const TestMesh& mesh, const Points& points) {
        Points edges;
        for (const Triangle& t : mesh.triangles) {
            std::array<Double3, 3> edge;
            for (std::size_t i = 0; i < 3; ++i) {
                const Double3 e = points[t.vertex[(i + 1) % 3]] - points[t.vertex[i]];
                edge[i] = (1 / length_of(e)) * e;
                if (t.vertex[i] < t.vertex[(i + 1) % 3]) edges.push_back(edge[i]);
            }
            add(cross(edge[0], edge[1]));
        }
        return edges;
    };
    const Points edges_a = edges_of(a, points_a), edges_b = edges_of(b, points_b);
    for (const Double3& e : edges_a) {
        for (const Double3& f : edges_b) add(cross(e, f));
    }
    return found;
}

[[noreturn]] void fail(const HardContact& hard, const char* what) {
    std::fprintf(stderr, "%s: %s\n", hard.id.c_str(), what);
    std::abort();
}

/// The corners of what two convex polygons share, by cutting the first along the other's sides.
Points clipped(Points polygon, const Points& by) {
    for (std::size_t i = 0; i < by.size(); ++i) {
        const Double3 from = by[i], along = by[(i + 1) % by.size()] - from;
        const auto side = [&](const Double3& p) { return cross(along, p - from).z; };
        Points left;
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const Double3 p = polygon[k], q = polygon[(k + 1) % polygon.size()];
            const double at_p = side(p), at_q = side(q);
            if (at_p >= 0) left.push_back(p);
            if (at_p * at_q < 0) left.push_back(p + (at_p / (at_p - at_q)) * (q - p));
        }
        polygon = std::move(left);
    }
    return polygon;
}

/// Makes the guises of each case: at three scales, far from the origin, swapped, turned.
class Maker {
public:
    explicit Maker(const std::string& family) : family_(family) {}

    [[nodiscard]] bool wants(std::string_view id) const {
        return id.starts_with(family_);
    }
    /// Where both are convex, the shortest way is that of all directions, and of those in `more`.
    void add(HardContact hard, const Points& more = {}) {
        const std::string name = hard.id;
        if (!more.empty()) hard.allowed = more;
        for (const int exponent : {0, -20, 20}) {
            for (const double shift : {0.0, 0x1p20}) {
                HardContact guise = hard;
                guise.is_plain = exponent == 0 && shift == 0;
                scale(guise, exponent);
                turn(guise, count_ % 3);
                place(guise, std::ldexp(shift, exponent));
                if (count_++ % 2 == 1) swap(guise);
                guise.id = name + (exponent == 0  ? ""
                                   : exponent > 0 ? " times 2^20"
                                                  : " times 2^-20");
                if (shift != 0) guise.id += " far away";
                if (guise.a.is_convex && guise.b.is_convex) find_truth(guise);
                made_.push_back(std::move(guise));
            }
        }
    }
    [[nodiscard]] std::vector<HardContact> take() {
        return std::move(made_);
    }

private:
    static void find_truth(HardContact& hard) {
        const Points a = hard.points_a(), b = hard.points_b();
        Points ways = candidates(*hard.a.mesh, a, *hard.b.mesh, b);
        ways.insert(ways.end(), hard.allowed.begin(), hard.allowed.end());
        hard.allowed.clear();
        std::vector<long double> far;
        for (const Double3& way : ways) far.push_back(reach(way, a, b));
        const auto farthest = static_cast<double>(*std::max_element(far.begin(), far.end()));
        // A gap is known by hand, and checked; a depth that is not is what was found.
        if (std::isnan(hard.separation)) {
            if (farthest > 0) fail(hard, "apart");
            hard.separation = farthest;
        }
        const double rounding = hard.rounding();
        if (std::fabs(farthest - hard.separation) > rounding) fail(hard, "not as constructed");
        const bool is_deep = hard.id.starts_with("K06") || hard.id.starts_with("K07");
        const double allowed = hard.separation * (is_deep ? 2 : 1) - rounding;
        for (std::size_t i = 0; i < ways.size(); ++i) {
            if (far[i] >= hard.separation - rounding) hard.normals.push_back(ways[i]);
            if (far[i] >= allowed) hard.allowed.push_back(ways[i]);
        }
        // Of vertex and edge that touch, all other directions in between are as right.
        if (hard.separation == 0 && hard.id.starts_with("K04")) hard.normals.clear();
    }

    void scale(HardContact& hard, int exponent) {
        if (exponent == 0) return;
        const double by = std::ldexp(1.0, exponent);
        for (ContactBody* body : {&hard.a, &hard.b}) {
            auto& [kept, made] = scaled_[{body->mesh.get(), exponent}];
            if (!made) {
                kept = body->mesh;
                made = shared(moved_by(*body->mesh, by, {}));
            }
            body->mesh = made;
            body->pose = with_shift(body->pose, by * body->pose.translation());
        }
        for (Double3& p : hard.outline) p = by * p;
        hard.size *= by;
        hard.separation *= by;
        hard.tolerance *= by;
    }
    /// About the diagonal, so that no number is rounded.
    static void turn(HardContact& hard, std::size_t turns) {
        for (std::size_t i = 0; i < turns; ++i) {
            const auto next = [](const Double3& p) { return Double3{p.z, p.x, p.y}; };
            for (ContactBody* body : {&hard.a, &hard.b}) {
                const auto& r = body->pose.rotation();
                const Double3 t = next(body->pose.translation());
                body->pose = Pose::from_rows({r[6], r[7], r[8], r[0], r[1], r[2], r[3], r[4], r[5],
                                              t.x, t.y, t.z})
                                 .value();
            }
            for (Points* points : {&hard.normals, &hard.allowed, &hard.outline}) {
                for (Double3& p : *points) p = next(p);
            }
        }
    }
    static void place(HardContact& hard, double shift) {
        if (shift == 0) return;
        const Double3 by = {shift, -shift, shift};
        for (ContactBody* body : {&hard.a, &hard.b}) {
            body->pose = with_shift(body->pose, body->pose.translation() + by);
        }
        for (Double3& p : hard.outline) p = p + by;
    }
    static void swap(HardContact& hard) {
        std::swap(hard.a, hard.b);
        hard.is_swapped = true;
        for (Points* points : {&hard.normals, &hard.allowed}) {
            for (Double3& p : *points) p = -1 * p;
        }
    }

    std::string family_;
    std::size_t count_ = 0;
    std::vector<HardContact> made_;
    std::map<std::pair<const TestMesh*, int>, std::pair<MeshPointer, MeshPointer>> scaled_;
};

constexpr Double3 kUp = {0, 0, 1};

HardContact named(std::string id, MeshPointer a, MeshPointer b, const Pose& pose_b,
                  double separation) {
    HardContact hard;
    hard.id = std::move(id);
    hard.a.mesh = std::move(a);
    hard.b.mesh = std::move(b);
    hard.b.pose = pose_b;
    hard.separation = separation;
    // Half as far again as the gap or the depth.
    hard.tolerance = std::isnan(separation) ? 0x1p-6 : 1.5 * std::fabs(separation) + 0x1p-10;
    return hard;
}

std::string text(double number) {
    std::array<char, 32> made{};
    std::snprintf(made.data(), made.size(), "%g", number);
    return made.data();
}

/// S16: the lowest vertex of a rough ball is below the box's top by the depth.
void add_scans(Maker& maker) {
    if (!maker.wants("S16")) return;
    const MeshPointer floor = box({-20, -20, -1}, {20, 20, 0});
    const std::array<MeshPointer, 2> scans = {rough_ball(3, {1, 1, 1}, 0.02, 1),
                                              rough_ball(3, {1.5, 1, 0.75}, 0.05, 2)};
    int number = 0;
    for (const MeshPointer& scan : scans) {
        for (const double depth : {0.005, 0.0125, 0.025, -0.005}) {
            for (int turn = 0; turn < 3; ++turn) {
                const Double3 axis = {1, 0.3 * turn, -0.2};
                const double angle = 0.7 + 1.1 * number;
                const Double3 at = {0.37 * number, turn == 0 ? 0.37 * number : -1.3, 0};
                double lowest = 0;
                for (const Double3& p : moved(*scan, turned_by(axis, angle))) {
                    lowest = std::min(lowest, p.z);
                }
                const Pose pose = turned_by(axis, angle, {at.x, at.y, -lowest - depth});
                HardContact hard = named("S16 " + std::string(scan == scans[0] ? "ball" : "blob") +
                                             " depth " + text(depth) + " turn " + text(turn),
                                         floor, scan, pose, -depth);
                hard.tolerance = depth < 0 ? -3 * depth : 0;
                hard.b.is_convex = false;
                hard.b.in_triangles = number++ % 2 == 1;
                hard.normals = hard.allowed = {kUp};
                maker.add(std::move(hard));
            }
        }
    }
}

void add_stacks(Maker& maker) {
    if (!maker.wants("K01")) return;
    const MeshPointer cube = plate(1, 1), thin = plate(4, 0x1p-4);
    struct Stack {
        const char* name;
        MeshPointer a;
        MeshPointer b;
    };
    for (const Stack& stack :
         {Stack{"cube on cube", cube, cube}, Stack{"plate on plate", thin, thin},
          Stack{"cube on plate", thin, cube}}) {
        const double high = (stack.a == cube ? 0.5 : 0x1p-5) + (stack.b == cube ? 0.5 : 0x1p-5);
        for (const double angle : {0.0, 7.0, 30.0, 45.0, 80.0}) {
            for (const double gap : {0x1p-7, 0.0, -0x1p-7}) {
                const Double3 at = {0.25, angle == 0 ? 0.375 : 0.0625, high + gap};
                HardContact hard =
                    named(std::string("K01 ") + stack.name + " turned by " + text(angle) + " gap " +
                              text(gap),
                          stack.a, stack.b, turned_by(kUp, angle * kDegree, at), gap);
                const auto square = [&](const MeshPointer& mesh, const Pose& pose) {
                    const double half = mesh == cube ? 0.5 : 2;
                    Points corners = {
                        {-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
                    for (Double3& p : corners) {
                        p = transform_point(pose, p);
                        p.z = stack.a == cube ? 0.5 : 0x1p-5;
                    }
                    return corners;
                };
                hard.outline = clipped(square(stack.b, hard.b.pose), square(stack.a, Pose()));
                maker.add(std::move(hard));
            }
        }
    }
}

void add_slides(Maker& maker) {
    if (!maker.wants("K02")) return;
    constexpr int kSquares = 100;
    const MeshPointer floor = shared(grid_sheet(kSquares, kSquares)), cube = plate(1, 1),
                      ball = shared(moved_by(icosphere(1), 0.75, {}));
    int number = 0;
    for (const MeshPointer& slider : {cube, ball}) {
        double lowest = 0;
        for (const Double3& p : slider->positions) lowest = std::min(lowest, p.z);
        for (const double gap : {0x1p-5, 0.0, -0x1p-5}) {
            for (int step = 0; step < 8; ++step) {
                // Some stand with their sides on the grid's lines.
                const Double3 at = {20.5 + (step < 2 ? step : 2.137 * step),
                                    40 + (step < 4 ? 0.5 * step : 1.311 * step), gap - lowest};
                const double angle = step % 3 == 0 ? 0 : 13 * step;
                HardContact hard = named("K02 " + std::string(slider == cube ? "cube" : "ball") +
                                             " step " + text(step) + " gap " + text(gap),
                                         floor, slider, turned_by(kUp, angle * kDegree, at), gap);
                hard.a.is_convex = false;
                hard.a.in_triangles = number++ % 2 == 0;
                hard.normals = hard.allowed = {kUp};
                maker.add(std::move(hard));
            }
        }
    }
}

/// Upside down, turned about the vertical, shifted.
Pose upside_down(double angle, const Double3& shift) {
    const double c = std::cos(angle / 2), s = std::sin(angle / 2);
    return Pose::from_quaternion(0, c, s, 0, shift).value();
}

void add_edges(Maker& maker) {
    if (!maker.wants("K03")) return;
    const MeshPointer ridge = roof();
    for (const double angle : {10.0, 30.0, 45.0, 60.0, 90.0, 135.0}) {
        for (const double gap : {0x1p-5, 0.0, -0x1p-8}) {
            for (const Double3& at :
                 {Double3{}, Double3{0.375, 0, 0}, Double3{-0.25, 0.03125, 0}}) {
                maker.add(
                    named("K03 at " + text(angle) + " degrees gap " + text(gap), ridge, ridge,
                          upside_down(angle * kDegree, {at.x, at.y, gap}), gap < 0 ? NAN : gap),
                    {kUp});
            }
        }
    }
}

void add_vertices_on_edges(Maker& maker) {
    if (!maker.wants("K04")) return;
    const MeshPointer ridge = roof();
    for (const double steep : {0.5, 1.0, 4.0}) {
        const MeshPointer tip = octahedron(steep);
        for (const double angle : {0.0, 20.0, 45.0}) {
            for (const double gap : {0x1p-5, 0.0, -0x1p-6}) {
                for (const double x : {0.0, 0.375}) {
                    Points fan;
                    for (int i = -45; i <= 45; ++i) {
                        fan.push_back({0, std::sin(i * kDegree), std::cos(i * kDegree)});
                    }
                    if (gap != 0) fan = {kUp};
                    maker.add(named("K04 steepness " + text(steep) + " turned by " + text(angle) +
                                        " gap " + text(gap),
                                    ridge, tip, turned_by(kUp, angle * kDegree, {x, 0, gap}),
                                    gap < 0 ? NAN : gap),
                              fan);
                }
            }
        }
    }
}

void add_vertices_on_faces(Maker& maker) {
    if (!maker.wants("K05")) return;
    const MeshPointer base = box({-1, -1, -2}, {1, 1, 0});
    for (const double steep : {0.5, 1.0, 4.0}) {
        const MeshPointer tip = octahedron(steep);
        // The first two lie on the line that divides the square into triangles, one way or the
        // other.
        for (const Double3& at :
             {Double3{}, Double3{0.25, 0.25, 0}, Double3{-0.25, 0.25, 0}, Double3{0.3, -0.1, 0}}) {
            for (const double gap : {0x1p-5, 0.0, -0x1p-6}) {
                maker.add(named("K05 steepness " + text(steep) + " at " + text(at.x) + " " +
                                    text(at.y) + " gap " + text(gap),
                                base, tip, turned_by(kUp, 0.3, {at.x, at.y, gap}), gap),
                          {kUp});
            }
        }
    }
}

void add_plates(Maker& maker) {
    if (!maker.wants("K06")) return;
    for (const double thickness : {0x1p-4, 0x1p-8, 0x1p-12}) {
        const MeshPointer thin = plate(2, thickness);
        for (const double angle : {90.0, 60.0, 45.0, 20.0}) {
            for (const Double3& at :
                 {Double3{}, Double3{0.3, 0.2, 0.05}, Double3{1, 0, 0}, Double3{0.1, -0.7, 0.01}}) {
                for (const Double3& axis : {Double3{1, 0, 0}, Double3{1, 0.4, 0.2}}) {
                    maker.add(named("K06 2^" + text(std::log2(thickness)) + " thick at " +
                                        text(angle) + " degrees shifted by " + text(at.x) + " " +
                                        text(at.y) + " " + text(at.z),
                                    thin, thin, turned_by(axis, angle * kDegree, at), NAN));
                }
            }
        }
    }
}

void add_deep_cubes(Maker& maker) {
    if (!maker.wants("K07")) return;
    const MeshPointer cube = plate(1, 1);
    const std::array<Double3, 3> axes = {{{0, 0, 1}, {1, 1, 0}, {0.3, -0.5, 0.8}}};
    const std::array<Double3, 4> ways = {
        {{0, 0, 1}, {0.3, 0, 1}, {0.5, 0.4, 0.7}, {-0.2, 0.9, 0.1}}};
    for (const double angle : {0.0, 20.0, 45.0, 77.0}) {
        for (const Double3& axis : axes) {
            if (angle == 0 && axis.x != 0) continue;
            for (std::size_t way = 0; way < ways.size(); ++way) {
                for (const double distance : {0.875, 0.625, 0.25, 0.03125}) {
                    maker.add(named(
                        "K07 turned by " + text(angle) + " about " + text(axis.x) + " " +
                            text(axis.y) + " " + text(axis.z) + " way " +
                            text(static_cast<double>(way)) + " distance " + text(distance),
                        cube, cube, turned_by(axis, angle * kDegree, distance * ways[way]), NAN));
                }
            }
        }
    }
}

}  // namespace

Placement HardContact::placement() const {
    if (a.pose.rotation() == Pose().rotation() && a.pose.translation() == Double3{}) {
        return Placement::b_moves(b.pose);
    }
    return Placement::world(a.pose, b.pose);
}

std::vector<Double3> HardContact::points_a() const {
    return moved(*a.mesh, a.pose);
}
std::vector<Double3> HardContact::points_b() const {
    return moved(*b.mesh, b.pose);
}

double HardContact::rounding() const {
    return 0x1p-48 * largest();
}
double HardContact::largest() const {
    double largest = 0;
    for (const Points& points : {points_a(), points_b(), a.mesh->positions, b.mesh->positions}) {
        for (const Double3& p : points) {
            largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
        }
    }
    return largest;
}

std::vector<HardContact> hard_contacts(const std::string& family) {
    Maker maker(family);
    add_scans(maker);
    add_stacks(maker);
    add_slides(maker);
    add_edges(maker);
    add_vertices_on_edges(maker);
    add_vertices_on_faces(maker);
    add_plates(maker);
    add_deep_cubes(maker);
    return maker.take();
}

long double reach(const Double3& normal, std::span<const Double3> a, std::span<const Double3> b) {
    const auto along = [&](const Double3& p) {
        return static_cast<long double>(normal.x) * p.x + static_cast<long double>(normal.y) * p.y +
               static_cast<long double>(normal.z) * p.z;
    };
    long double last = along(a.front()), first = along(b.front());
    for (const Double3& p : a) last = std::max(last, along(p));
    for (const Double3& p : b) first = std::min(first, along(p));
    return first - last;
}

double length_of(const Double3& v) {
    return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

double angle_between(const Double3& a, const Double3& b) {
    return std::atan2(length_of(cross(a, b)), a.x * b.x + a.y * b.y + a.z * b.z);
}

}  // namespace cdprep::test
