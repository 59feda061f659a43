// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace cdprep::report {

/// Returns " Did you mean 'collide'?" for the candidate with the fewest typing mistakes, the first
/// of several. A mistake is an added, missing or wrong letter, or two letters exchanged. The
/// mistakes may be at most a third of the word's letters; one is always permitted. Empty if no
/// candidate is that near, or if the word has one or two letters.
[[nodiscard]] std::string suggestion(std::string_view word,
                                     std::span<const std::string> candidates);

}  // namespace cdprep::report
