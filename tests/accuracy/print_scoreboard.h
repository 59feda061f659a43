// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "accuracy/scoreboard.h"

namespace cdprep::test {

/// The scoreboard to look at: a table for each feature, families by strategies, "0/96" for no
/// wrong answer of 96. `widest` is the widest interval of an answer by the promised width.
/// Then what was wrong, by its first example.
[[nodiscard]] std::string as_text(const Scoreboard& board);

/// One object, with a list of cells.
[[nodiscard]] std::string as_json(const Scoreboard& board);

}  // namespace cdprep::test
