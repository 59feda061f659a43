// SPDX-License-Identifier: MIT
#include "sort_pairs.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

namespace cdprep {
namespace {

constexpr std::size_t kFewPairs = 64;  ///< below, comparing is faster than counting
constexpr int kMostDigitBits = 9;
using Places = std::array<std::uint32_t, std::size_t{1} << kMostDigitBits>;

/// Some bits of the number of A's triangle.
struct Digit {
    int shift;
    int bits;
    std::size_t operator()(const TrianglePair& pair) const noexcept {
        return (pair.a >> shift) & ((std::uint32_t{1} << bits) - 1);
    }
};

/// One stable counting pass.
void sort_by_digit(std::span<const TrianglePair> from, TrianglePair* to, Digit digit) noexcept {
    Places place{};
    for (const TrianglePair& pair : from) ++place[digit(pair)];
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < (std::size_t{1} << digit.bits); ++i) {
        next += std::exchange(place[i], next);
    }
    for (const TrianglePair& pair : from) to[place[digit(pair)]++] = pair;
}

/// Sorts by A's triangle, in as few passes of equal width as will do.
void sort_by_a(std::span<TrianglePair> pairs, std::span<TrianglePair> other) noexcept {
    std::uint32_t all = 0;
    for (const TrianglePair& pair : pairs) all |= pair.a;
    const int bits = std::max(1, static_cast<int>(std::bit_width(all)));
    const int passes = (bits + kMostDigitBits - 1) / kMostDigitBits;
    const int width = (bits + passes - 1) / passes;
    std::span<TrianglePair> from = pairs;
    std::span<TrianglePair> to = other;
    for (int pass = 0; pass < passes; ++pass) {
        sort_by_digit(from, to.data(), {pass * width, width});
        std::swap(from, to);
    }
    if (from.data() != pairs.data()) std::copy(from.begin(), from.end(), pairs.begin());
}

}  // namespace

// A triangle seldom overlaps many: once the pairs stand by A's triangle, what is left
// are short runs.
void sort_pairs(std::span<TrianglePair> pairs, SortScratch& scratch) noexcept {
    if (pairs.size() <= kFewPairs || pairs.size() > scratch.size()) {
        std::sort(pairs.begin(), pairs.end());
        return;
    }
    sort_by_a(pairs, std::span(scratch).first(pairs.size()));
    for (auto first = pairs.begin(); first != pairs.end();) {
        const auto last = std::find_if(
            first, pairs.end(), [&](const TrianglePair& pair) { return pair.a != first->a; });
        if (last - first > 1) std::sort(first, last);
        first = last;
    }
}

}  // namespace cdprep
