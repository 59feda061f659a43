// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace cdprep::report {

/// " Did you mean 'collide'?" of the candidate that is fewest typing mistakes away (a letter more,
/// less, wrong, or two exchanged), the first of several; empty where none is near: more than a
/// third of the word's letters, but at least one, are mistakes, or the word has one or two letters.
[[nodiscard]] std::string suggestion(std::string_view word,
                                     std::span<const std::string> candidates);

}  // namespace cdprep::report
