// SPDX-License-Identifier: MIT
#include "query/touching_shapes.h"

namespace cdprep {
namespace {

template <class S>
TouchingShape<S> touching(const S&) noexcept {
    return {};
}

/// Returns ask(shape) for the shape that the variant holds. Shapes are trivial, so it always holds
/// one. std::visit is not used, because it could throw.
template <class Ask>
auto ask_of_each(const Shape& shape, Ask ask) noexcept {
    if (const auto* box = std::get_if<Box>(&shape)) return ask(*box);
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return ask(*sphere);
    if (const auto* capsule = std::get_if<Capsule>(&shape)) return ask(*capsule);
    return ask(*std::get_if<TriangleShape>(&shape));
}

}  // namespace

bool touches(const Model& model, const Shape& shape, Workspace& workspace,
             const ShapeOptions& options) noexcept {
    return ask_of_each(shape, [&](const auto& held) {
        return touching(held).any(model, held, workspace, options);
    });
}

std::size_t touching_triangles(const Model& model, const Shape& shape, Workspace& workspace,
                               std::span<std::uint32_t> room,
                               const ShapeOptions& options) noexcept {
    return ask_of_each(shape, [&](const auto& held) {
        return touching(held).all(model, held, workspace, room, options);
    });
}

bool visit_touching_triangles(const Model& model, const Shape& shape, Workspace& workspace,
                              TriangleVisitor visit, const ShapeOptions& options) noexcept {
    return ask_of_each(shape, [&](const auto& held) {
        return touching(held).visit(model, held, workspace, visit, options);
    });
}

std::optional<ShapeDistance> shape_distance(const Model& model, const Shape& shape,
                                            Workspace& workspace,
                                            const ShapeOptions& options) noexcept {
    return ask_of_each(shape,
                       [&](const auto& held) { return measure(model, held, workspace, options); });
}

}  // namespace cdprep
