// SPDX-License-Identifier: MIT
#include "cdprep/model.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "cdprep/format/sections.h"
#include "cdprep/pairs.h"
#include "core/mapped_file.h"
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
        EXPECT_EQ(opened.value().mesh().positions_f32.size(), 8u);
        EXPECT_TRUE(opened.value().mesh().positions_f64.empty());
        EXPECT_TRUE(opened.value().is_balanced());
        EXPECT_EQ(opened.value().record().components.size(), 1u);
        EXPECT_EQ(opened.value().record().mass, nullptr);
    }
}

/// The number of triangles that a query about two copies of a model finds: it reads every section.
std::size_t overlaps_of(const Model& model) {
    Workspace workspace;
    std::vector<TrianglePair> pairs(1000);
    const Pose pose = Pose::from_quaternion(1, 0, 0, 0, {0.5, 0.25, 0.125}).value();
    return overlaps({model, model, Placement::b_moves(pose)}, workspace, pairs);
}

fs::path write_cube(const ScratchFolder& scratch) {
    return scratch.write("cube.cdp.h5", baked_cube().span());
}

// Windows names files in UTF-16, other systems in bytes. Messages are in UTF-8 everywhere.
TEST(Model, OpensAndNamesAFileBeyondAscii) {
    const ScratchFolder scratch;
    const std::string name = "W\xc3\xbcrfel \xe7\xab\x8b \xf0\x9f\x93\xa6.cdp.h5";
    const std::optional<fs::path> relative = path_from_utf8(name.c_str());
    ASSERT_TRUE(relative);
    EXPECT_EQ(path_text(*relative), name);
    const fs::path path = scratch.path() / *relative;
    for (const OpenMode mode : {OpenMode::map, OpenMode::copy}) {
        const Result<Model> missing = Model::open(path, {.mode = mode});
        ASSERT_FALSE(missing);
        EXPECT_NE(missing.error().message.find(name + ": cannot be opened"), std::string::npos)
            << missing.error().message;
    }
    fs::rename(write_cube(scratch), path);
    for (const OpenMode mode : {OpenMode::map, OpenMode::copy}) {
        const Result<Model> opened = Model::open(path, {.mode = mode});
        ASSERT_TRUE(opened) << opened.error().message;
        EXPECT_EQ(opened.value().triangle_count(), 12U);
    }
}

// What POSIX promises of rename: an open file stays what it was.
TEST(Model, StaysWhatItWasWhenTheFileIsReplacedByRename) {
#ifdef _WIN32
    GTEST_SKIP() << "Windows refuses to replace a file that is mapped";
#endif
    for (const OpenMode mode : {OpenMode::map, OpenMode::copy}) {
        const ScratchFolder scratch;
        const fs::path path = write_cube(scratch);
        const Result<Model> before = Model::open(path, {.mode = mode});
        ASSERT_TRUE(before) << before.error().message;
        const std::size_t overlaps = overlaps_of(before.value());
        ASSERT_GT(overlaps, 0U);
        const TestMesh sphere = in_floats(icosphere(1));
        const AlignedBytes other = bake_tiny(sphere.positions, sphere.triangles);
        fs::rename(scratch.write("new", other.span()), path);
        EXPECT_EQ(before.value().triangle_count(), 12U);
        EXPECT_EQ(overlaps_of(before.value()), overlaps);
        const Result<Model> after = Model::open(path, {.mode = mode});
        ASSERT_TRUE(after) << after.error().message;
        EXPECT_EQ(after.value().triangle_count(), 80U);
        fs::remove(path);
        EXPECT_EQ(overlaps_of(before.value()), overlaps);
    }
}

// A copy is the Model's own; a mapping would end the test with SIGBUS.
TEST(Model, CopyStaysWhatItWasWhenTheFileIsTruncated) {
    const ScratchFolder scratch;
    const fs::path path = write_cube(scratch);
    const Result<Model> copied = Model::open(path, {.mode = OpenMode::copy});
    ASSERT_TRUE(copied) << copied.error().message;
    const std::size_t overlaps = overlaps_of(copied.value());
    fs::resize_file(path, 0);
    EXPECT_EQ(overlaps_of(copied.value()), overlaps);
    EXPECT_EQ(copied.value().triangle_count(), 12U);
}

// The same when it is rewritten in place: a mapping may see the new bytes.
TEST(Model, CopyStaysWhatItWasWhenTheFileIsRewritten) {
    const ScratchFolder scratch;
    const fs::path path = write_cube(scratch);
    const Result<Model> copied = Model::open(path, {.mode = OpenMode::copy});
    ASSERT_TRUE(copied) << copied.error().message;
    const std::size_t overlaps = overlaps_of(copied.value());
    std::fstream(path, std::ios::binary | std::ios::in | std::ios::out)
        << std::string(fs::file_size(path), '\xff');
    EXPECT_EQ(overlaps_of(copied.value()), overlaps);
    EXPECT_FALSE(Model::open(path, {.mode = OpenMode::copy}));
}

// Both modes look at the same bytes, so they refuse the same files in the same words.
TEST(Model, CopyIsCheckedAsAMappingIs) {
    const ScratchFolder scratch;
    AlignedBytes bytes = baked_cube();
    bytes.span()[bytes.size() - 1] ^= std::byte{1};
    for (const fs::path& path : {scratch.write("damaged", bytes.span()), scratch.path() / "none",
                                 scratch.path(), scratch.write("empty", "")}) {
        const Result<Model> mapped = Model::open(path);
        const Result<Model> copied = Model::open(path, {.mode = OpenMode::copy});
        ASSERT_FALSE(mapped);
        ASSERT_FALSE(copied) << path;
        EXPECT_EQ(copied.error().code, ErrorCode::unreadable);
        EXPECT_EQ(copied.error().message, mapped.error().message);
    }
}

