// SPDX-License-Identifier: MIT
#include "write/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "support/scratch_folder.h"
#include "unit/tools/image_sections.h"

namespace cdprep::write {
namespace {

using test::content_of;
using test::ScratchFolder;

void put(OutputFile& file, const std::string& text) {
    ASSERT_TRUE(file.write_at(0, std::as_bytes(std::span(text.data(), text.size()))));
}

using Temporary = OutputFile::Temporary;

/// With a name from the start, as on file systems without nameless files, and without.
class OutputFileOf : public testing::TestWithParam<Temporary> {
protected:
    Result<OutputFile> create(const std::string& name) const {
        return OutputFile::create(folder.file(name), GetParam());
    }

    const ScratchFolder folder;
};

INSTANTIATE_TEST_SUITE_P(Kinds, OutputFileOf,
                         testing::Values(Temporary::nameless_if_possible, Temporary::named),
                         [](const auto& kind) {
                             return kind.param == Temporary::named ? "named" : "nameless";
                         });

TEST(OutputFile, HasNoNameBeforeCommit) {
    const ScratchFolder folder;
    Result<OutputFile> file = OutputFile::create(folder.file("out"));
    ASSERT_TRUE(file);
    put(file.value(), "new");
    EXPECT_EQ(content_of(file->readable_path()), "new");
    if (!folder.names().empty()) GTEST_SKIP() << "this file system has no nameless files";
    ASSERT_TRUE(file.value().commit());
    EXPECT_EQ(folder.names(), (std::set<std::string>{"out"}));
}

TEST_P(OutputFileOf, AppearsWithCommitAndNotBefore) {
    {
        Result<OutputFile> file = create("out");
        ASSERT_TRUE(file);
        put(file.value(), "new");
        EXPECT_FALSE(folder.names().contains("out"));
        EXPECT_EQ(content_of(file->readable_path()), "new");
        ASSERT_TRUE(file.value().commit());
    }
    EXPECT_EQ(content_of(folder.file("out")), "new");
    EXPECT_EQ(folder.names(), (std::set<std::string>{"out"}));
}

TEST_P(OutputFileOf, WithoutCommitItLeavesNothing) {
    test::put_content(folder.file("out"), "old");
    {
        Result<OutputFile> file = create("out");
        ASSERT_TRUE(file);
        put(file.value(), "new");
    }
    EXPECT_EQ(content_of(folder.file("out")), "old");
    EXPECT_EQ(folder.names(), (std::set<std::string>{"out"}));
}

TEST_P(OutputFileOf, ALinkStaysAndWhatItNamesIsReplaced) {
    std::filesystem::create_directory(folder.file("far"));
    test::put_content(folder.file("far/out"), "old");
    std::filesystem::create_symlink("far/out", folder.file("near"));
    std::filesystem::create_symlink("near", folder.file("nearer"));
    {
        Result<OutputFile> file = create("nearer");
        ASSERT_TRUE(file);
        put(file.value(), "new");
        ASSERT_TRUE(file.value().commit());
    }
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("near")));
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("nearer")));
    EXPECT_EQ(content_of(folder.file("far/out")), "new");
}

// A rename would make a file of it, /dev/null too for who may.
TEST_P(OutputFileOf, NeitherAPipeNorAFolderIsReplaced) {
    std::filesystem::create_directory(folder.file("folder"));
    ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0666), 0);
    for (const char* name : {"folder", "pipe"}) {
        const Result<OutputFile> file = create(name);
        ASSERT_FALSE(file) << name;
        EXPECT_EQ(file.error().code, ErrorCode::unwritable);
        EXPECT_NE(file.error().message.find(name), std::string::npos);
    }
    EXPECT_EQ(folder.names(), (std::set<std::string>{"folder", "pipe"}));
}

TEST_P(OutputFileOf, AFolderThatTakesNoFilesIsNotCalledMissing) {
    const Result<OutputFile> missing = create("no/out");
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().message.find("no does not exist"), std::string::npos);
    if (!std::filesystem::is_directory("/proc/self")) GTEST_SKIP() << "/proc is not mounted";
    const Result<OutputFile> file = OutputFile::create("/proc/out", GetParam());
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, ErrorCode::unwritable);
    EXPECT_EQ(file.error().message,
              "/proc/out: cannot be written, because the folder /proc accepts no new files. "
              "Nothing was written.");
}

