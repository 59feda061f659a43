// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/triangle_tree.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

/// Against what it is measured how far a hull sticks out.
enum class Reference : std::uint8_t {
    solid,   ///< what closed components enclose, and the surface of the others
    surface  ///< the surface alone, as for sheets without volume
};

/// What a mesh encloses, and its surface: how far points are from it.
///
/// A closed component encloses the points around which its winding number, together with
/// that of the inverted components within it (its cavities), is not 0. Others enclose
/// nothing. Keeps a reference to nothing.
class Solid {
public:
    /// `mesh` has triangles. The same for any parallel_for.
    Solid(const mesh::Mesh& mesh, Reference reference, ParallelFor parallel_for);

    /// Bodies: closed components with their cavities, and open components one by one.
    [[nodiscard]] std::uint32_t body_count() const {
        return body_count_;
    }
    [[nodiscard]] std::uint32_t body_of(std::uint32_t triangle) const {
        return body_of_[triangle];
    }
    /// Whether some body encloses anything.
    [[nodiscard]] bool encloses() const {
        return encloses_;
    }
    /// Exact: whether p is enclosed; on the surface it may be either.
    [[nodiscard]] bool includes(const Double3& p) const;
    /// Exact: the bodies that enclose p, or have it on their closed surface; ascending.
    [[nodiscard]] std::vector<std::uint32_t> bodies_around(const Double3& p) const;

    [[nodiscard]] const TriangleTree& tree() const {
        return tree_;
    }
    /// Of the surface, and more than any error of rounding in coordinates.
    [[nodiscard]] double diagonal() const {
        return tree_.box().diagonal();
    }
    /// Larger than what rounding does to a distance that TriangleTree finds.
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
    std::vector<bool> closed_;  ///< of each body
    std::uint32_t body_count_ = 0;
    bool encloses_ = false;
    double slack_ = 0;
};

}  // namespace cdprep::convex
