// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cdprep/format/float_environment.h"
#include "cdprep/points.h"
#include "core/moved_model.h"
#include "core/require.h"
#include "core/smallest.h"
#include "core/sort_numbers.h"
#include "core/triangle_facts.h"
#include "query/touching_shapes.h"
#include "walk/walk_model.h"

namespace cdprep {

inline bool is_identity(const Pose& pose) noexcept {
    constexpr std::array<double, 9> kStill = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    return pose.rotation() == kStill && pose.translation() == Double3{0, 0, 0};
}

/// Returns the model in the pose that a shape query gives it.
inline MovedModel placed(const Model& model, const Pose& world_from_model) noexcept {
    return {model, is_identity(world_from_model) ? nullptr : &world_from_model};
}

/// The class that compares a shape with the boxes of a model; constructed from a MovedModel and the
/// shape. judge(node) returns the boxes that the shape may touch, and those that it contains
/// entirely. touches(corners) decides exactly. The file of each shape names its class `Type`.
template <class S>
struct AmongBoxesOf;

/// Calls `found` with every triangle, tree order, that touches the shape. Stops and returns false
/// when `found` returns false.
template <class S, class Found>
bool for_each_touching(const Model& model, const S& asked, Workspace& workspace,
                       const ShapeOptions& options, Found&& found) noexcept {
    const MovedModel moved = placed(model, options.world_from_model);
    const typename AmongBoxesOf<S>::Type shape(moved, asked);
    const bool skips = options.degenerate == Degenerate::skip;
    const auto look_at = [&](const TriangleRun& run, bool certain) {
        return each_triangle(model, run.first, run.last, [&](std::uint32_t i) {
            if (skips && is_marked_degenerate(model, i)) return true;
            if (!certain && !shape.touches(moved.corners(i))) return true;
            return static_cast<bool>(found(i));
        });
    };
    return walk_nodes(
        model, workspace.storage(), [&](const format::BvhNode& node) { return shape.judge(node); },
        [&](const TriangleRun& run) { return look_at(run, false); },
        [&](const TriangleRun& run) { return look_at(run, true); });
}

template <class S>
bool TouchingShape<S>::any(const Model& model, const S& shape, Workspace& workspace,
                           const ShapeOptions& options) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::touch);
    return !for_each_touching(model, shape, workspace, options,
                              [](std::uint32_t) { return false; });
}

template <class S>
std::size_t TouchingShape<S>::all(const Model& model, const S& shape, Workspace& workspace,
                                  std::span<std::uint32_t> room,
                                  const ShapeOptions& options) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::touch);
    Smallest<std::uint32_t> smallest(room);
    for_each_touching(model, shape, workspace, options, [&](std::uint32_t i) {
        smallest.add(source_number(model, i));
        return true;
    });
    sort_numbers(smallest.kept(), workspace.storage().frontier);
    return smallest.count();
}

template <class S>
bool TouchingShape<S>::visit(const Model& model, const S& shape, Workspace& workspace,
                             TriangleVisitor visit, const ShapeOptions& options) noexcept {
    format::FloatEnvironment environment;
    require(model, Ask::touch);
    return for_each_touching(model, shape, workspace, options, [&](std::uint32_t i) {
        const std::uint32_t source = source_number(model, i);
        return environment.outside([&] { return visit(source); });
    });
}

}  // namespace cdprep
