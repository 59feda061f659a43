// SPDX-License-Identifier: MIT
#include "cdprep/advanced/build_model.h"

#include <gtest/gtest.h>

#include <limits>

#include "cdprep/ask.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"
#include "support/aligned_bytes.h"
#include "support/meshes.h"

namespace cdprep::build {
namespace {

using format::Float3;
using format::SectionId;
using format::SectionSet;
using format::Triangle;
using test::AlignedBytes;
using test::TestMesh;

AlignedBytes image_of(const ModelArrays& arrays) {
    const SectionList list = arrays.sections();
    AlignedBytes memory(image_size(list.sections()).value());
    EXPECT_TRUE(build_image(arrays.facts, list.sections(), memory.span()));
    return memory;
}

// The deep check proves boxes, order, and marks of repeated corners in exact arithmetic.
TEST(BuildModel, EveryMeshBecomesAModelInWhichNothingIsWrong) {
    for (const TestMesh& mesh :
         {TestMesh{}, test::fan(1), test::unit_cube(), test::icosphere(3), test::klein_bottle(9, 9),
          test::coarse_grid_soup(3, 700, 2), test::copies_of_one_triangle(20),
          test::random_soup(1, 700, 0.3)}) {
        const auto doubles = build_model(mesh.positions, mesh.triangles);
        const auto floats = build_model(floats_of(mesh), mesh.triangles);
        ASSERT_TRUE(doubles && floats);
        for (const ModelArrays& arrays : {doubles.value(), floats.value()}) {
            const AlignedBytes image = image_of(arrays);
            EXPECT_FALSE(format::find_damage(image.span()));
            EXPECT_FALSE(format::find_deep_damage(image.span()));
            const auto model = Model::open(image.span());
            ASSERT_TRUE(model);
            EXPECT_TRUE(model.value().serves(Ask::collide | Ask::overlap | Ask::distance |
                                             Ask::within | Ask::ray | Ask::closest | Ask::inside |
                                             Ask::touch));
        }
    }
}

// A balanced surface is one whose edges cancel: known of each of these meshes.
TEST(BuildModel, BalancedAreMeshesWhoseEdgesCancel) {
    const auto is_balanced = [](const TestMesh& mesh) {
        const auto arrays = build_model(mesh.positions, mesh.triangles);
        return (arrays.value().facts.flags & format::model_balanced) != 0;
    };
    EXPECT_TRUE(is_balanced(test::unit_cube()));
    EXPECT_TRUE(is_balanced(test::torus(1, 0.4, 24, 12)));
    EXPECT_TRUE(is_balanced(test::joined(test::unit_cube(), test::icosphere(1))));
    EXPECT_FALSE(is_balanced(test::upper_half(test::icosphere(2))));
    EXPECT_FALSE(is_balanced(test::grid_sheet(4, 4)));
    EXPECT_FALSE(is_balanced(test::joined(test::unit_cube(), test::fan(3))));
}

// A cube of side 1 and one of side 2, inside out: volumes 1 and -8.
TEST(BuildModel, ComponentsStandInTheOrderOfTheirLowestTriangle) {
    const TestMesh mesh = test::joined(
        test::unit_cube(), test::reversed(test::moved_by(test::unit_cube(), 2, {5, 0, 0})));
    const auto arrays = build_model(mesh.positions, mesh.triangles);
    const auto& components = arrays.value().components;
    ASSERT_EQ(components.size(), 2U);
    EXPECT_EQ(components[0].triangle_count, 12U);
    EXPECT_DOUBLE_EQ(components[0].signed_volume, 1);
    EXPECT_DOUBLE_EQ(components[1].signed_volume, -8);
    EXPECT_LT(arrays.value().source_vertex[components[0].vertex], 8U);
    EXPECT_GE(arrays.value().source_vertex[components[1].vertex], 8U);
}

// Two of the three triangles: one repeats a corner, one has its corners on a line.
TEST(BuildModel, DegenerateTrianglesAreMarkedInTreeOrder) {
    const std::vector<Double3> positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {0, 1, 0}};
    const std::vector<Triangle> triangles = {{{0, 1, 2}}, {{0, 1, 3}}, {{3, 3, 1}}};
    const auto arrays = build_model(positions, triangles).value();
    ASSERT_EQ(arrays.degenerate_bits.size(), 1U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ((arrays.degenerate_bits[0] >> i & 1) != 0, arrays.bvh.order[i] != 1) << i;
    }
}

TEST(BuildModel, PositionsThatNoTriangleUsesAreLeftOut) {
    TestMesh mesh = test::unit_cube();
    mesh.positions.insert(mesh.positions.begin(), {9, 9, 9});
    for (Triangle& triangle : mesh.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) ++vertex;
    }
    const auto arrays = build_model(mesh.positions, mesh.triangles).value();
    EXPECT_EQ(arrays.facts.vertex_count, 8U);
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_EQ(arrays.positions_f64[i], mesh.positions[arrays.source_vertex[i]]);
    }
}

TEST(BuildModel, FloatsMakeTheModelThatTheirDoublesMakeInLessRoom) {
    const TestMesh mesh = test::in_floats(test::icosphere(3));
    const auto floats = build_model(floats_of(mesh), mesh.triangles).value();
    const auto doubles = build_model(mesh.positions, mesh.triangles).value();
    EXPECT_EQ(floats.bvh.order, doubles.bvh.order);
    EXPECT_TRUE(floats.bvh.exact_leaves);
    EXPECT_TRUE(floats.positions_f64.empty());
    EXPECT_TRUE(doubles.positions_f32.empty());
    EXPECT_EQ(image_of(floats).size() < image_of(doubles).size(), true);
}

