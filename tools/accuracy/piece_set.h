// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/pose.h"
#include "decompose/enclose/hull_sections.h"
#include "mesh/mesh.h"
#include "accuracy/bounding_shapes.h"

namespace cdprep::study {

/// Convex pieces that enclose a mesh, ready for questions: as a file stores them, with a
/// sphere around each.
struct PieceSet {
    convex::HullSections sections;
    std::vector<BoundingSphere> around;
    double outer_error = 0;  ///< no point of a piece is farther from the solid; model units
    double seconds = 0;      ///< what finding them took, of the clock

    /// Of corners and spheres: what a question may read.
    [[nodiscard]] std::uint64_t bytes() const noexcept;
};

/// At most so many pieces, of at most 64 corners each, by so much work
/// (convex::ApproximateOptions). Nothing when `stop` said so.
[[nodiscard]] std::optional<PieceSet> make_piece_set(const mesh::Mesh& mesh, std::size_t count,
                                                     std::size_t work, ParallelFor parallel_for,
                                                     const std::function<bool()>& stop);

/// Whether any piece of A has a point in common with one of B as moved: spheres first, then
/// convex_collide(). `moved_centres` is scratch. To `read`, or null, it adds the bytes of what it
/// reads; what it reads again counts again.
[[nodiscard]] bool pieces_touch(const PieceSet& a, const PieceSet& b, const Pose& a_from_b,
                                std::vector<Double3>& moved_centres, std::uint64_t* read = nullptr);

}  // namespace cdprep::study
