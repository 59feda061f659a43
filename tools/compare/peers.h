// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cdprep/result.h"
#include "compare/peer_answers.h"

namespace cdprep::report {

/// Reads what the program of peers printed. Fails with `unreadable`, in a sentence, when it is
/// not what tests/bench/peers.cpp says, whatever it is.
[[nodiscard]] Result<study::PeerRun> read_peers(std::string_view json);

}  // namespace cdprep::report

namespace cdprep::cli {

/// What a program of peers is asked: its words are the first one, then files that hold the
/// bytes, then the others. tests/bench/peers.cpp says what they mean.
struct PeerQuestions {
    std::string what;                               ///< "pair" or "build"
    std::vector<std::span<const std::byte>> files;  ///< models as baked, questions
    std::vector<std::string> words;
};

/// Runs the program and returns what it prints. It reads everything from memory: nothing is
/// written to disk. Fails with `unreadable` when it cannot be started or does not end with 0,
/// and with `interrupted` when the person stops us, which ends it too.
[[nodiscard]] Result<std::string> run_peers(const std::filesystem::path& program,
                                            const PeerQuestions& questions);

}  // namespace cdprep::cli
