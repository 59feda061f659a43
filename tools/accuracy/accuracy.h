// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cdprep/result.h"
#include "accuracy/ladder.h"
#include "study/machine.h"

namespace cdprep::study {

struct AccuracyOptions {
    bool is_quick = false;  ///< seconds instead of a minute or two: fewer poses, rounds and rungs
    std::uint64_t seed = 1;
    /// Names of ladders; empty: all of kLadderNames.
    std::vector<std::string> ladders{};
    ParallelFor parallel_for = serial_for;
    std::function<bool()> stop{};  ///< true ends all soon, with what there is
    /// Told now and then what is being done, and which share of all is done.
    std::function<void(double share, const std::string& step)> progress{};
};

inline constexpr std::array<const char*, 5> kLadderNames = {"geometry", "distance", "predicates",
                                                            "storage", "coherence"};

/// One of the two models, as it was studied.
struct StudiedModel {
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    double diagonal = 0;  ///< of its box, model units
    bool is_closed = false;
    bool single_precision = false;
};

/// What accuracy costs in time, for one pair of models.
struct AccuracyStudy {
    Machine machine;
    StudiedModel a;
    StudiedModel b;
    bool is_quick = false;
    TimingOptions timing;  ///< that every ladder was climbed with
    PoseSet set;
    std::size_t rigid = 0;  ///< poses whose answer is proved at level E3 too
    TimeRatio self;         ///< the exact question against itself
    std::vector<Ladder> ladders;
    Broken broken;       ///< promises that did not hold: bugs of ours
    double seconds = 0;  ///< of the clock, in all
};

/// Studies two welded meshes. Fails with bad_argument where one has no triangles, where both
/// have no extent, or where no poses are found; with over_budget where a hull would leave the
/// range of double; with interrupted when `stop` said so.
[[nodiscard]] Result<AccuracyStudy> study_accuracy(const mesh::Mesh& a, const mesh::Mesh& b,
                                                   const AccuracyOptions& options = {});

}  // namespace cdprep::study
