// SPDX-License-Identifier: MIT
#include "core/sort_pairs.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <utility>

namespace cdprep {
namespace {

constexpr std::size_t kFewPairs = 64;  ///< below, comparison sorting is faster than counting
constexpr int kMostDigitBits = 9;
constexpr int kPartBits = std::bit_width(PairParts::kParts - 1);
using Places = std::array<std::uint32_t, std::size_t{1} << kMostDigitBits>;

std::uint64_t key_of(const TrianglePair& pair) noexcept {
    return std::uint64_t{pair.a} << 32 | pair.b;
}

/// Returns the bits in which keys differ.
std::uint64_t differing_bits(std::span<const TrianglePair> pairs) noexcept {
    std::uint64_t any = 0;
    std::uint64_t all = ~std::uint64_t{0};
    for (const TrianglePair& pair : pairs) {
        any |= key_of(pair);
        all &= key_of(pair);
    }
    return pairs.empty() ? 0 : any ^ all;
}

/// Some bits of the number of A's triangle.
struct Digit {
    int shift;
    int bits;
    std::size_t operator()(const TrianglePair& pair) const noexcept {
        return (pair.a >> shift) & ((std::uint32_t{1} << bits) - 1);
    }
};

/// Performs one stable counting pass.
void sort_by_digit(std::span<const TrianglePair> from, TrianglePair* to, Digit digit) noexcept {
    assert(digit.bits > 0 && digit.bits <= kMostDigitBits);
    Places place{};
    for (const TrianglePair& pair : from) ++place[digit(pair)];
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < (std::size_t{1} << digit.bits); ++i) {
        next += std::exchange(place[i], next);
    }
    for (const TrianglePair& pair : from) to[place[digit(pair)]++] = pair;
}

/// Sorts by A's triangle, in the fewest passes of equal width.
void sort_by_a(std::span<TrianglePair> pairs, std::span<TrianglePair> other) noexcept {
    const auto differing = static_cast<std::uint32_t>(differing_bits(pairs) >> 32);
    const int bits = std::max(1, static_cast<int>(std::bit_width(differing)));
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

/// Sorts at most as many pairs as the scratch holds. A triangle seldom overlaps many others, so
/// short runs remain after the sort by A's triangle.
void sort_few(std::span<TrianglePair> pairs, SortScratch& scratch) noexcept {
    assert(pairs.size() <= scratch.size());
    sort_by_a(pairs, std::span(scratch).first(pairs.size()));
    for (auto first = pairs.begin(); first != pairs.end();) {
        const auto last = std::find_if(
            first, pairs.end(), [&](const TrianglePair& pair) { return pair.a != first->a; });
        if (last - first > 1) std::sort(first, last);
        first = last;
    }
}

}  // namespace

// In place: McIlroy, Bostic and McIlroy 1993, "American flag sort".
PairParts divide_pairs(std::span<TrianglePair> pairs) noexcept {
    const int width = std::bit_width(differing_bits(pairs));
    const int shift = std::max(0, width - kPartBits);
    const auto part = [&](const TrianglePair& pair) {
        return static_cast<std::size_t>(key_of(pair) >> shift) % PairParts::kParts;
    };
    PairParts parts{};
    for (const TrianglePair& pair : pairs) ++parts.first[part(pair) + 1];
    for (std::size_t i = 0; i < PairParts::kParts; ++i) parts.first[i + 1] += parts.first[i];
    std::array<std::size_t, PairParts::kParts> next{};
    std::copy_n(parts.first.begin(), PairParts::kParts, next.begin());
    for (std::size_t i = 0; i < PairParts::kParts; ++i) {
        while (next[i] < parts.first[i + 1]) {
            TrianglePair pair = pairs[next[i]];
            for (std::size_t at = part(pair); at != i; at = part(pair)) {
                std::swap(pair, pairs[next[at]++]);
            }
            pairs[next[i]++] = pair;
        }
    }
    return parts;
}

void sort_pairs(std::span<TrianglePair> pairs, SortScratch& scratch) noexcept {
    if (pairs.size() <= kFewPairs) {
        std::sort(pairs.begin(), pairs.end());
    } else if (pairs.size() <= scratch.size()) {
        sort_few(pairs, scratch);
    } else if (differing_bits(pairs) != 0) {
        // Each part differs in fewer bits than the whole, so the recursion ends.
        const PairParts parts = divide_pairs(pairs);
        for (std::size_t i = 0; i < PairParts::kParts; ++i) {
            sort_pairs(pairs.subspan(parts.first[i], parts.first[i + 1] - parts.first[i]), scratch);
        }
    }
}

}  // namespace cdprep
