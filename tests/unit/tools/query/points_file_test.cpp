// SPDX-License-Identifier: MIT
#include "query/points_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/scratch_folder.h"

namespace cdprep::cli {
namespace {

// By hand: the numbers are those of the lines.
TEST(ReadRays, ReadsOneRayPerLine) {
    const test::ScratchFolder folder;
    const auto rays = read_rays(folder.write("rays", "# two\n1 2 3 0 0 1\n4, 5, 6, -1, 0, 0\n"));
    ASSERT_TRUE(rays) << rays.error().message;
    ASSERT_EQ(rays->size(), 2U);
    EXPECT_EQ((*rays)[0].origin, (Double3{1, 2, 3}));
    EXPECT_EQ((*rays)[0].direction, (Double3{0, 0, 1}));
    EXPECT_EQ((*rays)[1].origin, (Double3{4, 5, 6}));
    EXPECT_EQ((*rays)[1].direction, (Double3{-1, 0, 0}));
}

// A file with a wrong line is unreadable, whatever is wrong; the second line is.
TEST(ReadRays, NamesTheLineThatIsNoRay) {
    const test::ScratchFolder folder;
    for (const char* line : {"0 0 0 0 0 0", "1 2 3 0 -0.0 0", "1 2 3", "1 2 3 4 5 x"}) {
        const std::filesystem::path path =
            folder.write("rays", "1 2 3 0 0 1\n" + std::string(line) + "\n");
        const auto rays = read_rays(path);
        ASSERT_FALSE(rays) << line;
        EXPECT_EQ(rays.error().code, ErrorCode::unreadable) << line;
        EXPECT_TRUE(rays.error().message.starts_with(path.string() + ": line 2: "))
            << rays.error().message;
    }
}

}  // namespace
}  // namespace cdprep::cli
