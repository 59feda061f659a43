// SPDX-License-Identifier: MIT
#include "cli/output_path.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iostream>

#include "cli/input_list.h"
#include "support/scratch_folder.h"

namespace cdprep::cli {
namespace {

// The report must not mix with a mesh on standard output.
TEST(ReportStream, IsStandardErrorForAMeshOnStandardOutput) {
    EXPECT_EQ(&report_stream("-"), &std::cerr);
    for (const char* file : {"mesh.obj", "./-", "-.obj", ""}) {
        EXPECT_EQ(&report_stream(file), &std::cout) << file;
    }
}

// A file has many paths, and links may lead to one that does not exist yet.
TEST(UsedFiles, RefusesAnOutputThatIsUsedByAnyPath) {
    namespace fs = std::filesystem;
    const test::ScratchFolder scratch;
    const fs::path folder = scratch.path(), input = folder / "in.obj";
    std::ofstream(input) << "v 0 0 0\n";
    fs::create_symlink(input, folder / "link.obj");
    fs::create_directory_symlink(folder, folder / "same");
    fs::create_hard_link(input, folder / "hard.obj");
    fs::create_symlink(folder / "out.obj", folder / "latest.obj");
    const auto fails = [&](const fs::path& output) {
        UsedFiles used;
        used.add_input(input);
        const Result<Done> added = used.add_output(output);
        EXPECT_TRUE(added || added.error().code == ErrorCode::bad_argument);
        EXPECT_TRUE(added || added.error().message.starts_with(output.string() + " is an input"));
        return !added;
    };
    for (const char* path :
         {"in.obj", "./in.obj", "link.obj", "same/in.obj", "same/link.obj", "hard.obj"}) {
        EXPECT_TRUE(fails(folder / path)) << path;
    }
    EXPECT_TRUE(fails(fs::relative(input)));
    for (const char* path : {"out.obj", "same/out.obj", "no/in.obj"}) {
        EXPECT_FALSE(fails(folder / path)) << path;
    }
    EXPECT_FALSE(fails({}));
    for (const char* path : {"same/out.obj", "latest.obj"}) {
        UsedFiles used;
        EXPECT_TRUE(used.add_output(folder / "out.obj"));
        EXPECT_FALSE(used.add_output(folder / path)) << path;
    }
}

// Above a linked folder is the folder above its target.
TEST(Shortened, LeadsToTheSameFile) {
    namespace fs = std::filesystem;
    const test::ScratchFolder scratch;
    const fs::path folder = scratch.path();
    fs::create_directories(folder / "real" / "below");
    fs::create_directory(folder / "plain");
    fs::create_directory_symlink(folder / "real" / "below", folder / "link");
    for (const fs::path& file : {folder / "a.obj", folder / "real" / "a.obj"}) {
        std::ofstream(file) << "v 0 0 0\n";
    }
    EXPECT_EQ(shortened(folder / "plain" / ".." / "a.obj"), folder / "a.obj");
    EXPECT_EQ(shortened(folder / "." / "a.obj"), folder / "a.obj");
    const fs::path linked = folder / "link" / ".." / "a.obj";
    EXPECT_EQ(shortened(linked), linked);
    EXPECT_TRUE(fs::equivalent(shortened(linked), folder / "real" / "a.obj"));
    EXPECT_EQ(shortened(folder / "plain" / ".." / "none.obj"), folder / "none.obj");
    fs::remove(folder / "real" / "a.obj");
    EXPECT_EQ(shortened(linked), linked) << "another file has the shorter name";
}

TEST(ListInputs, KeepsFilesThatALinkTellsApart) {
    namespace fs = std::filesystem;
    const test::ScratchFolder scratch;
    const fs::path folder = scratch.path();
    fs::create_directories(folder / "real" / "below");
    fs::create_directory_symlink(folder / "real" / "below", folder / "link");
    for (const fs::path& file : {folder / "a.obj", folder / "real" / "a.obj"}) {
        std::ofstream(file) << "v 0 0 0\n";
    }
    const std::string plain = (folder / "a.obj").string();
    const std::string linked = (folder / "link" / ".." / "a.obj").string();
    const std::string direct = (folder / "real" / "." / "a.obj").string();
    EXPECT_EQ(list_inputs({plain, linked}).size(), 2U);
    EXPECT_EQ(list_inputs({linked, direct, plain, plain}).size(), 2U);
}

TEST(ListInputs, KeepsFilesBehindLinksThatLeadNowhere) {
    namespace fs = std::filesystem;
    const test::ScratchFolder scratch;
    for (const char* name : {"first", "second"}) {
        fs::create_symlink(name, scratch.path() / name);  // a link to itself
    }
    const std::string first = (scratch.path() / "first" / "a.obj").string();
    const std::string second = (scratch.path() / "second" / "a.obj").string();
    EXPECT_EQ(list_inputs({first, second, first}).size(), 2U);
}

}  // namespace
}  // namespace cdprep::cli
