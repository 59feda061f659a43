// SPDX-License-Identifier: MIT
// XXH3 with 64 bits, seed 0 and the default secret (Yann Collet, xxHash 0.8, 2020). Written anew,
// so that the library is built without a header of others. checksum_test compares it with theirs.
// Numbers are read as on a little-endian machine; other machines refuse a file before this.
#include "cdprep/format/checksum.h"

#include <array>
#include <bit>
#include <cstring>

#if defined(__SSE2__) || defined(_M_X64)
#include <emmintrin.h>
#endif

namespace cdprep::format {
namespace {

constexpr std::uint64_t kPrime32[3] = {0x9E3779B1, 0x85EBCA77, 0xC2B2AE3D};
constexpr std::uint64_t kPrime[5] = {0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9,
                                     0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5};

/// Random bytes, which are part of the hash's definition.
alignas(64) constexpr std::uint8_t kSecret[192] = {
    0xb8, 0xfe, 0x6c, 0x39, 0x23, 0xa4, 0x4b, 0xbe, 0x7c, 0x01, 0x81, 0x2c, 0xf7, 0x21, 0xad, 0x1c,
    0xde, 0xd4, 0x6d, 0xe9, 0x83, 0x90, 0x97, 0xdb, 0x72, 0x40, 0xa4, 0xa4, 0xb7, 0xb3, 0x67, 0x1f,
    0xcb, 0x79, 0xe6, 0x4e, 0xcc, 0xc0, 0xe5, 0x78, 0x82, 0x5a, 0xd0, 0x7d, 0xcc, 0xff, 0x72, 0x21,
    0xb8, 0x08, 0x46, 0x74, 0xf7, 0x43, 0x24, 0x8e, 0xe0, 0x35, 0x90, 0xe6, 0x81, 0x3a, 0x26, 0x4c,
    0x3c, 0x28, 0x52, 0xbb, 0x91, 0xc3, 0x00, 0xcb, 0x88, 0xd0, 0x65, 0x8b, 0x1b, 0x53, 0x2e, 0xa3,
    0x71, 0x64, 0x48, 0x97, 0xa2, 0x0d, 0xf9, 0x4e, 0x38, 0x19, 0xef, 0x46, 0xa9, 0xde, 0xac, 0xd8,
    0xa8, 0xfa, 0x76, 0x3f, 0xe3, 0x9c, 0x34, 0x3f, 0xf9, 0xdc, 0xbb, 0xc7, 0xc7, 0x0b, 0x4f, 0x1d,
    0x8a, 0x51, 0xe0, 0x4b, 0xcd, 0xb4, 0x59, 0x31, 0xc8, 0x9f, 0x7e, 0xc9, 0xd9, 0x78, 0x73, 0x64,
    0xea, 0xc5, 0xac, 0x83, 0x34, 0xd3, 0xeb, 0xc3, 0xc5, 0x81, 0xa0, 0xff, 0xfa, 0x13, 0x63, 0xeb,
    0x17, 0x0d, 0xdd, 0x51, 0xb7, 0xf0, 0xda, 0x49, 0xd3, 0x16, 0x55, 0x26, 0x29, 0xd4, 0x68, 0x9e,
    0x2b, 0x16, 0xbe, 0x58, 0x7d, 0x47, 0xa1, 0xfc, 0x8f, 0xf8, 0xb8, 0xd1, 0x7a, 0xd0, 0x31, 0xce,
    0x45, 0xcb, 0x3a, 0x8f, 0x95, 0x16, 0x04, 0x28, 0xaf, 0xd7, 0xfb, 0xca, 0xbb, 0x4b, 0x40, 0x7e,
};

constexpr std::size_t kStripe = 64;          ///< bytes that are mixed at once, in eight lanes
constexpr std::size_t kStripesOfBlock = 16;  ///< the secret moves on by 8 bytes for each
constexpr std::size_t kBlock = kStripe * kStripesOfBlock;

using Lanes = std::array<std::uint64_t, 8>;

template <class Byte>
[[nodiscard]] std::uint64_t word(const Byte* bytes) noexcept {
    std::uint64_t value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

template <class Byte>
[[nodiscard]] std::uint64_t half_word(const Byte* bytes) noexcept {
    std::uint32_t value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

[[nodiscard]] std::uint64_t reversed(std::uint64_t value) noexcept {
    std::uint64_t bytes = 0;
    for (int i = 0; i < 8; ++i) bytes = (bytes << 8U) | ((value >> (8U * i)) & 0xFFU);
    return bytes;
}

/// The upper and the lower half of the product, joined by exclusive or.
[[nodiscard]] std::uint64_t folded_product(std::uint64_t a, std::uint64_t b) noexcept {
    const std::uint64_t a0 = a & 0xFFFFFFFFU, a1 = a >> 32U;
    const std::uint64_t b0 = b & 0xFFFFFFFFU, b1 = b >> 32U;
    const std::uint64_t low = a0 * b0, mixed = a1 * b0;
    const std::uint64_t middle = a0 * b1 + (low >> 32U) + (mixed & 0xFFFFFFFFU);
    return (a1 * b1 + (mixed >> 32U) + (middle >> 32U)) ^ (a * b);
}

[[nodiscard]] std::uint64_t avalanche(std::uint64_t hash) noexcept {
    hash = (hash ^ (hash >> 37U)) * 0x165667919E3779F9;
    return hash ^ (hash >> 32U);
}

/// The stronger one, for the shortest inputs.
[[nodiscard]] std::uint64_t strong_avalanche(std::uint64_t hash) noexcept {
    hash = (hash ^ (hash >> 33U)) * kPrime[1];
    hash = (hash ^ (hash >> 29U)) * kPrime[2];
    return hash ^ (hash >> 32U);
}

/// Mixes 16 bytes with 16 bytes of the secret.
[[nodiscard]] std::uint64_t mixed(const std::byte* bytes, const std::uint8_t* secret) noexcept {
    return folded_product(word(bytes) ^ word(secret), word(bytes + 8) ^ word(secret + 8));
}

[[nodiscard]] std::uint64_t hash_up_to_3(const std::byte* bytes, std::size_t size) noexcept {
    if (size == 0) return strong_avalanche(word(kSecret + 56) ^ word(kSecret + 64));
    const auto first = std::to_integer<std::uint64_t>(bytes[0]);
    const auto middle = std::to_integer<std::uint64_t>(bytes[size / 2]);
    const auto last = std::to_integer<std::uint64_t>(bytes[size - 1]);
    const std::uint64_t all = (first << 16U) | (middle << 24U) | last | (size << 8U);
    return strong_avalanche(all ^ half_word(kSecret) ^ half_word(kSecret + 4));
}

[[nodiscard]] std::uint64_t hash_4_to_8(const std::byte* bytes, std::size_t size) noexcept {
    const std::uint64_t all = half_word(bytes + size - 4) + (half_word(bytes) << 32U);
    std::uint64_t hash = all ^ word(kSecret + 8) ^ word(kSecret + 16);
    hash = (hash ^ std::rotl(hash, 49) ^ std::rotl(hash, 24)) * 0x9FB21C651E98DF25;
    hash = (hash ^ ((hash >> 35U) + size)) * 0x9FB21C651E98DF25;
    return hash ^ (hash >> 28U);
}

[[nodiscard]] std::uint64_t hash_9_to_16(const std::byte* bytes, std::size_t size) noexcept {
    const std::uint64_t low = word(bytes) ^ word(kSecret + 24) ^ word(kSecret + 32);
    const std::uint64_t high = word(bytes + size - 8) ^ word(kSecret + 40) ^ word(kSecret + 48);
    return avalanche(size + reversed(low) + high + folded_product(low, high));
}

/// Mixes from both ends inwards.
[[nodiscard]] std::uint64_t hash_17_to_128(const std::byte* bytes, std::size_t size) noexcept {
    std::uint64_t hash = size * kPrime[0];
    for (std::size_t i = (size - 1) / 32 + 1; i-- > 0;) {
        hash += mixed(bytes + 16 * i, kSecret + 32 * i);
        hash += mixed(bytes + size - 16 * (i + 1), kSecret + 32 * i + 16);
    }
    return avalanche(hash);
}

[[nodiscard]] std::uint64_t hash_129_to_240(const std::byte* bytes, std::size_t size) noexcept {
    std::uint64_t hash = size * kPrime[0];
    for (std::size_t i = 0; i < 8; ++i) hash += mixed(bytes + 16 * i, kSecret + 16 * i);
    hash = avalanche(hash);
    for (std::size_t i = 8; i < size / 16; ++i) {
        hash += mixed(bytes + 16 * i, kSecret + 16 * (i - 8) + 3);
    }
    return avalanche(hash + mixed(bytes + size - 16, kSecret + 119));
}

#if defined(__SSE2__) || defined(_M_X64)

// Every x86-64 processor has these instructions. Compilers do not make them of the loop below,
// which takes four times as long.
[[nodiscard]] inline __m128i load(const void* bytes) noexcept {
    return _mm_loadu_si128(static_cast<const __m128i*>(bytes));
}

[[nodiscard]] inline __m128i mixed_in(__m128i sum, const std::byte* stripe,
                                      const std::uint8_t* secret) noexcept {
    const __m128i data = load(stripe);
    const __m128i mix = _mm_xor_si128(data, load(secret));
    const __m128i product = _mm_mul_epu32(mix, _mm_srli_epi64(mix, 32));
    const __m128i swapped = _mm_shuffle_epi32(data, _MM_SHUFFLE(1, 0, 3, 2));
    return _mm_add_epi64(sum, _mm_add_epi64(product, swapped));
}

/// Mixes stripes into the lanes. The secret of each starts 8 bytes after that of the one before.
void add_stripes(Lanes& lanes, const std::byte* stripe, std::size_t count,
                 const std::uint8_t* secret) noexcept {
    // Variables stay in registers; elements of an array would not.
    __m128i a = load(&lanes[0]), b = load(&lanes[2]), c = load(&lanes[4]), d = load(&lanes[6]);
    for (std::size_t n = 0; n < count; ++n, stripe += kStripe, secret += 8) {
        a = mixed_in(a, stripe, secret);
        b = mixed_in(b, stripe + 16, secret + 16);
        c = mixed_in(c, stripe + 32, secret + 32);
        d = mixed_in(d, stripe + 48, secret + 48);
    }
    const __m128i sums[4] = {a, b, c, d};
    std::memcpy(lanes.data(), sums, sizeof sums);
}
#else

/// Does the same.
void add_stripes(Lanes& lanes, const std::byte* stripe, std::size_t count,
                 const std::uint8_t* secret) noexcept {
    for (std::size_t n = 0; n < count; ++n, stripe += kStripe, secret += 8) {
        for (std::size_t i = 0; i < lanes.size(); ++i) {
            const std::uint64_t data = word(stripe + 8 * i);
            const std::uint64_t mix = data ^ word(secret + 8 * i);
            lanes[i] += (mix & 0xFFFFFFFFU) * (mix >> 32U);
            lanes[i ^ 1U] += data;
        }
    }
}

#endif

void scramble(Lanes& lanes) noexcept {
    for (std::size_t i = 0; i < lanes.size(); ++i) {
        const std::uint64_t key = word(kSecret + sizeof kSecret - kStripe + 8 * i);
        lanes[i] = (lanes[i] ^ (lanes[i] >> 47U) ^ key) * kPrime32[0];
    }
}

[[nodiscard]] std::uint64_t hash_long(const std::byte* bytes, std::size_t size) noexcept {
    Lanes lanes = {kPrime32[2], kPrime[0],   kPrime[1], kPrime[2],
                   kPrime[3],   kPrime32[1], kPrime[4], kPrime32[0]};
    const std::size_t blocks = (size - 1) / kBlock;
    for (std::size_t block = 0; block < blocks; ++block) {
        add_stripes(lanes, bytes + block * kBlock, kStripesOfBlock, kSecret);
        scramble(lanes);
    }
    const std::size_t stripes = (size - 1 - blocks * kBlock) / kStripe;
    add_stripes(lanes, bytes + blocks * kBlock, stripes, kSecret);
    add_stripes(lanes, bytes + size - kStripe, 1, kSecret + sizeof kSecret - kStripe - 7);

    std::uint64_t hash = size * kPrime[0];
    for (std::size_t i = 0; i < 4; ++i) {
        const std::uint8_t* const secret = kSecret + 11 + 16 * i;
        hash += folded_product(lanes[2 * i] ^ word(secret), lanes[2 * i + 1] ^ word(secret + 8));
    }
    return avalanche(hash);
}

}  // namespace

std::uint64_t checksum(std::span<const std::byte> bytes) noexcept {
    const std::size_t size = bytes.size();
    if (size <= 3) return hash_up_to_3(bytes.data(), size);
    if (size <= 8) return hash_4_to_8(bytes.data(), size);
    if (size <= 16) return hash_9_to_16(bytes.data(), size);
    if (size <= 128) return hash_17_to_128(bytes.data(), size);
    if (size <= 240) return hash_129_to_240(bytes.data(), size);
    return hash_long(bytes.data(), size);
}

}  // namespace cdprep::format
