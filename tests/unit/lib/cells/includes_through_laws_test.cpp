// SPDX-License-Identifier: MIT
#include "cdprep/points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "support/brute_force.h"
#include "support/every_structure.h"
#include "support/exact_winding.h"

#include "cdprep/advanced/query_counts.h"
#include "cdprep/cells.h"

namespace cdprep::test {
namespace {

Double3 grid_point(std::mt19937& random, int grid) {
    std::uniform_int_distribution<int> step(-grid, grid);
    const int x = step(random), y = step(random), z = step(random);
    return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

/// Tetrahedra on a grid, any way round, some flat: closed, self-crossing, with corners,
/// edges and faces in common.
TestMesh tetrahedra(std::mt19937& random, int count, int grid) {
    TestMesh mesh;
    for (int i = 0; i < count; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int k = 0; k < 4; ++k) mesh.positions.push_back(grid_point(random, grid));
        for (const auto& [a, b, c] : {std::array{0U, 1U, 2U}, std::array{1U, 0U, 3U},
                                      std::array{2U, 1U, 3U}, std::array{0U, 2U, 3U}}) {
            mesh.triangles.push_back({{first + a, first + b, first + c}});
        }
    }
    return mesh;
}

bool same(const Inclusion& a, const Inclusion& b) {
    return a.answer == b.answer && a.on_surface == b.on_surface && a.winding == b.winding;
}

/// What exact rays say, in the product's words.
Inclusion inclusion_of(const std::optional<int>& winding) {
    if (!winding) return {Answer::yes, true, 0};
    return {*winding != 0 ? Answer::yes : Answer::no, false, static_cast<double>(*winding)};
}

struct Seen {
    int on_surface = 0, outside = 0, inside = 0;

