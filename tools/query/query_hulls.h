// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/command.h"
#include "query/pair_arguments.h"

namespace cdprep::cli {

/// Returns whether a query is about the convex hulls of two models.
[[nodiscard]] bool asks_hulls(const PairArguments& arguments);

/// Queries the convex hulls of the whole models, always as solids.
Exit run_hulls(const PairArguments& arguments);

}  // namespace cdprep::cli
