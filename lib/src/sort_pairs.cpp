// SPDX-License-Identifier: MIT
#include "sort_pairs.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace cdprep {
namespace {

constexpr std::size_t kFewPairs = 64;  ///< below, comparing is faster than counting
constexpr int kDigitBits = 8;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;

/// One stable counting pass by the digit of `number` at `shift`.
template <class Number>
void sort_by_digit(std::span<const TrianglePair> from, TrianglePair* to, int shift,
                   Number number) noexcept {
    std::array<std::uint32_t, kDigits> place{};
    const auto digit = [&](const TrianglePair& pair) {
        return (number(pair) >> shift) & (kDigits - 1);
    };
    for (const TrianglePair& pair : from) ++place[digit(pair)];
    std::uint32_t next = 0;
    for (std::uint32_t& count : place) {
        const std::uint32_t first = next;
        next += count;
        count = first;
    }
    for (const TrianglePair& pair : from) to[place[digit(pair)]++] = pair;
}

}  // namespace

void sort_pairs(std::span<TrianglePair> pairs, SortScratch& scratch) noexcept {
    if (pairs.size() <= kFewPairs || pairs.size() > scratch.size()) {
        std::sort(pairs.begin(), pairs.end());
        return;
    }
    std::uint32_t bits_a = 0;
    std::uint32_t bits_b = 0;
    for (const TrianglePair& pair : pairs) {
        bits_a |= pair.a;
        bits_b |= pair.b;
    }
    std::span<TrianglePair> from = pairs;
    std::span<TrianglePair> to(scratch.data(), pairs.size());
    const auto pass = [&](std::uint32_t bits, auto number) {
        for (int shift = 0; shift < static_cast<int>(std::bit_width(bits)); shift += kDigitBits) {
            sort_by_digit(from, to.data(), shift, number);
            std::swap(from, to);
        }
    };
    pass(bits_b, [](const TrianglePair& pair) { return pair.b; });
    pass(bits_a, [](const TrianglePair& pair) { return pair.a; });
    if (from.data() != pairs.data()) std::copy(from.begin(), from.end(), pairs.begin());
}

}  // namespace cdprep
