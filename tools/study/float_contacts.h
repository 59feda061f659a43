// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "cdprep/model.h"
#include "cdprep/pose.h"
#include "cdprep/visitor.h"
#include "cdprep/workspace.h"

namespace cdprep::study {

/// A pair of triangles that boxes and planes in float do not part: what is left to the exact
/// stage of overlaps().
struct FloatContact {
    std::uint32_t a;  ///< source numbering
    std::uint32_t b;
    bool certain;  ///< float arithmetic proves that they cross; else they may be apart
};

enum class FloatSearch : std::uint8_t { all, first };  ///< first: in the order for a first hit

/// Calls `visit` with each of them until it returns false; returns false when it did. With
/// `first`, the walk looks where a hit is likely, as collide() does.
bool visit_float_contacts(const Model& a, const Model& b, const Placement& placement,
                          Workspace& workspace, FloatSearch search, Visitor<FloatContact> visit);

}  // namespace cdprep::study
