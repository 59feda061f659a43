// SPDX-License-Identifier: MIT
#pragma once

#include "repair/repair.h"

namespace cdprep::test {

/// The steps of a preset, with default limits.
inline mesh::RepairOptions preset_options(const char* preset) {
    mesh::RepairOptions options;
    options.steps = *mesh::find_repair_preset(preset);
    return options;
}

inline bool has(const mesh::StoredVerdict& found, format::VerdictFacts fact) {
    return (found.verdict.facts & fact) != 0;
}

}  // namespace cdprep::test
