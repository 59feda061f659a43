// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "cdprep/format/verdict.h"

namespace cdprep::report {

/// The facts that hold, as words: "closed", "two-manifold", "oriented", "orientable",
/// "balanced", "inverted", "crossings-examined", "self-crossing".
[[nodiscard]] std::vector<std::string> fact_words(const format::Verdict& verdict);

/// What is promised, as words: "surface", "inside-exact", "simple-solid",
/// "contained-pieces".
[[nodiscard]] std::vector<std::string> promise_words(const format::Verdict& verdict);

/// Facts and figures for people: "closed, 2-manifold, oriented, not self-crossing; ...".
[[nodiscard]] std::string verdict_text(const format::Verdict& verdict);

/// What answers mean on it, for people.
[[nodiscard]] std::string promises_text(const format::Verdict& verdict);

}  // namespace cdprep::report
