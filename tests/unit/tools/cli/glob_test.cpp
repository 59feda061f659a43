// SPDX-License-Identifier: MIT
#include "cli/glob.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/scratch_folder.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;

class ExpandPattern : public ::testing::Test {
protected:
    ExpandPattern() {
        for (const char* name : {"a.obj", "b.stl", "in/a.obj", "in/deep/c.obj", ".git/d.obj",
                                 "in/.hidden.obj", "[x].obj"}) {
            const fs::path path = folder_.path() / name;
            fs::create_directories(path.parent_path());
            std::ofstream(path) << name;
        }
        fs::create_directory_symlink("..", folder_.path() / "in/up");
    }

    std::vector<std::string> expand(const std::string& pattern) {
        std::vector<std::string> names;
        for (const fs::path& path : expand_pattern((folder_.path() / pattern).string())) {
            names.push_back(path.lexically_relative(folder_.path()).string());
        }
        return names;
    }

    using Names = std::vector<std::string>;
    test::ScratchFolder folder_;
};

TEST_F(ExpandPattern, MatchesNamesAsAShellDoes) {
    EXPECT_EQ(expand("*.obj"), (Names{"[x].obj", "a.obj"}));
    EXPECT_EQ(expand("?.*"), (Names{"a.obj", "b.stl"}));
    EXPECT_EQ(expand("[!a].*"), (Names{"b.stl"}));
    EXPECT_EQ(expand("*/a.obj"), (Names{"in/a.obj"}));
    EXPECT_EQ(expand("in/.*.obj"), (Names{"in/.hidden.obj"}));
    EXPECT_EQ(expand("\\[x\\].*"), (Names{"[x].obj"}));
}

TEST_F(ExpandPattern, GoesDownAnyNumberOfFoldersButThroughNoLink) {
    EXPECT_EQ(expand("**/*.obj"), (Names{"[x].obj", "a.obj", "in/a.obj", "in/deep/c.obj"}));
    EXPECT_EQ(expand("in/**/c.obj"), (Names{"in/deep/c.obj"}));
    EXPECT_EQ(expand("**/**/c.obj"), (Names{"in/deep/c.obj"}));
}

TEST_F(ExpandPattern, MatchesNothingWhereNothingIs) {
    EXPECT_EQ(expand("*.ply"), Names{});
    EXPECT_EQ(expand("no/*.obj"), Names{});
    EXPECT_EQ(expand("a.obj/*"), Names{});
}

}  // namespace
}  // namespace cdprep::cli
