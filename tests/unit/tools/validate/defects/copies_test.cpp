// SPDX-License-Identifier: GPL-3.0-or-later
// Meetings of copies, counted and listed by those of one of them, against all pairs found
// one by one.
#include "validate/defects/copies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <tuple>

#include "unit/tools/soup_of.h"
#include "validate/defects/find_defects.h"
#include "validate/defects/sound_mesh.h"

namespace cdprep::mesh {
namespace {

using Meetings = std::vector<TriangleMeeting>;

constexpr std::uint32_t kSeed = 20261121;

/// A mesh on a grid of which triangles are repeated by chance, in any winding, anywhere.
test::TestMesh with_copies(std::uint32_t seed, int count, int grid) {
    test::TestMesh mesh = test::coarse_grid_soup(seed, count, grid);
    std::mt19937 random(seed);
    for (std::size_t i = mesh.triangles.size(); i-- > 0;) {
        while (random() % 2 == 0) {
            Triangle copy = mesh.triangles[i];
            std::shuffle(copy.vertex.begin(), copy.vertex.end(), random);
            mesh.triangles.push_back(copy);
        }
    }
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    return mesh;
}

SoundMesh sound_mesh_of(const test::TestMesh& mesh) {
    FindingList findings(0);
    DefectCounts counts;
    return find_sound_mesh(test::soup_of(mesh), findings, counts);
}

Copies copies_in(const Mesh& mesh) {
    return Copies(find_edge_flaws(collect_stars(mesh)).repeated);
}

/// Of the corners, whatever the winding.
std::array<std::uint32_t, 3> key_of(const Triangle& triangle) {
    auto key = triangle.vertex;
    std::sort(key.begin(), key.end());
    return key;
}

Meetings without_duplicates(Meetings meetings) {
    std::erase_if(meetings, [](const auto& m) { return m.meeting == Meeting::duplicate; });
    return meetings;
}

/// All meetings of the triangles that are no copies, sorted by (a, b).
Meetings find_distinct_meetings(const Mesh& mesh, const Copies& copies) {
    Meetings found;
    EXPECT_TRUE(
        search_distinct_meetings(mesh, copies, {}, [&](std::span<const TriangleMeeting> some) {
            found.insert(found.end(), some.begin(), some.end());
        }));
    std::sort(found.begin(), found.end(),
              [](const auto& x, const auto& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
    return found;
}

TEST(Copies, AreTheTrianglesWithTheSameCorners) {
    for (std::uint32_t seed = kSeed; seed < kSeed + 20; ++seed) {
        const Mesh mesh = sound_mesh_of(with_copies(seed, 40, 2)).mesh;
        std::map<std::array<std::uint32_t, 3>, std::vector<std::uint32_t>> truth;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            truth[key_of(mesh.triangles[i])].push_back(i);
        }
        const Copies copies = copies_in(mesh);
        EXPECT_FALSE(copies.empty());
        std::size_t several = 0;
        for (const auto& [key, numbers] : truth) {
            several += numbers.size() > 1 ? 1 : 0;
            const CopyList list = copies.of(numbers.front());
            ASSERT_EQ(list.size(), numbers.size());
            for (std::size_t i = 0; i < numbers.size(); ++i) ASSERT_EQ(list[i], numbers[i]);
        }
        std::size_t visited = 0;
        copies.for_each([&](const CopyList& list) {
            ++visited;
            EXPECT_GT(list.size(), 1U);
        });
        EXPECT_EQ(visited, several);
        EXPECT_EQ(copies.left_of(mesh.triangles.size()).size(), truth.size());
    }
}

TEST(Copies, DistinctMeetingsStandForAllPairs) {
    std::size_t all = 0, distinct = 0;
    for (std::uint32_t seed = kSeed; seed < kSeed + 40; ++seed) {
        const Mesh mesh = sound_mesh_of(with_copies(seed, 40, 1 + static_cast<int>(seed % 3))).mesh;
        const Copies copies = copies_in(mesh);
        const Meetings found = find_distinct_meetings(mesh, copies);
        const Meetings truth = without_duplicates(find_self_intersections(mesh));
        ASSERT_EQ(first_pairs(found, copies, truth.size() + 1), truth) << seed;
        for (const std::size_t most : {0U, 1U, 2U, 17U, 100U}) {
            const auto end = truth.begin() +
                             static_cast<std::ptrdiff_t>(std::min<std::size_t>(most, truth.size()));
            ASSERT_EQ(first_pairs(found, copies, most), Meetings(truth.begin(), end)) << most;
        }
        all += truth.size();
        distinct += found.size();
    }
    EXPECT_GT(distinct, 1000U);
    EXPECT_GT(all, 2 * distinct);
}

TEST(Copies, WithoutAnyNothingChanges) {
    const Mesh mesh = sound_mesh_of(test::random_soup(kSeed, 300, 0.5)).mesh;
    const Copies copies = copies_in(mesh);
    EXPECT_TRUE(copies.empty());
    const Meetings truth = find_self_intersections(mesh);
    EXPECT_GT(truth.size(), 20U);
    EXPECT_EQ(find_distinct_meetings(mesh, copies), truth);
    EXPECT_EQ(first_pairs(truth, copies, truth.size()), truth);
}

/// What a rule about pairs would list of meetings that are found one by one.
struct Listed {
    std::uint64_t count = 0;
    std::vector<std::vector<std::uint32_t>> places;

    void add(const SoundMesh& sound, const TriangleMeeting& pair, std::size_t most) {
        ++count;
        if (places.size() == most) return;
        places.push_back({sound.source_triangle[pair.a], sound.source_triangle[pair.b]});
    }
};

std::map<Rule, Listed> listed_one_by_one(const SoundMesh& sound, std::size_t most) {
    std::map<Rule, Listed> listed;
    for (const TriangleMeeting& pair : find_self_intersections(sound.mesh)) {
        switch (pair.meeting) {
            case Meeting::crossing:
            case Meeting::corner_crossing:
                listed[Rule::crossing_triangles].add(sound, pair, most);
                break;
            case Meeting::touching:
            case Meeting::edge_crossing:
                listed[Rule::touching_triangles].add(sound, pair, most);
                break;
            case Meeting::coplanar_overlap:
            case Meeting::fold:
                listed[Rule::coplanar_overlap].add(sound, pair, most);
                break;
            default:
                break;
        }
    }
    return listed;
}

TEST(Copies, AreCountedAndListedAsPairsFoundOneByOne) {
    for (std::uint32_t seed = kSeed; seed < kSeed + 20; ++seed) {
        const test::TestMesh mesh = with_copies(seed, 60, 1 + static_cast<int>(seed % 4));
        const SoundMesh sound = sound_mesh_of(mesh);
        for (const std::size_t most : {3U, 50U, 100000U}) {
            auto truth = listed_one_by_one(sound, most);
            const DefectReport report = find_defects(test::soup_of(mesh), {.max_places = most});
            EXPECT_EQ(report.counts.crossing_pairs, truth[Rule::crossing_triangles].count);
            EXPECT_EQ(report.counts.touching_pairs, truth[Rule::touching_triangles].count);
            EXPECT_EQ(report.counts.coplanar_overlap_pairs, truth[Rule::coplanar_overlap].count);
            EXPECT_EQ(report.counts.self_intersecting_pairs,
                      find_self_intersections(sound.mesh).size());
            for (const Finding& finding : report.findings) {
                if (!truth.contains(finding.rule)) continue;
                EXPECT_EQ(finding.count, truth[finding.rule].count);
                std::vector<std::vector<std::uint32_t>> places;
                for (const Place& place : finding.places) places.push_back(place.triangles);
                EXPECT_EQ(places, truth[finding.rule].places) << seed;
                truth.erase(finding.rule);
            }
            for (const auto& [rule, listed] : truth) EXPECT_EQ(listed.count, 0U);
        }
    }
}

/// Copies of one triangle, others through them and one copy between: 3 of another component.
TEST(Copies, OfOneTriangleCostWhatTheyAre) {
    constexpr std::uint64_t kCopies = 200000;
    test::TestMesh mesh;
    mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {9, 9, 1}};
    for (std::uint32_t i = 0; i < kCopies; ++i) {
        mesh.triangles.push_back(i % 3 == 0 ? Triangle{{1, 0, 2}} : Triangle{{0, 1, 2}});
        if (i % 80000 == 1) mesh.triangles.push_back({{3, 4, 5}});
    }
    const DefectReport report = find_defects(test::soup_of(mesh));
    EXPECT_EQ(report.counts.duplicate_triangles, kCopies - 1 + 2);
    EXPECT_EQ(report.counts.crossing_pairs, 3 * kCopies);
    EXPECT_EQ(report.counts.touching_pairs, 0U);
    EXPECT_EQ(report.counts.coplanar_overlap_pairs, 0U);
    EXPECT_EQ(report.counts.self_intersecting_pairs, 3 * kCopies + kCopies * (kCopies - 1) / 2 + 3);
    EXPECT_EQ(report.counts.overlapping_components, 1U);
    for (const Finding& finding : report.findings) {
        if (finding.rule == Rule::overlapping_components) {
            EXPECT_EQ(finding.places.at(0).measure, 3.0 * kCopies);
        }
        if (finding.rule != Rule::crossing_triangles) continue;
        EXPECT_EQ(finding.places.size(), 1000U);
        EXPECT_EQ(finding.places[0].triangles, (std::vector<std::uint32_t>{0, 2}));
        EXPECT_EQ(finding.places[2].triangles, (std::vector<std::uint32_t>{0, 160004}));
        EXPECT_EQ(finding.places[3].triangles, (std::vector<std::uint32_t>{1, 2}));
        EXPECT_EQ(finding.places[6].triangles, (std::vector<std::uint32_t>{2, 3}));
    }
}

// Without area they are in no pair at all.
TEST(Copies, WithoutAreaAreInNoPair) {
    test::TestMesh mesh = test::copies_of_one_triangle(5);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.positions[i] = {1.0 * (i % 3), 0, 2.0 * (i % 3)};
    }
    const DefectReport report = find_defects(test::soup_of(mesh));
    EXPECT_EQ(report.counts.duplicate_triangles, 4U);
    EXPECT_EQ(report.counts.self_intersecting_pairs, 0U);
    EXPECT_EQ(report.verdicts.front().facts & format::verdict_self_crossing, 0U);
}

}  // namespace
}  // namespace cdprep::mesh
