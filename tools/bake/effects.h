// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "cdprep/ask.h"
#include "cdprep/result.h"

namespace cdprep::cli {

/// What a bake is to serve.
struct Effects {
    std::vector<std::string> names;  ///< sorted, each once
    Ask asks = Ask::nothing;
    format::SectionSet sections;  ///< what they need or use, without structures
    bool all = false;             ///< asked for by that word
};

/// Takes a comma-separated list of effects: the rows of the table of needs that `--effects` adds.
/// "all" stands for every one; an empty list for the default: collide, overlap, distance, within,
/// ray, closest. Fails with bad_argument on an unknown name, and lists the known ones.
[[nodiscard]] Result<Effects> parse_effects(const std::string& list);

}  // namespace cdprep::cli
