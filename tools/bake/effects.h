// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/ask.h"
#include "cdprep/result.h"

namespace cdprep::cli {

/// The effects that a file is baked for.
struct Effects {
    std::vector<std::string> names;  ///< sorted, each once
    Ask asks = Ask::nothing;
    format::SectionSet sections;  ///< sections that they need or use, without structures
    bool all = false;             ///< the list contains "all"
};

/// The effects that a file is baked for if none are named.
inline constexpr const char* kDefaultEffects = "collide,overlap,distance,within,ray,closest";

/// Returns the words that a list of effects may hold: the names of all effects, sorted, and "all".
[[nodiscard]] std::vector<std::string> effect_words();

/// Parses a comma-separated list of effects. An effect is a row of needs() whose option is
/// `--effects`. "all" selects every effect. An empty list selects kDefaultEffects. Fails with
/// bad_argument on an unknown name, and lists the known ones.
[[nodiscard]] Result<Effects> parse_effects(const std::string& list);

/// Returns the options of `cdprep bake` for a file that serves `needed`, for example "--effects
/// collide,contacts --structures hull". They keep what the file serves now, with its `sections`. An
/// effect is left out if the others have those sections.
[[nodiscard]] std::string options_to_bake(Ask needed, Ask served, format::SectionSet sections);

/// Returns the fastest bounds for the queries that a bake serves. Swept rectangles bound distances
/// more tightly, which helps distance and contact queries; no other query uses them.
[[nodiscard]] build::BvhBounds bounds_for(const Effects& effects);

}  // namespace cdprep::cli
