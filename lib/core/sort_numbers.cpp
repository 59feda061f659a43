// SPDX-License-Identifier: MIT
#include "core/sort_numbers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <utility>

namespace cdprep {
namespace {

constexpr std::size_t kFew = 64;  ///< below, comparison sorting is faster than counting

/// Returns the place where the numbers of each digit start, and the end of the last.
template <int kBits, class Number>
std::array<std::size_t, (std::size_t{1} << kBits) + 1> places(std::span<const Number> numbers,
                                                              int shift) noexcept {
    constexpr std::size_t kDigits = std::size_t{1} << kBits;
    std::array<std::size_t, kDigits + 1> start{};
    for (const Number number : numbers) ++start[(number >> shift) % kDigits + 1];
    for (std::size_t d = 0; d < kDigits; ++d) start[d + 1] += start[d];
    return start;
}

/// Performs one stable counting pass from one buffer to the other.
template <class From, class To>
void pass(std::span<const From> from, std::span<To> to, int shift) noexcept {
    constexpr int kBits = 8;
    auto place = places<kBits>(from, shift);
    for (const From number : from) {
        to[place[(number >> shift) % (1U << kBits)]++] = static_cast<To>(number);
    }
}

/// Sorts by digits, lowest first. Passes go to the scratch and back until no bits are left.
void sort_in_passes(std::span<std::uint32_t> numbers, std::span<std::uint64_t> scratch,
                    int bits) noexcept {
    assert(numbers.size() <= scratch.size());
    const std::span<std::uint64_t> other = scratch.first(numbers.size());
    for (int shift = 0; shift < bits; shift += 16) {
        pass<std::uint32_t, std::uint64_t>(numbers, other, shift);
        pass<std::uint64_t, std::uint32_t>(other, numbers, shift + 8);
    }
}

/// Sorts in place by the highest digit until the rest fits the scratch (McIlroy, Bostic and McIlroy
/// 1993).
void sort_lowest(std::span<std::uint32_t> numbers, std::span<std::uint64_t> scratch,
                 int bits) noexcept {
    if (numbers.size() <= kFew) {
        std::sort(numbers.begin(), numbers.end());
        return;
    }
    if (numbers.size() <= scratch.size()) {
        sort_in_passes(numbers, scratch, bits);
        return;
    }
    if (bits == 0) return;
    constexpr int kBits = 4;
    const int shift = std::max(0, bits - kBits);
    const auto start = places<kBits>(std::span<const std::uint32_t>(numbers), shift);
    const auto digit = [&](std::uint32_t number) { return (number >> shift) % (1U << kBits); };
    auto next = start;
    for (std::size_t d = 0; d + 1 < start.size(); ++d) {
        while (next[d] < start[d + 1]) {  // follows each cycle to its end
            std::uint32_t number = numbers[next[d]];
            while (digit(number) != d) std::swap(number, numbers[next[digit(number)]++]);
            numbers[next[d]++] = number;
        }
    }
    for (std::size_t d = 0; d + 1 < start.size(); ++d) {
        sort_lowest(numbers.subspan(start[d], start[d + 1] - start[d]), scratch, shift);
    }
}

}  // namespace

void sort_numbers(std::span<std::uint32_t> numbers, std::span<std::uint64_t> scratch) noexcept {
    std::uint32_t all = 0;
    for (const std::uint32_t number : numbers) all |= number;
    sort_lowest(numbers, scratch, static_cast<int>(std::bit_width(all)));
}

}  // namespace cdprep
