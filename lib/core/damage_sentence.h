// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "cdprep/format/find_damage.h"

namespace cdprep {

/// Returns a sentence for people: the file, what is wrong, the number found, the
/// number allowed, and what to do next.
[[nodiscard]] std::string damage_sentence(std::string_view file, const format::Damage& damage);

}  // namespace cdprep
