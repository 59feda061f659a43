// SPDX-License-Identifier: MIT
#include "cdprep/includes_through.h"

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

#include "cdprep/query_counts.h"

namespace cdprep::test {
namespace {

std::vector<Corners> surface_of(const TestMesh& mesh) {
    std::vector<Corners> surface;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        surface.push_back(corners_of(mesh, i, nullptr));
    }
    return surface;
}

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
    Workspace workspace;
    for (const Structure structure : kStructures) {
        const Inclusion found = includes_through(structure, model, q, workspace);
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

}  // namespace
}  // namespace cdprep::test
