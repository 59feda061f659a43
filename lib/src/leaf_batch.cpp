// SPDX-License-Identifier: MIT
#include "leaf_batch.h"

#include <algorithm>
#include <cmath>

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
    frame.scale = std::ldexp(scale, model.header().frame_exponent);
    frame.frame_origin[0] = o.x;
    frame.frame_origin[1] = o.y;
    frame.frame_origin[2] = o.z;
    frame.takes_origin = 1;
    return frame;
}

}  // namespace

LeafBatch::LeafBatch(const Model& a, const Model& b, const PlacedBoxes& placed,
                     Workspace::Storage& scratch) noexcept
    : scratch_(scratch), leaves_a_(a.leaves().data()), leaves_b_(b.leaves().data()), placement_{} {
    placement_.a = leaf_frame(a, placed.scale_a);
    placement_.b = leaf_frame(b, placed.scale_b);
    std::copy(placed.rotation.begin(), placed.rotation.end(), placement_.rotation);
    std::copy(placed.shift.begin(), placed.shift.end(), placement_.shift);
    for (std::size_t i = 0; i < 9; ++i) {
        placement_.corner_rotation[i] = static_cast<float>(placed.rotation[i] * placement_.b.scale);
    }
    placement_.error = static_cast<float>(placed.double_slack * (1 + 0x1p-20));
}

}  // namespace cdprep
