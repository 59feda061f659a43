// SPDX-License-Identifier: MIT
#include "validate/fingerprint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "unit/tools/soup_of.h"

namespace cdprep::report {
namespace {

using mesh::Place;
using mesh::Rule;

std::uint64_t fingerprint(const mesh::TriangleSoup& soup, Rule rule, const Place& place) {
    return Fingerprints(soup).of(rule, place);
}

/// A soup with other numbers, and where the old ones went.
struct Renumbered {
    mesh::TriangleSoup soup;
    std::vector<std::uint32_t> vertex;
    std::vector<std::uint32_t> triangle;
};

Renumbered renumbered(const mesh::TriangleSoup& soup, std::mt19937& random) {
    Renumbered result;
    result.vertex.resize(soup.positions.size());
    result.triangle.resize(soup.triangles.size());
    std::iota(result.vertex.begin(), result.vertex.end(), 0U);
    std::iota(result.triangle.begin(), result.triangle.end(), 0U);
    std::shuffle(result.vertex.begin(), result.vertex.end(), random);
    std::shuffle(result.triangle.begin(), result.triangle.end(), random);
    result.soup.positions.resize(soup.positions.size());
    result.soup.triangles.resize(soup.triangles.size());
    for (std::size_t i = 0; i < result.vertex.size(); ++i) {
        result.soup.positions[result.vertex[i]] = soup.positions[i];
    }
    for (std::size_t i = 0; i < result.triangle.size(); ++i) {
        const auto& [a, b, c] = soup.triangles[i].vertex;
        result.soup.triangles[result.triangle[i]] = {
            {result.vertex[c], result.vertex[a], result.vertex[b]}};
    }
    return result;
}

// By law: numbers are not hashed, positions are.
TEST(Fingerprints, StayWhenVerticesAndTrianglesAreNumberedAnew) {
    const mesh::TriangleSoup soup = test::soup_of(test::unit_cube());
    std::mt19937 random(1);
    for (int i = 0; i < 20; ++i) {
        const Renumbered other = renumbered(soup, random);
        const Place place{{2, 5}, {7, 3, 1}, {}, 0};
        Place same{{other.triangle[5], other.triangle[2]},
                   {other.vertex[1], other.vertex[7], other.vertex[3]},
                   {},
                   9};
        EXPECT_EQ(fingerprint(soup, Rule::t_junction, place),
                  fingerprint(other.soup, Rule::t_junction, same));
    }
}

// By hand: two cubes far apart; whichever triangle names a component, it is the same one.
TEST(Fingerprints, OfComponentsDoNotDependOnTheTriangleThatNamesThem) {
    mesh::TriangleSoup soup = test::soup_of(test::unit_cube());
    const auto corners = static_cast<std::uint32_t>(soup.positions.size());
    const std::size_t half = soup.triangles.size();
    for (std::uint32_t i = 0; i < corners; ++i) {
        const mesh::Double3 p = soup.positions[i];
        soup.positions.push_back({p.x + 10, p.y, p.z});
    }
    for (std::size_t i = 0; i < half; ++i) {
        const auto& [a, b, c] = soup.triangles[i].vertex;
        soup.triangles.push_back({{a + corners, b + corners, c + corners}});
    }
    std::set<std::uint64_t> first;
    std::set<std::uint64_t> second;
    for (std::uint32_t i = 0; i < half; ++i) {
        const auto j = static_cast<std::uint32_t>(i + half);
        first.insert(fingerprint(soup, Rule::inverted_component, {{i}, {}, {}, 0}));
        second.insert(fingerprint(soup, Rule::inverted_component, {{j}, {}, {}, 0}));
    }
    EXPECT_EQ(first.size(), 1U);
    EXPECT_EQ(second.size(), 1U);
    EXPECT_NE(first, second);
}

TEST(Fingerprints, DifferByRuleByPositionAndByWhatIsNamed) {
    const mesh::TriangleSoup soup = test::soup_of(test::unit_cube());
    mesh::TriangleSoup moved = soup;
    moved.positions[soup.triangles[0].vertex[0]].x += 0x1p-50;
    const std::set<std::uint64_t> all = {
        fingerprint(soup, Rule::sliver, {{0}, {}, {}, 0}),
        fingerprint(soup, Rule::zero_area, {{0}, {}, {}, 0}),
        fingerprint(soup, Rule::sliver, {{1}, {}, {}, 0}),
        fingerprint(soup, Rule::sliver, {{0, 1}, {}, {}, 0}),
        fingerprint(soup, Rule::sliver, {{}, {0, 1, 2}, {}, 0}),
        fingerprint(soup, Rule::sliver, {{}, {0}, {}, 0}),
        fingerprint(soup, Rule::sliver, {{}, {0, 1}, {}, 0}),
        fingerprint(moved, Rule::sliver, {{0}, {}, {}, 0}),
    };
    EXPECT_EQ(all.size(), 8U);
}

// By definition: -0 equals 0, a NaN is a NaN, and a number beyond the file is a number.
TEST(Fingerprints, TakeWhatNoMeshMayHold) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    mesh::TriangleSoup soup = test::soup_of(test::unit_cube());
    soup.positions[0] = {-0.0, kNan, 1};
    mesh::TriangleSoup same = soup;
    same.positions[0] = {0.0, -kNan, 1};
    for (const Rule rule : {Rule::non_finite_coordinate, Rule::several_components}) {
        EXPECT_EQ(fingerprint(soup, rule, {{0}, {0}, {}, 0}),
                  fingerprint(same, rule, {{0}, {0}, {}, 0}));
    }
    EXPECT_NE(fingerprint(soup, Rule::index_out_of_range, {{}, {900}, {}, 0}),
              fingerprint(soup, Rule::index_out_of_range, {{}, {901}, {}, 0}));
}

// By hand: an edge with four triangles is one place, whichever of them is named.
TEST(Fingerprints, OfAPlaceWithVerticesAreThoseOfTheVertices) {
    const mesh::TriangleSoup soup = test::soup_of(test::unit_cube());
    EXPECT_EQ(fingerprint(soup, Rule::non_manifold_edge, {{1}, {2, 3}, {}, 4}),
              fingerprint(soup, Rule::non_manifold_edge, {{7}, {3, 2}, {}, 4}));
}

TEST(FingerprintText, ReadsBack) {
    for (const std::uint64_t number :
         {std::uint64_t{0}, std::uint64_t{0xa5}, ~std::uint64_t{0}, std::uint64_t{1} << 60}) {
        EXPECT_EQ(fingerprint_text(number).size(), 16U);
        EXPECT_EQ(parse_fingerprint(fingerprint_text(number)), number);
    }
    for (const char* text :
         {"", "12", "000000000000000g", "00000000000000001", "-000000000000001"}) {
        EXPECT_FALSE(parse_fingerprint(text)) << text;
    }
}

}  // namespace
}  // namespace cdprep::report
