// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "accuracy/ladder.h"
#include "cdprep/result.h"
#include "study/machine.h"

namespace cdprep::study {

struct AccuracyOptions {
    bool is_quick = false;  ///< seconds instead of a minute or two: fewer poses, rounds and rungs
    std::uint64_t seed = 1;
    /// Names of ladders; empty: all of kLadderNames.
    std::vector<std::string> ladders{};
    ParallelFor parallel_for = serial_for;
    std::function<bool()> stop{};  ///< true ends the study soon
    /// Called now and then with the current step and the completed share of the work.
    std::function<void(double share, const std::string& step)> progress{};
};

inline constexpr std::array<const char*, 5> kLadderNames = {"geometry", "distance", "predicates",
                                                            "storage", "coherence"};

/// The facts about one of the two models, as it was studied.
struct StudiedModel {
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    double diagonal = 0;  ///< of its box, model units
    bool is_balanced = false;
    bool single_precision = false;
};

/// The time and the errors of all ways to answer, for one pair of models.
struct AccuracyStudy {
    Machine machine;
    StudiedModel a;
    StudiedModel b;
    bool is_quick = false;
    TimingOptions timing;  ///< the options of all ladders
    PoseSet set;
    std::size_t rigid = 0;  ///< poses whose answer is proved at level E3 too
    TimeRatio self;         ///< the exact query against itself
    std::vector<Ladder> ladders;
    Broken broken;       ///< promises that did not hold: bugs of ours
    double seconds = 0;  ///< total wall-clock time
};

/// Studies two welded meshes. Fails with bad_argument if one has no triangles, if both have no
/// extent, or if no poses are found, as for coordinates near 2^1000. Fails with over_budget if a
/// hull would leave the range of double, and with interrupted if `stop` returned true.
[[nodiscard]] Result<AccuracyStudy> study_accuracy(const mesh::Mesh& a, const mesh::Mesh& b,
                                                   const AccuracyOptions& options = {});

}  // namespace cdprep::study
