// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/pairs.h"
#include "cdprep/visitor.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// A pair of triangles that tests in float do not separate: what overlaps() leaves to its exact
/// stage.
struct FloatContact {
    std::uint32_t a;  ///< number in the imported file
    std::uint32_t b;
    bool certain;  ///< proved: they cross; else they may be apart
};

enum class FloatSearch : std::uint8_t {
    all,   ///< in tree order
    first  ///< in the order in which collide() looks for a hit
};

/// Calls `visit` with each such pair, until it returns false; returns false when it did. No pair
/// in contact is missing. For studies of what exactness costs, and for answers that may be wrong.
/// Reads the placement of `pair` alone. Needs Ask::overlap. Costs less than overlaps().
bool visit_float_contacts(const Pair& pair, Workspace& workspace, FloatSearch search,
                          Visitor<FloatContact> visit);

}  // namespace cdprep
