// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>

#include "cdprep/plan.h"

namespace cdprep::scenes {

/// The effects that a scene file may ask for. Not all of them are built.
inline const std::array<std::string, 12> kEffectWords = {
    "collide",    "overlap", "distance", "within", "contacts", "response",
    "continuous", "self",    "deform",   "tear",   "inside",   "haptic"};

/// Returns the bit of an effect, or nothing if no version of the library has it yet.
[[nodiscard]] inline Ask effect_of(const std::string& word) noexcept {
    const Needs* row = find_needs(std::string_view(word));
    return row == nullptr ? Ask::nothing : row->ask;
}

/// Returns the name of one effect.
[[nodiscard]] inline std::string effect_name(Ask one) {
    const Needs* row = find_needs(one);
    return row == nullptr ? "unknown" : row->name;
}

}  // namespace cdprep::scenes
