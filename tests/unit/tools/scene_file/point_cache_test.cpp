// SPDX-License-Identifier: MIT
#include "scene_file/point_cache.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/scratch_folder.h"

namespace cdprep::scenes {
namespace {

void append_word(std::string& bytes, std::uint32_t word) {
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(word >> (8 * i) & 255U));
}

/// A file of the form PC2, made by its description.
std::string cache_bytes(std::uint32_t points, std::uint32_t samples,
                        const std::vector<float>& numbers, std::uint32_t version = 1) {
    std::string bytes("POINTCACHE2\0", 12);
    append_word(bytes, version);
    append_word(bytes, points);
    append_word(bytes, std::bit_cast<std::uint32_t>(0.0f));
    append_word(bytes, std::bit_cast<std::uint32_t>(1.0f));
    append_word(bytes, samples);
    for (const float number : numbers) append_word(bytes, std::bit_cast<std::uint32_t>(number));
    return bytes;
}

Result<PointCache> parse_bytes(const std::string& bytes) {
    return PointCache::parse(import::SourceFile("c.pc2", bytes));
}

const std::vector<float> kNumbers = {1, 2, 3, 4, 5, 6, 3, 2, 1, 8, 5, 2};

// By hand: two points, two samples.
TEST(PointCache, ReadsSamples) {
    const test::ScratchFolder folder;
    const auto cache =
        PointCache::open(folder.write("c.pc2", std::string_view(cache_bytes(2, 2, kNumbers))));
    ASSERT_TRUE(cache) << cache.error().message;
    EXPECT_EQ(cache->points(), 2u);
    EXPECT_EQ(cache->samples(), 2u);
    EXPECT_EQ(cache->at({0, 0, 0}, 1), (format::Double3{4, 5, 6}));
    EXPECT_EQ(cache->at({1, 1, 0}, 0), (format::Double3{3, 2, 1}));
    EXPECT_EQ(cache->at({0, 1, 0.25}, 0), (format::Double3{1.5, 2, 2.5}));
}

TEST(PointCache, NamesEachMistake) {
    const std::string good = cache_bytes(2, 2, kNumbers);
    const float infinity = std::numeric_limits<float>::infinity();
    std::vector<float> not_a_number = kNumbers, infinite = kNumbers;
    not_a_number[10] = std::numeric_limits<float>::quiet_NaN();
    infinite[2] = -infinity;
    const std::pair<std::string, std::string> mistakes[] = {
        {"PC2",
         "c.pc2: byte 0: found 'PC2' as the first of 3 bytes; expected 'POINTCACHE2' and a "
         "zero."},
        {good.substr(0, 31), "c.pc2: the file ends at byte 31, within its header of 32 bytes."},
        {cache_bytes(2, 2, kNumbers, 2), "c.pc2: byte 12: found version 2; expected version 1."},
        {cache_bytes(0, 2, kNumbers), "c.pc2: byte 16: found 0 points; expected at least 1."},
        {cache_bytes(0xfffffffeU, 2, kNumbers),
         "c.pc2: byte 16: found -2 points; expected at least 1."},
        {cache_bytes(2, 0, kNumbers), "c.pc2: byte 28: found 0 samples; expected at least 1."},
        {cache_bytes(2, 3, kNumbers),
         "c.pc2: byte 28: found 3 samples of 24 bytes; expected as "
         "many as fit in the 48 bytes after the header."},
        {cache_bytes(2, 1, kNumbers),
         "c.pc2: byte 28: found 1 sample of 24 bytes; expected as "
         "many as fit in the 48 bytes after the header."},
        {cache_bytes(0x7fffffffU, 0x7fffffffU, kNumbers),
         "c.pc2: byte 28: found 2147483647 samples of 25769803764 bytes; expected as many as fit "
         "in the 48 bytes after the header."},
        {cache_bytes(2, 2, not_a_number),
         "c.pc2: sample 1: coordinate y of point 1 is not a "
         "number; expected a finite number."},
        {cache_bytes(2, 2, infinite),
         "c.pc2: sample 0: coordinate z of point 0 is infinite; "
         "expected a finite number."},
    };
    for (const auto& [bytes, sentence] : mistakes) {
        const auto cache = parse_bytes(bytes);
        ASSERT_FALSE(cache) << sentence;
        EXPECT_EQ(cache.error().code, ErrorCode::unreadable);
        EXPECT_EQ(cache.error().message, sentence);
    }
    EXPECT_FALSE(PointCache::open("no/such/file.pc2"));
}

TEST(PointCache, RejectsEveryTruncation) {
    const std::string good = cache_bytes(2, 2, kNumbers);
    ASSERT_TRUE(parse_bytes(good));
    for (std::size_t length = 0; length < good.size(); ++length) {
        EXPECT_FALSE(parse_bytes(good.substr(0, length))) << length;
    }
    EXPECT_FALSE(parse_bytes(good + "x"));
}

// By hand: three samples at 0, 0.5 and 1.
TEST(SamplesAt, StayOrRepeat) {
    using Pair = SamplePair;
    for (const bool repeats : {false, true}) {
        EXPECT_EQ(samples_at(0, 0.5, repeats, 3), (Pair{0, 1, 0}));
        EXPECT_EQ(samples_at(0.375, 0.5, repeats, 3), (Pair{0, 1, 0.75}));
        EXPECT_EQ(samples_at(0.5, 0.5, repeats, 3), (Pair{1, 2, 0}));
    }
    EXPECT_EQ(samples_at(1.25, 0.5, true, 3), (Pair{2, 0, 0.5}));
    EXPECT_EQ(samples_at(1.5, 0.5, true, 3), (Pair{0, 1, 0}));
    EXPECT_EQ(samples_at(1.5e9 + 0.125, 0.5, true, 3), (Pair{0, 1, 0.25}));
    for (const double time : {1.0, 1.25, 1.5, 1e300}) {
        EXPECT_EQ(samples_at(time, 0.5, false, 3), (Pair{2, 2, 0})) << time;
    }
    EXPECT_EQ(samples_at(7, 0.5, false, 1), (Pair{0, 0, 0}));
    EXPECT_EQ(samples_at(7.25, 0.5, true, 1), (Pair{0, 0, 0.5}));
    EXPECT_EQ(samples_at(1e300, 1e-300, false, 3), (Pair{2, 2, 0}));
}

// Times near a multiple of the period have places below the number of samples.
TEST(SamplesAt, AreAlwaysSamples) {
    for (std::size_t samples = 1; samples < 40; ++samples) {
        const double step = 0.1 / static_cast<double>(samples);
        double time = static_cast<double>(samples) * step;
        for (int i = 0; i < 8; ++i) {
            const SamplePair pair = samples_at(time, step, true, samples);
            EXPECT_LT(pair.first, samples);
            EXPECT_LT(pair.second, samples);
            EXPECT_TRUE(pair.share >= 0 && pair.share < 1) << pair.share;
            time = std::nextafter(time, 0);
        }
    }
}

}  // namespace
}  // namespace cdprep::scenes
