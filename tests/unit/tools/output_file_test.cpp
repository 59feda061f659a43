// SPDX-License-Identifier: MIT
#include "write/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>

#include "support/scratch_folder.h"
#include "unit/tools/image_sections.h"

namespace cdprep::write {
namespace {

using test::content_of;
using test::ScratchFolder;

void put(OutputFile& file, const std::string& text) {
    ASSERT_TRUE(file.write_at(0, std::as_bytes(std::span(text.data(), text.size()))));
}

TEST(OutputFile, AppearsWithCommitAndNotBefore) {
    const ScratchFolder folder;
    {
        Result<OutputFile> file = OutputFile::create(folder.file("out"));
        ASSERT_TRUE(file);
        put(file.value(), "new");
        EXPECT_FALSE(folder.names().contains("out"));
        EXPECT_EQ(file.value().temporary().parent_path(),
                  std::filesystem::path(folder.file("out")).parent_path());
        ASSERT_TRUE(file.value().commit());
    }
    EXPECT_EQ(content_of(folder.file("out")), "new");
    EXPECT_EQ(folder.names(), (std::set<std::string>{"out"}));
}

TEST(OutputFile, WithoutCommitItLeavesNothing) {
    const ScratchFolder folder;
    test::put_content(folder.file("out"), "old");
    {
        Result<OutputFile> file = OutputFile::create(folder.file("out"));
        ASSERT_TRUE(file);
        put(file.value(), "new");
    }
    EXPECT_EQ(content_of(folder.file("out")), "old");
    EXPECT_EQ(folder.names(), (std::set<std::string>{"out"}));
}

TEST(OutputFile, ALinkStaysAndWhatItNamesIsReplaced) {
    const ScratchFolder folder;
    std::filesystem::create_directory(folder.file("far"));
    test::put_content(folder.file("far/out"), "old");
    std::filesystem::create_symlink("far/out", folder.file("near"));
    std::filesystem::create_symlink("near", folder.file("nearer"));
    {
        Result<OutputFile> file = OutputFile::create(folder.file("nearer"));
        ASSERT_TRUE(file);
        put(file.value(), "new");
        ASSERT_TRUE(file.value().commit());
    }
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("near")));
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("nearer")));
    EXPECT_EQ(content_of(folder.file("far/out")), "new");
}

// A rename would make a file of it, /dev/null too for who may.
TEST(OutputFile, NeitherAPipeNorAFolderIsReplaced) {
    const ScratchFolder folder;
    std::filesystem::create_directory(folder.file("folder"));
    ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0666), 0);
    for (const char* name : {"folder", "pipe"}) {
        const Result<OutputFile> file = OutputFile::create(folder.file(name));
        ASSERT_FALSE(file) << name;
        EXPECT_EQ(file.error().code, ErrorCode::unwritable);
        EXPECT_NE(file.error().message.find(name), std::string::npos);
    }
    EXPECT_EQ(folder.names(), (std::set<std::string>{"folder", "pipe"}));
}

/// What a killed writer leaves: its temporary, with no lock on it.
std::string abandoned_temporary(const ScratchFolder& folder) {
    Result<OutputFile> file = OutputFile::create(folder.file("out"));
    std::string name = file.value().temporary().string();
    return name;
}

TEST(OutputFile, AnAbandonedTemporaryIsTakenOver) {
    const ScratchFolder folder;
    const std::string stray = abandoned_temporary(folder);
    test::put_content(stray, "a much longer half of something");
    Result<OutputFile> file = OutputFile::create(folder.file("out"));
    ASSERT_TRUE(file);
    put(file.value(), "new");
    ASSERT_TRUE(file.value().commit());
    EXPECT_EQ(content_of(folder.file("out")), "new");
    EXPECT_EQ(folder.names(), (std::set<std::string>{"out"}));
}

TEST(OutputFile, TwoWritersOfOneTargetDoNotShareATemporary) {
    const ScratchFolder folder;
    Result<OutputFile> first = OutputFile::create(folder.file("out"));
    Result<OutputFile> second = OutputFile::create(folder.file("out"));
    ASSERT_TRUE(first && second);
    EXPECT_NE(first.value().temporary(), second.value().temporary());
    put(first.value(), "first");
    put(second.value(), "second");
    ASSERT_TRUE(first.value().commit());
    EXPECT_EQ(content_of(folder.file("out")), "first");
    ASSERT_TRUE(second.value().commit());
    EXPECT_EQ(content_of(folder.file("out")), "second");
    EXPECT_EQ(folder.names(), (std::set<std::string>{"out"}));
}

// Both were killed: the next writer takes the first one's temporary over and
// removes the second one's.
TEST(OutputFile, StraysOfSeveralKilledWritersAreRemoved) {
    const ScratchFolder folder;
    std::string first, second;
    {
        const Result<OutputFile> one = OutputFile::create(folder.file("out"));
        const Result<OutputFile> two = OutputFile::create(folder.file("out"));
        ASSERT_TRUE(one && two);
        first = one.value().temporary().string();
        second = two.value().temporary().string();
    }
    test::put_content(first, "stray");
    test::put_content(second, "stray");
    Result<OutputFile> next = OutputFile::create(folder.file("out"));
    ASSERT_TRUE(next && next.value().commit());
    EXPECT_EQ(folder.names(), (std::set<std::string>{"out"}));
}

TEST(OutputFile, ATemporaryThatIsBeingWrittenIsLeftAlone) {
    const ScratchFolder folder;
    const std::string held = abandoned_temporary(folder);
    test::put_content(held, "held");
    const int descriptor = ::open(held.c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_GE(descriptor, 0);
    ASSERT_EQ(::flock(descriptor, LOCK_EX | LOCK_NB), 0);
    Result<OutputFile> file = OutputFile::create(folder.file("out"));
    ASSERT_TRUE(file);
    put(file.value(), "new");
    ASSERT_TRUE(file.value().commit());
    EXPECT_EQ(content_of(held), "held");
    EXPECT_EQ(content_of(folder.file("out")), "new");
    ::close(descriptor);
}

}  // namespace
}  // namespace cdprep::write
