// SPDX-License-Identifier: MIT
// The second opinion is xxHash's own header, where it is installed (Debian: libxxhash-dev).
#include "cdprep/format/checksum.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

#if __has_include(<xxhash.h>)
#define XXH_INLINE_ALL
#include <xxhash.h>
#define CDPREP_HAVE_XXHASH
#endif

namespace cdprep::format {
namespace {

/// Bytes without a pattern, the same on every machine.
std::vector<std::byte> scrambled_bytes(std::size_t size, std::uint64_t seed) {
    std::vector<std::byte> bytes(size);
    std::uint64_t state = seed;
    for (std::byte& byte : bytes) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        byte = static_cast<std::byte>(state >> 56U);
    }
    return bytes;
}

std::uint64_t checksum_of_first(std::size_t size) {
    static const std::vector<std::byte> kBytes = scrambled_bytes(100'000, 1);
    return checksum(std::span(kBytes).first(size));
}

// Computed with xxHash 0.8.1, for machines without it: one size for each way to hash.
TEST(Checksum, IsThatOfXxh3) {
    EXPECT_EQ(checksum({}), 0x2D06800538D394C2U);
    EXPECT_EQ(checksum_of_first(1), 0xC00F9D4F580C0C3AU);
    EXPECT_EQ(checksum_of_first(3), 0xE92112D1E602AF4AU);
    EXPECT_EQ(checksum_of_first(4), 0x9008DE7E100606D1U);
    EXPECT_EQ(checksum_of_first(8), 0xCCA6EE6F8E080C52U);
    EXPECT_EQ(checksum_of_first(9), 0x568F9D2E69AD8BD0U);
    EXPECT_EQ(checksum_of_first(16), 0x600A07A4F5A9911CU);
    EXPECT_EQ(checksum_of_first(17), 0xDEAB0265F35DFC24U);
    EXPECT_EQ(checksum_of_first(32), 0xD04581C566616653U);
    EXPECT_EQ(checksum_of_first(64), 0xAD0685DABB3CE66BU);
    EXPECT_EQ(checksum_of_first(128), 0x410BD3B4D8D84F51U);
    EXPECT_EQ(checksum_of_first(129), 0x55964EEC39625032U);
    EXPECT_EQ(checksum_of_first(240), 0x977B659BDC81FDB1U);
    EXPECT_EQ(checksum_of_first(241), 0x2CB1ED4A30C8BDEDU);
    EXPECT_EQ(checksum_of_first(1024), 0x5EC111A1E5A293AEU);
    EXPECT_EQ(checksum_of_first(1025), 0x5EA0264528A903FCU);
    EXPECT_EQ(checksum_of_first(4097), 0x9DDE02683BA48D0EU);
    EXPECT_EQ(checksum_of_first(100000), 0x17728B9BA27F68A8U);
}

TEST(Checksum, AgreesWithXxHashForEverySize) {
#ifdef CDPREP_HAVE_XXHASH
    const std::vector<std::byte> bytes = scrambled_bytes(5'000, 2);
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
        // A copy of this size shows sanitizers what is read outside.
        const std::vector<std::byte> copy(bytes.begin(), bytes.begin() + std::ptrdiff_t(size));
        ASSERT_EQ(checksum(copy), XXH3_64bits(copy.data(), size)) << size;
    }
    // Unaligned, and blocks at both sides of the ends of long inputs.
    const std::vector<std::byte> many = scrambled_bytes(1'100'000, 3);
    for (const std::size_t size : {65'535U, 65'536U, 65'537U, 1'048'576U, 1'099'999U}) {
        for (const std::size_t from : {0U, 1U}) {
            const auto part = std::span(many).subspan(from, size);
            ASSERT_EQ(checksum(part), XXH3_64bits(part.data(), size)) << size << " from " << from;
        }
    }
    // Bytes of 0 and 255 alone: no carry is lost.
    for (const auto value : {std::byte{0}, std::byte{255}}) {
        const std::vector<std::byte> equal(3'000, value);
        for (std::size_t size = 0; size <= equal.size(); ++size) {
            ASSERT_EQ(checksum(std::span(equal).first(size)), XXH3_64bits(equal.data(), size));
        }
    }
#else
    GTEST_SKIP() << "xxhash.h is not installed (Debian: libxxhash-dev)";
#endif
}

}  // namespace
}  // namespace cdprep::format
