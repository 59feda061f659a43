// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// Decides which triangles are occluded along rays towards a centre.
///
/// A triangle occludes another in a direction if both lie in it and the first is farther out.
/// Exact: the remaining directions of a triangle are cones between planes through the centre. Their
/// corners are never computed, only signs of determinants.
class RadialCover {
public:
    /// `triangles` index `positions`, in which equal points have one number. Both must outlive this
    /// object.
    RadialCover(const Double3& centre, std::span<const Double3> positions,
                std::span<const Triangle> triangles);
    RadialCover(RadialCover&&) noexcept;
    RadialCover& operator=(RadialCover&&) noexcept;
    ~RadialCover();

    /// Returns whether the triangle covers no direction: its plane contains the centre, or it is
    /// degenerate.
    [[nodiscard]] bool is_edge_on(std::uint32_t triangle) const;

    /// Returns whether `others` together occlude the triangle in all its directions, except single
    /// lines. A triangle occludes neither itself, nor an edge-on triangle, nor one in its own
    /// plane. An edge-on triangle occludes nothing and is never occluded. Takes O(others) time if
    /// one direction proves the triangle visible. Otherwise the time grows with the number of
    /// fragments into which the others cut it. Any number of threads may call it.
    [[nodiscard]] bool is_hidden(std::uint32_t triangle,
                                 std::span<const std::uint32_t> others) const;

    struct Data;  ///< private to the source file

private:
    std::unique_ptr<Data> data_;
};

}  // namespace cdprep::mesh
