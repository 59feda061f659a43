// SPDX-License-Identifier: MIT
#include "scene_file/bake_cache.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "bake/effects.h"
#include "support/scratch_folder.h"

namespace cdprep::scenes {
namespace {

// A file that changes meanwhile counts as it was hashed first. Another cache hashes it anew.
TEST(BakeCache, HashesAFileOnce) {
    const std::string triangle = "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const test::ScratchFolder folder;
    const auto mesh = folder.write("m.off", std::string_view(triangle));
    const cli::Threads threads(1);
    std::size_t stages = 0;
    BakeCache first(folder.path() / "cache");
    const auto find_in = [&](BakeCache& cache, double weld_distance) {
        cli::BakeOptions options;
        options.effects = cli::parse_effects("collide").value();
        options.weld_distance = weld_distance;
        const auto baked =
            cache.find_or_bake(mesh, options, threads, [&](const char*) { ++stages; });
        EXPECT_TRUE(baked) << baked.error().message;
        return baked ? *baked : std::filesystem::path();
    };
    const auto plain = find_in(first, 0), welded = find_in(first, 0.5);
    EXPECT_NE(plain, welded) << "other options, as other models of one file have";
    stages = 0;
    folder.write("m.off", std::string_view("no mesh at all"));
    EXPECT_EQ(find_in(first, 0), plain);
    EXPECT_EQ(find_in(first, 0.5), welded);
    folder.write("m.off", triangle + "\n");
    EXPECT_EQ(stages, 0u);
    BakeCache second(folder.path() / "cache");
    EXPECT_NE(find_in(second, 0), plain);
    EXPECT_GT(stages, 0u);
}

}  // namespace
}  // namespace cdprep::scenes
