// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "compare/comparison.h"

namespace cdprep::report {

/// Returns one complete HTML page with every table, the checks, the errata of both publications,
/// and the settings of all measurements. A chart shows the time of each strategy for each pair. A
/// cell's tooltip shows its spread and cases, or why it is empty. The page has no script. It makes
/// no network requests; its Content-Security-Policy forbids them too. It is suitable for print. Any
/// model name is safe.
[[nodiscard]] std::string comparison_page(const study::Comparison& comparison);

}  // namespace cdprep::report
