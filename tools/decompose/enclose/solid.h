// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/mesh.h"
#include "mesh/triangle_tree.h"

namespace cdprep::convex {

/// The reference from which errors are measured.
enum class Reference : std::uint8_t {
    solid,   ///< the volume of balanced components, and the surface of the others
    surface  ///< the surface alone, as for sheets without volume
};

/// The solid that a mesh encloses, and its surface: it measures the distance of points from it.
///
/// The cavities of a balanced component are the inverted components within it. It encloses the
/// points where the sum of its winding number and theirs is not 0. Other components enclose
/// nothing. Keeps no reference to the mesh.
class Solid {
public:
    /// `mesh` has triangles. The same for any parallel_for.
    Solid(const mesh::Mesh& mesh, Reference reference, ParallelFor parallel_for);

    /// Returns the number of bodies. A body is a balanced component with its cavities, or one
    /// unbalanced component.
    [[nodiscard]] std::uint32_t body_count() const {
        return body_count_;
    }
    [[nodiscard]] std::uint32_t body_of(std::uint32_t triangle) const {
        return body_of_[triangle];
    }
    /// Returns true if some body encloses a volume.
    [[nodiscard]] bool encloses() const {
        return encloses_;
    }
    /// Returns true if p is enclosed. Exact; on the surface the result may be either.
    [[nodiscard]] bool includes(const Double3& p) const;
    /// Returns the bodies that enclose p, or have it on their surface; ascending. Exact.
    [[nodiscard]] std::vector<std::uint32_t> bodies_around(const Double3& p) const;

    [[nodiscard]] const TriangleTree& tree() const {
        return tree_;
    }
    /// Returns the diagonal of the surface's box. It exceeds any rounding error of a coordinate.
    [[nodiscard]] double diagonal() const {
        return tree_.box().diagonal();
    }
    /// Returns a bound on the rounding error of the distances that TriangleTree finds.
    [[nodiscard]] double slack() const {
        return slack_;
    }

private:
    struct Around {
        std::uint32_t body;
        int winding;
        bool on_surface;
    };
    void count_around(const Double3& p, std::vector<Around>& around) const;

    TriangleTree tree_;
    std::vector<std::uint32_t> body_of_;
    std::vector<bool> balanced_;  ///< of each body
    std::uint32_t body_count_ = 0;
    bool encloses_ = false;
    double slack_ = 0;
};

}  // namespace cdprep::convex
