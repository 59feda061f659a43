// SPDX-License-Identifier: MIT
#include <immintrin.h>

#include "kernels.h"

namespace cdprep::kernels {
namespace {

constexpr std::size_t kLanes = 8;

__m256 absolute(__m256 x) noexcept {
    return _mm256_andnot_ps(_mm256_set1_ps(-0.0F), x);
}

/// (m0 x + m1 y) + m2 z, in the reference's order and without contraction.
__m256 combined(float m0, float m1, float m2, const __m256* v) noexcept {
    const __m256 sum = _mm256_add_ps(_mm256_mul_ps(_mm256_set1_ps(m0), v[0]),
                                     _mm256_mul_ps(_mm256_set1_ps(m1), v[1]));
    return _mm256_add_ps(sum, _mm256_mul_ps(_mm256_set1_ps(m2), v[2]));
}

struct Boxes {
    __m256 centre[3];
    __m256 half[3];
};

Boxes scaled_boxes(const float* node, float scale) noexcept {
    Boxes boxes;
    const __m256 factor = _mm256_set1_ps(0.5F * scale);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const __m256 lower = _mm256_loadu_ps(node + kLanes * axis);
        const __m256 upper = _mm256_loadu_ps(node + kLanes * (3 + axis));
        boxes.centre[axis] = _mm256_mul_ps(_mm256_add_ps(lower, upper), factor);
        boxes.half[axis] = _mm256_mul_ps(_mm256_sub_ps(upper, lower), factor);
    }
    return boxes;
}

Boxes turned_to_b(const Boxes& boxes, const BoxPlacement& p) noexcept {
    Boxes turned;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float* r = p.rotation + axis;
        const float* q = p.abs_rotation + axis;
        turned.centre[axis] = combined(r[0], r[3], r[6], boxes.centre);
        turned.half[axis] = combined(q[0], q[3], q[6], boxes.half);
    }
    return turned;
}

/// B's boxes as the tests along A's axes want them: shifted, with the slack.
Boxes turned_to_a(const Boxes& boxes, const BoxPlacement& p) noexcept {
    Boxes turned;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float* r = p.rotation + 3 * axis;
        const float* q = p.abs_rotation + 3 * axis;
        turned.centre[axis] =
            _mm256_add_ps(combined(r[0], r[1], r[2], boxes.centre), _mm256_set1_ps(p.shift[axis]));
        turned.half[axis] =
            _mm256_add_ps(combined(q[0], q[1], q[2], boxes.half), _mm256_set1_ps(p.slack));
    }
    return turned;
}

/// B's boxes as the tests along B's axes want them.
Boxes shifted_in_b(const Boxes& boxes, const BoxPlacement& p) noexcept {
    Boxes shifted;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        shifted.centre[axis] =
            _mm256_add_ps(boxes.centre[axis], _mm256_set1_ps(p.shift_in_b[axis]));
        shifted.half[axis] = _mm256_add_ps(boxes.half[axis], _mm256_set1_ps(p.slack));
    }
    return shifted;
}

/// Rows of eight floats, so that one box can be broadcast.
struct Rows {
    alignas(32) float centre[3][kLanes];
    alignas(32) float half[3][kLanes];
};

void store(const Boxes& boxes, Rows& rows) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        _mm256_store_ps(rows.centre[axis], boxes.centre[axis]);
        _mm256_store_ps(rows.half[axis], boxes.half[axis]);
    }
}

/// Lanes of `a` that box j of `rows` misses along one of three axes.
__m256 apart(const Boxes& a, const Rows& rows, std::size_t j) noexcept {
    __m256 result = _mm256_setzero_ps();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const __m256 gap =
            absolute(_mm256_sub_ps(a.centre[axis], _mm256_broadcast_ss(&rows.centre[axis][j])));
        const __m256 reach = _mm256_add_ps(a.half[axis], _mm256_broadcast_ss(&rows.half[axis][j]));
        result = _mm256_or_ps(result, _mm256_cmp_ps(gap, reach, _CMP_GT_OQ));
    }
    return result;
}

void overlap_masks(const BoxPlacement& p, const float* a, const float* b, std::size_t first_b,
                   std::size_t last_b, std::uint8_t* masks) noexcept {
    const Boxes boxes_a = scaled_boxes(a, p.scale_a);
    const Boxes turned_a = turned_to_b(boxes_a, p);
    const Boxes boxes_b = scaled_boxes(b, p.scale_b);
    Rows along_a;
    Rows along_b;
    store(turned_to_a(boxes_b, p), along_a);
    store(shifted_in_b(boxes_b, p), along_b);
    for (std::size_t j = first_b; j < last_b; ++j) {
        const __m256 out = _mm256_or_ps(apart(boxes_a, along_a, j), apart(turned_a, along_b, j));
        masks[j] = static_cast<std::uint8_t>(~_mm256_movemask_ps(out));
    }
}

}  // namespace

const Table kAvx2 = {"avx2", overlap_masks};

}  // namespace cdprep::kernels
