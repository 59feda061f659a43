// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cdprep/advanced/query_counts.h"
#include "compare/model_forms.h"
#include "compare/strategy.h"
#include "study/pose_set.h"
#include "study/timing.h"

namespace cdprep::study {

/// Returns the strata in which a query is measured: those where its answers differ and take time.
[[nodiscard]] std::span<const Stratum> strata_of(Asked asked) noexcept;
/// Returns the poses of those strata, in the order of the set.
[[nodiscard]] std::vector<std::size_t> cases_of(Asked asked, const PoseSet& poses);

/// The tolerance of `within`, as a share of PoseSet::diagonal.
inline constexpr double kWithinShare = 0.01;
/// The tolerance of `contacts`, as a share of PoseSet::diagonal.
inline constexpr double kContactShare = 1e-3;

/// The number of queries whose work is counted: collide and overlap.
inline constexpr std::size_t kCounted = 2;

/// One way to answer queries, with its results.
struct Contender {
    std::string name;     ///< such as "octree"
    std::string setting;  ///< "paper", "tuned", or empty
    bool is_approximate = false;
    bool is_peer = false;  ///< timed in a program of its own
    std::string peer{};    ///< its library's key, such as "fcl"; empty for ours
    /// By Asked, over cases_of(). Has no cases if the query was not measured.
    std::array<Timings, kAsked> timings{};
    /// The same over the deep poses, with caches that hold nothing of the models. Only for collide
    /// and overlap.
    std::array<Timings, kAsked> cold{};
    std::array<std::string, kAsked> reasons{};  ///< why it was not measured
    std::size_t agreeing = 0;  ///< answers to collide and overlap equal to the exact ones
    std::size_t answers = 0;   ///< number compared
    std::size_t found = 0;     ///< overlapping pairs found over all poses
    std::size_t pairs = 0;     ///< the true number of them
    /// The mean work of a collide and an overlap, by Asked and stratum. Zero if not measured or not
    /// counted.
    std::array<std::array<QueryCounts, kStrata>, kCounted> counts{};
};

/// The exact answers against which all others are compared.
struct ExactAnswers {
    std::vector<bool> hits;          ///< by pose
    std::vector<std::size_t> pairs;  ///< overlapping, by pose
};

struct PairStudy {
    std::size_t a = 0;  ///< indices of the meshes
    std::size_t b = 0;
    PoseSet poses;
    ExactAnswers exact;
    /// The exact strategy's collide over the deep poses, compared with itself: the difference that
    /// the clock can resolve here.
    TimeRatio itself;
    std::vector<Contender> contenders;
};

struct PairStudyOptions {
    TimingOptions timing;  ///< its budget is for each query
    /// Includes the literal search of Ponce Atencio's talk. For 871,414 triangles it takes at least
    /// ten times as long as all others together.
    bool literal = true;
};

/// Measures every strategy at the poses.
[[nodiscard]] PairStudy study_pair(const ModelForms& a, const ModelForms& b, PoseSet poses,
                                   const PairStudyOptions& options);

/// Returns the name of a strategy in tables, such as "octree, paper".
[[nodiscard]] std::string title_of(const Contender& contender);

}  // namespace cdprep::study
