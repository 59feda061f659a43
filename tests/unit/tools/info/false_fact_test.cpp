// SPDX-License-Identifier: MIT
#include "info/false_fact.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "bake/pipeline.h"
#include "cdprep/format/find_damage.h"
#include "cli/command.h"
#include "support/changed_sections.h"
#include "support/defect_zoo.h"
#include "support/meshes.h"
#include "support/scratch_folder.h"
#include "write/mesh_file.h"

namespace cdprep::cli {
namespace {

using format::Bounds;
using format::Component;
using format::FileHeader;
using format::MassProperties;
using format::Verdict;
using test::AlignedBytes;
using test::TestMesh;

AlignedBytes bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    return AlignedBytes(std::as_bytes(std::span(text)));
}

/// The file that the program bakes.
AlignedBytes baked(const TestMesh& mesh, const std::string& effects = "all",
                   BakeOptions options = {}) {
    const test::ScratchFolder folder;
    const std::string input = folder.file("mesh.obj");
    const auto written = write::write_mesh_file(input, write::MeshFormat::obj,
                                                {mesh.positions, mesh.triangles, false, {}});
    EXPECT_TRUE(written);
    options.effects = parse_effects(effects).value();
    const Threads threads(1);
    const auto report =
        bake(input, folder.file("mesh.cdp.h5"), options, threads, [](const char*) {});
    EXPECT_TRUE(report) << report.error().message;
    return bytes_of(folder.file("mesh.cdp.h5"));
}

/// What is found false in a file that is safe to query, and in which nothing else is damaged.
std::optional<FalseFact> false_fact(const AlignedBytes& file) {
    const Result<Model> model = Model::open(file.span());
    EXPECT_TRUE(model) << model.error().message;
    if (!model) return std::nullopt;
    EXPECT_FALSE(format::find_deep_damage(file.span()));
    return find_false_fact(model.value());
}

std::string field_of(const std::optional<FalseFact>& fact) {
    return fact ? fact->field : "nothing";
}

/// A torus and a cube beside it: two balanced components, the first of genus 1.
TestMesh two_solids() {
    return test::joined(test::torus(2, 0.5, 12, 8),
                        test::moved_by(test::unit_cube(), 1, {5, 0, 0}));
}

/// The field of the fact that is found after element `index` of a section was changed.
template <class Element, class Change>
std::string after(const AlignedBytes& file, SectionId id, std::uint64_t index, Change change) {
    auto value = test::element<Element>(file, id, index);
    change(value);
    return field_of(false_fact(test::with(file, id, index * sizeof value, value)));
}

AlignedBytes with_header(const AlignedBytes& file, const FileHeader& header) {
    AlignedBytes changed(file.span());
    std::memcpy(changed.span().data(), &header, sizeof header);
    test::reseal(changed.span());
    return changed;
}

AlignedBytes with_flags(const AlignedBytes& file, std::uint32_t toggled) {
    FileHeader header = format::read_header(file.span());
    header.flags ^= toggled;
    return with_header(file, header);
}

/// Bake refuses coordinates that are not finite and corners that are not there.
bool can_be_baked(const test::ZooAnimal& animal) {
    return !animal.found.contains(101) && !animal.found.contains(102);
}

// What bake records was decided on this very mesh.
TEST(FalseFact, IsNotFoundInWhatBakeWrites) {
    std::vector<TestMesh> meshes = {two_solids(),
                                    test::grid_sheet(3, 2),
                                    test::klein_bottle(9, 7),
                                    test::three_sheets(),
                                    test::icosphere(2),
                                    test::coarse_grid_soup(7, 200, 2),
                                    test::reversed(two_solids()),
                                    test::moebius_strip(8)};
    for (const test::ZooAnimal& animal : test::defect_zoo()) {
        if (can_be_baked(animal)) meshes.push_back(animal.mesh);
    }
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        // Of which numbers of source triangles are kept, and of which not.
        for (const char* effects : {"all", "collide,inside", "inside,response", "response"}) {
            EXPECT_EQ(field_of(false_fact(baked(meshes[i], effects))), "nothing")
                << "mesh " << i << ", " << effects;
        }
        BakeOptions options;
        options.normalize = true;
        options.repair = "closed";
        EXPECT_EQ(field_of(false_fact(baked(meshes[i], "all", options))), "nothing")
            << "mesh " << i;
    }
}

