// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "cdprep/build_bvh.h"
#include "cdprep/model.h"

namespace cdprep::report {

/// How --bounds, provenance and info call what bounds the triangles of a model.
struct BoundsName {
    const char* name;
    build::BvhBounds bounds;
};
inline constexpr std::array<BoundsName, 5> kBoundsNames = {{
    {"aabb", build::BvhBounds::aligned},
    {"obb", build::BvhBounds::oriented},
    {"pss", build::BvhBounds::swept_points},
    {"lss", build::BvhBounds::swept_lines},
    {"rss", build::BvhBounds::swept_rectangles},
}};

[[nodiscard]] constexpr const char* bounds_name(build::BvhBounds bounds) noexcept {
    for (const BoundsName& known : kBoundsNames) {
        if (known.bounds == bounds) return known.name;
    }
    return "unknown";
}

/// Of an open model, by the sections it has.
[[nodiscard]] inline build::BvhBounds bounds_of(const Model& model) noexcept {
    if (model.sections().contains(SectionId::swept_nodes)) {
        return build::swept_bounds(format::swept_kind(model.header().flags));
    }
    return model.sections().contains(SectionId::oriented_nodes) ? build::BvhBounds::oriented
                                                                : build::BvhBounds::aligned;
}

}  // namespace cdprep::report
