// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/mesh.h"
#include "validate/defects/rule.h"

namespace cdprep::mesh {

/// A place where a rule found something.
struct Place {
    std::vector<std::uint32_t> triangles;  ///< source numbers, ascending
    std::vector<std::uint32_t> vertices;   ///< numbers of the file; the rule defines the order
    Double3 position{};                    ///< a point of the place, model units
    double measure = 0;                    ///< see RuleText::measure
};

/// The occurrences that one rule found.
struct Finding {
    Rule rule;
    std::uint64_t count = 0;      ///< of all occurrences, even if few places are kept
    std::vector<Place> places;    ///< the first ones, in source order
    bool is_lower_bound = false;  ///< the search ended early: more and lower places may exist
};

}  // namespace cdprep::mesh
