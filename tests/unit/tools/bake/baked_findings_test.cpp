// SPDX-License-Identifier: MIT
#include "bake/baked_findings.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <sstream>
#include <string>

#include "bake/pipeline.h"
#include "support/scratch_folder.h"

namespace cdprep::cli {
namespace {

/// A report without findings, of a search that ended after so many pairs.
report::ValidationReport ended_after(std::uint64_t pairs) {
    report::ValidationReport report;
    report.defects.crossings_complete = false;
    report.defects.counts.self_intersecting_pairs = pairs;
    return report;
}

TEST(StrictRefusal, SaysWhichLimitEndedTheSearch) {
    EXPECT_EQ(strict_refusal(ended_after(1), 1),
              "the search for crossing triangles ended early, at --max-pairs 1, after 1 pair that "
              "meets. --strict requires a complete search: raise --max-pairs, or bake without "
              "--strict.");
    EXPECT_EQ(strict_refusal(ended_after(999), 1000),
              "the search for crossing triangles ended early, at the limit of its work, after 999 "
              "pairs that meet. --strict requires a complete search: bake without --strict.");
}

/// Pairs of closed tetrahedra, as OFF text. The tip of one touches the top of the other, within its
/// only triangle.
std::string touching_pairs(int count) {
    constexpr int kCorners = 8;
    constexpr std::array<std::array<int, 3>, kCorners> kPoints = {
        {{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {2, 2, -4}, {2, 2, 0}, {1, 1, 2}, {4, 1, 2}, {1, 4, 2}}};
    constexpr std::array<std::array<int, 3>, kCorners> kTriangles = {
        {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}, {5, 6, 7}, {4, 6, 5}, {4, 7, 6}, {4, 5, 7}}};
    std::ostringstream text;
    text << "OFF\n" << kCorners * count << ' ' << kCorners * count << " 0\n";
    for (int i = 0; i < count; ++i) {
        for (const auto& [x, y, z] : kPoints) text << x + 10 * i << ' ' << y << ' ' << z << '\n';
    }
    for (int i = 0; i < count; ++i) {
        for (const auto& [a, b, c] : kTriangles) {
            const int first = kCorners * i;
            text << "3 " << first + a << ' ' << first + b << ' ' << first + c << '\n';
        }
    }
    return text.str();
}

// By hand: solids that touch are a note and no warning, so only the limit refuses the mesh. A
// search of few triangles would end before the limit.
TEST(Bake, StrictRefusesAMeshThatWasNotFullyExamined) {
    const test::ScratchFolder folder;
    const std::filesystem::path input = folder.write("touching.off", touching_pairs(64));
    const std::filesystem::path output = folder.file("touching.cdp.h5");
    BakeOptions options;
    options.effects.sections = {format::SectionId::positions_f32, format::SectionId::positions_f64,
                                format::SectionId::triangles};
    options.strict = true;
    options.max_pairs = 1;
    const auto refused = bake(input, output, options, Threads(1), [](const char*) {});
    ASSERT_TRUE(refused) << refused.error().message;
    EXPECT_EQ(refused->exit, static_cast<int>(Exit::findings));
    ASSERT_TRUE(refused->error);
    EXPECT_NE(refused->error->find("ended early, at --max-pairs 1, "), std::string::npos)
        << *refused->error;
    EXPECT_FALSE(std::filesystem::exists(output));
    options.max_pairs = mesh::kDefaultMaxPairs;
    const auto baked = bake(input, output, options, Threads(1), [](const char*) {});
    ASSERT_TRUE(baked) << baked.error().message;
    EXPECT_EQ(baked->exit, 0);
    EXPECT_FALSE(baked->error) << *baked->error;
    EXPECT_TRUE(std::filesystem::exists(output));
}

}  // namespace
}  // namespace cdprep::cli
