// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cdprep/format/float_environment.h"
#include "cdprep/points.h"
#include "contact_pairs.h"
#include "core/require.h"
#include "smallest.h"
#include "sort_numbers.h"
#include "walk_model.h"

namespace cdprep {

inline bool is_identity(const Pose& pose) noexcept {
    constexpr std::array<double, 9> kStill = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    return pose.rotation() == kStill && pose.translation() == Double3{0, 0, 0};
}

/// The model as a question about a shape sees it.
inline MovedModel placed(const Model& model, const Pose& world_from_model) noexcept {
    return {model, is_identity(world_from_model) ? nullptr : &world_from_model};
}

/// Calls `found` with every triangle, tree order, that touches the shape, until it
/// returns false; returns false when it did. Shape is made from a MovedModel and what
/// the caller asked about; shape.judge(node) says which boxes it may touch and which it
/// holds entirely, shape.touches(corners) decides exactly.
template <class Shape, class Asked, class Found>
bool for_each_touching(const Model& model, const Asked& asked, Workspace& workspace,
                       const ShapeOptions& options, Found&& found) noexcept {
    const MovedModel moved = placed(model, options.world_from_model);
    const Shape shape(moved, asked);
    const bool skips = options.degenerate == Degenerate::skip;
    const auto look_at = [&](const TriangleRun& run, bool certain) {
        for (std::uint32_t i = run.first; i < run.last; ++i) {
            if (skips && is_marked_degenerate(model, i)) continue;
            if (!certain && !shape.touches(moved.corners(i))) continue;
            if (!found(i)) return false;
        }
        return true;
    };
    return walk_nodes(
        model, workspace.storage(), [&](const format::BvhNode& node) { return shape.judge(node); },
        [&](const TriangleRun& run) { return look_at(run, false); },
        [&](const TriangleRun& run) { return look_at(run, true); });
}

template <class Shape, class Asked>
bool any_touching(const Model& model, const Asked& asked, Workspace& workspace,
                  const ShapeOptions& options) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::touch);
    return !for_each_touching<Shape>(model, asked, workspace, options,
                                     [](std::uint32_t) { return false; });
}

template <class Shape, class Asked>
std::size_t all_touching(const Model& model, const Asked& asked, Workspace& workspace,
                         std::span<std::uint32_t> triangles, const ShapeOptions& options) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::touch);
    Smallest<std::uint32_t> smallest(triangles);
    for_each_touching<Shape>(model, asked, workspace, options, [&](std::uint32_t i) {
        smallest.add(source_number(model, i));
        return true;
    });
    sort_numbers(smallest.kept(), workspace.storage().frontier);
    return smallest.count();
}

template <class Shape, class Asked>
bool visit_touching(const Model& model, const Asked& asked, Workspace& workspace,
                    TriangleVisitor visit, const ShapeOptions& options) noexcept {
    format::FloatEnvironment environment;
    require(model, Ask::touch);
    return for_each_touching<Shape>(model, asked, workspace, options, [&](std::uint32_t i) {
        const std::uint32_t source = source_number(model, i);
        return environment.outside([&] { return visit(source); });
    });
}

}  // namespace cdprep
