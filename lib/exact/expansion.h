// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace cdprep {

/// An exact sum of doubles: non-overlapping components, least first, none zero (Shewchuk 1997,
/// strongly non-overlapping). `Capacity` is an upper bound of their number; nothing is allocated.
/// Exact as long as no product leaves the range of double; predicates.cpp ensures that.
template <std::size_t Capacity>
struct Expansion {
    std::array<double, Capacity> component;
    std::size_t size = 0;

    void append(double value) noexcept {
        assert(value == 0 || size < Capacity);
        if (value != 0) component[size++] = value;
    }
    /// Returns the sign of the exact sum, which is the sign of the largest component.
    [[nodiscard]] int sign() const noexcept {
        if (size == 0) return 0;
        return component[size - 1] > 0 ? 1 : -1;
    }
};

/// A rounded value and the exact error of the rounding.
struct Exact2 {
    double value;
    double tail;
};

inline Exact2 two_sum(double a, double b) noexcept {
    const double sum = a + b;
    const double b_virtual = sum - a;
    const double a_virtual = sum - b_virtual;
    return {sum, (a - a_virtual) + (b - b_virtual)};
}

/// Requires |a| >= |b| or a == 0.
inline Exact2 fast_two_sum(double a, double b) noexcept {
    assert(a == 0 || !(std::fabs(a) < std::fabs(b)));
    const double sum = a + b;
    return {sum, b - (sum - a)};
}

/// Splits into the upper 26 bits and the rest (Veltkamp). Overflows beyond 2^996.
inline Exact2 split(double a) noexcept {
    constexpr double kSplitter = 0x1p27 + 1;
    const double scaled = kSplitter * a;
    const double upper = scaled - (scaled - a);
    return {upper, a - upper};
}

/// Dekker's product. Uses no fused multiply-add, because the oldest supported processors lack it.
inline Exact2 two_product(double a, double b) noexcept {
    const double product = a * b;
    const Exact2 x = split(a);
    const Exact2 y = split(b);
    const double rest = product - x.value * y.value - x.tail * y.value - x.value * y.tail;
    return {product, x.tail * y.tail - rest};
}

/// Returns a - b, exactly.
inline Expansion<2> difference(double a, double b) noexcept {
    const Exact2 exact = two_sum(a, -b);
    Expansion<2> result;
    result.append(exact.tail);
    result.append(exact.value);
    return result;
}

template <std::size_t N>
Expansion<N> negated(Expansion<N> a) noexcept {
    for (std::size_t i = 0; i < a.size; ++i) a.component[i] = -a.component[i];
    return a;
}

/// Shewchuk's FAST-EXPANSION-SUM, which requires rounding to even. Merges the components of both by
/// size and adds them up from the least.
template <std::size_t N, std::size_t M>
Expansion<N + M> sum(const Expansion<N>& a, const Expansion<M>& b) noexcept {
    Expansion<N + M> result;
    std::size_t i = 0;
    std::size_t j = 0;
    const auto next = [&] {
        const bool take_a =
            j == b.size || (i < a.size && std::fabs(a.component[i]) < std::fabs(b.component[j]));
        return take_a ? a.component[i++] : b.component[j++];
    };
    double carry = 0;
    while (i < a.size || j < b.size) {
        const Exact2 exact = two_sum(carry, next());
        carry = exact.value;
        result.append(exact.tail);
    }
    result.append(carry);
    return result;
}

/// Shewchuk's SCALE-EXPANSION.
template <std::size_t N>
Expansion<2 * N> scaled(const Expansion<N>& a, double factor) noexcept {
    Expansion<2 * N> result;
    double carry = 0;
    for (std::size_t i = 0; i < a.size; ++i) {
        const Exact2 exact = two_product(a.component[i], factor);
        const Exact2 low = two_sum(carry, exact.tail);
        const Exact2 high = fast_two_sum(exact.value, low.value);
        result.append(low.tail);
        result.append(high.tail);
        carry = high.value;
    }
    result.append(carry);
    return result;
}

template <std::size_t N>
Expansion<4 * N> product(const Expansion<N>& a, const Expansion<2>& b) noexcept {
    Expansion<4 * N> result;
    if (b.size < 2) {
        const double factor = b.size == 0 ? 0 : b.component[0];
        const Expansion<2 * N> exact = scaled(a, factor);
        for (std::size_t i = 0; i < exact.size; ++i) result.append(exact.component[i]);
        return result;
    }
    return sum(scaled(a, b.component[0]), scaled(a, b.component[1]));
}

}  // namespace cdprep
