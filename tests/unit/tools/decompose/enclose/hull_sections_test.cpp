// SPDX-License-Identifier: MIT
// Hulls in files: what the baker writes is sound, says what the hull is, and nothing else
// gets past the check.
#include "decompose/enclose/hull_sections.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>

#include "cdprep/advanced/find_falsehood.h"
#include "cdprep/format/content_hash.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/format/sections.h"
#include "cdprep/hulls.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/reseal.h"
#include "unit/tools/soup_of.h"
#include "unit/tools/tiny_hull_sections.h"

namespace cdprep::convex {
namespace {

using format::SectionId;
using test::AlignedBytes;
using test::as_section;

constexpr std::array kIds = {SectionId::hulls,         SectionId::hull_blocks,
                             SectionId::hull_vertices, SectionId::hull_facets,
                             SectionId::hull_groups,   SectionId::hull_neighbours,
                             SectionId::hull_starts};

test::TestMesh two_of(test::TestMesh mesh, double apart) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const test::TestMesh one = mesh;
    for (const Double3& p : one.positions) mesh.positions.push_back({p.x + apart, p.y, p.z});
    for (const format::Triangle& t : one.triangles) {
        mesh.triangles.push_back({{first + t.vertex[0], first + t.vertex[1], first + t.vertex[2]}});
    }
    return mesh;
}

HullSections sections_of(const test::TestMesh& mesh) {
    return *make_hull_sections(test::mesh_of(mesh), {}, 0, serial_for);
}

AlignedBytes baked(const test::TestMesh& mesh, const HullSections& hulls) {
    return test::with_sections(
        test::bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true}),
        tiny_sections(hulls));
}

std::vector<test::TestMesh> meshes() {
    test::TestMesh point = test::copies_of_one_triangle(2);
    for (Double3& p : point.positions) p = {1, 2, 3};
    return {test::TestMesh{},       point,
            test::fan(9),           test::unit_cube(),
            test::icosphere(2),     two_of(test::icosphere(2), 3),
            test::grid_sheet(9, 9), two_of(test::unit_cube(), 0.5)};
}

TEST(HullSections, AreSound) {
    for (const test::TestMesh& mesh : meshes()) {
        const AlignedBytes file = baked(mesh, sections_of(mesh));
        const auto damage = format::find_damage(file.span());
        EXPECT_FALSE(damage) << format::section_name(damage->section) << " " << damage->at;
    }
}

// By hand: one around all; of two components one each besides.
TEST(HullSections, AreAroundTheWholeAndItsComponents) {
    const test::TestMesh one = test::unit_cube(), two = two_of(one, 3);
    const auto opened = test::open_tiny(baked(two, sections_of(two)));
    const Model& model = opened.model;
    ASSERT_EQ(model.hulls().hulls.size(), 3U);
    EXPECT_EQ(find_hull(model, format::HullScope::whole), 0U);
    EXPECT_EQ(find_hull(model, format::HullScope::component, 1), 2U);
    EXPECT_FALSE(find_hull(model, format::HullScope::component, 2));
    EXPECT_FALSE(find_hull(model, format::HullScope::instance, 0));
    EXPECT_EQ(model.hulls().hulls[0].group_count, 6U);
    EXPECT_EQ(sections_of(one).hulls.size(), 1U);
}

double height(const Double3& d, const Double3& p) {
    return d.x * p.x + d.y * p.y + d.z * p.z;
}

/// Where climbing to strictly higher neighbours ends.
std::uint32_t climbed(const ConvexPoints& points, std::uint32_t from, const Double3& d) {
    for (bool moved = true; moved;) {
        moved = false;
        const std::uint32_t end = points.neighbour_begins[from + 1];
        for (std::uint32_t i = points.neighbour_begins[from]; i < end && !moved; ++i) {
            const std::uint32_t other = points.neighbours[i];
            moved = height(d, points.point(other)) > height(d, points.point(from));
            if (moved) from = other;
        }
    }
    return from;
}

