// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/mesh.h"
#include "validate/defects/rule.h"

namespace cdprep::mesh {

/// Where something was found.
struct Place {
    std::vector<std::uint32_t> triangles;  ///< source numbers, ascending
    std::vector<std::uint32_t> vertices;   ///< numbers of the file, in the rule's order
    Double3 position{};                    ///< a point of it, model units
    double measure = 0;                    ///< as RuleText::measure says
};

/// One rule that found something.
struct Finding {
    Rule rule;
    std::uint64_t count = 0;      ///< all of them, however few places are kept
    std::vector<Place> places;    ///< the first, in source order
    bool is_lower_bound = false;  ///< the search ended early: there may be more, and lower places
};

}  // namespace cdprep::mesh
