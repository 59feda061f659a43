// SPDX-License-Identifier: MIT
// Rows of eight floats that AVX2 and AVX-512 make alike; see exact_leaf.h. Included by their
// sources alone, below <immintrin.h>.
#pragma once

#include <cstdint>

namespace cdprep::kernels {
namespace {

/// Loads the points of four numbers, three numbers apart: a row for each coordinate.
inline void load_four_points(const float* positions, const std::uint32_t* vertices,
                             __m128 (&row)[3]) noexcept {
    const auto point = [&](std::size_t i) { return positions + std::size_t{3} * vertices[3 * i]; };
    const auto xy = [](const float* one, const float* two) {
        const auto as_double = [](const float* p) { return reinterpret_cast<const double*>(p); };
        return _mm_castpd_ps(_mm_loadh_pd(_mm_load_sd(as_double(one)), as_double(two)));
    };
    const float *a = point(0), *b = point(1), *c = point(2), *d = point(3);
    const __m128 ab = xy(a, b), cd = xy(c, d);
    row[0] = _mm_shuffle_ps(ab, cd, 0x88);
    row[1] = _mm_shuffle_ps(ab, cd, 0xdd);
    __m128 z = _mm_insert_ps(_mm_load_ss(a + 2), _mm_load_ss(b + 2), 0x10);
    z = _mm_insert_ps(z, _mm_load_ss(c + 2), 0x20);
    row[2] = _mm_insert_ps(z, _mm_load_ss(d + 2), 0x30);
}

/// Reduces eight rows to the least lane of each. Of zeros with both signs, chooses as
/// build::least(): a lane against the one four after it, then two after it, then one after it.
inline __m256 least_of_eight(const __m256 (&row)[8]) noexcept {
    const auto fours = [&](std::size_t i) {
        const __m256 first = _mm256_permute2f128_ps(row[i], row[i + 4], 0x20);
        return _mm256_min_ps(_mm256_permute2f128_ps(row[i], row[i + 4], 0x31), first);
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