// A sheet has a border, and two solids have none.
TEST(FalseFact, IsAForgedFlag) {
    const AlignedBytes sheet = baked(test::grid_sheet(3, 2));
    const auto balanced = false_fact(with_flags(sheet, format::model_balanced));
    ASSERT_TRUE(balanced);
    EXPECT_EQ(balanced->field, "the user block, field flags, flag balanced");
    EXPECT_EQ(balanced->found + balanced->expected, "10");
    const AlignedBytes solids = baked(two_solids());
    const auto unbalanced = false_fact(with_flags(solids, format::model_balanced));
    ASSERT_TRUE(unbalanced);
    EXPECT_EQ(unbalanced->found + unbalanced->expected, "01");
    // Two solids are longer than a model of diagonal 1.
    EXPECT_EQ(field_of(false_fact(with_flags(solids, format::model_normalized))),
              "the user block, field flags, flag normalized");
    BakeOptions options;
    options.normalize = true;
    const AlignedBytes small = baked(two_solids(), "all", options);
    EXPECT_EQ(field_of(false_fact(with_flags(small, format::model_normalized))),
              "the user block, field normalize_factor");
    FileHeader header = format::read_header(small.span());
    ASSERT_GT(header.normalize_factor, 0);
    FileHeader in_metres = header;
    in_metres.metres_per_unit = 1;
    EXPECT_EQ(field_of(false_fact(with_header(small, in_metres))),
              "the user block, field metres_per_unit");
    header.normalize_factor = 0;  // a normalized model with triangles was scaled by something
    EXPECT_EQ(field_of(false_fact(with_header(small, header))),
              "the user block, field normalize_factor");
}

// Each field is recomputed from the mesh, so any other value is false.
TEST(FalseFact, IsAForgedFieldOfAVerdict) {
    const AlignedBytes file = baked(two_solids());
    const auto field = [&](std::uint64_t index, auto change) {
        return after<Verdict>(file, SectionId::verdicts, index, change);
    };
    for (std::uint64_t i = 0; i < 3; ++i) {
        const std::string start = "section verdicts, element " + std::to_string(i) + ", field ";
        for (std::uint32_t bit = 0; bit < 32; ++bit) {
            ASSERT_EQ(field(i, [&](Verdict& v) { v.facts ^= 1U << bit; }), start + "facts") << bit;
            ASSERT_EQ(field(i, [&](Verdict& v) { v.promises ^= 1U << bit; }), start + "promises");
        }
        EXPECT_EQ(field(i, [](Verdict& v) { ++v.first_triangle; }), start + "first_triangle");
        EXPECT_EQ(field(i, [](Verdict& v) { ++v.boundary_loops; }), start + "boundary_loops");
        EXPECT_EQ(field(i, [](Verdict& v) { v.euler += 2; }), start + "euler");
        EXPECT_EQ(field(i, [](Verdict& v) { ++v.genus; }), start + "genus");
        EXPECT_EQ(field(i, [](Verdict& v) { v.area *= 1 + 0x1p-52; }), start + "area");
        EXPECT_EQ(field(i, [](Verdict& v) { v.volume = -v.volume; }), start + "volume");
    }
    EXPECT_EQ(field(1, [](Verdict& v) { --v.triangle_count; }),
              "section verdicts, element 1, field triangle_count");
}

TEST(FalseFact, IsAVerdictTooFew) {
    const AlignedBytes file = test::with_changed(baked(two_solids()), SectionId::verdicts,
                                                 [](std::vector<std::byte>& bytes) {
                                                     bytes.resize(bytes.size() - sizeof(Verdict));
                                                     return true;
                                                 });
    EXPECT_EQ(field_of(false_fact(file)), "section verdicts, number of elements");
}

// The torus has 192 triangles of the 204, and comes first.
TEST(FalseFact, IsAForgedComponent) {
    const AlignedBytes file = baked(two_solids());
    const auto field = [&](auto change) {
        return after<Component>(file, SectionId::components, 0, change);
    };
    const std::string start = "section components, element 0, field ";
    const auto cube = test::element<Component>(file, SectionId::components, 1);
    EXPECT_EQ(field([&](Component& c) { c.vertex = cube.vertex; }), start + "vertex");
    EXPECT_EQ(field([](Component& c) { c.flags = 0; }), start + "flags");
    EXPECT_EQ(field([](Component& c) { c.flags |= 2; }), start + "flags");
    EXPECT_EQ(field([](Component& c) { c.signed_volume = -c.signed_volume; }),
              start + "signed_volume");
    AlignedBytes moved(file.span());
    for (const auto& [index, count] : {std::pair{0U, 191U}, std::pair{1U, 13U}}) {
        auto component = test::element<Component>(moved, SectionId::components, index);
        component.triangle_count = count;
        moved = test::with(moved, SectionId::components, index * sizeof component, component);
    }
    EXPECT_EQ(field_of(false_fact(moved)), start + "triangle_count");
    const AlignedBytes one =
        test::with_changed(file, SectionId::components, [](std::vector<std::byte>& bytes) {
            Component first;
            std::memcpy(&first, bytes.data(), sizeof first);
            first.triangle_count = 204;
            bytes.resize(sizeof first);
            std::memcpy(bytes.data(), &first, sizeof first);
            return true;
        });
    EXPECT_EQ(field_of(false_fact(one)), "section components, number of elements");
}

