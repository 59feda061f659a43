// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/result.h"
#include "study/table.h"

namespace cdprep::study {

/// Returns Table 1: the queries that each strategy can answer. A cell is X if its probe passed. A
/// probe queries boxes and triangles with answers known by hand: apart, touching and overlapping.
/// Every answer must be right. Fails like make_model_forms().
[[nodiscard]] Result<Table> feature_table();

/// Checks that no feature in Table 1 of the comparative study is missing.
[[nodiscard]] Check feature_check(const Table& table);

}  // namespace cdprep::study
