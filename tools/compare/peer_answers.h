// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "compare/pair_study.h"

namespace cdprep::study {

/// The times and answers of another library, by case in the order of cases_of().
struct PeerAnswered {
    std::vector<std::vector<double>> seconds;  ///< by case and round
    std::vector<std::size_t> answers;          ///< 0 or 1; for overlap, the number of pairs
};

struct PeerAnswers {
    std::string key;   ///< such as "fcl"
    std::string name;  ///< with its version
    std::string note;  ///< how it was measured
    std::array<PeerAnswered, kAsked> asked{};
    std::array<std::string, kAsked> reasons{};  ///< why it was not measured
};

/// A structure that another library built over a model.
struct PeerBuild {
    std::string key;              ///< such as "fcl_swept"
    std::string name;             ///< with its version
    std::string note;             ///< what the structure is
    std::vector<double> seconds;  ///< by round
    std::size_t vertices = 0;     ///< of a hull; 0 for trees
    std::size_t facets = 0;
};

/// A library that was not measured.
struct AbsentPeer {
    std::string key;
    std::string name;
    std::string reason;
};

/// The libraries that answered for a pair or built structures over a model, and those that did not.
struct PeerRun {
    std::vector<PeerAnswers> peers;
    std::vector<PeerBuild> builds;
    std::vector<AbsentPeer> absent;
};

/// Returns the input of the peer program for a pair: one line per pose, as defined in
/// tests/bench/peers.cpp.
[[nodiscard]] std::string peer_questions(const PoseSet& poses);

/// Adds a peer to our strategies and compares its answers with the exact ones. Returns why that is
/// impossible, in a sentence, if it has too few or too many answers. Otherwise returns nothing.
[[nodiscard]] std::string add_peer(const PeerAnswers& answers, PairStudy& study);

}  // namespace cdprep::study
