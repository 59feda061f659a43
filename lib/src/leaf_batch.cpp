// SPDX-License-Identifier: MIT
#include "leaf_batch.h"

#include <algorithm>

namespace cdprep {
namespace {

std::uint8_t used_lanes(const format::BvhLeaf& leaf) noexcept {
    return static_cast<std::uint8_t>((1U << leaf.count) - 1);
}

}  // namespace

LeafBatch::Side::Side(const Model& model, double scale) noexcept
    : leaves(model.leaves().data()),
      exact(model.has_exact_leaves()),
      frame_scale(exact ? std::ldexp(scale, model.header().frame_exponent) : scale),
      frame_origin{},
      box_scale(static_cast<float>(scale)) {
    const Double3& o = model.header().frame_origin;
    if (exact) frame_origin = {o.x, o.y, o.z};
}

/// Of a leaf, in pair units along the model's own axes.
std::array<double, 3> LeafBatch::Side::origin(const format::BvhLeaf& leaf) const noexcept {
    std::array<double, 3> at{};
    for (std::size_t i = 0; i < 3; ++i) {
        at[i] = (double{leaf.origin[i]} - frame_origin[i]) * frame_scale;
    }
    return at;
}

LeafBatch::LeafBatch(const Model& a, const Model& b, const PlacedBoxes& placed,
                     Workspace::Storage& scratch) noexcept
    : scratch_(scratch),
      a_(a, placed.scale_a),
      b_(b, placed.scale_b),
      rotation_(placed.rotation),
      shift_(placed.shift),
      error_(static_cast<float>(placed.double_slack * (1 + 0x1p-20))),
      placement_{} {
    placement_.scale_a = static_cast<float>(a_.frame_scale);
    for (std::size_t i = 0; i < 9; ++i) {
        placement_.rotation[i] = static_cast<float>(rotation_[i] * b_.frame_scale);
    }
}

void LeafBatch::add(std::uint32_t leaf_a, std::uint32_t leaf_b) noexcept {
    const format::BvhLeaf& a = a_.leaves[leaf_a];
    const format::BvhLeaf& b = b_.leaves[leaf_b];
    const std::array<double, 3> at_a = a_.origin(a);
    const std::array<double, 3> at_b = b_.origin(b);
    kernels::LeafPair& pair = scratch_.leaf_pairs[count_];
    pair.a = a.corner[0][0].data();
    pair.b = b.corner[0][0].data();
    for (std::size_t i = 0; i < 3; ++i) {
        const double* r = &rotation_[3 * i];
        const double at = (r[0] * at_b[0] + r[1] * at_b[1]) + r[2] * at_b[2];
        pair.offset[i] = static_cast<float>((at + shift_[i]) - at_a[i]);
        pair.middle_a[i] = a_.exact ? a.origin[i] : 0;
        pair.middle_b[i] = b_.exact ? b.origin[i] : 0;
        pair.half_a[i] = a.half[i] * a_.box_scale;
    }
    pair.reach_b = std::max({b.half[0], b.half[1], b.half[2]}) * b_.box_scale;
    pair.error = error_;
    pair.used_a = used_lanes(a);
    pair.used_b = used_lanes(b);
    scratch_.leaf_numbers[count_] = std::uint64_t{leaf_a} << 32 | leaf_b;
    ++count_;
}

}  // namespace cdprep
