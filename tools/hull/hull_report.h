// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cdprep/result.h"

namespace cdprep::report {

/// One hull: around all, a component or a node.
struct HullFigures {
    std::string name;
    int dimension = -1;
    std::uint64_t points = 0;
    std::uint64_t facets = 0;  ///< triangles
    std::uint64_t faces = 0;   ///< maximal coplanar ones
    bool exact = true;
    double distance = 0;  ///< from the exact hull at most, model units
};

/// What `cdprep hull` gave.
struct HullReport {
    std::string input;
    std::string output;
    std::string scope;  ///< "whole", "component" or "node"
    std::uint64_t triangles = 0;
    std::uint64_t vertices = 0;
    std::vector<HullFigures> hulls;
    double seconds = 0;  ///< of finding hulls alone
    int exit = 0;
    std::optional<std::string> error;  ///< the sentence, when it failed
};

/// Returns why there is no enclosing hull; `option` asked for it.
[[nodiscard]] Error hull_beyond_range(const std::string& input, const char* option);

/// For a person: a line for each hull, at most `most_lines`, and what they are together.
[[nodiscard]] std::string hull_text(const HullReport& report, std::size_t most_lines);

/// One object: "hulls" has an object for each.
[[nodiscard]] std::string hull_json(const HullReport& report);

}  // namespace cdprep::report