    void add(const Inclusion& found) {
        ++(found.on_surface ? on_surface : found.answer == Answer::no ? outside : inside);
    }
};

void expect_everywhere(const Model& model, const Double3& q, const Inclusion& truth,
                       const std::string& where) {
    Workspace workspace(cells());
    for (const Structure structure : kStructures) {
        const Inclusion found = points_inside(model, q, workspace, structure);
        EXPECT_TRUE(same(found, truth))
            << name_of(structure) << ", " << where << ": winding " << found.winding << " for "
            << truth.winding << ", on the surface " << found.on_surface << " for "
            << truth.on_surface;
    }
}

// Points on a half grid, so that they and their rays lie on corners, edges, planes of
// cells and borders of cones; in between, points next to those.
TEST(IncludesThroughLaws, EveryStructureAgreesWithExactRays) {
    constexpr std::uint32_t kSeed = 81;
    std::mt19937 random(kSeed);
    Seen seen;
    for (const int exponent : {0, -1000, -300, 40, 900}) {
        const double scale = std::ldexp(1.0, exponent);
        for (int round = 0; round < 8 && !::testing::Test::HasFailure(); ++round) {
            const TestMesh mesh = moved_by(tetrahedra(random, 3 + 4 * round, 4), scale, {0, 0, 0});
            const OpenModel model = open_with_every_structure(
                mesh, {.level = static_cast<std::uint32_t>(round % 7), .threshold = 2});
            const std::vector<Corners> surface = surface_of(mesh);
            for (int i = 0; i < 40; ++i) {
                const Double3 half = grid_point(random, 7);
                Double3 q{scale * half.x / 2, scale * half.y / 2, scale * half.z / 2};
                if (i % 5 == 0) q.y = std::nextafter(q.y, scale * 9);
                if (i % 5 == 1) q.z = std::nextafter(q.z, -scale * 9);
                const Inclusion truth = inclusion_of(exact_winding(surface, q));
                expect_everywhere(model.model, q, truth,
                                  "seed " + std::to_string(kSeed) + ", 2^" +
                                      std::to_string(exponent) + ", round " +
                                      std::to_string(round) + ", point " + std::to_string(i));
                seen.add(truth);
            }
        }
    }
    EXPECT_GT(seen.on_surface, 100);
    EXPECT_GT(seen.outside, 200);
    EXPECT_GT(seen.inside, 200);
}

/// All answers at some points, through every structure, which must be one.
std::vector<double> windings(const TestMesh& mesh, const std::vector<Double3>& points,
                             const Division& division = {}) {
    const OpenModel open = open_with_every_structure(mesh, division);
    Workspace workspace(cells());
    std::vector<double> all;
    for (const Double3& q : points) {
        const Inclusion truth = points_inside(open.model, q, workspace);
        expect_everywhere(open.model, q, truth, "beside the hierarchy");
        all.push_back(truth.on_surface ? std::numeric_limits<double>::infinity() : truth.winding);
    }
    return all;
}

std::vector<Double3> half_grid_points(std::mt19937& random, int count, int grid) {
    std::vector<Double3> points;
    for (int i = 0; i < count; ++i) {
        const Double3 p = grid_point(random, grid);
        points.push_back({0.5 * p.x, 0.5 * p.y, 0.5 * p.z});
    }
    return points;
}

// A law: the surface is the same. Vertices that no triangle uses take the centre, from
// which the tetra-tree's rays run, elsewhere, and far outside.
TEST(IncludesThroughLaws, OrderFirstCornersAndCentreDoNotMatter) {
    constexpr std::uint32_t kSeed = 82;
    std::mt19937 random(kSeed);
    int inside = 0, asked = 0;
    for (int round = 0; round < 12; ++round) {
        TestMesh mesh = tetrahedra(random, 12, 3);
        const auto points = half_grid_points(random, 40, 4);
        const auto before = windings(mesh, points);
        std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
        for (Triangle& t : mesh.triangles) {
            std::rotate(t.vertex.begin(), t.vertex.begin() + (round + t.vertex[0]) % 3,
                        t.vertex.end());
        }
        ASSERT_EQ(windings(mesh, points), before) << kSeed << ' ' << round;
        for (const double far : {0.0, 1.0, 100.0}) {
            const Double3 p = grid_point(random, 5);
            mesh.positions.insert(mesh.positions.end(), 40, {far * p.x, far * p.y, far * p.z});
            ASSERT_EQ(windings(mesh, points), before) << kSeed << ' ' << round << ' ' << far;
        }
        for (const double winding : before) {
            ++asked;
            inside += winding != 0 ? 1 : 0;
        }
    }
    EXPECT_GT(inside, asked * 3 / 10);
    EXPECT_LT(inside, asked * 7 / 10);
}

/// By the divergence theorem; for a mesh near the origin.
double volume_of(const std::vector<Corners>& surface) {
    double six_times = 0;
    for (const auto& [a, b, c] : surface) {
        six_times += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                     a.z * (b.x * c.y - b.y * c.x);
    }
    return six_times / 6;
}

double area_of(const std::vector<Corners>& surface) {
    double area = 0;
    for (const auto& [a, b, c] : surface) {
        const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
        const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
        area += 0.5 * std::hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx);
    }
    return area;
}

/// The winding numbers in n^3 cells of about [-2, 2]^3, times a cell's volume. Asked off
/// the middles, lest all halves of a shape err alike.
double volume_by_counting(Structure structure, const Model& model, int n) {
    Workspace workspace(cells());
    const double edge = 4.0 / n;
    double sum = 0;
    for (int i = 0; i < n * n * n; ++i) {
        const Double3 q{edge * (i % n + 0.37) - 2, edge * (i / n % n + 0.61) - 2,
                        edge * (i / n / n + 0.53) - 2};
        sum += points_inside(model, q, workspace, structure).winding;
    }
    return sum * edge * edge * edge;
}

// A law: the sum tends to the signed volume. A point of space and the one asked for its
// cell are less than 1.04 edges apart, and differ by what the way between them crosses:
// edge times area is a bound that is proved, and a sixteenth of it what errors of both
// signs leave.
TEST(IncludesThroughLaws, WindingNumbersOfAFineGridAddUpToTheVolume) {
    const TestMesh ball = moved_by(icosphere(3), 1.25, {0.125, 0.0625, 0});
    const TestMesh ring = torus(1.25, 0.5, 40, 20);
    const TestMesh cavity = reversed(moved_by(icosphere(2), 0.5, {0, 0, 0.25}));
    for (const TestMesh& mesh : {ball, ring, joined(ball, cavity),
                                 joined(ring, moved_by(ring, 0.75, {0.5, 0, 0})), reversed(ring)}) {
        const OpenModel open = open_with_every_structure(mesh, {.level = 4, .threshold = 8});
        const std::vector<Corners> surface = surface_of(mesh);
        for (const int n : {8, 16, 32}) {
            for (const Structure structure : kStructures) {
                EXPECT_NEAR(volume_by_counting(structure, open.model, n), volume_of(surface),
                            4.0 / n * area_of(surface) / 16)
                    << name_of(structure) << ", " << n;
            }
        }
    }
}

// Beside the exact rays' few points many, of models with layers, holes and corners, at any
// size and place; the hierarchy is what exact rays were held against at length.
TEST(IncludesThroughLaws, LargeModelsAgreeWithTheHierarchy) {
    constexpr std::uint32_t kSeed = 83;
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> component(-1.75, 1.75);
    const TestMesh two = joined(torus(1, 0.5, 24, 12), moved_by(icosphere(1), 0.75, {0.5, 0, 0}));
    Seen seen;
    for (const auto& [scale, shift] :
         {std::array{1.0, 0.0}, std::array{1e-3, 1e6}, std::array{0x1p-1000, 0.0},
          std::array{0x1p990, 0.0}, std::array{0x1p-1060, 0.0}}) {
        const TestMesh mesh = moved_by(two, scale, {shift, -shift, shift});
        for (const std::uint32_t level : {2U, 7U}) {
            const OpenModel open =
                open_with_every_structure(mesh, {.level = level, .threshold = 4});
            Workspace workspace(cells());
            for (int i = 0; i < 300; ++i) {
                const double x = component(random), y = component(random), z = component(random);
                Double3 q{scale * x + shift, scale * y - shift, scale * z * 0.5 + shift};
                const Double3& v = mesh.positions[random() % mesh.positions.size()];
                if (i % 4 == 0) q = v;
                if (i % 4 == 1) q = {q.x, v.y, v.z};
                const Inclusion truth = points_inside(open.model, q, workspace);
                expect_everywhere(open.model, q, truth,
                                  "seed " + std::to_string(kSeed) + ", times " +
                                      std::to_string(scale) + ", level " + std::to_string(level) +
                                      ", point " + std::to_string(i));
                seen.add(truth);
            }
            if (HasFailure()) return;
        }
    }
    EXPECT_GT(seen.on_surface, 600);
    EXPECT_GT(seen.inside, 700);
    EXPECT_GT(seen.outside, 700);
}

// The centre and its neighbours among the doubles, where rays are shortest.
TEST(IncludesThroughLaws, PointsNextToTheCentreAreAnsweredExactly) {
    constexpr std::uint32_t kSeed = 84;
    std::mt19937 random(kSeed);
    Seen seen;
    for (int round = 0; round < 60; ++round) {
        const TestMesh mesh = tetrahedra(random, 6, 2);
        const OpenModel open = open_with_every_structure(mesh, {.level = 1U + round % 5U});
        const std::vector<Corners> surface = surface_of(mesh);
        const Double3 c = open.model.tetra_tree().tree->centre;
        for (int i = 0; i < 27; ++i) {
            const auto beside = [](double x, int step) {
                return step == 0 ? x : std::nextafter(x, step == 1 ? 9.0 : -9.0);
            };
            const Double3 q{beside(c.x, i % 3), beside(c.y, i / 3 % 3), beside(c.z, i / 9)};
            const Inclusion truth = inclusion_of(exact_winding(surface, q));
            expect_everywhere(open.model, q, truth,
                              "seed " + std::to_string(kSeed) + ", round " + std::to_string(round) +
                                  ", point " + std::to_string(i));
            seen.add(truth);
        }
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_GT(seen.on_surface, 15);
    EXPECT_GT(seen.inside, 300);
    EXPECT_GT(seen.outside, 300);
}

}  // namespace
}  // namespace cdprep::test
