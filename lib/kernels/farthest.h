// SPDX-License-Identifier: MIT
// The body that all instruction sets share; see kernels.h. Products and sums are rounded one by one
// and in one order, so the answers are the same for every table, to the last bit.
#pragma once

#include <cassert>

#include "kernels.h"

namespace cdprep::kernels {

/// The most blocks: the number of a point has 32 bits.
inline constexpr std::size_t kMostBlocks = std::size_t{1} << 29;  ///< for 2^32 points

namespace {

inline double highest_of(const double (&lanes)[kLanes]) noexcept {
    const auto of = [](double a, double b) { return a > b ? a : b; };
    return of(of(of(lanes[0], lanes[1]), of(lanes[2], lanes[3])),
              of(of(lanes[4], lanes[5]), of(lanes[6], lanes[7])));
}

/// The highest value of each lane, and the first block that has it.
template <class D8>
struct HighestOfLane {
    D8 value = D8(-format::kInfinity);
    D8 block = D8(0.0);

    void take(const D8& other, const D8& number) noexcept {
        const auto higher = greater(other, value);
        value = select(higher, other, value);
        block = select(higher, number, block);
    }
    /// Returns the highest value of all lanes; of several, the lowest number.
    [[nodiscard]] FarthestPoint farthest() const noexcept {
        double values[kLanes];
        double blocks[kLanes];
        value.store(values);
        block.store(blocks);
        const double most = highest_of(values);
        // One lane, as a rule: a search for the highest lane would mispredict its branches.
        unsigned rest = ~bits(greater(D8(most), value)) & ((1U << kLanes) - 1);
        FarthestPoint best = {0xffffffff, most, 0};
        for (; rest != 0; rest &= rest - 1) {
            const unsigned lane = format::lowest_set_bit(rest);
            const auto number = static_cast<std::uint32_t>(blocks[lane]) * 8 + lane;
            best.number = number < best.number ? number : best.number;
        }
        return best;
    }
};

template <class D8>
std::uint32_t farthest_of(const double* blocks, std::size_t count,
                          const double* direction) noexcept {
    assert(count > 0 && count <= kMostBlocks);
    const D8 dx(direction[0]), dy(direction[1]), dz(direction[2]);
    HighestOfLane<D8> highest;
    D8 number(0.0);
    const D8 one(1.0);
    for (const double* end = blocks + 24 * count; blocks != end; blocks += 24) {
        const D8 x = D8::load(blocks), y = D8::load(blocks + 8), z = D8::load(blocks + 16);
        highest.take((dx * x + dy * y) + dz * z, number);
        number = number + one;
    }
    return highest.farthest().number;
}

/// The relative error of a value, which is the sum of three products of a difference and a
/// component. The difference, the product and two sums are off by u each, relative to the sum of
/// the products' magnitudes. The final sum with the error here is off by another u. The sixth
/// covers the roundings of the magnitudes.
inline constexpr double kValueError = 6 * 0x1p-53;

template <class D8>
FarthestPoint farthest_moved_of(const double* blocks, std::size_t count,
                                const MovedDirection& from) noexcept {
    assert(count > 0 && count <= kMostBlocks);
    const double* r = from.rotation;
    const double* t = from.translation;
    const D8 error(kValueError);
    HighestOfLane<D8> highest;
    D8 bound(-format::kInfinity);
    D8 number(0.0);
    const D8 one(1.0);
    for (const double* end = blocks + 24 * count; blocks != end; blocks += 24) {
        const D8 x = D8::load(blocks), y = D8::load(blocks + 8), z = D8::load(blocks + 16);
        D8 value(0.0), size(0.0);
        for (std::size_t i = 0; i < 3; ++i) {
            const D8 at =
                ((D8(r[3 * i]) * x + D8(r[3 * i + 1]) * y) + D8(r[3 * i + 2]) * z) + D8(t[i]);
            const D8 term = (at - D8(from.origin[i])) * D8(from.direction[i]);
            value = value + term;
            size = size + abs(term);
        }
        highest.take(value, number);
        bound = max(bound, value + size * error);
        number = number + one;
    }
    FarthestPoint best = highest.farthest();
    double bounds[kLanes];
    bound.store(bounds);
    best.bound = highest_of(bounds);
    assert(!(best.bound < best.value));
    return best;
}

}  // namespace
}  // namespace cdprep::kernels
