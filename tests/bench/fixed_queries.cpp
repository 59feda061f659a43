// SPDX-License-Identifier: MIT
// Asks one fixed question about two generated models, many times over: what
// count_instructions runs under callgrind.
//
// Usage: fixed_queries QUESTION TIMES
// QUESTION is overlap, collide_hit, collide_miss, distance, within, pairs_within,
// ray, ray_miss, ray_any, closest, box, box_turned, sphere, capsule, triangle, to_capsule or
// to_triangle.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cdprep/pairs.h"
#include "cdprep/points.h"
#include "support/open_tiny.h"

namespace {

using namespace cdprep;

Placement turned(double x) {
    return Placement::b_moves(Pose::from_quaternion(5, 1, 2, 3, {x, 0.1, 0.05}).value());
}

/// Questions about the ring and a ray, point or shape; nothing for another question.
std::optional<double> ask_ring(const std::string& question, const Model& ring, Workspace& workspace,
                               std::span<std::uint32_t> triangles) {
    const Ray ray = {{3, 0.2, 0.1}, {-1, 0, 0.01}};
    const Ray upwards = {{0.1, 0.2, -3}, {0.01, 0, 1}};  // through the hole
    const Box box = {{0.8, 0.1, -0.1}, {1.3, 0.6, 0.3}};
    const Box larger = {{0.2, 0.1, -0.6}, {1.3, 1.2, 0.6}};
    const Sphere sphere = {{0.9, 0.3, 0.1}, 0.3};
    const Capsule capsule = {{0.9, 0.3, 0.1}, {0.2, 0.1, 0.5}, 0.1};
    const Capsule above = {{0.9, 0.3, 0.9}, {0.2, 0.1, 0.8}, 0.1};
    const TriangleShape triangle = {{{{0.9, 0.3, 0.1}, {0.2, 0.1, 0.5}, {0.8, 0.9, 0.2}}}};
    const TriangleShape nearby = {{{{0.9, 0.3, 0.9}, {0.2, 0.1, 0.8}, {0.8, 0.9, 0.7}}}};
    const auto all = [&](const auto& shape, const ShapeOptions& options = {}) {
        return static_cast<double>(touching_triangles(ring, shape, workspace, triangles, options));
    };
    if (question == "ray") return cast_ray(ring, ray, workspace)->t;
    if (question == "ray_miss") return cast_ray(ring, upwards, workspace) ? 1 : 0;
    if (question == "ray_any") return ray_hits(ring, ray, workspace) ? 1 : 0;
    if (question == "closest") return closest_point(ring, {0.3, 0.2, 0.9}, workspace)->upper;
    if (question == "box") return all(box);
    if (question == "box_turned") return all(larger, {turned(0.1).pose_b()});
    if (question == "sphere") return all(sphere);
    if (question == "capsule") return all(capsule);
    if (question == "triangle") return all(triangle);
    if (question == "to_capsule") return shape_distance(ring, above, workspace)->upper;
    if (question == "to_triangle") return shape_distance(ring, nearby, workspace)->upper;
    return std::nullopt;
}

/// Returns something of the answer.
double ask(const std::string& question, const Model& ball, const Model& ring, Workspace& workspace,
           std::vector<TrianglePair>& pairs) {
    const Pair crossing = {ball, ring, turned(0.4)};
    const Pair apart = {ball, ring, turned(2.5)};
    const auto hits = [&](const Pair& pair) {
        return collide(pair, workspace).hit == Answer::yes ? 1.0 : 0.0;
    };
    if (question == "overlap") {
        return static_cast<double>(overlaps(crossing, workspace, pairs));
    }
    if (question == "collide_hit") return hits(crossing);
    if (question == "collide_miss") return hits(apart);
    if (question == "distance") return distance(apart, workspace)->upper;
    if (question == "within") return within(apart, 0.01, workspace) ? 1 : 0;
    if (question == "pairs_within") {
        return static_cast<double>(pairs_within(crossing, 0.02, workspace, pairs));
    }
    static std::array<std::uint32_t, 4096> triangles;
    if (const auto answer = ask_ring(question, ring, workspace, triangles)) return *answer;
    std::fprintf(stderr, "fixed_queries: no query '%s'\n", question.c_str());
    std::exit(2);
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 3) {
        std::fprintf(stderr, "usage: %s QUESTION TIMES\n", arguments[0]);
        return 2;
    }
    const test::OpenModel ball = test::open_tiny(test::icosphere(4));
    const test::OpenModel ring = test::open_tiny(test::torus(1, 0.25, 64, 32));
    Workspace workspace;
    std::vector<TrianglePair> pairs(100'000);
    double sum = 0;
    for (int i = 0; i < std::atoi(arguments[2]); ++i) {
        sum += ask(arguments[1], ball.model, ring.model, workspace, pairs);
    }
    std::printf("%s %g\n", arguments[1], sum);
}