TEST(BuildModel, OnlyWantedSectionsAreListed) {
    const TestMesh mesh = test::unit_cube();
    const auto arrays = build_model(mesh.positions, mesh.triangles).value();
    const SectionList list = arrays.sections({SectionId::triangles, SectionId::bvh_nodes});
    ASSERT_EQ(list.sections().size(), 2U);
    EXPECT_EQ(list.sections()[0].id, SectionId::triangles);
    EXPECT_EQ(list.sections()[1].id, SectionId::bvh_nodes);
}

/// Triangles that share no vertex; the last is a point.
TestMesh loose_triangles(int count) {
    TestMesh mesh = test::random_soup(1, count, 0.3);
    const Double3 point = mesh.positions.back();
    for (int i = 1; i <= 3; ++i) *(mesh.positions.end() - i) = point;
    return mesh;
}

/// Calls body(planned, size) for every way to build a mesh.
template <class Body>
void for_each_plan(const TestMesh& mesh, const Body& body) {
    for (const BvhBounds bounds : {BvhBounds::aligned, BvhBounds::oriented, BvhBounds::swept_points,
                                   BvhBounds::swept_rectangles, BvhBounds::oriented_and_swept}) {
        const auto doubles = build_model(mesh.positions, mesh.triangles, {.bounds = bounds});
        const auto floats = build_model(floats_of(mesh), mesh.triangles, {.bounds = bounds});
        for (const SectionSet wanted :
             {SectionSet::all(), sections_for(Ask::collide), sections_for(Ask::closest)}) {
            PlannedModel planned = {static_cast<std::uint32_t>(mesh.positions.size()),
                                    static_cast<std::uint32_t>(mesh.triangles.size()),
                                    Precision::double_precision, bounds, wanted};
            body(planned, image_size(doubles.value().sections(wanted).sections()).value());
            planned.precision = Precision::single_precision;
            body(planned, image_size(floats.value().sections(wanted).sections()).value());
        }
    }
}

// The law of the bound: proved in section_places.h for the greatest sections that there can be.
TEST(BuildModel, NoImageIsLargerThanItsBound) {
    std::size_t rounds = 0;
    const auto expect_enough = [&](const PlannedModel& planned, std::size_t size) {
        EXPECT_LE(size, image_size_bound(planned));
        ++rounds;
    };
    for (int count = 0; count < 70; ++count) {
        for_each_plan(test::random_soup(7, count, 0.3), expect_enough);
    }
    TestMesh unused = test::icosphere(2);
    unused.positions.resize(1000);
    for (const TestMesh& mesh :
         {TestMesh{}, unused, test::unit_cube(), test::icosphere(4), test::klein_bottle(9, 9),
          test::coarse_grid_soup(3, 3000, 2), test::copies_of_one_triangle(2000)}) {
        for_each_plan(mesh, expect_enough);
    }
    EXPECT_EQ(rounds, 77u * 30u);
}

// By hand: triangles that share nothing are the components, and one is degenerate.
TEST(BuildModel, TheWorstMeshTakesTheWholeBound) {
    for (const int count : {1, 8, 64, 65, 3000}) {
        for_each_plan(loose_triangles(count), [](const PlannedModel& planned, std::size_t size) {
            EXPECT_EQ(size, image_size_bound(planned));
        });
    }
    EXPECT_EQ(image_size_bound({}), 4096u + 64u) << "a header";
    constexpr std::uint32_t kMost = format::kMaxTriangles;
    EXPECT_GT(image_size_bound({kMost, kMost}), std::uint64_t{kMost} * 80) << "wraps around";
}

// The first bad vertex is named, whatever is wrong with it.
TEST(BuildModel, NumbersThatNoModelMayHoldAreRefusedByVertex) {
    const auto refusal = [](double x) {
        TestMesh mesh = test::unit_cube();
        mesh.positions[5].y = x;
        mesh.positions[7].x = x;
        return build_model(mesh.positions, mesh.triangles).error();
    };
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(refusal(std::numeric_limits<double>::quiet_NaN()).message,
              "Vertex 5 cannot be used: its y coordinate is NaN.");
    EXPECT_EQ(refusal(kInfinity).message, "Vertex 5 cannot be used: its y coordinate is infinite.");
    EXPECT_EQ(refusal(-kInfinity).message,
              "Vertex 5 cannot be used: its y coordinate is infinite.");
    EXPECT_EQ(refusal(-0x1.1p1000).message,
              "Vertex 5 cannot be used: its y coordinate lies beyond 2^1000.");
    EXPECT_EQ(refusal(1e300 * 1e8).code, ErrorCode::bad_argument);
    std::vector<Float3> floats = floats_of(test::unit_cube());
    floats[3].z = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(build_model(floats, test::unit_cube().triangles).error().message,
              "Vertex 3 cannot be used: its z coordinate is NaN.");
}

TEST(BuildModel, TrianglesOverVerticesThatAreNotThereAreRefused) {
    TestMesh mesh = test::unit_cube();
    mesh.triangles[4].vertex[1] = 8;
    EXPECT_EQ(build_model(mesh.positions, mesh.triangles).error().message,
              "Triangle 4 uses vertex 8 of 8: vertices are numbered from 0.");
    mesh.triangles[2].vertex[0] = 0xffffffffU;
    EXPECT_EQ(build_model(mesh.positions, mesh.triangles).error().message,
              "Triangle 2 uses vertex 4294967295 of 8: vertices are numbered from 0.");
    EXPECT_FALSE(build_model(std::span<const Double3>(), mesh.triangles));
}

}  // namespace
}  // namespace cdprep::build
