// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "accuracy/bounding_shapes.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/pose.h"
#include "decompose/enclose/hull_sections.h"
#include "mesh/mesh.h"

namespace cdprep::study {

/// Convex parts that enclose a mesh, ready for queries: as a file stores them, with a sphere
/// around each.
struct PartSet {
    convex::HullSections sections;
    std::vector<BoundingSphere> around;
    double outer_error = 0;  ///< no point of a part is farther from the solid; model units
    double seconds = 0;      ///< the wall-clock time of the search

    /// Returns the bytes of corners and spheres, which a query may read.
    [[nodiscard]] std::uint64_t bytes() const noexcept;
};

/// Returns at most `count` parts of at most 64 corners each. `work` bounds the search
/// (convex::ApproximateOptions). Returns nothing if `stop` returned true.
[[nodiscard]] std::optional<PartSet> make_part_set(const mesh::Mesh& mesh, std::size_t count,
                                                   std::size_t work, ParallelFor parallel_for,
                                                   const std::function<bool()>& stop);

/// Returns whether any part of A shares a point with a part of the moved B. Tests spheres first,
/// then convex_collide(). `moved_centres` is scratch memory. Adds the bytes that it reads to `read`
/// if that is not null; data that is read again counts again.
[[nodiscard]] bool parts_touch(const PartSet& a, const PartSet& b, const Pose& a_from_b,
                               std::vector<Double3>& moved_centres, std::uint64_t* read = nullptr);

}  // namespace cdprep::study
