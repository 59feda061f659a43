// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "cdprep/format/verdict.h"

namespace cdprep::report {

/// Returns the facts that hold, as words: "closed", "two-manifold", "oriented", "orientable",
/// "balanced", "inverted", "crossings-examined", "self-crossing".
[[nodiscard]] std::vector<std::string> fact_words(const format::Verdict& verdict);

/// Returns the promises that hold, as words: "surface", "inside-exact", "simple-solid",
/// "contained-pieces".
[[nodiscard]] std::vector<std::string> promise_words(const format::Verdict& verdict);

/// Returns facts and figures for people: "closed, 2-manifold, oriented, not self-crossing; ...".
[[nodiscard]] std::string verdict_text(const format::Verdict& verdict);

/// Returns text for people: the meaning of query results on a mesh with this verdict.
[[nodiscard]] std::string promises_text(const format::Verdict& verdict);

}  // namespace cdprep::report
