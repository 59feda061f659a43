// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/html_page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "page/base64.h"
#include "page/page_surface.h"
#include "page/page_text.h"
#include "support/meshes.h"
#include "validate/choose_triangles.h"
#include "validate/defects/rule.h"
#include "validate/page_marks.h"

namespace cdprep::report {
namespace {

using mesh::Double3;
using mesh::Rule;
using mesh::Triangle;

std::string in_base64(std::string_view text) {
    return base64(std::as_bytes(std::span(text)));
}

std::size_t count_of(std::string_view text, std::string_view part) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string_view::npos; ++at) ++count;
    return count;
}

std::string page_of(const ValidationReport& report, const test::TestMesh& mesh,
                    const PageOptions& options = {}) {
    const PageMesh page{&report, mesh.positions, mesh.triangles, {}};
    return html_page({&page, 1}, options);
}

/// A finding of every rule, each with `places` places of `named` triangles and vertices.
ValidationReport crowded(std::size_t places, std::size_t named) {
    ValidationReport report;
    report.input = "crowded.obj";
    for (const mesh::RuleText& text : mesh::all_rules()) {
        mesh::Finding finding{text.rule, 1'000'000'000, {}};
        mesh::Place place;
        for (std::uint32_t i = 0; i < named; ++i) {
            place.triangles.push_back(i % 12);
            place.vertices.push_back(i % 8);
        }
        finding.places.assign(places, place);
        report.defects.findings.push_back(finding);
    }
    return report;
}

// The vectors of RFC 4648, section 10.
TEST(Base64, IsThatOfTheStandard) {
    EXPECT_EQ(in_base64(""), "");
    EXPECT_EQ(in_base64("f"), "Zg==");
    EXPECT_EQ(in_base64("fo"), "Zm8=");
    EXPECT_EQ(in_base64("foo"), "Zm9v");
    EXPECT_EQ(in_base64("foob"), "Zm9vYg==");
    EXPECT_EQ(in_base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(in_base64("foobar"), "Zm9vYmFy");
}

// A name that could end the element leaves the number of elements as it is.
TEST(HtmlPage, NamesCannotEndTheirElement) {
    ValidationReport plain;
    plain.input = "x";
    plain.node_of_triangle_run = {"y"};
    plain.first_triangle = {0};
    plain.defects.findings = {{Rule::sliver, 1, {{{0}, {0, 1, 2}, {0, 0, 0}, 1}}}};
    ValidationReport hostile = plain;
    hostile.input = "</title></script><script>alert(1)</script><!--\xff@data@@three@";
    hostile.node_of_triangle_run = {"</script><img src=x onerror=alert(1)>\"'&"};
    hostile.error = "</script>";
    const std::string as_plain = page_of(plain, test::unit_cube());
    const std::string as_hostile = page_of(hostile, test::unit_cube());
    for (const char* part :
         {"<script", "</script", "<!--", "<img", "</title", "onerror=alert(1)>"}) {
        EXPECT_EQ(count_of(as_plain, part), count_of(as_hostile, part)) << part;
    }
    EXPECT_NE(as_hostile.find("\\u003c/script\\u003e"), std::string::npos);
}

// Nothing of ours names a place to load from, and the policy forbids it to all else.
TEST(HtmlPage, AsksForNothing) {
    for (const std::string_view text :
         {page::kFrame, page::kStyle, page::kElements, page::kView, page::kList, page::kPage}) {
        for (const char* part :
             {"http:", "https:", "//cdn", "@import", "url(", " src=\"", "fetch("}) {
            EXPECT_EQ(text.find(part), std::string_view::npos) << part;
        }
    }
    EXPECT_NE(page::kFrame.find("default-src 'none'"), std::string_view::npos);
}

TEST(HtmlPage, CarriesThreeJsAndItsLicence) {
    const std::string text = html_page({});
    EXPECT_NE(text.find("Permission is hereby granted, free of charge"), std::string::npos);
    EXPECT_NE(text.find("three.js authors"), std::string::npos);
    EXPECT_NE(text.find("THREE.OrbitControls"), std::string::npos);
    EXPECT_GT(page::kThree.size(), 500'000U);
    EXPECT_EQ(text.find("@js@"), std::string::npos);
}

TEST(HtmlPage, EveryRuleHasAColourInBothThemes) {
    for (const mesh::RuleText& text : mesh::all_rules()) {
        const std::string name = std::string("--rule-") + mark_style(text.rule).hue + ":";
        EXPECT_EQ(count_of(page::kStyle, name), 2U) << text.name;
    }
}

TEST(HtmlPage, KeepsTrueCountsOfWhatItDoesNotList) {
    const std::string text = page_of(crowded(3, 500), test::unit_cube());
    EXPECT_NE(text.find("\"count\":1000000000"), std::string::npos);
    EXPECT_NE(text.find("\"nt\":500"), std::string::npos);
}

// 26 rules with 1000 places of 3000 numbers each are 156 million numbers.
TEST(HtmlPage, IsBoundedHoweverMuchWasFound) {
    const ValidationReport report = crowded(1000, 3000);
    EXPECT_LT(page_of(report, test::unit_cube()).size(), 80'000'000U);
}

TEST(HtmlPage, IsBoundedHoweverManyMeshesThereAre) {
    const ValidationReport report = crowded(100, 3);
    const test::TestMesh cube = test::unit_cube();
    const std::vector<PageMesh> meshes(500, {&report, cube.positions, cube.triangles, {}});
    EXPECT_LT(html_page(meshes).size(), 130'000'000U);
}

// Smaller meshes are drawn whole, and what they leave goes to the larger.
TEST(HtmlPage, MeshesShareTheTriangles) {
    const ValidationReport report;
    const test::TestMesh small = test::unit_cube();
    const test::TestMesh large = test::grid_sheet(40, 40);
    const std::vector<PageMesh> meshes = {{&report, large.positions, large.triangles, {}},
                                          {&report, small.positions, small.triangles, {}}};
    const std::string all = html_page(meshes, {.max_triangles = 3212});
    EXPECT_EQ(count_of(all, "\"whole\":true"), 2U);
    const std::string fewer = html_page(meshes, {.max_triangles = 3211});
    EXPECT_EQ(count_of(fewer, "\"whole\":true"), 1U);
    EXPECT_EQ(count_of(fewer, "\"whole\":false"), 1U);
}

TEST(HtmlPage, MeshWithoutDrawableTrianglesIsStillListed) {
    ValidationReport report;
    report.input = "broken.obj";
    report.error = "broken.obj: line 3 has 2 coordinates, not 3.";
    const std::string text = page_of(report, {});
    EXPECT_NE(text.find("line 3 has 2 coordinates"), std::string::npos);
    EXPECT_NE(text.find("\"drawn\":null"), std::string::npos);
}

// Neither the first that is not there nor one far beyond; the finding is still told.
TEST(HtmlPage, ATriangleThatIsNotThereIsPassedOver) {
    for (const std::uint32_t triangle : {12U, 64U, 1'000'000U}) {
        ValidationReport report;
        report.defects.findings.push_back({Rule::sliver, 1, {{{triangle}, {0}, {0, 0, 0}, 1}}});
        EXPECT_NE(page_of(report, test::unit_cube()).find("CDP0203"), std::string::npos);
    }
}

TEST(HtmlPage, SameInputGivesTheSameBytes) {
    const ValidationReport report = crowded(5, 3);
    EXPECT_EQ(page_of(report, test::unit_cube()), page_of(report, test::unit_cube()));
}

// The cube's corners are a power of two apart, so the frame holds them exactly.
TEST(PageFrame, ServesEveryExtent) {
    for (const int exponent : {-1060, -1000, -40, 0, 40, 1000, 1022}) {
        const double side = std::ldexp(1, exponent);
        test::TestMesh cube = test::moved_by(test::unit_cube(), side, {0, 0, 0});
        const auto frame = find_page_frame(cube.positions, cube.triangles);
        ASSERT_TRUE(frame) << exponent;
        for (std::size_t i = 0; i < 8; ++i) {
            const Double3 plain = test::unit_cube().positions[i];
            const std::array<float, 3> drawn = frame->from_model(cube.positions[i]);
            EXPECT_EQ(drawn[0], plain.x == 0 ? -0.5F : 0.5F) << exponent;
            EXPECT_EQ(drawn[1], plain.y == 0 ? -0.5F : 0.5F) << exponent;
            EXPECT_EQ(drawn[2], plain.z == 0 ? -0.5F : 0.5F) << exponent;
        }
    }
}

TEST(PageFrame, HoldsTheLargestDoublesOfBothSigns) {
    const double most = std::numeric_limits<double>::max();
    const std::vector<Double3> positions = {{-most, 0, 0}, {most, 0, 0}, {0, most, 0}};
    const std::vector<Triangle> triangles = {{{0, 1, 2}}};
    const auto frame = find_page_frame(positions, triangles);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->from_model(positions[0])[0], -1.0F);
    EXPECT_EQ(frame->from_model(positions[1])[0], 1.0F);
}

TEST(PageFrame, LeavesOutWhatCannotBeDrawn) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Double3> positions = {
        {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {nan, 0, 0}, {9, 9, 9}};
    const auto frame =
        find_page_frame(positions, std::vector<Triangle>{{{0, 1, 2}}, {{0, 1, 3}}, {{0, 1, 77}}});
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->centre, (Double3{1, 1, 0}));
    EXPECT_FALSE(find_page_frame(positions, std::vector<Triangle>{{{0, 1, 3}}}));
    EXPECT_FALSE(find_page_frame({}, {}));
}

// A sheet of 20,000 triangles with one finding in the middle.
TEST(ChooseTriangles, KeepsThoseNamedAndThoseAroundThem) {
    const test::TestMesh sheet = test::grid_sheet(100, 100);
    const auto frame = find_page_frame(sheet.positions, sheet.triangles);
    ASSERT_TRUE(frame);
    mesh::Finding finding{Rule::sliver, 1, {{{10'100, 3}, {}, {50, 50, 0}, 0}}};
    for (const std::size_t limit : {20'000U, 8000U, 500U, 60U, 2U, 1U}) {
        const auto chosen =
            choose_triangles(sheet.positions, sheet.triangles, *frame, {&finding, 1}, limit);
        EXPECT_LE(chosen.size(), limit);
        EXPECT_GE(chosen.size(), std::min<std::size_t>(limit, 2)) << limit;
        EXPECT_TRUE(std::ranges::is_sorted(chosen));
        EXPECT_TRUE(std::ranges::binary_search(chosen, 3U)) << limit;
        if (limit > 60) {
            EXPECT_GT(chosen.size(), 50U) << limit;
        }
    }
}

TEST(CoarseTriangles, AreFewAndSpanTheWhole) {
    const test::TestMesh ball = test::icosphere(5);  // 20,480 triangles
    const auto frame = find_page_frame(ball.positions, ball.triangles);
    ASSERT_TRUE(frame);
    const DrawnTriangles coarse = coarse_triangles(ball.positions, ball.triangles, *frame, {}, 16);
    EXPECT_GT(coarse.indices.size() / 3, 300U);
    EXPECT_LT(coarse.indices.size() / 3, 16U * 16U * 12U);
    const auto [least, most] = std::ranges::minmax(coarse.positions);
    EXPECT_LT(least, -0.42F);  // the ball reaches from -0.5 to 0.5
    EXPECT_GT(most, 0.42F);
    EXPECT_LT(std::ranges::max(coarse.indices), coarse.positions.size() / 3);
    std::vector<std::uint32_t> all(ball.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_TRUE(coarse_triangles(ball.positions, ball.triangles, *frame, all, 16).indices.empty());
}

// One edge of the cube, its loop and a triangle: numbers known by hand.
TEST(Marks, AreWhatEachRuleIsSeenBy) {
    const test::TestMesh cube = test::unit_cube();
    const auto frame = find_page_frame(cube.positions, cube.triangles);
    ASSERT_TRUE(frame);
    const auto marks_of = [&](Rule rule, const mesh::Place& place) {
        return make_marks(cube.positions, cube.triangles, *frame, rule, {&place, 1}, 100);
    };
    const mesh::Place place{{0}, {0, 1}, {0.5, 0, 0}, 1};
    const Marks edge = marks_of(Rule::boundary_edge, place);
    EXPECT_EQ(edge.segments.size(), 6U);
    EXPECT_EQ(edge.segment_ends, (std::vector<std::uint32_t>{1}));
    EXPECT_TRUE(edge.triangles.empty());
    EXPECT_EQ(std::hypot(edge.places[3], edge.places[4], edge.places[5]), 1.0F);
    const Marks loop = marks_of(Rule::boundary_loop, {{0}, {0, 1, 3, 2}, {0.5, 0.5, 0}, 1});
    EXPECT_EQ(loop.segments.size(), 24U);
    const Marks triangle = marks_of(Rule::sliver, place);
    EXPECT_EQ(triangle.triangles.size(), 9U);
    const Marks beyond = marks_of(Rule::sliver, {{99}, {99}, {0, 0, 0}, 0});
    EXPECT_TRUE(beyond.triangles.empty());
    EXPECT_EQ(beyond.places.size(), 7U);
}

// Whichever of its coordinates is no number.
TEST(Marks, APositionThatIsNoNumberIsNowhere) {
    const test::TestMesh cube = test::unit_cube();
    const auto frame = find_page_frame(cube.positions, cube.triangles);
    ASSERT_TRUE(frame);
    for (const double bad : {std::nan(""), HUGE_VAL}) {
        for (double mesh::Double3::*axis :
             {&mesh::Double3::x, &mesh::Double3::y, &mesh::Double3::z}) {
            mesh::Place place{{0}, {0, 1}, {0.5, 0, 0}, 1};
            place.position.*axis = bad;
            const Marks marks = make_marks(cube.positions, cube.triangles, *frame,
                                           Rule::non_finite_coordinate, {&place, 1}, 100);
            ASSERT_EQ(marks.places.size(), 7U);
            for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(std::isnan(marks.places[i])) << i;
            EXPECT_EQ(marks.places[6], 0.0F);
        }
    }
}

TEST(Marks, BeyondTheirNumberAreAPositionOnly) {
    const test::TestMesh cube = test::unit_cube();
    const auto frame = find_page_frame(cube.positions, cube.triangles);
    ASSERT_TRUE(frame);
    const std::vector<mesh::Place> places(5, {{0, 1}, {}, {0, 0, 0}, 0});
    const Marks marks =
        make_marks(cube.positions, cube.triangles, *frame, Rule::crossing_triangles, places, 3);
    EXPECT_EQ(marks.triangles.size(), 27U);
    EXPECT_EQ(marks.triangle_ends, (std::vector<std::uint32_t>{2, 3, 3, 3, 3}));
    EXPECT_EQ(marks.places.size(), 35U);
}

}  // namespace
}  // namespace cdprep::report