// Without source_triangle the order of components is not known, but each must be there.
TEST(FalseFact, IsFoundWithoutSourceNumbers) {
    const AlignedBytes file = baked(two_solids(), "collide,inside");
    ASSERT_FALSE(format::find_section(file.span(), SectionId::source_triangle));
    const auto component = [&](auto change) {
        return after<Component>(file, SectionId::components, 0, change);
    };
    const auto other = test::element<Component>(file, SectionId::components, 1);
    EXPECT_EQ(component([](Component& c) { c.flags = 0; }),
              "section components, element 0, field flags");
    EXPECT_EQ(component([](Component& c) { c.signed_volume *= 1 + 1e-9; }),
              "section components, element 0, field signed_volume");
    EXPECT_NE(component([&](Component& c) { c.vertex = other.vertex; }), "nothing");
    const auto verdict = [&](std::uint64_t index, auto change) {
        return after<Verdict>(file, SectionId::verdicts, index, change);
    };
    EXPECT_EQ(verdict(0, [](Verdict& v) { v.facts ^= format::verdict_closed; }),
              "section verdicts, element 0, field facts");
    EXPECT_EQ(verdict(2, [](Verdict& v) { v.genus = 5; }),
              "section verdicts, of a component, field genus");
    EXPECT_EQ(verdict(1, [](Verdict& v) { v.area *= 1 + 1e-9; }),
              "section verdicts, of a component, field area");
    EXPECT_EQ(verdict(2, [](Verdict& v) { v.volume *= 1 + 1e-9; }),
              "section verdicts, of a component, field volume");
}

// The sheet [0, 3] x [0, 2] at z = 0 with one triangle folded flat.
TEST(FalseFact, IsAForgedDegenerateBit) {
    TestMesh mesh = test::grid_sheet(3, 2);
    mesh.triangles.push_back({{0, 1, 2}});  // three corners on the sheet's first row or column
    const AlignedBytes file = baked(mesh);
    const auto word = test::element<std::uint64_t>(file, SectionId::degenerate_bits, 0);
    ASSERT_NE(word, 0U);
    const std::uint64_t less = word & (word - 1);
    const std::string start = "section degenerate_bits, bit ";
    EXPECT_EQ(field_of(false_fact(test::with(file, SectionId::degenerate_bits, 0, less))),
              start + std::to_string(std::countr_zero(word)));
    EXPECT_EQ(field_of(false_fact(test::with(file, SectionId::degenerate_bits, 0,
                                             word ^ (std::uint64_t{1} << 63)))),
              start + "63");
    EXPECT_EQ(field_of(false_fact(test::without(file, SectionId::degenerate_bits))),
              start + std::to_string(std::countr_zero(word)));
}

// The box of two solids is [-2.5, 6] x [-2.5, 2.5] x [-0.5, 1].
TEST(FalseFact, IsAForgedBound) {
    const AlignedBytes file = baked(two_solids());
    const auto field = [&](auto change) {
        return after<Bounds>(file, SectionId::bounds, 0, change);
    };
    const std::string start = "section bounds, element 0, field ";
    EXPECT_EQ(field([](Bounds& b) { b.lower.x -= 1; }), start + "lower.x");
    EXPECT_EQ(field([](Bounds& b) { b.upper.z += 1e-9; }), start + "upper.z");
    EXPECT_EQ(field([](Bounds& b) { b.half_extent.y *= 1 - 1e-9; }), start + "half_extent.y");
    EXPECT_EQ(field([](Bounds& b) { b.half_extent.y *= 4; }), start + "half_extent");
    EXPECT_EQ(field([](Bounds& b) { b.axis[1].x += 1e-9; }), start + "axis");
    EXPECT_EQ(field([](Bounds& b) {
                  b.axis[2] = {-b.axis[2].x, -b.axis[2].y, -b.axis[2].z};
              }),
              start + "axis");
    EXPECT_EQ(field([](Bounds& b) { b.oriented_centre.x += 0.5; }).substr(0, start.size()), start);
}