// Oracle: every point looked at. Starts are near: most climbs are short.
TEST(HullSections, ClimbingFromAStartEndsAtTheFarthestPoint) {
    const test::TestMesh mesh = test::icosphere(3);
    const auto opened = test::open_tiny(baked(mesh, sections_of(mesh)));
    const ConvexPoints points = convex_points(opened.model, 0);
    ASSERT_EQ(points.count, mesh.positions.size());
    ASSERT_EQ(points.starts.size(), kDirectionStarts);
    std::mt19937 random(4);
    std::normal_distribution<double> side;
    int at_once = 0;
    for (int i = 0; i < 2'000; ++i) {
        const double x = side(random), y = side(random);
        const Double3 d = {x, y, side(random)};
        double most = -std::numeric_limits<double>::infinity();
        for (std::uint32_t p = 0; p < points.count; ++p) {
            most = std::max(most, height(d, points.point(p)));
        }
        const std::uint32_t start = points.starts[direction_cell(d)];
        const std::uint32_t end = climbed(points, start, d);
        EXPECT_EQ(height(d, points.point(end)), most);
        at_once += start == end ? 1 : 0;
    }
    EXPECT_GT(at_once, 600);
}

// The points, facets and vertices are those of the hull.
TEST(HullSections, SayWhatTheHullIs) {
    const test::TestMesh mesh = test::coarse_grid_soup(7, 40, 4);
    const ConvexHull hull = convex_hull(mesh.positions);
    HullSections sections;
    std::vector<std::uint32_t> source(mesh.positions.size());
    std::iota(source.begin(), source.end(), 1000U);
    sections.add(format::HullScope::whole, 0, {hull, 0}, source);
    ASSERT_EQ(sections.facets.size(), hull.facets.size());
    for (std::size_t f = 0; f < hull.facets.size(); ++f) {
        EXPECT_EQ(sections.facets[f].point, hull.facets[f]);
    }
    for (std::size_t i = 0; i < hull.points.size(); ++i) {
        EXPECT_EQ(sections.vertices[i], hull.numbers[i] + 1000);
        EXPECT_EQ(sections.blocks[i / 8].at[0][i % 8], hull.points[i].x);
    }
}

format::SectionEntry entry_of(const AlignedBytes& file, SectionId id) {
    return format::find_section(file.span(), id).value();
}

AlignedBytes with_word(const AlignedBytes& file, std::uint64_t at, std::uint32_t value) {
    AlignedBytes changed(file.span());
    std::memcpy(changed.span().data() + at, &value, sizeof value);
    test::reseal(changed.span());
    return changed;
}

/// Whether a file that holds another word there is as safe as before.
bool is_free(SectionId id, std::uint64_t byte, std::uint32_t value, std::uint32_t points) {
    using format::Hull;
    const std::uint64_t member = byte % sizeof(Hull);
    if (id == SectionId::hulls) {
        return member == offsetof(Hull, number) || member >= offsetof(Hull, distance) ||
               (member == offsetof(Hull, flags) && value < 2) ||
               (member == offsetof(Hull, scope) && value < 3) ||
               (member == offsetof(Hull, dimension) && value == 2);  // flat or not: not looked at
    }
    return id == SectionId::hull_starts && value < points;
}

