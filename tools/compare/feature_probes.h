// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cdprep/result.h"
#include "study/table.h"

namespace cdprep::study {

/// Table 1: what each strategy can answer. A cell is X when a probe passed: the strategy was
/// asked about boxes and triangles whose answers are known by hand, apart, touching and
/// overlapping, and was right every time. Fails as make_model_forms().
[[nodiscard]] Result<Table> feature_table();

/// Nothing that the paper's Table 1 ticks is missing.
[[nodiscard]] Check feature_check(const Table& table);

}  // namespace cdprep::study
