// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// Which triangles hide which from a centre's far side: seen along rays towards it.
///
/// A triangle hides another in a direction in which both lie and it is farther out.
/// Exact: what is left of a triangle's directions is kept as cones between planes through
/// the centre, whose corners are never computed, only the signs of determinants.
class RadialCover {
public:
    /// `triangles` index `positions`, in which equal points have one number; both outlive this.
    RadialCover(const Double3& centre, std::span<const Double3> positions,
                std::span<const Triangle> triangles);
    RadialCover(RadialCover&&) noexcept;
    RadialCover& operator=(RadialCover&&) noexcept;
    ~RadialCover();

    /// Whether the plane of the triangle holds the centre, or there is no plane: then it
    /// covers no direction.
    [[nodiscard]] bool is_edge_on(std::uint32_t triangle) const;

    /// Returns whether `others` together hide the triangle in all its directions but for
    /// single lines. No triangle hides itself, one that is edge-on, or its own plane; an
    /// edge-on triangle is not hidden. O(others) when one direction proves it bare, more by
    /// the pieces that the others cut it into when not. Any number of threads.
    [[nodiscard]] bool is_hidden(std::uint32_t triangle,
                                 std::span<const std::uint32_t> others) const;

    struct Data;  ///< private to the source file

private:
    std::unique_ptr<Data> data_;
};

}  // namespace cdprep::mesh
