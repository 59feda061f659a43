// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "compare/pair_study.h"

namespace cdprep::study {

/// What another library took and said; by case, as cases_of() has them.
struct PeerAnswered {
    std::vector<std::vector<double>> seconds;  ///< by case and round
    std::vector<std::size_t> answers;          ///< 0 or 1; of overlap, the number of pairs
};

struct PeerAnswers {
    std::string key;   ///< "fcl"
    std::string name;  ///< with its version
    std::string note;  ///< of how it was asked
    std::array<PeerAnswered, kAsked> asked{};
    std::array<std::string, kAsked> reasons{};  ///< why it was not asked
};

/// A structure that another library built over a model.
struct PeerBuild {
    std::string key;              ///< "fcl_swept"
    std::string name;             ///< with its version
    std::string note;             ///< of what it is
    std::vector<double> seconds;  ///< by round
    std::size_t vertices = 0;     ///< of a hull; 0 of trees
    std::size_t facets = 0;
};

/// A library that was not asked.
struct AbsentPeer {
    std::string key;
    std::string name;
    std::string reason;
};

/// All who answered about a pair, or built their structures over a model, and who did not.
struct PeerRun {
    std::vector<PeerAnswers> peers;
    std::vector<PeerBuild> builds;
    std::vector<AbsentPeer> absent;
};

/// What the program of peers is asked about a pair: a line a pose, as tests/bench/peers.cpp says.
[[nodiscard]] std::string peer_questions(const PoseSet& poses);

/// Sets a peer beside our strategies, its answers held against the exact ones. Returns why
/// that cannot be, in a sentence, when it has too few or too many answers; else nothing.
[[nodiscard]] std::string add_peer(const PeerAnswers& answers, PairStudy& study);

}  // namespace cdprep::study
