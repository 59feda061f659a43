// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace cdprep {

/// An exact sum of doubles: components that do not overlap, least first, none
/// zero (Shewchuk 1997). `Capacity` is an upper bound of their number; nothing
/// is allocated. Exact as long as no product of two components leaves the range
/// of double; predicates.cpp scales so that none does.
template <std::size_t Capacity>
struct Expansion {
    std::array<double, Capacity> component;
    std::size_t size = 0;

    void append(double value) noexcept {
        if (value != 0) component[size++] = value;
    }
    /// Sign of the exact sum: that of the largest component.
    [[nodiscard]] int sign() const noexcept {
        if (size == 0) return 0;
        return component[size - 1] > 0 ? 1 : -1;
    }
};

/// A rounded value and exactly what rounding lost.
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

inline Exact2 two_product(double a, double b) noexcept {
    const double product = a * b;
    return {product, std::fma(a, b, -product)};
}

/// a - b, exactly.
inline Expansion<2> difference(double a, double b) noexcept {
    const Exact2 exact = two_sum(a, -b);
    Expansion<2> result;
    result.append(exact.tail);
    result.append(exact.value);
    return result;
}

/// Adds one component to an expansion of any size (Shewchuk's GROW-EXPANSION).
template <std::size_t N>
void grow(Expansion<N>& e, double b) noexcept {
    const std::size_t size = e.size;
    e.size = 0;
    double carry = b;
    for (std::size_t i = 0; i < size; ++i) {
        const Exact2 sum = two_sum(carry, e.component[i]);
        carry = sum.value;
        e.append(sum.tail);
    }
    e.append(carry);
}

template <std::size_t N, std::size_t M>
Expansion<N + M> sum(const Expansion<N>& a, const Expansion<M>& b) noexcept {
    Expansion<N + M> result;
    for (std::size_t i = 0; i < a.size; ++i) result.component[i] = a.component[i];
    result.size = a.size;
    for (std::size_t i = 0; i < b.size; ++i) grow(result, b.component[i]);
    return result;
}

template <std::size_t N>
Expansion<N> negated(Expansion<N> a) noexcept {
    for (std::size_t i = 0; i < a.size; ++i) a.component[i] = -a.component[i];
    return a;
}

template <std::size_t N, std::size_t M>
Expansion<2 * N * M> product(const Expansion<N>& a, const Expansion<M>& b) noexcept {
    Expansion<2 * N * M> result;
    for (std::size_t i = 0; i < a.size; ++i) {
        for (std::size_t j = 0; j < b.size; ++j) {
            const Exact2 exact = two_product(a.component[i], b.component[j]);
            grow(result, exact.tail);
            grow(result, exact.value);
        }
    }
    return result;
}

}  // namespace cdprep
