// SPDX-License-Identifier: MIT
#include "cone_children.h"

#include <bit>

namespace cdprep::build {
namespace {

constexpr std::uint32_t kMiddle = 3;  ///< the child between the other three

/// The octants that corners of these signs may reach, when all are on one side of some
/// coordinate planes. Signs of differences are exact.
std::uint32_t possible_octants(const SeenTriangle& t) noexcept {
    constexpr std::array<std::uint32_t, 3> kPositive = {0x55, 0x33, 0x0f};
    std::uint32_t mask = 0xff;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double a = t[0].at[axis], b = t[1].at[axis], c = t[2].at[axis];
        if (a > 0 && b > 0 && c > 0) mask &= kPositive[axis];
        if (a < 0 && b < 0 && c < 0) mask &= ~kPositive[axis];
    }
    return mask;
}

}  // namespace

ConeChildren::ConeChildren(std::uint32_t key, std::uint32_t level) noexcept
    : key_(key),
      bits_(key == kRootKey ? 3 : 2),
      below_(key == kRootKey ? 2 * level : 2 * (level - tetra_level(key) - 1)) {}

ConeChildren::SureChildren ConeChildren::sure_children(const InnerCones& cones) const noexcept {
    SureChildren sure{0, 0};
    for (const std::uint32_t cone : cones) {
        // One that is not a finest cone is too short to match.
        const std::uint32_t child = cone >> below_;
        if (child >> bits_ != key_) continue;
        sure.mask |= 1U << (child & ((1U << bits_) - 1));
        ++sure.corners;
    }
    return sure;
}

// With all corners in two children that one plane parts, or in one, nothing of the triangle
// is elsewhere: both together are convex. So are the middle child and some of the others.
std::uint32_t ConeChildren::told_by(const InnerCones& cones) const noexcept {
    const SureChildren sure = sure_children(cones);
    if (sure.corners < 3) return 0;
    if (key_ != kRootKey) {
        return (sure.mask >> kMiddle & 1U) != 0 || std::has_single_bit(sure.mask) ? sure.mask : 0;
    }
    const auto lowest = static_cast<std::uint32_t>(std::countr_zero(sure.mask));
    const auto highest = static_cast<std::uint32_t>(std::bit_width(sure.mask)) - 1;
    const bool is_pair = sure.mask == (1U << lowest | 1U << highest);
    return is_pair && std::popcount(lowest ^ highest) <= 1 ? sure.mask : 0;
}

/// The children that the planes of the middle one do not keep the triangle from.
std::uint32_t ConeChildren::possible_children(const PlacedTriangle& t) {
    if (key_ == kRootKey) return possible_octants(t.seen);
    // Generators m12, m23, m31: across from m12 is the child of v3, and so on.
    constexpr std::array<std::uint32_t, 3> kBehind = {2, 0, 1};
    const FaceValues f = face_values(faces_of(kMiddle), t.seen);
    std::uint32_t mask = 0xf;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto& at = f.at[k];
        const auto& slack = f.slack;
        const bool before = at[0] > slack[0] && at[1] > slack[1] && at[2] > slack[2];
        const bool behind = at[0] < -slack[0] && at[1] < -slack[1] && at[2] < -slack[2];
        if (before) mask &= ~(1U << kBehind[k]);
        if (behind) mask &= 1U << kBehind[k];
    }
    return mask;
}

const ConeFaces& ConeChildren::faces_of(std::uint32_t child) {
    if (!faces_[child]) {
        faces_[child] = cone_faces(tetra_cone(key_ << bits_ | child));
    }
    return *faces_[child];
}

std::uint32_t ConeChildren::touched_by(const PlacedTriangle& t, const Double3& centre) {
    const std::uint32_t possible = possible_children(t);
    // What is on one side of a plane through the centre does not hold it.
    if (possible == 0xff && triangles_touch(t.corners, {centre, centre, centre})) return 0;
    std::uint32_t mask = sure_children(t.inner_cones).mask & possible;
    std::uint32_t open = possible & ~mask;
    // It touches one of them.
    if (mask == 0 && std::has_single_bit(open)) return open;
    for (; open != 0; open &= open - 1) {
        const auto child = static_cast<std::uint32_t>(std::countr_zero(open));
        const ConeFaces& faces = faces_of(child);
        if (touches_faces(t.corners, centre, faces, face_values(faces, t.seen))) {
            mask |= 1U << child;
        }
    }
    return mask;
}

}  // namespace cdprep::build
