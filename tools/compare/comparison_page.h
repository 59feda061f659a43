// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "compare/comparison.h"

namespace cdprep::report {

/// One complete HTML page with every table, a chart of what each strategy takes for each pair,
/// the checks, the papers' errata, and how everything was measured. Point at a cell for its
/// spread and cases, or for why it is empty. No script; asks no network for anything, by its
/// own Content-Security-Policy too, and prints on paper. Any name of a model is safe.
[[nodiscard]] std::string comparison_page(const study::Comparison& comparison);

}  // namespace cdprep::report
