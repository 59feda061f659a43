// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <utility>

#include "bake/effects.h"
#include "bake/pipeline.h"
#include "cdprep/advanced/build_model.h"
#include "cdprep/format/sections.h"
#include "cdprep/model.h"
#include "info/info_report.h"
#include "study/memory_model.h"
#include "support/meshes.h"
#include "support/scratch_folder.h"
#include "write/mesh_file.h"

namespace cdprep::cli {
namespace {

using format::SectionId;

// The mesh that a baked file holds, given to the library: of all that build_model() makes the
// file has the same bytes, and the same facts. Numbers of source vertices aside, which are
// those of another file.
TEST(BakedModel, TheLibraryBuildsWhatABakeHolds) {
    const test::ScratchFolder folder;
    for (const char* name : {"bracket", "bolt"}) {
        BakeOptions options;
        options.effects.sections = {
            SectionId::positions_f32,   SectionId::positions_f64,   SectionId::triangles,
            SectionId::source_triangle, SectionId::source_vertex,   SectionId::bvh_nodes,
            SectionId::bvh_leaves,      SectionId::degenerate_bits, SectionId::oriented_nodes,
            SectionId::swept_nodes,     SectionId::components};
        options.bounds = build::BvhBounds::oriented_and_swept;
        const std::string file = folder.file("m.cdp.h5");
        const auto baked = bake(std::string(CDPREP_SOURCE_DIR) + "/samples/meshes/" + name + ".obj",
                                file, options, Threads(1), [](const char*) {});
        ASSERT_TRUE(baked) << baked.error().message;
        const auto model = Model::open(file);
        ASSERT_TRUE(model) << model.error().message;
        const mesh::Mesh mesh = study::mesh_of(model.value());
        build::ModelArrays arrays = build::arrange_model(
            mesh.positions, mesh.triangles,
            build::build_bvh(mesh.positions, mesh.triangles, {.bounds = options.bounds}),
            mesh.single_precision ? build::Precision::single_precision
                                  : build::Precision::double_precision);
        const format::FileHeader& facts = model.value().header();
        EXPECT_EQ(arrays.facts.flags, facts.flags);
        EXPECT_EQ(arrays.facts.vertex_count, facts.vertex_count);
        EXPECT_EQ(arrays.facts.triangle_count, facts.triangle_count);
        EXPECT_EQ(arrays.facts.frame_origin, facts.frame_origin);
        EXPECT_EQ(arrays.facts.frame_exponent, facts.frame_exponent);
        const build::SectionList list = arrays.sections();
        const auto table = build::make_section_table(list.sections());
        ASSERT_TRUE(table);
        std::size_t compared = 0;
        for (const build::Section& section : list.sections()) {
            if (section.id == SectionId::source_vertex) continue;
            const auto* bytes = reinterpret_cast<const std::byte*>(&facts);
            const std::span<const std::byte> image(bytes, facts.file_size);
            const auto entry = format::find_section(image, section.id);
            ASSERT_TRUE(entry) << format::section_name(section.id);
            ASSERT_EQ(entry->count * entry->element_size, section.bytes.size());
            EXPECT_EQ(std::memcmp(image.data() + entry->offset, section.bytes.data(),
                                  section.bytes.size()),
                      0)
                << name << ": " << format::section_name(section.id);
            ++compared;
        }
        EXPECT_GE(compared, 8U);
    }
}

// A length of a normalised model is a share of the diagonal, whatever unit the source has.
TEST(BakedModel, ANormalizedOneHasNoUnit) {
    for (const bool normalize : {false, true}) {
        BakeOptions options;
        options.import.metres_per_unit = 0.001;
        options.normalize = normalize;
        auto image = bake_image(std::string(CDPREP_SOURCE_DIR) + "/samples/meshes/bracket.obj",
                                options, Threads(1), [](const char*) {});
        ASSERT_TRUE(image) << image.error().message;
        const auto model = Model::open(image.value().bytes());
        ASSERT_TRUE(model) << model.error().message;
        EXPECT_EQ(model.value().header().metres_per_unit, normalize ? 0 : 0.001);
    }
}

// By hand: if one triangle of a cube is reversed, each edge still has two triangles, but the
// directed uses of three edges do not cancel.
TEST(BakedModel, ACubeWithAReversedTriangleIsClosedAndUnbalanced) {
    test::TestMesh cube = test::unit_cube();
    std::swap(cube.triangles[5].vertex[0], cube.triangles[5].vertex[1]);
    const test::ScratchFolder folder;
    const std::string input = folder.file("cube.obj");
    const std::string output = folder.file("cube.cdp.h5");
    const auto written = write::write_mesh_file(input, write::MeshFormat::obj,
                                                {cube.positions, cube.triangles, false, {}});
    ASSERT_TRUE(written) << written.error().message;
    BakeOptions options;
    options.effects = parse_effects("collide").value();
    const auto baked = bake(input, output, options, Threads(1), [](const char*) {});
    ASSERT_TRUE(baked) << baked.error().message;
    EXPECT_FALSE(baked->balanced);
    const std::string line = report::bake_text(*baked, report::Timings::hide);
    EXPECT_NE(line.find(", unbalanced, "), std::string::npos) << line;
    const auto model = Model::open(output);
    ASSERT_TRUE(model) << model.error().message;
    ASSERT_FALSE(model.value().record().verdicts.empty());
    const std::uint32_t facts = model.value().record().verdicts[0].facts;
    EXPECT_NE(facts & format::verdict_closed, 0U);
    EXPECT_EQ(facts & format::verdict_balanced, 0U);
    const std::string text = report::info_text(output, model.value(), {});
    EXPECT_NE(text.find("because the mesh is unbalanced\n"), std::string::npos) << text;
    EXPECT_NE(text.find("mesh: closed, "), std::string::npos) << text;
    const std::string json = report::info_json(output, model.value(), {});
    EXPECT_NE(json.find("\"balanced\": false"), std::string::npos) << json;
}

}  // namespace
}  // namespace cdprep::cli
