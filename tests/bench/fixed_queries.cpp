// SPDX-License-Identifier: MIT
// Asks one fixed question about two generated models, many times over: what
// count_instructions runs under callgrind.
//
// Usage: fixed_queries QUESTION TIMES
// QUESTION is overlap, collide_hit, collide_miss, distance, within, ray or closest.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "cdprep/cast_ray.h"
#include "cdprep/closest_point.h"
#include "cdprep/collide.h"
#include "cdprep/distance.h"
#include "support/open_tiny.h"

namespace {

using namespace cdprep;

Placement turned(double x) {
    return Placement::b_moves(Pose::from_quaternion(5, 1, 2, 3, {x, 0.1, 0.05}).value());
}

/// Returns something of the answer.
double ask(const std::string& question, const Model& ball, const Model& ring, Workspace& workspace,
           std::vector<TrianglePair>& pairs) {
    const Placement crossing = turned(0.4);
    const Placement apart = turned(2.5);
    if (question == "overlap") {
        return static_cast<double>(overlapping_triangles(ball, ring, crossing, workspace, pairs));
    }
    if (question == "collide_hit") return collide(ball, ring, crossing, workspace).hit ? 1 : 0;
    if (question == "collide_miss") return collide(ball, ring, apart, workspace).hit ? 1 : 0;
    if (question == "distance") return distance(ball, ring, apart, workspace)->upper;
    if (question == "within") return is_within(ball, ring, apart, 0.01, workspace) ? 1 : 0;
    if (question == "ray") return cast_ray(ring, {{3, 0.2, 0.1}, {-1, 0, 0.01}}, workspace)->t;
    if (question == "closest") return closest_point(ring, {0.3, 0.2, 0.9}, workspace)->upper;
    std::fprintf(stderr, "fixed_queries: no question '%s'\n", question.c_str());
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
