// SPDX-License-Identifier: MIT
#include "walk/leaf_batch.h"

#include <algorithm>

namespace cdprep {
namespace {

static_assert(offsetof(format::BvhLeaf, origin) == kernels::kLeafOrigin * sizeof(float));
static_assert(offsetof(format::BvhLeaf, half) == kernels::kLeafHalf * sizeof(float));

kernels::LeafFrame leaf_frame(bool exact_leaves, const Double3& frame_origin,
                              std::int32_t frame_exponent, double scale) noexcept {
    kernels::LeafFrame frame{};
    frame.scale = scale;
    frame.box_scale = static_cast<float>(scale);
    if (!exact_leaves) return frame;
    frame.scale = scaled(scale, frame_exponent);
    frame.frame_origin[0] = frame_origin.x;
    frame.frame_origin[1] = frame_origin.y;
    frame.frame_origin[2] = frame_origin.z;
    frame.takes_origin = 1;
    return frame;
}

kernels::LeafFrame leaf_frame(const Model& model, double scale) noexcept {
    return leaf_frame(model.has_exact_leaves(), model.header().frame_origin,
                      model.header().frame_exponent, scale);
}

kernels::LeafPlacement place_leaves(const kernels::LeafFrame& a, const kernels::LeafFrame& b,
                                    const PlacedBoxes& placed) noexcept {
    kernels::LeafPlacement placement{};
    placement.a = a;
    placement.b = b;
    std::copy(placed.rotation.begin(), placed.rotation.end(), placement.rotation);
    std::copy(placed.shift.begin(), placed.shift.end(), placement.shift);
    for (std::size_t i = 0; i < 9; ++i) {
        placement.corner_rotation[i] = static_cast<float>(placed.rotation[i] * placement.b.scale);
    }
    placement.error = static_cast<float>(placed.double_slack * (1 + 0x1p-20));
    return placement;
}

}  // namespace

kernels::LeafPlacement place_leaves(const Model& a, const Model& b,
                                    const PlacedBoxes& placed) noexcept {
    return place_leaves(leaf_frame(a, placed.scale_a), leaf_frame(b, placed.scale_b), placed);
}

kernels::LeafPlacement place_leaves(const build::Bvh& tree, const PlacedBoxes& placed) noexcept {
    const kernels::LeafFrame frame =
        leaf_frame(tree.exact_leaves, tree.frame.origin, tree.frame.exponent, 1);
    return place_leaves(frame, frame, placed);
}

}  // namespace cdprep