// Spans of sections keep the alignment that the format promises.
TEST(Model, CopyIsAlignedAsSectionsAre) {
    const ScratchFolder scratch;
    const fs::path path = write_cube(scratch);
    const Result<Model> copied = Model::open(path, {.mode = OpenMode::copy});
    ASSERT_TRUE(copied) << copied.error().message;
    const auto place = reinterpret_cast<std::uintptr_t>(&copied.value().header());
    EXPECT_EQ(place % format::kSectionAlignment, 0U);
}

// Attributes of Linux's sysfs say that they have a page, and end before: as does a file that is
// truncated while it is copied.
TEST(Model, CopyOfAFileThatEndsEarlyIsRefused) {
    const fs::path path = "/sys/kernel/mm/transparent_hugepage/enabled";
    std::error_code none;
    if (!fs::is_regular_file(path, none) || fs::file_size(path, none) != 4096) {
        GTEST_SKIP() << "this system has no file that is shorter than it says";
    }
    const Result<Model> copied = Model::open(path, {.mode = OpenMode::copy});
    ASSERT_FALSE(copied);
    EXPECT_EQ(copied.error().code, ErrorCode::unreadable);
    EXPECT_NE(copied.error().message.find("had 4096 bytes when it was opened, but only "),
              std::string::npos)
        << copied.error().message;
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
    ASSERT_EQ(opened.value().record().verdicts.size(), 1u);
    EXPECT_EQ(opened.value().record().verdicts[0].promises, stored.promises);
    EXPECT_EQ(opened.value().record().verdicts[0].volume, 1.0);
    EXPECT_EQ(opened.value().record().findings, text);
    const AlignedBytes without = baked_cube();
    const auto none = Model::open(without.span());
    ASSERT_TRUE(none) << none.error().message;
    EXPECT_TRUE(none.value().record().verdicts.empty());
    EXPECT_TRUE(none.value().record().findings.empty());
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
                  .find("but its header states " + std::to_string(bytes.size())),
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
    const auto* triangles = first.model.mesh().triangles.data();
    const Model second = std::move(first.model);
    EXPECT_EQ(second.mesh().triangles.data(), triangles);
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
    EXPECT_TRUE(opened.value().source().triangle.empty());
    EXPECT_EQ(opened.value().sections(), wanted);
    Workspace workspace;
    EXPECT_TRUE(
        collide({opened.value(), opened.value(), Placement::b_moves(Pose())}, workspace).hit ==
        Answer::yes);
}

// Sections on pages of their own. A touch of a closed one ends the program, so all that it returns
// it has read.
TEST(Model, TouchReadsTheOpenSectionsThatItIsAskedFor) {
    const TestMesh ball = icosphere(4);
    const AlignedBytes bytes =
        bake_tiny(ball.positions, ball.triangles, {.section_alignment = 4096});
    const SectionSet wanted = {SectionId::bvh_nodes, SectionId::bvh_leaves};
    GuardedPages pages(bytes.span(), wanted);
    const auto opened = Model::open(pages.bytes(), wanted);
    ASSERT_TRUE(opened);
    const Model& model = opened.value();
    const std::size_t nodes = model.bvh().nodes.size_bytes();
    const std::size_t leaves = model.bvh().leaves.size_bytes();
    EXPECT_GT(leaves, 100'000U);
    EXPECT_EQ(model.touch(), nodes + leaves);
    EXPECT_EQ(model.touch(SectionSet{SectionId::bvh_leaves, SectionId::triangles}), leaves);
    EXPECT_EQ(model.touch(Ask::closest), nodes);
    EXPECT_EQ(model.touch(SectionSet{}), 0U);
    EXPECT_EQ(model.touch(Ask::nothing), 0U);
    pages.close(SectionId::bvh_nodes);
    EXPECT_EQ(model.touch(SectionSet{SectionId::bvh_leaves}), leaves);
    EXPECT_DEATH((void)model.touch(), "");
}

// By hand: one triangle of three is a segment. A query skips it whatever sections were named.
TEST(Model, TheMarksOfDegenerateTrianglesComeWithTheBvh) {
    const TestMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}},
                        {{{0, 1, 2}}, {{0, 3, 1}}, {{1, 3, 2}}}};
    const AlignedBytes bytes = bake_tiny(mesh.positions, mesh.triangles);
    const SectionSet some = {SectionId::bvh_nodes, SectionId::bvh_leaves,
                             SectionId::source_triangle};
    const auto opened = Model::open(bytes.span(), some);
    ASSERT_TRUE(opened);
    EXPECT_TRUE(opened.value().sections().contains(SectionId::degenerate_bits));
    Workspace workspace;
    const Pair twice = {*opened, *opened, Placement::b_moves(Pose())};
    Pair skipping = twice;
    skipping.options.degenerate = Degenerate::skip;
    EXPECT_EQ(overlaps(twice, workspace, {}), 9U);
    EXPECT_EQ(overlaps(skipping, workspace, {}), 4U);
    const SectionSet mesh_alone = {SectionId::triangles};
    EXPECT_TRUE(Model::open(bytes.span(), mesh_alone)
                    .value()
                    .sections()
                    .contains(SectionId::degenerate_bits));
    const SectionSet numbers_alone = {SectionId::source_triangle};
    EXPECT_FALSE(Model::open(bytes.span(), numbers_alone)
                     .value()
                     .sections()
                     .contains(SectionId::degenerate_bits));
}

}  // namespace
}  // namespace cdprep::test
