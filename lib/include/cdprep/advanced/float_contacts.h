// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/format/api.h"
#include "cdprep/pairs.h"
#include "cdprep/visitor.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// A pair of triangles that the float tests do not separate. overlaps() passes such pairs to its
/// exact stage.
struct FloatContact {
    std::uint32_t a;  ///< source number
    std::uint32_t b;
    bool certain;  ///< proven: they cross; otherwise they may be apart
};

enum class FloatSearch : std::uint8_t {
    all,   ///< in the order of a depth-first walk
    first  ///< in the order in which collide() looks for a hit
};

/// Calls `visit` with each FloatContact of the two models until `visit` returns false. Returns
/// false if `visit` did; otherwise true. No pair in contact is missing. Serves studies of the cost
/// of exactness, and callers that accept a few pairs that are not in contact. Reads only the models
/// and the placement of `pair`. Needs Ask::overlap of both models. Costs less than overlaps().
CDPREP_API bool visit_float_contacts(const Pair& pair, Workspace& workspace, FloatSearch search,
                                     Visitor<FloatContact> visit);

}  // namespace cdprep
