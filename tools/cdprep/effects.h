// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "cdprep/format/section_set.h"
#include "cdprep/result.h"

namespace cdprep::cli {

/// What a bake is to serve.
struct Effects {
    std::vector<std::string> names;  ///< sorted, each once
    format::SectionSet sections;     ///< what they need
    bool all = false;                ///< asked for by that word
};

/// Takes a comma-separated list of effects. "all" stands for every effect that
/// can be baked; an empty list for the default: collide, overlap, distance,
/// within, ray, closest. Fails with bad_argument on a name that is unknown or
/// that this version cannot bake, and lists those it can.
[[nodiscard]] Result<Effects> parse_effects(const std::string& list);

/// Sections that a question needs in each file.
[[nodiscard]] format::SectionSet sections_for(const std::string& effect);

/// Names, with commas, of the sections in `needed` that `present` lacks. Either
/// kind of positions will do.
[[nodiscard]] std::string missing_sections(format::SectionSet needed, format::SectionSet present);

/// Names, with commas, of all in `needed` that `present` lacks, whatever they are.
[[nodiscard]] std::string missing_parts(format::SectionSet needed, format::SectionSet present);

}  // namespace cdprep::cli
