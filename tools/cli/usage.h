// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace cdprep::cli {

/// For options that take one of some words. Refuses others in one sentence with the nearest.
[[nodiscard]] CLI::Validator one_of(std::vector<std::string> words);

/// For options that take a whole number from `least` to `most`.
[[nodiscard]] CLI::Validator whole_from(
    std::uint64_t least, std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// For options that take a finite number of 0 or more, of that unit.
[[nodiscard]] CLI::Validator zero_or_more(const char* unit = nullptr);

/// For options that take a finite number above 0.
[[nodiscard]] CLI::Validator above_zero();

/// For options that take a size such as 500MB, from a byte to a petabyte; makes it a number of
/// bytes. Units are powers of 1024.
[[nodiscard]] CLI::Validator size_to_petabyte();

/// "cdprep query: 'colide' is not a command. Did you mean 'collide'? ...": why arguments were not
/// understood, and what helps.
[[nodiscard]] std::string usage_sentence(const CLI::App& app, const CLI::ParseError& error);

}  // namespace cdprep::cli
