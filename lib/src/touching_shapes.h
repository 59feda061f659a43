// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/points.h"

namespace cdprep {

// touches(), touching_triangles(), visit_touching_triangles() and shape_distance() of each shape.

[[nodiscard]] bool touches_shape(const Model& model, const Box& box, Workspace& workspace,
                                 const ShapeOptions& options) noexcept;
[[nodiscard]] std::size_t triangles_at(const Model& model, const Box& box, Workspace& workspace,
                                       std::span<std::uint32_t> room,
                                       const ShapeOptions& options) noexcept;
bool visit_triangles_at(const Model& model, const Box& box, Workspace& workspace,
                        TriangleVisitor visit, const ShapeOptions& options) noexcept;

[[nodiscard]] bool touches_shape(const Model& model, const Sphere& sphere, Workspace& workspace,
                                 const ShapeOptions& options) noexcept;
[[nodiscard]] std::size_t triangles_at(const Model& model, const Sphere& sphere,
                                       Workspace& workspace, std::span<std::uint32_t> room,
                                       const ShapeOptions& options) noexcept;
bool visit_triangles_at(const Model& model, const Sphere& sphere, Workspace& workspace,
                        TriangleVisitor visit, const ShapeOptions& options) noexcept;

[[nodiscard]] bool touches_shape(const Model& model, const Capsule& capsule, Workspace& workspace,
                                 const ShapeOptions& options) noexcept;
[[nodiscard]] std::size_t triangles_at(const Model& model, const Capsule& capsule,
                                       Workspace& workspace, std::span<std::uint32_t> room,
                                       const ShapeOptions& options) noexcept;
bool visit_triangles_at(const Model& model, const Capsule& capsule, Workspace& workspace,
                        TriangleVisitor visit, const ShapeOptions& options) noexcept;

[[nodiscard]] bool touches_shape(const Model& model, const TriangleShape& triangle,
                                 Workspace& workspace, const ShapeOptions& options) noexcept;
[[nodiscard]] std::size_t triangles_at(const Model& model, const TriangleShape& triangle,
                                       Workspace& workspace, std::span<std::uint32_t> room,
                                       const ShapeOptions& options) noexcept;
bool visit_triangles_at(const Model& model, const TriangleShape& triangle, Workspace& workspace,
                        TriangleVisitor visit, const ShapeOptions& options) noexcept;

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
