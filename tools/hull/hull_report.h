// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cdprep/result.h"

namespace cdprep::report {

/// One hull: around the whole mesh, a component or a node.
struct HullFigures {
    std::string name;
    int dimension = -1;
    std::uint64_t points = 0;
    std::uint64_t facets = 0;  ///< triangles
    std::uint64_t faces = 0;   ///< maximal coplanar faces
    bool exact = true;
    double distance = 0;  ///< upper bound on the distance from the exact hull, model units
};

/// The result of `cdprep hull`.
struct HullReport {
    std::string input;
    std::string output;
    std::string scope;  ///< "whole", "component" or "node"
    std::uint64_t triangles = 0;
    std::uint64_t vertices = 0;
    std::vector<HullFigures> hulls;
    double seconds = 0;  ///< of the hull search only
    int exit = 0;
    std::optional<std::string> error;  ///< the message, if it failed
};

/// Returns the error for a missing enclosing hull, which `option` requested.
[[nodiscard]] Error hull_beyond_range(const std::string& input, const char* option);

/// Returns a text for people: at most `most_lines` lines of hulls, and totals.
[[nodiscard]] std::string hull_text(const HullReport& report, std::size_t most_lines);

/// Returns one JSON object, which hull.schema.json describes. "hulls" has an object per hull.
[[nodiscard]] std::string hull_json(const HullReport& report);

}  // namespace cdprep::report
