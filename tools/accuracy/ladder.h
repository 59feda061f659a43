// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/pair_errors.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/pairs.h"
#include "study/memory_model.h"
#include "study/pose_set.h"
#include "study/share_interval.h"
#include "study/timing.h"

namespace cdprep::study {

/// The guarantee of a rung's answers. The study asserts it: an answer that breaks it is a bug of
/// ours.
enum class Promise : std::uint8_t {
    none,
    no_misses,      ///< models that it calls apart are apart
    no_false_hits,  ///< models that it calls a hit touch
    both_sides,     ///< yes and no are right; it may answer unknown
    exact,          ///< every answer is right
    interval,       ///< its interval contains the truth
};

/// The wrong answers in the poses of one stratum.
struct StratumErrors {
    ShareInterval misses;      ///< called apart, of the poses that touch
    ShareInterval false_hits;  ///< not called apart, of the poses that do not touch
    std::size_t unknown = 0;   ///< unknown answers; they count as hits
    double median_s = 0;       ///< time
};

/// The wrong answers by the truth of the exact rotation (level E3 in GLOSSARY.md), over the poses
/// at which it is proved. At the other poses the truth is not known.
struct RigidErrors {
    ShareInterval misses;       ///< called apart, of the poses that touch
    ShareInterval false_hits;   ///< not called apart, of the poses that do not touch
    std::size_t undecided = 0;  ///< poses at which nothing is proved
};

/// The errors of distances, over the poses that do not touch.
struct DistanceErrors {
    double median = 0;             ///< of |estimate - truth| / truth
    double worst = 0;              ///< the largest of |estimate - truth| / truth
    double worst_of_diagonal = 0;  ///< the largest of |estimate - truth| / diagonal
    ShareInterval holds;           ///< of the intervals that contain the truth
};

/// One way to answer a query, with its costs and errors. Values that were not measured are absent.
struct Rung {
    std::string name;        ///< short, unique in the ladder
    std::string how;         ///< a sentence without a period
    std::string question{};  ///< if not the ladder's; only rungs with the same one are compared
    Promise promise = Promise::none;
    Timing time;                  ///< of all poses
    std::vector<double> seconds;  ///< by case of the ladder
    std::vector<Answer> answers;  ///< by pose; empty if the query has other answers
    std::array<StratumErrors, kStrata> strata{};
    std::optional<RigidErrors> rigid;  ///< present if there are answers
    std::optional<double> error;       ///< shown in the chart; 0 for an exact rung
    double error_low = 0;              ///< 95 % confidence
    double error_high = 0;
    std::optional<double> build_s;       ///< seconds to build its structures, for both models
    std::optional<std::uint64_t> bytes;  ///< size of the arrays that it reads, of both models
    /// The mean bytes that a query reads, over the cases, counted as in bytes_read.h.
    std::optional<double> touched;
    std::vector<PairCounts> pair_counts;  ///< by pose; empty if the query finds no pairs
    std::optional<PairErrors> pairs;      ///< of pair_counts
    std::optional<DistanceErrors> distance;
    /// No point of the shape is farther from the solid (or surface) than this share of the
    /// diagonal; proved. The larger value of both models.
    std::optional<double> outer;
    /// No point of the model is farther from the shape than this share of the diagonal; 0 if the
    /// shape encloses the model.
    std::optional<double> inner;
    std::optional<double> displacement;       ///< largest of a vertex, as a share of the diagonal
    std::optional<std::uint64_t> degenerate;  ///< triangles that became degenerate
    std::optional<std::size_t> worst_pose;    ///< number of the pose with the worst answer
    std::string worst;                        ///< the error of this answer
};

/// Rungs that answer one query, from coarse to exact.
struct Ladder {
    std::string name;      ///< "geometry", "distance", ...
    std::string question;  ///< the query, a sentence without a period
    std::string error;     ///< the meaning of Rung::error
    std::string cases;     ///< the meaning of a case of Rung::seconds: "pose", "frame", ...
    std::vector<Rung> rungs;
    std::vector<std::string> left_out;  ///< sentences on absent rungs and figures
};

/// A broken promise: the sentence names the ladder, the rung and the pose.
using Broken = std::vector<std::string>;

/// The input of every ladder. The referenced objects must outlive it.
struct Climb {
    const mesh::Mesh& mesh_a;
    const mesh::Mesh& mesh_b;
    const MemoryModel& a;
    const MemoryModel& b;
    const PoseSet& set;
    TimingOptions timing;
    bool is_quick;
    ParallelFor parallel_for;
    std::function<bool()> stop;
    /// Called when a step begins.
    std::function<void(const std::string& step)> begins;

    [[nodiscard]] bool must_stop() const {
        return stop && stop();
    }
};

/// Sets the fields that follow from a rung's answers: errors by stratum, `error` and the worst
/// pose. `error` is the share of wrong answers, or of false hits if the rung promises no misses.
/// Adds a sentence to `broken` if answers break the promise.
void judge_answers(const std::string& ladder, const PoseSet& set, Rung& rung, Broken& broken);

/// Adds a sentence to `broken` if the rung's pairs break its promise. A missing pair breaks
/// `no_misses`, an extra pair breaks `no_false_hits`, and either breaks `exact`.
void judge_pairs(const std::string& ladder, const Rung& rung, Broken& broken);

/// Sets the error and its confidence band.
void keep_error(const ShareBand& error, Rung& rung);

/// Sets the times, in total and by stratum, from timings by pose.
void keep_time(const PoseSet& set, const Timings& timings, Rung& rung);

/// Returns the name of pose number `pose` in sentences: "deep 3 (pose 12)".
[[nodiscard]] std::string pose_name(const PoseSet& set, std::size_t pose);

/// Returns, for each rung, whether another one with the same query dominates it: better in time or
/// error, and not worse in the other. Rungs without an error are not dominated.
[[nodiscard]] std::vector<bool> dominated(const std::vector<Rung>& rungs);

}  // namespace cdprep::study