// Whatever else is written in a word that leads anywhere is damage.
TEST(HullSections, AnotherWordIsRefused) {
    int asked = 0;
    const test::TestMesh mesh = test::icosphere(2);
    const AlignedBytes file = baked(mesh, sections_of(mesh));
    const auto points = static_cast<std::uint32_t>(mesh.positions.size());
    std::mt19937 random(5);
    for (const SectionId id : {SectionId::hulls, SectionId::hull_facets, SectionId::hull_groups,
                               SectionId::hull_starts}) {
        const format::SectionEntry entry = entry_of(file, id);
        for (std::uint64_t byte = 0; byte < entry.count * entry.element_size; byte += 4) {
            std::uint32_t now = 0;
            std::memcpy(&now, file.span().data() + entry.offset + byte, sizeof now);
            for (const std::uint32_t value : {0U, 1U, 0x7fffffffU, 0xffffffffU, now - 1, now + 1,
                                              now ^ (1U << random() % 32)}) {
                if (value == now || is_free(id, byte, value, points)) continue;
                ++asked;
                EXPECT_TRUE(format::find_damage(with_word(file, entry.offset + byte, value).span()))
                    << format::section_name(id) << " byte " << byte << ": " << value;
            }
        }
    }
    EXPECT_GT(asked, 10'000);
}

TEST(HullSections, BadNeighboursAndPointsAreRefused) {
    const test::TestMesh mesh = test::icosphere(2);
    const HullSections good = sections_of(mesh);
    const auto is_refused = [&](const HullSections& bad) {
        return format::find_damage(baked(mesh, bad).span()).has_value();
    };
    EXPECT_FALSE(is_refused(good));
    const std::size_t begins = mesh.positions.size() + 1;
    for (const std::size_t at : {std::size_t{0}, std::size_t{5}, begins - 1, begins, begins + 9}) {
        HullSections bad = good;
        bad.neighbours[at] = static_cast<std::uint32_t>(at < begins ? 1 << 20 : begins - 1);
        EXPECT_TRUE(is_refused(bad)) << at;
    }
    for (const double value : {2.0, -2.0, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()}) {
        HullSections bad = good;
        bad.blocks[3].at[1][2] = value;
        EXPECT_TRUE(is_refused(bad)) << value;
        bad = good;
        bad.hulls[0].reach.y = -value * value;
        EXPECT_TRUE(is_refused(bad)) << value;
    }
    HullSections bad = good;
    bad.blocks.back().at[0][7] *= 0.5;  // past the last point
    EXPECT_TRUE(is_refused(bad));
    bad = good;
    bad.starts.pop_back();
    EXPECT_TRUE(is_refused(bad));
    bad = good;
    bad.vertices.pop_back();
    EXPECT_TRUE(is_refused(bad));
    bad = good;
    bad.blocks.push_back(bad.blocks.back());
    bad.vertices.resize(bad.vertices.size() + 8);
    EXPECT_TRUE(is_refused(bad));
}

// A reach may be larger than the points ask for, up to the largest that finite points have.
TEST(HullSections, AReachIsANumberUpToTheGreatest) {
    constexpr double kMost = 4 * format::kMaxCoordinate;
    const test::TestMesh mesh = test::icosphere(2);
    const HullSections good = sections_of(mesh);
    for (const auto axis : {&Double3::x, &Double3::y, &Double3::z}) {
        const auto is_refused = [&](double reach) {
            HullSections changed = good;
            changed.hulls[0].reach.*axis = reach;
            return format::find_damage(baked(mesh, changed).span()).has_value();
        };
        EXPECT_FALSE(is_refused(kMost));
        EXPECT_TRUE(is_refused(std::nextafter(kMost, 2 * kMost)));
        EXPECT_TRUE(is_refused(std::numeric_limits<double>::infinity()));
        EXPECT_TRUE(is_refused(std::numeric_limits<double>::quiet_NaN()));
        EXPECT_TRUE(is_refused(std::nextafter(good.hulls[0].reach.*axis, 0)));
    }
    HullSections endless = good;
    endless.hulls[0].reach.x = std::numeric_limits<double>::infinity();
    const auto damage = format::find_damage(baked(mesh, endless).span());
    ASSERT_TRUE(damage);
    EXPECT_EQ(damage->kind, format::DamageKind::bad_number);
    EXPECT_EQ(damage->found, 0U);
    EXPECT_EQ(damage->limit, 0U);
}

/// How often the file with two neighbours of a list exchanged is accepted.
template <class T>
std::size_t accepted_orders(const test::TestMesh& mesh, const HullSections& good,
                            std::vector<T> HullSections::*list) {
    std::size_t accepted = 0;
    for (std::size_t i = 1; i < (good.*list).size(); ++i) {
        HullSections changed = good;
        std::swap((changed.*list)[i - 1], (changed.*list)[i]);
        accepted += format::find_damage(baked(mesh, changed).span()) ? 0 : 1;
    }
    return accepted;
}

TEST(HullSections, HullsFacetsAndGroupsHaveOneOrder) {
    const test::TestMesh mesh = two_of(test::icosphere(2), 3);
    const HullSections good = sections_of(mesh);
    ASSERT_EQ(good.hulls.size(), 3U);
    ASSERT_GT(good.groups.size(), 100U);
    EXPECT_EQ(accepted_orders(mesh, good, &HullSections::hulls), 0U);
    EXPECT_EQ(accepted_orders(mesh, good, &HullSections::facets), 0U);
    EXPECT_EQ(accepted_orders(mesh, good, &HullSections::groups), 0U);
}

TEST(HullSections, AMissingPartIsRefused) {
    const test::TestMesh mesh = test::unit_cube();
    const HullSections hulls = sections_of(mesh);
    for (const SectionId missing : kIds) {
        std::vector<test::TinySection> sections = tiny_sections(hulls);
        std::erase_if(sections, [&](const auto& section) { return section.id == missing; });
        const auto damage =
            format::find_damage(test::with_sections(test::bake_tiny(mesh.positions, mesh.triangles,
                                                                    {.double_precision = true}),
                                                    sections)
                                    .span());
        ASSERT_TRUE(damage);
        EXPECT_EQ(damage->section, missing);
    }
}

std::optional<format::Damage> falsehood(const test::TestMesh& mesh, const HullSections& hulls) {
    const auto opened = test::open_tiny(baked(mesh, hulls));
    return find_hull_falsehood(opened.bytes.span(), opened.model);
}

TEST(HullSections, AreTrue) {
    for (const test::TestMesh& mesh : meshes()) {
        const auto damage = falsehood(mesh, sections_of(mesh));
        EXPECT_FALSE(damage) << format::section_name(damage->section) << " " << damage->at;
    }
}

// A hull of one point, and a mesh that has another.
TEST(HullSections, AnotherPointIsOutsideAHullOfOne) {
    test::TestMesh mesh = test::copies_of_one_triangle(2);
    for (Double3& p : mesh.positions) p = {1, 2, 3};
    const HullSections hulls = sections_of(mesh);
    ASSERT_EQ(hulls.hulls[0].dimension, 0U);
    mesh.positions.back() = {4, 5, 6};
    const AlignedBytes file = baked(mesh, hulls);
    const auto damage = falsehood(mesh, hulls);
    ASSERT_TRUE(damage);
    EXPECT_EQ(damage->section, SectionId::hulls);
    EXPECT_EQ(damage->at, format::find_section(file.span(), SectionId::hulls)->offset);
    EXPECT_EQ(damage->found, 0U);
    EXPECT_EQ(damage->limit, 0U);
}

// Safe to query, but no hull of this mesh.
TEST(HullSections, WhatIsNoHullIsFalse) {
    const test::TestMesh mesh = test::icosphere(2);
    const HullSections good = sections_of(mesh);
    test::TestMesh larger = mesh;
    larger.positions[5] = {2, 2, 2};
    EXPECT_TRUE(falsehood(larger, good));
    HullSections bad = good;
    bad.blocks[2].at[1][3] *= 1 - 0x1p-52;  // not the vertex any more
    EXPECT_TRUE(falsehood(mesh, bad));
    bad = good;
    bad.blocks[2].at[1][3] *= 0.5;
    bad.hulls[0].flags = 0;  // does not say so either, but is reflex there
    EXPECT_TRUE(falsehood(mesh, bad));
    bad = good;
    const std::size_t last = bad.neighbours.size() - 1;
    bad.neighbours[last] = bad.neighbours[last] == 3 ? 4 : 3;
    EXPECT_TRUE(falsehood(mesh, bad));
    bad = good;
    bad.vertices[7] ^= 1;
    EXPECT_TRUE(falsehood(mesh, bad));
    const test::TestMesh cube = test::unit_cube();
    bad = sections_of(cube);
    bad.groups[0].facet_count = 3;  // of a cube's coplanar pairs, one and a third
    bad.groups[1] = {3, 1};
    bad.facets[2].group = 0;
    EXPECT_TRUE(falsehood(cube, bad));
}

}  // namespace
}  // namespace cdprep::convex
