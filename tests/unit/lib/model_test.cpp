// SPDX-License-Identifier: MIT
#include "cdprep/model.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "cdprep/collide.h"
#include "cdprep/format/sections.h"
#include "support/guarded_pages.h"
#include "support/open_tiny.h"
#include "support/scratch_folder.h"

namespace cdprep::test {
namespace {

namespace fs = std::filesystem;

AlignedBytes baked_cube() {
    const TestMesh cube = unit_cube();
    return bake_tiny(cube.positions, cube.triangles);
}

TEST(Model, OpensFromAPathAsFromMemory) {
    const ScratchFolder scratch;
    const AlignedBytes bytes = baked_cube();
    const fs::path path = scratch.write("cube.cdp.h5", bytes.span());
    for (const auto& opened : {Model::open(path), Model::open_trusted(path)}) {
        ASSERT_TRUE(opened) << opened.error().message;
        EXPECT_EQ(opened.value().triangle_count(), 12u);
        EXPECT_EQ(opened.value().positions_f32().size(), 8u);
        EXPECT_TRUE(opened.value().positions_f64().empty());
        EXPECT_TRUE(opened.value().is_closed());
        EXPECT_EQ(opened.value().components().size(), 1u);
        EXPECT_EQ(opened.value().mass_properties(), nullptr);
    }
}

// Written by hand: what is read must be what was stored.
TEST(Model, ShowsWhatWasFoundWhenItWasBaked) {
    const format::Verdict stored{format::verdict_closed | format::verdict_balanced,
                                 format::promise_surface | format::promise_inside_exact,
                                 12,
                                 0,
                                 0,
                                 2,
                                 0,
                                 0,
                                 6.0,
                                 1.0};
    const auto bytes = std::as_bytes(std::span(&stored, 1));
    const std::string text = "{\"findings\":[]}";
    const auto letters = std::as_bytes(std::span(text));
    format::FileHeader facts{};
    facts.triangle_count = 12;
    const AlignedBytes file =
        assemble(facts, {{SectionId::verdicts, {bytes.begin(), bytes.end()}},
                         {SectionId::findings, {letters.begin(), letters.end()}}});
    const auto opened = Model::open(file.span());
    ASSERT_TRUE(opened) << opened.error().message;
    ASSERT_EQ(opened.value().verdicts().size(), 1u);
    EXPECT_EQ(opened.value().verdicts()[0].promises, stored.promises);
    EXPECT_EQ(opened.value().verdicts()[0].volume, 1.0);
    EXPECT_EQ(opened.value().findings(), text);
    const AlignedBytes without = baked_cube();
    const auto none = Model::open(without.span());
    ASSERT_TRUE(none) << none.error().message;
    EXPECT_TRUE(none.value().verdicts().empty());
    EXPECT_TRUE(none.value().findings().empty());
}

TEST(Model, SaysWhatIsWrongWithAFile) {
    const ScratchFolder scratch;
    const AlignedBytes bytes = baked_cube();
    const auto sentence = [](const fs::path& path) {
        const auto opened = Model::open(path);
        return opened ? std::string("opened") : opened.error().message;
    };
    EXPECT_NE(sentence(scratch.path() / "none").find("cannot be opened"), std::string::npos);
    EXPECT_NE(sentence(scratch.path()).find("not a regular file"), std::string::npos);
    EXPECT_NE(sentence(scratch.write("empty", "")).find("has 0 bytes"), std::string::npos);
    EXPECT_NE(sentence(scratch.write("cut", bytes.span().first(bytes.size() - 1)))
                  .find("but its header says " + std::to_string(bytes.size())),
              std::string::npos);
    AlignedBytes flipped(bytes.span());
    flipped.span()[bytes.size() - 64] ^= std::byte{1};
    EXPECT_NE(sentence(scratch.write("flipped", flipped.span())).find("has checksum"),
              std::string::npos);
}

TEST(Model, MisalignedMemoryIsRefused) {
    const AlignedBytes bytes = baked_cube();
    AlignedBytes shifted(bytes.size() + 8);
    std::memcpy(shifted.span().data() + 8, bytes.span().data(), bytes.size());
    const auto opened = Model::open(std::as_const(shifted).span().subspan(8));
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, ErrorCode::bad_argument);
}

TEST(Model, MovingKeepsTheSpans) {
    OpenModel first = open_tiny(unit_cube());
    const auto* triangles = first.model.triangles().data();
    const Model second = std::move(first.model);
    EXPECT_EQ(second.triangles().data(), triangles);
}

TEST(Model, NamesBeyondTheLastAreEmpty) {
    format::FileHeader facts{};
    std::vector<std::byte> names;
    for (const char c : std::string("left\0right\0", 11)) names.push_back(std::byte(c));
    const AlignedBytes bytes = assemble(facts, {{SectionId::group_names, names}});
    const auto opened = Model::open(bytes.span());
    ASSERT_TRUE(opened) << opened.error().message;
    const Model& model = opened.value();
    EXPECT_EQ(model.name(SectionId::group_names, 0), "left");
    EXPECT_EQ(model.name(SectionId::group_names, 1), "right");
    EXPECT_EQ(model.name(SectionId::group_names, 2), "");
    EXPECT_EQ(model.name(SectionId::material_names, 0), "");
}

// Sections on pages of their own; any access to an unwanted one ends the program.
TEST(Model, OpenAndQueryTouchOnlyTheSectionsAskedFor) {
    const TestMesh cube = unit_cube();
    const AlignedBytes bytes =
        bake_tiny(cube.positions, cube.triangles, {.section_alignment = 4096});
    const SectionSet wanted = {SectionId::bvh_nodes, SectionId::bvh_leaves};
    const GuardedPages pages(bytes.span(), wanted);
    EXPECT_GE(pages.guarded(), 5);
    const auto opened = Model::open(pages.bytes(), wanted);
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_TRUE(opened.value().source_triangle().empty());
    EXPECT_EQ(opened.value().sections(), wanted);
    Workspace workspace;
    EXPECT_TRUE(collide(opened.value(), opened.value(), Placement::b_moves(Pose()), workspace).hit);
}

}  // namespace
}  // namespace cdprep::test
