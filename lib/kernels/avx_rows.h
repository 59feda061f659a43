// SPDX-License-Identifier: MIT
// Rows of eight floats that AVX2 and AVX-512 make alike; see exact_leaf.h. Included by their
// sources alone, below their lanes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cdprep::kernels {
namespace {

/// Loads the points of four numbers, three numbers apart: a row for each coordinate.
inline void load_four_points(const float* positions, const std::uint32_t* vertices,
                             __m128 (&row)[3]) noexcept {
    const auto point = [&](std::size_t i) { return positions + std::size_t{3} * vertices[3 * i]; };
    const auto two_floats = [](const float* p) {
        return _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p)));
    };
    const float *a = point(0), *b = point(1), *c = point(2), *d = point(3);
    const __m128 ab = _mm_movelh_ps(two_floats(a), two_floats(b));
    const __m128 cd = _mm_movelh_ps(two_floats(c), two_floats(d));
    row[0] = _mm_shuffle_ps(ab, cd, 0x88);
    row[1] = _mm_shuffle_ps(ab, cd, 0xdd);
    __m128 z = _mm_insert_ps(_mm_load_ss(a + 2), _mm_load_ss(b + 2), 0x10);
    z = _mm_insert_ps(z, _mm_load_ss(c + 2), 0x20);
    row[2] = _mm_insert_ps(z, _mm_load_ss(d + 2), 0x30);
}

/// Loads the points of eight numbers, three numbers apart: a row for each coordinate.
inline void load_points(const float* positions, const std::uint32_t* vertices,
                        F8 (&row)[3]) noexcept {
    __m128 lower[3], upper[3];
    load_four_points(positions, vertices, lower);
    load_four_points(positions, vertices + 12, upper);
    for (std::size_t i = 0; i < 3; ++i) row[i] = _mm256_set_m128(upper[i], lower[i]);
}

/// Reduces eight rows to the least lane of each. Compares a lane with the one four after it, then
/// two, then one. So it chooses among zeros with both signs as build::least() does.
inline F8 least_of_rows(const F8 (&row)[8]) noexcept {
    const auto fours = [&](std::size_t i) {
        const __m256 first = _mm256_permute2f128_ps(row[i].x, row[i + 4].x, 0x20);
        return _mm256_min_ps(_mm256_permute2f128_ps(row[i].x, row[i + 4].x, 0x31), first);
    };
    const auto twos = [&](std::size_t i) {
        const __m256 a = fours(i), b = fours(i + 1);
        return _mm256_min_ps(_mm256_shuffle_ps(a, b, 0xee), _mm256_shuffle_ps(a, b, 0x44));
    };
    const __m256 a = twos(0), b = twos(2);
    return _mm256_min_ps(_mm256_shuffle_ps(a, b, 0xdd), _mm256_shuffle_ps(a, b, 0x88));
}

}  // namespace
}  // namespace cdprep::kernels
