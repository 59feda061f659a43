// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cdprep/advanced/query_counts.h"
#include "compare/model_forms.h"
#include "study/pose_set.h"
#include "compare/strategy.h"
#include "study/timing.h"

namespace cdprep::study {

/// The strata in which each is asked: where its answers differ, and take time.
[[nodiscard]] std::span<const Stratum> strata_of(Asked asked) noexcept;
/// The poses of those strata, in the order of the set.
[[nodiscard]] std::vector<std::size_t> cases_of(Asked asked, const PoseSet& poses);

/// Of `within`, as a share of PoseSet::diagonal.
inline constexpr double kWithinShare = 0.01;
/// Of `contacts`, likewise.
inline constexpr double kContactShare = 1e-3;

/// Those of Asked that are counted: collide and overlap.
inline constexpr std::size_t kCounted = 2;

/// One way to answer, and what came of it.
struct Contender {
    std::string name;     ///< "octree"
    std::string setting;  ///< "paper", "tuned", or empty
    bool is_approximate = false;
    bool is_peer = false;  ///< timed in a program of its own
    std::string peer{};    ///< its library's key, "fcl"; of ours empty
    /// By Asked, over cases_of(); without cases where it was not asked.
    std::array<Timings, kAsked> timings{};
    /// The same over the deep poses, with caches that hold nothing of the models; of collide and
    /// overlap alone.
    std::array<Timings, kAsked> cold{};
    std::array<std::string, kAsked> reasons{};  ///< why it was not asked
    std::size_t agreeing = 0;  ///< answers to collide and overlap equal to the exact ones
    std::size_t answers = 0;   ///< compared
    std::size_t found = 0;     ///< overlapping pairs, of all poses
    std::size_t pairs = 0;     ///< of those, there are
    /// What a collide and an overlap do in the mean, by Asked and stratum; zero where it was not
    /// asked or is not counted.
    std::array<std::array<QueryCounts, kStrata>, kCounted> counts{};
};

/// The exact answers to which all are held.
struct ExactAnswers {
    std::vector<bool> hits;          ///< by pose
    std::vector<std::size_t> pairs;  ///< overlapping, by pose
};

struct PairStudy {
    std::size_t a = 0;  ///< numbers of the meshes
    std::size_t b = 0;
    PoseSet poses;
    ExactAnswers exact;
    /// The exact strategy's collide over the deep poses against itself: what the clock can tell
    /// apart here.
    TimeRatio itself;
    std::vector<Contender> contenders;
};

struct PairStudyOptions {
    TimingOptions timing;  ///< its budget is for each question
    /// The talk's algorithm to the letter is asked too: of 871,414 triangles it takes ten times as
    /// long as all others together, or more.
    bool literal = true;
};

/// Asks every strategy at the poses.
[[nodiscard]] PairStudy study_pair(const ModelForms& a, const ModelForms& b, PoseSet poses,
                                   const PairStudyOptions& options);

/// What stands for a strategy in tables: "octree, paper".
[[nodiscard]] std::string title_of(const Contender& contender);

}  // namespace cdprep::study
