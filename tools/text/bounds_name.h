// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/model.h"

namespace cdprep::report {

/// The name of a kind of bounding volumes, as --bounds, provenance and info spell it.
struct BoundsName {
    const char* name;
    build::BvhBounds bounds;
};
inline constexpr std::array<BoundsName, 6> kBoundsNames = {{
    {"aabb", build::BvhBounds::aligned},
    {"obb", build::BvhBounds::oriented},
    {"pss", build::BvhBounds::swept_points},
    {"lss", build::BvhBounds::swept_lines},
    {"rss", build::BvhBounds::swept_rectangles},
    {"obb+rss", build::BvhBounds::oriented_and_swept},
}};

[[nodiscard]] constexpr const char* bounds_name(build::BvhBounds bounds) noexcept {
    for (const BoundsName& known : kBoundsNames) {
        if (known.bounds == bounds) return known.name;
    }
    return "unknown";
}

/// Returns the kind of bounding volumes of an open model, found from its sections.
[[nodiscard]] inline build::BvhBounds bounds_of(const Model& model) noexcept {
    const bool oriented = model.sections().contains(SectionId::oriented_nodes);
    if (!model.sections().contains(SectionId::swept_nodes)) {
        return oriented ? build::BvhBounds::oriented : build::BvhBounds::aligned;
    }
    if (oriented) return build::BvhBounds::oriented_and_swept;
    return build::swept_bounds(format::swept_kind(model.header().flags));
}

}  // namespace cdprep::report
