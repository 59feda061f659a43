// SPDX-License-Identifier: MIT
#include "write/write_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <thread>

#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/scratch_folder.h"
#include "unit/tools/image_sections.h"

namespace cdprep::write {
namespace {

using format::SectionId;
using test::content_of;
using test::ScratchFolder;
using test::sections_of;

test::AlignedBytes image_of(const test::TestMesh& mesh) {
    return test::bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true});
}

Result<Done> write_image(const std::string& path, const test::AlignedBytes& image) {
    return write_file(path, format::read_header(image.span()), sections_of(image));
}

// Sizes on both sides of the page threshold: 12 and 12,800 triangles.
TEST(WriteFile, AWrittenFileHoldsTheSameSections) {
    const ScratchFolder folder;
    for (const test::TestMesh& mesh : {test::unit_cube(), test::grid_sheet(80, 80)}) {
        const test::AlignedBytes image =
            test::with_adaptive_octree(test::with_octree(image_of(mesh), {.threshold = 4}));
        const Result<Done> done = write_image(folder.file("m.cdp.h5"), image);
        ASSERT_TRUE(done) << done.error().message;
        const std::string file = content_of(folder.file("m.cdp.h5"));
        EXPECT_FALSE(format::find_damage(test::bytes_of(file)));
        for (const Section& section : sections_of(image)) {
            const auto entry = format::find_section(test::bytes_of(file), section.id);
            ASSERT_TRUE(entry) << format::section_name(section.id);
            ASSERT_EQ(entry->count * entry->element_size, section.bytes.size());
            if (section.bytes.empty()) continue;
            EXPECT_EQ(std::memcmp(file.data() + entry->offset, section.bytes.data(),
                                  section.bytes.size()),
                      0)
                << format::section_name(section.id);
        }
    }
}

// Outside HDF5's own structures: whatever header and table say but where sections lie. The
// sections' bytes are compared above.
TEST(WriteFile, AFileIsTheImageOfItsSectionsWrappedInHdf5) {
    const ScratchFolder folder;
    const test::AlignedBytes image = test::with_octree(image_of(test::grid_sheet(80, 80)), {});
    format::FileHeader facts = format::read_header(image.span());
    facts.metres_per_unit = 0.001;
    facts.up_axis = format::UpAxis::y;
    std::vector<Section> sections = sections_of(image);
    sections.push_back({SectionId::findings, {}});
    ASSERT_TRUE(write_file(folder.file("m.cdp.h5"), facts, sections));
    test::AlignedBytes memory(build::image_size(sections).value());
    const auto built = build::build_image(facts, sections, memory.span());
    ASSERT_TRUE(built);
    const std::string file = content_of(folder.file("m.cdp.h5"));
    const auto block_of = [](std::span<const std::byte> bytes) {
        // What depends on where sections lie and on HDF5.
        format::FileHeader header = format::read_header(bytes);
        header.file_size = header.header_checksum = 0;
        header.superblock = {};
        std::vector<std::byte> block(format::kUserBlockSize);
        std::copy_n(bytes.begin(), block.size(), block.begin());
        std::memcpy(block.data(), &header, sizeof header);
        for (std::uint32_t i = 0; i < header.section_count; ++i) {
            std::memset(block.data() + format::kSectionTableOffset +
                            i * sizeof(format::SectionEntry) +
                            offsetof(format::SectionEntry, offset),
                        0, sizeof(std::uint64_t));
        }
        return block;
    };
    EXPECT_EQ(block_of(test::bytes_of(file)), block_of(built.value()));
}

TEST(WriteFile, ASectionGivenTwiceIsRefusedAndNothingWritten) {
    const ScratchFolder folder;
    const test::AlignedBytes image = image_of(test::unit_cube());
    std::vector<Section> sections = sections_of(image);
    sections.push_back(sections.front());
    const Result<Done> done =
        write_file(folder.file("m.cdp.h5"), format::read_header(image.span()), sections);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::bad_argument);
    EXPECT_FALSE(std::filesystem::exists(folder.file("m.cdp.h5")));
}

// The content hash knows nothing of HDF5 or of where sections lie.
TEST(WriteFile, TheContentHashIsThatOfAnyOtherLayout) {
    const ScratchFolder folder;
    const test::AlignedBytes image = image_of(test::icosphere(2));
    ASSERT_TRUE(write_image(folder.file("m.cdp.h5"), image));
    const std::string file = content_of(folder.file("m.cdp.h5"));
    EXPECT_EQ(format::read_header(test::bytes_of(file)).content_hash,
              format::read_header(image.span()).content_hash);
}

TEST(WriteFile, LargeSectionsStartPagesAndSmallOnesCacheLines) {
    const ScratchFolder folder;
    ASSERT_TRUE(write_image(folder.file("m.cdp.h5"), image_of(test::grid_sheet(80, 80))));
    const std::string file = content_of(folder.file("m.cdp.h5"));
    int large = 0, small = 0;
    for (std::uint32_t number = 1; number < 64; ++number) {
        const auto entry =
            format::find_section(test::bytes_of(file), static_cast<SectionId>(number));
        if (!entry || entry->count == 0) continue;
        const bool is_large = entry->count * entry->element_size >= format::kPageThreshold;
        EXPECT_EQ(entry->offset % (is_large ? format::kPageAlignment : format::kSectionAlignment),
                  0U)
            << number;
        (is_large ? large : small) += 1;
    }
    EXPECT_GE(large, 2);
    EXPECT_GE(small, 1);
}

