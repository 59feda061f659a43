// SPDX-License-Identifier: MIT
#include "leaf_batch.h"

#include <algorithm>

namespace cdprep {
namespace {

static_assert(offsetof(format::BvhLeaf, origin) == kernels::kLeafOrigin * sizeof(float));
static_assert(offsetof(format::BvhLeaf, half) == kernels::kLeafHalf * sizeof(float));

kernels::LeafFrame leaf_frame(const Model& model, double scale) noexcept {
    kernels::LeafFrame frame{};
    frame.scale = scale;
    frame.box_scale = static_cast<float>(scale);
    if (!model.has_exact_leaves()) return frame;
    const Double3& o = model.header().frame_origin;
    frame.scale = scaled(scale, model.header().frame_exponent);
    frame.frame_origin[0] = o.x;
    frame.frame_origin[1] = o.y;
    frame.frame_origin[2] = o.z;
    frame.takes_origin = 1;
    return frame;
}

}  // namespace

kernels::LeafPlacement place_leaves(const Model& a, const Model& b,
                                    const PlacedBoxes& placed) noexcept {
    kernels::LeafPlacement placement{};
    placement.a = leaf_frame(a, placed.scale_a);
    placement.b = leaf_frame(b, placed.scale_b);
    std::copy(placed.rotation.begin(), placed.rotation.end(), placement.rotation);
    std::copy(placed.shift.begin(), placed.shift.end(), placement.shift);
    for (std::size_t i = 0; i < 9; ++i) {
        placement.corner_rotation[i] = static_cast<float>(placed.rotation[i] * placement.b.scale);
    }
    placement.error = static_cast<float>(placed.double_slack * (1 + 0x1p-20));
    return placement;
}

}  // namespace cdprep
