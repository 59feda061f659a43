// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "cdprep/result.h"

namespace cdprep::cli {

/// What a program of peers is asked about two models.
struct PeerQuestions {
    std::span<const std::byte> a;  ///< as baked
    std::span<const std::byte> b;
    std::string poses;     ///< a line each
    double tolerance = 0;  ///< model units
    std::size_t rounds = 1;
    double budget_s = 1;  ///< for one question to one peer
};

/// Runs the program and returns what it prints. It reads everything from memory: nothing is
/// written to disk. Fails with `unreadable` when it cannot be started or does not end with 0,
/// and with `interrupted` when the person stops us, which ends it too.
[[nodiscard]] Result<std::string> run_peers(const std::filesystem::path& program,
                                            const PeerQuestions& questions);

}  // namespace cdprep::cli
