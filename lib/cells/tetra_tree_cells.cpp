// SPDX-License-Identifier: MIT
#include "cells/tetra_tree_cells.h"

#include <cmath>

#include "exact/vectors.h"

// The part of a cone's triangles between its two radii lies in a truncated cone of six corners.
// Both of a cone's bounds hold these corners, which are computed in double. Components are sums of
// at most seven units, so they are off by 2^-47 at most (float_below(), float_over()). The kernels'
// slack is for boxes within one unit of the frame's origin, but a cone's corners may be seven away.
// So the oriented box is enlarged by 2^-18 of that. This also covers the rounding of its axes: unit
// and at right angles up to 2^-22.

namespace cdprep {
namespace {

using Vector = std::array<double, 3>;

/// Returns a vector of unit length, up to the rounding of its components to float.
Vector unit(const Vector& v) noexcept {
    const double factor = 1 / std::sqrt(dot(v, v));
    Vector result{};
    for (std::size_t i = 0; i < 3; ++i) result[i] = double{static_cast<float>(v[i] * factor)};
    return result;
}

/// Generators in double, of size one along the octahedron.
using Generators = std::array<Vector, 3>;

Generators generators_of(const TetraCone& cone) noexcept {
    const double factor = two_to(-static_cast<int>(cone.level));
    Generators result{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) result[i][k] = cone.generator[i][k] * factor;
    }
    return result;
}

Vector middle(const Vector& a, const Vector& b) noexcept {
    return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
}

/// Returns the generators of the four children, as format::TetraTree numbers them.
std::array<Generators, 4> split(const Generators& v) noexcept {
    const Vector m12 = middle(v[0], v[1]);
    const Vector m23 = middle(v[1], v[2]);
    const Vector m31 = middle(v[2], v[0]);
    return {{{v[0], m12, m31}, {m12, v[1], m23}, {m31, m23, v[2]}, {m12, m23, m31}}};
}

/// The corners of a truncated cone, relative to its centre.
using SixCorners = std::array<Vector, 6>;

SixCorners corners_of(const Generators& v, const format::TetraNode& node) noexcept {
    const double root3 = std::sqrt(3.0);
    SixCorners corners{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            corners[i][k] = v[i][k] * (root3 * double{node.radius_min});
            corners[3 + i][k] = v[i][k] * (root3 * double{node.radius_max});
        }
    }
    return corners;
}

void bound_aligned(const Vector& centre, const SixCorners& corners, unsigned lane,
                   format::BvhNode& boxes) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double lower = corners[0][axis];
        double upper = lower;
        for (const Vector& corner : corners) {
            lower = std::min(lower, corner[axis]);
            upper = std::max(upper, corner[axis]);
        }
        boxes.lower[axis][lane] = clipped(float_below(centre[axis] + lower));
        boxes.upper[axis][lane] = clipped(float_over(centre[axis] + upper));
    }
}

/// Bounds the corners by a box along the cone's middle direction.
void bound_oriented(const Vector& centre, const SixCorners& corners, const Generators& v,
                    unsigned lane, format::OrientedNode& boxes) noexcept {
    const Vector along = unit(
        {v[0][0] + v[1][0] + v[2][0], v[0][1] + v[1][1] + v[2][1], v[0][2] + v[1][2] + v[2][2]});
    const Vector side = {v[1][0] - v[0][0], v[1][1] - v[0][1], v[1][2] - v[0][2]};
    const std::array<Vector, 2> stored = {along, unit(cross(along, side))};
    const std::array<Vector, 3> axes = {stored[0], stored[1], cross(stored[0], stored[1])};
    Vector box_centre = centre;
    double far = 0;
    std::array<double, 3> half{};
    for (std::size_t k = 0; k < 3; ++k) {
        double lower = dot(axes[k], corners[0]);
        double upper = lower;
        for (const Vector& corner : corners) {
            const double at = dot(axes[k], corner);
            lower = std::min(lower, at);
            upper = std::max(upper, at);
        }
        half[k] = (upper - lower) / 2;
        far += half[k];
        for (std::size_t i = 0; i < 3; ++i) box_centre[i] += (lower + upper) / 2 * axes[k][i];
    }
    for (std::size_t i = 0; i < 3; ++i) far += std::fabs(box_centre[i]);
    for (std::size_t i = 0; i < 3; ++i) {
        boxes.axis[0][i][lane] = static_cast<float>(stored[0][i]);
        boxes.axis[1][i][lane] = static_cast<float>(stored[1][i]);
        boxes.centre[i][lane] = static_cast<float>(box_centre[i]);
        boxes.half[i][lane] = float_over(half[i] + far * 0x1p-18);
    }
}

}  // namespace

TetraTreeCells::TetraTreeCells(const Model& model, const TetraDetail& detail) noexcept
    : detail_(detail),
      tree_(model.tetra_tree().tree),
      nodes_(model.tetra_tree().nodes.data()),
      boxes_(detail.solid ? nullptr : model.tetra_tree().boxes.data()),
      oriented_(model.tetra_tree().oriented.data()),
      references_(model.tetra_tree().references),
      centre_{} {
    if (tree_ == nullptr) return;
    const FrameOf frame(model);
    centre_ = {frame.frame(0, tree_->centre.x), frame.frame(1, tree_->centre.y),
               frame.frame(2, tree_->centre.z)};
    for (const format::TetraNode& node : model.tetra_tree().nodes.first(
             std::min(model.tetra_tree().nodes.size(), std::size_t{8}))) {
        octants_ += node.key < 16 ? 1 : 0;
    }
}

void TetraTreeCells::bound(const Cell& cell, MadeBounds& bounds) const noexcept {
    const bool is_top = cell.node == kAboveRoots;
    std::array<Generators, 4> below{};
    if (!is_top) below = split(generators_of(tetra_cone(nodes_[cell.node].key)));
    for (unsigned rest = lanes(cell); rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(rest));
        format::TetraNode node = nodes_[child(cell, lane).node];
        if (detail_.solid) node.radius_min = 0;
        const Generators v = is_top ? generators_of(tetra_cone(node.key)) : below[node.key % 4];
        const SixCorners corners = corners_of(v, node);
        bound_aligned(centre_, corners, lane, bounds.boxes);
        bound_oriented(centre_, corners, v, lane, bounds.oriented);
    }
}

unsigned TetraTreeCells::lanes_listing(const Cell& cell, std::uint32_t triangle,
                                       const Corners& corners) const noexcept {
    if (is_at_centre(triangle)) return 0;
    unsigned listing = 0;
    for (unsigned rest = lanes(cell); rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(rest));
        const TetraCone cone = tetra_cone(nodes_[child(cell, lane).node].key);
        if (triangle_touches_cone(corners, tree_->centre, cone)) listing |= 1U << lane;
    }
    return listing;
}

}  // namespace cdprep
