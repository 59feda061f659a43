// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"
#include "support/meshes.h"
#include "support/scratch_folder.h"
#include "unit/tools/image_sections.h"
#include "write/write_file.h"

namespace cdprep::write {
namespace {

using format::DamageKind;
using format::SectionId;
using test::content_of;
using test::ScratchFolder;

/// A baked file, and what h5repack with these options makes of it.
class Repacked {
public:
    explicit Repacked(const test::TestMesh& mesh, const std::string& options = "")
        : image_(test::bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true})) {
        const Result<Done> done =
            write_file(baked(), format::read_header(image_.span()), test::sections_of(image_));
        EXPECT_TRUE(done) << done.error().message;
        const std::string command =
            "h5repack " + options + " '" + baked() + "' '" + path() + "' > /dev/null 2>&1";
        is_made_ = std::system(command.c_str()) == 0;
    }

    [[nodiscard]] bool is_made() const {
        return is_made_;
    }
    [[nodiscard]] std::string baked() const {
        return folder_.file("baked.cdp.h5");
    }
    [[nodiscard]] std::string path() const {
        return folder_.file("repacked.cdp.h5");
    }
    [[nodiscard]] const ScratchFolder& folder() const {
        return folder_;
    }
    [[nodiscard]] const test::AlignedBytes& image() const {
        return image_;
    }

private:
    ScratchFolder folder_;
    test::AlignedBytes image_;
    bool is_made_ = false;
};

bool has_h5repack() {
    return std::system("h5repack --version > /dev/null 2>&1") == 0;
}

void expect_same_sections(const std::string& path, const test::AlignedBytes& image) {
    const std::string file = content_of(path);
    ASSERT_FALSE(format::find_damage(test::bytes_of(file)));
    for (const Section& section : test::sections_of(image)) {
        const auto entry = format::find_section(test::bytes_of(file), section.id);
        ASSERT_TRUE(entry) << format::section_name(section.id);
        ASSERT_EQ(entry->count * entry->element_size, section.bytes.size());
        if (section.bytes.empty()) continue;
        EXPECT_EQ(
            std::memcmp(file.data() + entry->offset, section.bytes.data(), section.bytes.size()), 0)
            << format::section_name(section.id);
    }
    EXPECT_EQ(format::read_header(test::bytes_of(file)).content_hash,
              format::read_header(image.span()).content_hash);
}

class ReindexFile : public testing::Test {
protected:
    void SetUp() override {
        if (!has_h5repack()) GTEST_SKIP() << "h5repack (hdf5-tools) is not installed";
    }
};

// Sections on both sides of the page threshold.
TEST_F(ReindexFile, MendsWhatH5repackMoved) {
    for (const test::TestMesh& mesh : {test::unit_cube(), test::grid_sheet(80, 80)}) {
        const Repacked repacked(mesh);
        ASSERT_TRUE(repacked.is_made());
        const std::string moved = content_of(repacked.path());
        const auto damage = format::find_damage(test::bytes_of(moved));
        ASSERT_TRUE(damage);
        EXPECT_EQ(damage->kind, DamageKind::rewritten);

        const Result<Done> done = reindex_file(repacked.path());
        ASSERT_TRUE(done) << done.error().message;
        expect_same_sections(repacked.path(), repacked.image());
        EXPECT_EQ(repacked.folder().names(),
                  (std::set<std::string>{"baked.cdp.h5", "repacked.cdp.h5"}));
    }
}

TEST_F(ReindexFile, MendsOtherLibraryVersionsAndPagedFiles) {
    for (const char* options : {"-L", "-S PAGE", "-L -c 65000 -d 0"}) {
        const Repacked repacked(test::icosphere(3), options);
        ASSERT_TRUE(repacked.is_made()) << options;
        const Result<Done> done = reindex_file(repacked.path());
        ASSERT_TRUE(done) << options << ": " << done.error().message;
        expect_same_sections(repacked.path(), repacked.image());
    }
}

TEST_F(ReindexFile, KeepsTheEntriesOfEmptySections) {
    const Repacked repacked({});
    ASSERT_TRUE(repacked.is_made());
    const Result<Done> done = reindex_file(repacked.path());
    if (!done) {  // nothing is stored, so nothing can be found
        EXPECT_EQ(done.error().code, ErrorCode::unreadable);
        return;
    }
    expect_same_sections(repacked.path(), repacked.image());
}

TEST_F(ReindexFile, NamesADatasetThatIsCompressed) {
    const Repacked repacked(test::icosphere(3), "-f GZIP=5");
    ASSERT_TRUE(repacked.is_made());
    const std::string before = content_of(repacked.path());
    const Result<Done> done = reindex_file(repacked.path());
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::unreadable);
    EXPECT_NE(done.error().message.find("positions_f64"), std::string::npos)
        << done.error().message;
    EXPECT_EQ(content_of(repacked.path()), before);
}

// A new checksum over changed bytes would bless the damage.
TEST_F(ReindexFile, RefusesDataThatIsNotTheBakedOne) {
    const Repacked repacked(test::icosphere(3));
    ASSERT_TRUE(repacked.is_made());
    std::string file = content_of(repacked.path());
    const std::string_view pattern = "\0\0\0\0\0\0\xf0\x3f";  // the double 1.0
    const std::size_t at = file.find(std::string(pattern.data(), 8), format::kUserBlockSize + 4096);
    ASSERT_NE(at, std::string::npos);
    file[at] = '\x01';
    test::put_content(repacked.path(), file);
    const Result<Done> done = reindex_file(repacked.path());
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::unreadable);
    EXPECT_EQ(content_of(repacked.path()), file);
}

TEST_F(ReindexFile, LeavesAnUntouchedFileAsItIs) {
    const Repacked repacked(test::icosphere(3));
    const std::string before = content_of(repacked.baked());
    ASSERT_TRUE(reindex_file(repacked.baked()));
    EXPECT_EQ(content_of(repacked.baked()), before);
}

TEST_F(ReindexFile, RefusesEveryTruncationOfTheUserBlockAndSome) {
    const Repacked repacked(test::unit_cube());
    const std::string file = content_of(repacked.path());
    for (std::size_t size = 0; size < file.size(); size += 97) {
        test::put_content(repacked.path(), file.substr(0, size));
        const Result<Done> done = reindex_file(repacked.path());
        ASSERT_FALSE(done) << size;
        EXPECT_EQ(done.error().code, ErrorCode::unreadable) << size;
    }
}

TEST_F(ReindexFile, RefusesWhatIsNotABake) {
    const ScratchFolder folder;
    test::put_content(folder.file("text"), std::string(10000, 'x'));
    for (const char* name : {"text", "missing"}) {
        const Result<Done> done = reindex_file(folder.file(name));
        ASSERT_FALSE(done);
        EXPECT_EQ(done.error().code, ErrorCode::unreadable);
        EXPECT_NE(done.error().message.find(name), std::string::npos);
    }
}

}  // namespace
}  // namespace cdprep::write
