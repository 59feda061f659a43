// SPDX-License-Identifier: MIT
// A stranger's program: asks two models, and prints every answer bit for bit. What it prints does
// not depend on how it is compiled. Its own numbers are small integers times powers of two, which
// no option rounds.
//
// Usage: answers BALL RING
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/advanced/convex_penetration.h"
#include "cdprep/hulls.h"
#include "cdprep/pairs.h"
#include "cdprep/points.h"

namespace {

using namespace cdprep;

void print(double number) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    std::printf(" %016llx", static_cast<unsigned long long>(bits));
}

void print(const Double3& p) {
    print(p.x);
    print(p.y);
    print(p.z);
}

void end_line(const char* what) {
    std::printf(" %s\n", what);
}

/// The same numbers on every machine.
class Dice {
public:
    /// A multiple of 2^-16 in [-2, 2).
    double number() {
        state_ = state_ * 6364136223846793005U + 1442695040888963407U;
        const auto step = static_cast<std::int32_t>(state_ >> 46U) - (1 << 17);
        return static_cast<double>(step) * 0x1p-16;
    }
    Double3 point() {
        const double x = number(), y = number(), z = number();
        return {x, y, z};
    }

private:
    std::uint64_t state_ = 1;
};

void print_points(Dice& dice) {
    const Pose pose = Pose::from_quaternion(5, 1, 2, 3, {0.375, 0.125, 0.0625}).value();
    const Pose both = relative_pose(pose, Pose::from_quaternion(1, 2, 0, 1, {1, 2, 3}).value());
    print(both.translation());
    for (const double number : both.rotation()) print(number);
    end_line("relative_pose");
    for (int i = 0; i < 1000; ++i) {
        const Double3 p = dice.point();
        print(transform_point(pose, p));
        std::printf(" %u", direction_cell(p));
        end_line("moved");
    }
}

void print_pairs(const Model& a, const Model& b, const Placement& placement, Workspace& workspace) {
    std::vector<TrianglePair> pairs(100'000);
    pairs.resize(overlaps({a, b, placement}, workspace, pairs));
    for (const TrianglePair& pair : pairs) std::printf("%u %u\n", pair.a, pair.b);
    const auto visit = [](const Crossing& crossing) {
        print(crossing.from);
        print(crossing.to);
        end_line("crossing");
        return true;
    };
    visit_crossings({a, b, placement}, workspace, visit);
    if (const auto found = distance({a, b, placement}, workspace)) {
        print(found->lower);
        print(found->upper);
        print(found->witness_a);
        print(found->witness_b);
    }
    const Collision solid = collide({a, b, placement, {.body = Body::solid}}, workspace);
    std::printf(" %d %zu", static_cast<int>(solid.hit),
                pairs_within({a, b, placement}, 0x1p-6, workspace, {}));
    end_line("pair");
    const ConvexPoints hull_a = convex_points(a, 0), hull_b = convex_points(b, 0);
    if (const auto found = convex_distance(hull_a, hull_b, placement)) print(found->upper);
    if (const auto found = convex_penetration(hull_a, hull_b, placement)) {
        print(found->upper);
        print(found->normal);
    }
    for (std::uint32_t i = 0; i < hull_a.count; ++i) print(hull_a.point(i));
    end_line("hulls");
}

void print_places(const Model& model, Dice& dice, Workspace& workspace) {
    std::vector<RayHit> hits(100);
    for (int i = 0; i < 200; ++i) {
        const Double3 at = dice.point(), to = dice.point();
        if (const auto near = closest_point(model, at, workspace)) {
            print(near->point);
            print(near->upper);
        }
        const std::size_t count = all_ray_hits(model, {at, to}, workspace, hits);
        for (std::size_t k = 0; k < count; ++k) {
            print(hits[k].t);
            print(hits[k].point);
            std::printf(" %d", k > 0 && hits[k - 1] < hits[k] ? 1 : 0);
        }
        const Inclusion in = points_inside(model, at, workspace);
        std::printf(" %d", static_cast<int>(in.answer));
        const Sphere sphere = {at, 0.25};
        std::printf(" %zu", touching_triangles(model, sphere, workspace, {}));
        if (const auto far = shape_distance(model, Capsule{at, to, 0.125}, workspace)) {
            print(far->upper);
            print(far->on_shape);
        }
        end_line("place");
    }
}

void print_bvh(Dice& dice) {
    std::vector<Double3> corners;
    std::vector<format::Triangle> triangles;
    for (std::uint32_t i = 0; i < 300; ++i) {
        for (int k = 0; k < 3; ++k) corners.push_back(dice.point());
        triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}});
    }
    const build::Bvh bvh =
        build::build_bvh(corners, triangles, {.bounds = build::BvhBounds::oriented_and_swept});
    for (const std::uint32_t triangle : bvh.order) std::printf(" %u", triangle);
    for (const format::OrientedNode& node : bvh.oriented_nodes) {
        for (const auto& row : node.centre) {
            for (const float number : row) print(static_cast<double>(number));
        }
    }
    print(build::surface_cost(bvh));
    end_line("build_bvh");
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 3) return 2;
    const auto ball = Model::open(arguments[1]);
    const auto ring = Model::open(arguments[2]);
    if (!ball || !ring) {
        std::puts((!ball ? ball : ring).error().message.c_str());
        return 1;
    }
    Workspace workspace;
    Dice dice;
    print_points(dice);
    for (const double x : {0.25, 0.75, 2.5}) {
        const Pose pose = Pose::from_quaternion(5, 1, 2, 3, {x, 0.125, 0.0625}).value();
        print_pairs(ball.value(), ring.value(), Placement::b_moves(pose), workspace);
    }
    print_places(ball.value(), dice, workspace);
    print_places(ring.value(), dice, workspace);
    print_bvh(dice);
    return 0;
}