// Sums of some hundred terms near 10 are right to 1e-12 and better.
TEST(FalseFact, IsAForgedMassProperty) {
    const AlignedBytes file = baked(two_solids());
    const auto field = [&](auto change) {
        return after<MassProperties>(file, SectionId::mass_properties, 0, change);
    };
    const std::string start = "section mass_properties, element 0, field ";
    EXPECT_EQ(field([](MassProperties& m) { m.volume *= 1 + 1e-10; }), start + "volume");
    EXPECT_EQ(field([](MassProperties& m) { m.surface_area *= 1 + 1e-10; }),
              start + "surface_area");
    EXPECT_EQ(field([](MassProperties& m) { m.centre.y += 1e-9; }), start + "centre.y");
    EXPECT_EQ(field([](MassProperties& m) { m.inertia[0] *= 1 + 1e-8; }), start + "inertia.xx");
    EXPECT_EQ(field([](MassProperties& m) { m.inertia[3] += 1e-7; }), start + "inertia.xy");
    // What another machine adds up in another order is no damage.
    EXPECT_EQ(field([](MassProperties& m) {
                  m.volume *= 1 + 0x1p-52;
                  m.surface_area *= 1 - 0x1p-52;
                  m.inertia[0] *= 1 + 0x1p-51;
              }),
              "nothing");
}

// An unbalanced mesh encloses nothing.
TEST(FalseFact, IsMassOfAnUnbalancedMesh) {
    const AlignedBytes solid = baked(two_solids());
    const AlignedBytes sheet = baked(test::grid_sheet(3, 2));
    std::vector<test::TinySection> sections;
    for (std::uint32_t number = 1; number < 64; ++number) {
        const SectionId id{number};
        const AlignedBytes& of = id == SectionId::mass_properties ? solid : sheet;
        const auto entry = format::find_section(of.span(), id);
        if (!entry) continue;
        const auto bytes = of.span().subspan(entry->offset, entry->count * entry->element_size);
        sections.push_back({id, {bytes.begin(), bytes.end()}});
    }
    const AlignedBytes file = test::assemble(format::read_header(sheet.span()), sections);
    EXPECT_EQ(field_of(false_fact(file)), "section mass_properties, number of elements");
}

// Two numbers of vertices change places, everywhere but in the order of first use.
TEST(FalseFact, IsAVertexOutOfOrder) {
    const AlignedBytes file = baked(test::unit_cube());
    const auto triangle = test::element<format::Triangle>(file, SectionId::triangles, 0);
    const format::Triangle turned = {{triangle.vertex[1], triangle.vertex[2], triangle.vertex[0]}};
    const Result<Model> honest = Model::open(file.span());
    ASSERT_TRUE(honest);
    const AlignedBytes forged = test::with(file, SectionId::triangles, 0, turned);
    const Result<Model> model = Model::open(forged.span());
    ASSERT_TRUE(model);
    EXPECT_EQ(field_of(find_false_fact(model.value())),
              "section triangles, element 0, field vertex");
}

// The finding of the outside review: a sheet that says it is balanced passed.
TEST(FalseFact, IsToldByInfoInOneSentence) {
    const test::ScratchFolder folder;
    const AlignedBytes sheet = baked(test::grid_sheet(3, 2));
    const AlignedBytes forged = with_flags(sheet, format::model_balanced);
    const std::string path = folder.write("sheet.cdp.h5", forged.span()).string();
    const Program program("cdprep", "1", "");
    Exit exit = Exit::success;
    add_info(program.root(), exit);
    const std::array plain = {"cdprep", "info", path.c_str()};
    const std::array deep = {"cdprep", "info", "--deep", path.c_str()};
    testing::internal::CaptureStdout();
    EXPECT_FALSE(program.parse(static_cast<int>(plain.size()), plain.data()));
    EXPECT_EQ(exit, Exit::success);  // safe to query
    static_cast<void>(testing::internal::GetCapturedStdout());
    testing::internal::CaptureStderr();
    EXPECT_FALSE(program.parse(static_cast<int>(deep.size()), deep.data()));
    EXPECT_EQ(exit, Exit::unreadable);
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "cdprep info: " + path +
                  ": the user block, field flags, flag balanced does not match the mesh: found 1, "
                  "expected 0. Copy the file again, or bake it again.\n");
}

}  // namespace
}  // namespace cdprep::cli
