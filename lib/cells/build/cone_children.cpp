// SPDX-License-Identifier: MIT
#include "cells/build/cone_children.h"

#include <bit>
#include <cassert>

namespace cdprep::build {
namespace {

constexpr std::uint32_t kMiddle = 3;  ///< the child between the other three
/// The generators of the middle child are m12, m23, m31. The child of v3 is across from m12.
constexpr std::array<std::uint32_t, 3> kBehind = {2, 0, 1};
constexpr std::uint32_t kAllChildren = 0xf;
constexpr std::uint32_t kAllOctants = 0xff;

/// Places are at most 1. They are off by 8 u, then rounded to float: less than half of this.
constexpr float kPlaceSlack = 0x1p-23F;

/// Returns the octants that the triangle may reach. It excludes octants beyond a coordinate plane
/// that has all corners strictly on its other side. Signs of differences are exact.
std::uint32_t possible_octants(const SeenTriangle& t) noexcept {
    constexpr std::array<std::uint32_t, 3> kPositive = {0x55, 0x33, 0x0f};
    std::uint32_t mask = kAllOctants;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double a = t[0].at[axis], b = t[1].at[axis], c = t[2].at[axis];
        if (a > 0 && b > 0 && c > 0) mask &= kPositive[axis];
        if (a < 0 && b < 0 && c < 0) mask &= ~kPositive[axis];
    }
    return mask;
}

/// Returns the octants that strictly contain the corners, if these are one octant or two side by
/// side. Then the triangle is in no other octant. Returns 0 otherwise.
std::uint32_t neighbours_of(const std::array<const PlacedVertex*, 3>& at) noexcept {
    std::uint32_t differing = 0;
    std::uint32_t mask = 0;
    const auto octant_of = [](std::uint32_t cone) { return cone >> 2 * tetra_level(cone) & 7U; };
    for (const PlacedVertex* p : at) {
        if (p->inner_cone == 0) return 0;
        mask |= 1U << octant_of(p->inner_cone);
        differing |= octant_of(p->inner_cone) ^ octant_of(at[0]->inner_cone);
    }
    return (differing & (differing - 1)) == 0 ? mask : 0;
}

}  // namespace

ConeChildren::ConeChildren(const TetraInput& input, std::uint32_t key) noexcept
    : input_(input),
      key_(key),
      bits_(key == kRootKey ? 3 : 2),
      below_(key == kRootKey ? 2 * input.level : 2 * (input.level - tetra_level(key) - 1)) {
    if (key == kRootKey) return;
    assert(tetra_level(key) < input.level);
    middle_ = cone_faces(tetra_cone(key << 2 | kMiddle));
    for (std::size_t k = 0; k < 3; ++k) {
        const ConeFace& face = middle_.face[k];
        const auto weight = static_cast<float>(face.weight);  // exact
        borders_[face.axis] = {weight - kPlaceSlack, weight + kPlaceSlack, 1U << kBehind[k]};
    }
}

/// Returns the children in which corners certainly lie.
std::uint32_t ConeChildren::sure_children(const Places& at) const noexcept {
    std::uint32_t mask = 0;
    for (const PlacedVertex* p : at) {
        // The key of an inner cone that is not a finest one is too short to match.
        const std::uint32_t child = p->inner_cone >> below_;
        if (child >> bits_ == key_) mask |= 1U << (child & ((1U << bits_) - 1));
    }
    return mask;
}

// A triangle with all corners on one side of a plane through the centre lies on that side. In one
// octant, planes are lines of its face.
std::uint32_t ConeChildren::possible_by_places(const Places& at) const noexcept {
    const bool is_upright = middle_.face[0].side > 0;  // as are all three
    std::uint32_t mask = kAllChildren;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float a = at[0]->at[axis], b = at[1]->at[axis], c = at[2]->at[axis];
        const float least = std::min(std::min(a, b), c);
        const float most = std::max(std::max(a, b), c);
        const Border& border = borders_[axis];
        const bool all_above = least > border.below;
        const bool all_below = most < border.above;
        const std::uint32_t not_behind = is_upright ? all_above : all_below;
        const std::uint32_t behind = is_upright ? all_below : all_above;
        mask &= ~(border.child & (0 - not_behind)) & (border.child | (behind - 1));
    }
    return mask;
}

std::uint32_t ConeChildren::possible_by_values(const SeenTriangle& t) const noexcept {
    const FaceValues f = face_values(middle_, t);
    std::uint32_t mask = kAllChildren;
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

/// Returns those of some children that the triangle touches, by exact tests.
std::uint32_t ConeChildren::touched_among(std::uint32_t triangle, std::uint32_t children) {
    const Corners t = input_.corners(triangle);
    const SeenTriangle seen = seen_triangle(input_.centre, t, input_.scale);
    std::uint32_t mask = 0;
    for (; children != 0; children &= children - 1) {
        const auto child = static_cast<std::uint32_t>(std::countr_zero(children));
        std::optional<ConeFaces>& faces = faces_[child];
        if (!faces) faces = cone_faces(tetra_cone(key_ << bits_ | child));
        if (touches_faces(t, input_.centre, *faces, face_values(*faces, seen))) {
            mask |= 1U << child;
        }
    }
    return mask;
}

std::uint32_t ConeChildren::touched_by(std::uint32_t triangle, bool in_octant) {
    const auto& v = input_.triangles[triangle].vertex;
    const Places at = {&input_.places[v[0]], &input_.places[v[1]], &input_.places[v[2]]};
    const std::uint32_t sure = sure_children(at);
    std::uint32_t possible = 0;
    if (key_ == kRootKey) {
        if (const std::uint32_t octants = neighbours_of(at); octants != 0) return octants;
        possible = possible_octants(input_.seen(triangle));
        // A triangle on one side of a plane through the centre does not hold the centre.
        const Double3& c = input_.centre;
        if (possible == kAllOctants && triangles_touch(input_.corners(triangle), {c, c, c})) {
            return 0;
        }
    } else {
        possible = in_octant ? possible_by_places(at) : possible_by_values(input_.seen(triangle));
    }
    // The triangle touches one of them.
    assert(possible != 0);
    if ((possible & (possible - 1)) == 0) return possible;
    const std::uint32_t open = possible & ~sure;
    return open == 0 ? sure & possible : (sure & possible) | touched_among(triangle, open);
}

}  // namespace cdprep::build
