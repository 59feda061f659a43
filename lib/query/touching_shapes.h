// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/points.h"

namespace cdprep {

/// touches(), touching_triangles() and visit_touching_triangles() for one shape. The file of each
/// shape instantiates them.
template <class S>
struct TouchingShape {
    [[nodiscard]] static bool any(const Model& model, const S& shape, Workspace& workspace,
                                  const ShapeOptions& options) noexcept;
    [[nodiscard]] static std::size_t all(const Model& model, const S& shape, Workspace& workspace,
                                         std::span<std::uint32_t> room,
                                         const ShapeOptions& options) noexcept;
    static bool visit(const Model& model, const S& shape, Workspace& workspace,
                      TriangleVisitor visit, const ShapeOptions& options) noexcept;
};

// shape_distance() for each shape.

[[nodiscard]] std::optional<ShapeDistance> measure(const Model& model, const Box& box,
                                                   Workspace& workspace,
                                                   const ShapeOptions& options) noexcept;
[[nodiscard]] std::optional<ShapeDistance> measure(const Model& model, const Sphere& sphere,
                                                   Workspace& workspace,
                                                   const ShapeOptions& options) noexcept;
[[nodiscard]] std::optional<ShapeDistance> measure(const Model& model, const Capsule& capsule,
                                                   Workspace& workspace,
                                                   const ShapeOptions& options) noexcept;
[[nodiscard]] std::optional<ShapeDistance> measure(const Model& model,
                                                   const TriangleShape& triangle,
                                                   Workspace& workspace,
                                                   const ShapeOptions& options) noexcept;

}  // namespace cdprep