TEST_P(OutputFileOf, AnAbandonedTemporaryIsTakenOver) {
    const std::string stray = folder.file(".out.tmp");
    test::put_content(stray, "a much longer half of something");
    Result<OutputFile> file = create("out");
    ASSERT_TRUE(file);
    put(file.value(), "new");
    ASSERT_TRUE(file.value().commit());
    EXPECT_EQ(content_of(folder.file("out")), "new");
    EXPECT_EQ(folder.names(), (std::set<std::string>{"out"}));
}

TEST_P(OutputFileOf, TwoWritersOfOneTargetDoNotShareATemporary) {
    Result<OutputFile> first = create("out");
    Result<OutputFile> second = create("out");
    ASSERT_TRUE(first && second);
    EXPECT_NE(first.value().readable_path(), second.value().readable_path());
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
TEST_P(OutputFileOf, StraysOfSeveralKilledWritersAreRemoved) {
    const std::string first = folder.file(".out.tmp");
    const std::string second = folder.file(".out.tmp1");
    test::put_content(first, "stray");
    test::put_content(second, "stray");
    Result<OutputFile> next = create("out");
    ASSERT_TRUE(next && next.value().commit());
    EXPECT_EQ(folder.names(), (std::set<std::string>{"out"}));
}

TEST_P(OutputFileOf, ATemporaryThatIsBeingWrittenIsLeftAlone) {
    const std::string held = folder.file(".out.tmp");
    test::put_content(held, "held");
    const int descriptor = ::open(held.c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_GE(descriptor, 0);
    ASSERT_EQ(::flock(descriptor, LOCK_EX | LOCK_NB), 0);
    Result<OutputFile> file = create("out");
    ASSERT_TRUE(file);
    put(file.value(), "new");
    ASSERT_TRUE(file.value().commit());
    EXPECT_EQ(content_of(held), "held");
    EXPECT_EQ(content_of(folder.file("out")), "new");
    ::close(descriptor);
}

TEST_P(OutputFileOf, ALinkWithTheNameOfATemporaryIsNotFollowed) {
    test::put_content(folder.file("precious"), "kept");
    std::filesystem::create_symlink("precious", folder.file(".out.tmp"));
    Result<OutputFile> file = create("out");
    ASSERT_TRUE(file);
    put(file.value(), "new");
    ASSERT_TRUE(file.value().commit());
    EXPECT_EQ(content_of(folder.file("precious")), "kept");
    EXPECT_EQ(content_of(folder.file("out")), "new");
    EXPECT_EQ(folder.names(), (std::set<std::string>{".out.tmp", "out", "precious"}));
}

TEST(WriteAll, WritesEveryFile) {
    const ScratchFolder folder;
    test::put_content(folder.file("b"), "old");
    const std::vector<FileBytes> files = {{folder.file("a"), "one"}, {folder.file("b"), ""}};
    ASSERT_TRUE(write_all(files));
    EXPECT_EQ(content_of(folder.file("a")), "one");
    EXPECT_EQ(content_of(folder.file("b")), "");
    EXPECT_TRUE(write_all({}));
}

// All files are open at once: more than this process may open at first.
TEST(WriteAll, WritesMoreFilesThanMayBeOpen) {
    const ScratchFolder folder;
    std::vector<FileBytes> files;
    for (int i = 0; i < 100; ++i) files.push_back({folder.file(std::to_string(i)), "x"});
    struct rlimit before {};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    struct rlimit low = before;
    low.rlim_cur = 64;
    if (before.rlim_max < 1'000) GTEST_SKIP() << "this process may open only " << before.rlim_max;
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &low), 0);
    const Result<Done> written = write_all(files);
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_EQ(folder.names().size(), files.size());
}

TEST(WriteAll, WritesNothingIfOneFileCannotBeWritten) {
    const ScratchFolder folder;
    test::put_content(folder.file("a"), "old");
    const std::vector<FileBytes> files = {
        {folder.file("a"), "new"}, {folder.file("b"), "new"}, {folder.file("no folder/c"), "new"}};
    const Result<Done> written = write_all(files);
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::unwritable);
    EXPECT_EQ(content_of(folder.file("a")), "old");
    EXPECT_EQ(folder.names(), (std::set<std::string>{"a"}));
}

}  // namespace
}  // namespace cdprep::write
