// SPDX-License-Identifier: MIT
#include "moved_leaf.h"

#include <algorithm>

namespace cdprep {
namespace {

void grow(Box3& box, const Box3& other) noexcept {
    box.lower = {std::min(box.lower.x, other.lower.x), std::min(box.lower.y, other.lower.y),
                 std::min(box.lower.z, other.lower.z)};
    box.upper = {std::max(box.upper.x, other.upper.x), std::max(box.upper.y, other.upper.y),
                 std::max(box.upper.z, other.upper.z)};
}

Box3 box_of(const Corners& t) noexcept {
    Box3 box{t[0], t[0]};
    grow(box, {t[1], t[1]});
    grow(box, {t[2], t[2]});
    return box;
}

}  // namespace

void MovedLeaf::load(const MovedModel& model, std::uint32_t index) noexcept {
    if (leaf == index) return;
    leaf = index;
    first = index * format::kBvhWidth;
    count = std::min(format::kBvhWidth, model.model->triangle_count() - first);
    for (std::uint32_t i = 0; i < count; ++i) {
        corners[i] = model.corners(first + i);
        box[i] = box_of(corners[i]);
        if (i == 0) all = box[0];
        grow(all, box[i]);
    }
}

}  // namespace cdprep
