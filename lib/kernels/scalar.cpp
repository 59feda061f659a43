// SPDX-License-Identifier: MIT
#include "kernels.h"

namespace cdprep::kernels {
namespace {

constexpr std::size_t kLanes = 8;

float absolute(float x) noexcept {
    return x < 0 ? -x : x;
}

/// Eight boxes by centre and half extent, along the axes of either model.
struct Boxes {
    float centre[3][kLanes];
    float half[3][kLanes];
};

Boxes scaled_boxes(const float* node, float scale) noexcept {
    Boxes boxes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < kLanes; ++i) {
            const float lower = node[kLanes * axis + i];
            const float upper = node[kLanes * (3 + axis) + i];
            boxes.centre[axis][i] = (lower + upper) * (0.5F * scale);
            boxes.half[axis][i] = (upper - lower) * (0.5F * scale);
        }
    }
    return boxes;
}

/// A's boxes along B's axes: centre R^T c, half extent |R|^T h.
Boxes turned_boxes(const Boxes& boxes, const BoxPlacement& p) noexcept {
    Boxes turned;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < kLanes; ++i) {
            turned.centre[axis][i] = (p.rotation[axis] * boxes.centre[0][i] +
                                      p.rotation[3 + axis] * boxes.centre[1][i]) +
                                     p.rotation[6 + axis] * boxes.centre[2][i];
            turned.half[axis][i] = (p.abs_rotation[axis] * boxes.half[0][i] +
                                    p.abs_rotation[3 + axis] * boxes.half[1][i]) +
                                   p.abs_rotation[6 + axis] * boxes.half[2][i];
        }
    }
    return turned;
}

void overlap_masks(const BoxPlacement& p, const float* a, const float* b, std::size_t first_b,
                   std::size_t last_b, std::uint8_t* masks) noexcept {
    const Boxes boxes_a = scaled_boxes(a, p.scale_a);
    const Boxes turned_a = turned_boxes(boxes_a, p);
    const Boxes boxes_b = scaled_boxes(b, p.scale_b);
    for (std::size_t j = first_b; j < last_b; ++j) {
        const float c[3] = {boxes_b.centre[0][j], boxes_b.centre[1][j], boxes_b.centre[2][j]};
        const float h[3] = {boxes_b.half[0][j], boxes_b.half[1][j], boxes_b.half[2][j]};
        std::uint8_t mask = 0;
        for (std::size_t i = 0; i < kLanes; ++i) {
            bool apart = false;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float* r = p.rotation + 3 * axis;
                const float* q = p.abs_rotation + 3 * axis;
                const float centre = ((r[0] * c[0] + r[1] * c[1]) + r[2] * c[2]) + p.shift[axis];
                const float half = ((q[0] * h[0] + q[1] * h[1]) + q[2] * h[2]) + p.slack;
                apart |= absolute(boxes_a.centre[axis][i] - centre) > boxes_a.half[axis][i] + half;
                const float centre_b = c[axis] + p.shift_in_b[axis];
                const float half_b = h[axis] + p.slack;
                apart |=
                    absolute(turned_a.centre[axis][i] - centre_b) > turned_a.half[axis][i] + half_b;
            }
            mask = static_cast<std::uint8_t>(mask | (apart ? 0U : 1U) << i);
        }
        masks[j] = mask;
    }
}

}  // namespace

const Table kScalar = {"scalar", overlap_masks};

}  // namespace cdprep::kernels