TEST(WriteFile, TheSectionTableIsSortedByIdWhateverTheOrderOfTheArguments) {
    const ScratchFolder folder;
    const test::AlignedBytes image = image_of(test::unit_cube());
    std::vector<Section> sections = sections_of(image);
    ASSERT_TRUE(write_file(folder.file("a"), format::read_header(image.span()), sections));
    std::reverse(sections.begin(), sections.end());
    ASSERT_TRUE(write_file(folder.file("b"), format::read_header(image.span()), sections));
    EXPECT_EQ(content_of(folder.file("a")), content_of(folder.file("b")));
}

// More than a second apart, under another name: a stored time would show.
TEST(WriteFile, TwoWritesAreByteIdentical) {
    const ScratchFolder folder;
    const test::AlignedBytes image = image_of(test::grid_sheet(80, 80));
    ASSERT_TRUE(write_image(folder.file("first.cdp.h5"), image));
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    ASSERT_TRUE(write_image(folder.file("quite_another_name.cdp.h5"), image));
    EXPECT_EQ(content_of(folder.file("first.cdp.h5")),
              content_of(folder.file("quite_another_name.cdp.h5")));
}

TEST(WriteFile, BehindTheUserBlockStandsHdf5) {
    const ScratchFolder folder;
    ASSERT_TRUE(write_image(folder.file("m.cdp.h5"), image_of(test::unit_cube())));
    const std::string file = content_of(folder.file("m.cdp.h5"));
    EXPECT_EQ(file.substr(format::kUserBlockSize, 8), "\x89HDF\r\n\x1a\n");
    EXPECT_EQ(file[format::kUserBlockSize + 8], 2) << "superblock of another version";
}

TEST(WriteFile, EmptySectionsHaveAnEntryAndNoOffset) {
    const ScratchFolder folder;
    ASSERT_TRUE(write_image(folder.file("m.cdp.h5"), image_of({})));
    const std::string file = content_of(folder.file("m.cdp.h5"));
    EXPECT_FALSE(format::find_damage(test::bytes_of(file)));
    const auto entry = format::find_section(test::bytes_of(file), SectionId::triangles);
    ASSERT_TRUE(entry);
    EXPECT_EQ(entry->count, 0U);
    EXPECT_EQ(entry->offset, 0U);
}

TEST(WriteFile, ReplacesTheOldFileAndLeavesNothingElse) {
    const ScratchFolder folder;
    test::put_content(folder.file("m.cdp.h5"), "something else");
    ASSERT_TRUE(write_image(folder.file("m.cdp.h5"), image_of(test::unit_cube())));
    EXPECT_TRUE(Model::open(folder.file("m.cdp.h5")).ok());
    EXPECT_EQ(folder.names(), (std::set<std::string>{"m.cdp.h5"}));
}

TEST(WriteFile, AMissingFolderIsASentence) {
    const ScratchFolder folder;
    const Result<Done> done =
        write_image(folder.file("nowhere/m.cdp.h5"), image_of(test::unit_cube()));
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::unwritable);
    EXPECT_NE(done.error().message.find("nowhere/m.cdp.h5: "), std::string::npos);
    EXPECT_EQ(done.error().message.back(), '.');
}

// What does not read back is never renamed: here a triangle uses vertex 999.
TEST(WriteFile, DamagedSectionsNeverAppearUnderTheName) {
    const ScratchFolder folder;
    test::put_content(folder.file("m.cdp.h5"), "old");
    const test::AlignedBytes image = image_of(test::unit_cube());
    std::vector<Section> sections = sections_of(image);
    std::vector<std::uint32_t> corners(36, 999);
    for (Section& section : sections) {
        if (section.id == SectionId::triangles) section.bytes = std::as_bytes(std::span(corners));
    }
    const Result<Done> done =
        write_file(folder.file("m.cdp.h5"), format::read_header(image.span()), sections);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::unwritable);
    EXPECT_EQ(content_of(folder.file("m.cdp.h5")), "old");
    EXPECT_EQ(folder.names(), (std::set<std::string>{"m.cdp.h5"}));
}

/// Makes every write beyond `bytes` fail while it lives, as a full disk does.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        std::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
    }

private:
    rlimit before_{};
};

// The writer meets the limit in HDF5's part, in the sections and at the end.
TEST(WriteFile, WhenNoMoreCanBeWrittenTheOldFileStays) {
    const ScratchFolder folder;
    const std::string path = folder.file("m.cdp.h5");
    ASSERT_TRUE(write_image(path, image_of(test::unit_cube())));
    const std::string old = content_of(path);
    const test::AlignedBytes image = image_of(test::grid_sheet(80, 80));
    ASSERT_TRUE(write_image(folder.file("whole"), image));
    const std::size_t whole = content_of(folder.file("whole")).size();
    int refused = 0;
    for (const std::size_t limit :
         {std::size_t{1}, std::size_t{5000}, whole / 4, whole / 2, whole - 4096, whole - 1}) {
        Result<Done> done = Done{};
        {
            const FileSizeLimit limited(limit);
            done = write_image(path, image);
        }
        ASSERT_FALSE(done) << limit;
        EXPECT_EQ(done.error().code, ErrorCode::unwritable);
        EXPECT_NE(done.error().message.find("m.cdp.h5: "), std::string::npos);
        EXPECT_EQ(done.error().message.find('\n'), std::string::npos);
        EXPECT_EQ(content_of(path), old) << limit;
        EXPECT_EQ(folder.names(), (std::set<std::string>{"m.cdp.h5", "whole"})) << limit;
        ++refused;
    }
    EXPECT_EQ(refused, 6);
    EXPECT_TRUE(write_image(path, image));
}

}  // namespace
}  // namespace cdprep::write
