// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "study/pair_study.h"

namespace cdprep::study {

/// What another library took and said; by case, as cases_of() has them.
struct PeerAnswered {
    std::vector<double> seconds;
    std::vector<std::size_t> answers;  ///< 0 or 1; of overlap, the number of pairs
};

struct PeerAnswers {
    std::string name;
    std::string note;    ///< of how it was asked
    double build_s = 0;  ///< of both models
    std::array<PeerAnswered, kAsked> asked{};
    std::array<std::string, kAsked> reasons{};  ///< why it was not asked
};

/// All who answered about a pair, and who did not.
struct PeerRun {
    std::vector<PeerAnswers> peers;
    std::vector<std::string> absent;  ///< a sentence each
};

/// What the program of peers is asked about a pair: a line a pose, as tests/bench/peers.cpp says.
[[nodiscard]] std::string peer_questions(const PoseSet& poses);

/// Sets a peer beside our strategies, its answers held against the exact ones. Returns why
/// that cannot be, in a sentence, when it has too few or too many answers; else nothing.
[[nodiscard]] std::string add_peer(const PeerAnswers& answers, PairStudy& study);

}  // namespace cdprep::study
