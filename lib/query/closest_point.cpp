// SPDX-License-Identifier: MIT
#include "cdprep/format/float_environment.h"
#include "cdprep/points.h"
#include "core/require.h"
#include "core/triangle_facts.h"
#include "walk/nearest_triangle.h"

namespace cdprep {

std::optional<ClosestPoint> closest_point(const Model& model, const Double3& query,
                                          Workspace& workspace, double max_distance) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::closest);
    const auto near = nearest_triangle({model, nullptr}, query, max_distance, workspace.storage());
    if (!near) return std::nullopt;
    return ClosestPoint{near->point, near->lower, near->upper,
                        source_number(model, near->triangle)};
}

}  // namespace cdprep
