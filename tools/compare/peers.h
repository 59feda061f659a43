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

/// Reads the output of the peer program. Any input is safe. Fails with `unreadable`, in a sentence,
/// if the output does not have the form defined in tests/bench/peers.cpp.
[[nodiscard]] Result<study::PeerRun> read_peers(std::string_view json);

}  // namespace cdprep::report

namespace cdprep::cli {

/// The arguments of a peer program: first `what`, then files that hold the bytes, then `words`.
/// tests/bench/peers.cpp defines their meaning.
struct PeerQuestions {
    std::string what;                               ///< "pair" or "build"
    std::vector<std::span<const std::byte>> files;  ///< baked models, questions
    std::vector<std::string> words;
};

/// Runs the program and returns its output. It reads everything from memory; nothing is written to
/// disk. Fails with `unreadable` if the program does not start or does not end with 0. Fails with
/// `interrupted` if the user stops us; the program then ends too.
[[nodiscard]] Result<std::string> run_peers(const std::filesystem::path& program,
                                            const PeerQuestions& questions);

}  // namespace cdprep::cli
