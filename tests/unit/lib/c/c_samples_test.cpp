// SPDX-License-Identifier: MIT
// The samples in C, as a stranger runs them.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>

#include "support/meshes.h"
#include "support/scratch_folder.h"
#include "support/tiny_baker.h"

namespace cdprep::test {
namespace {

struct Close {
    void operator()(std::FILE* pipe) const {
        pclose(pipe);
    }
};

/// CDPREP_EMULATOR runs programs of another processor (tests/full/cross).
std::string output_of(const std::string& command) {
    const char* const emulator = std::getenv("CDPREP_EMULATOR");
    const std::string prefix = emulator != nullptr ? std::string(emulator) + " " : "";
    const std::unique_ptr<std::FILE, Close> pipe(popen((prefix + command + " 2>&1").c_str(), "r"));
    std::string output;
    std::array<char, 256> line{};
    while (std::fgets(line.data(), line.size(), pipe.get()) != nullptr) output += line.data();
    return output;
}

class CSamples : public testing::Test {
protected:
    CSamples() : path_((folder_.path() / "cube.cdp.h5").string()) {
        const TestMesh cube = unit_cube();
        const AlignedBytes file = bake_tiny(cube.positions, cube.triangles);
        std::ofstream(path_, std::ios::binary)
            .write(reinterpret_cast<const char*>(file.span().data()),
                   static_cast<std::streamsize>(file.size()));
    }
    [[nodiscard]] std::string run(const char* sample) const {
        return output_of(std::string(sample) + " " + path_ + " " + path_);
    }
    ScratchFolder folder_;
    std::string path_;
};

// By hand: the cube is 1 wide and moves by 0.01 a frame, so it hits itself up to frame 100, where
// the faces touch.
TEST_F(CSamples, ACubeHitsItselfUntilItHasMovedByItsWidth) {
    const std::string output = run(SAMPLE_COLLIDE);
    EXPECT_TRUE(output.starts_with("frame 0\nframe 1\n")) << output.substr(0, 100);
    EXPECT_TRUE(output.ends_with("frame 99\nframe 100\n"))
        << output.substr(output.size() < 100 ? 0 : output.size() - 100);
}

// By hand: a cube on itself, each triangle is in one pair with itself at least.
TEST_F(CSamples, ACubeOverlapsItself) {
    const std::string output = run(SAMPLE_OVERLAPS);
    EXPECT_TRUE(output.starts_with("0: (")) << output.substr(0, 100);
    EXPECT_TRUE(output.ends_with(" pairs\n")) << output;
}

// By hand: a cube of side 1 moves by 0.25 a step and touches another until step 4.
TEST(CSample, BuildsACubeFromArraysAndAsksIt) {
    EXPECT_EQ(output_of(SAMPLE_BUILD),
              "12 triangles, balanced\n"
              "x = 0: hit\n"
              "x = 0.25: hit\n"
              "x = 0.5: hit\n"
              "x = 0.75: hit\n"
              "x = 1: hit\n"
              "x = 1.25: 0.25 apart\n"
              "x = 1.5: 0.5 apart\n");
}

// By hand: crate i starts i - 0.75 above the floor and 1 high, and falls by 0.125 a frame.
TEST(CSample, CratesFallThroughTheFloor) {
    EXPECT_EQ(output_of(SAMPLE_FALL),
              "frame 1: crate 1 hits the floor\n"
              "frame 9: crate 2 hits the floor\n"
              "frame 10: crate 1 has passed the floor\n"
              "frame 17: crate 3 hits the floor\n"
              "frame 18: crate 2 has passed the floor\n"
              "frame 25: crate 4 hits the floor\n"
              "frame 26: crate 3 has passed the floor\n"
              "frame 34: crate 4 has passed the floor\n");
}

TEST_F(CSamples, AFileThatIsNotThereIsNamed) {
    const std::string output = output_of(std::string(SAMPLE_COLLIDE) + " nothing.cdp.h5 " + path_);
    EXPECT_NE(output.find("CDPREP_UNREADABLE: nothing.cdp.h5"), std::string::npos) << output;
}

}  // namespace
}  // namespace cdprep::test
