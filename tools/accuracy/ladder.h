// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/pairs.h"
#include "study/memory_model.h"
#include "accuracy/pair_errors.h"
#include "study/pose_set.h"
#include "study/share_interval.h"
#include "study/timing.h"

namespace cdprep::study {

/// What a rung's answers may be relied on for. A study asserts it: one answer against it is a
/// bug of ours.
enum class Promise : std::uint8_t {
    none,
    no_misses,      ///< what it calls apart is apart
    no_false_hits,  ///< what it calls a hit is one
    both_sides,     ///< yes and no are right; it may say unknown
    exact,          ///< every answer is right
    interval,       ///< the interval that it gives holds the truth
};

/// Answers that were wrong in the poses of one stratum.
struct StratumErrors {
    ShareInterval misses;      ///< called apart, of the poses that touch
    ShareInterval false_hits;  ///< not called apart, of the poses that do not touch
    std::size_t unknown = 0;   ///< answers; they count as hits
    double median_s = 0;       ///< time
};

/// The same flags against the truth of the exact rotation (level E3), over the poses at which
/// it is proved. At the others it may be either.
struct RigidErrors {
    ShareInterval misses;       ///< called apart, of the poses that touch
    ShareInterval false_hits;   ///< not called apart, of the poses that do not touch
    std::size_t undecided = 0;  ///< poses at which nothing is proved
};

/// Distances against the exact ones, over the poses that do not touch.
struct DistanceErrors {
    double median = 0;             ///< of |estimate - truth| by the truth
    double worst = 0;              ///< the same, the greatest
    double worst_of_diagonal = 0;  ///< the greatest by the diagonal
    ShareInterval holds;           ///< the interval holds the truth
};

/// One way to answer, and what it costs and errs. What was not measured is absent.
struct Rung {
    std::string name;        ///< short, of its own in the ladder
    std::string how;         ///< a sentence without a period
    std::string question{};  ///< where it is not the ladder's; others are not compared with it
    Promise promise = Promise::none;
    Timing time;                  ///< of all poses
    std::vector<double> seconds;  ///< by case of the ladder
    std::vector<Answer> answers;  ///< by pose; empty where the question is another
    std::array<StratumErrors, kStrata> strata{};
    std::optional<RigidErrors> rigid;  ///< where there are answers
    std::optional<double> error;       ///< what the chart shows, 0 of an exact rung
    double error_low = 0;              ///< 95 % confidence
    double error_high = 0;
    std::optional<double> build_s;       ///< both models; what its structures took
    std::optional<std::uint64_t> bytes;  ///< both models; of what it reads of
    /// Bytes that a question reads, on average over the cases, counted as in bytes_read.h.
    std::optional<double> touched;
    std::vector<PairCounts> pair_counts;  ///< by pose; empty where no pairs are asked for
    std::optional<PairErrors> pairs;      ///< of these
    std::optional<DistanceErrors> distance;
    /// No point of the shape is farther from the solid (or surface) than this, by the
    /// diagonal; proved. The greater of both models.
    std::optional<double> outer;
    /// No point of the model is farther from the shape than this, by the diagonal; 0 where the
    /// shape encloses.
    std::optional<double> inner;
    std::optional<double> displacement;       ///< of a vertex at most, by the diagonal
    std::optional<std::uint64_t> degenerate;  ///< triangles that became so
    std::optional<std::size_t> worst_pose;    ///< number of the pose with the worst answer
    std::string worst;                        ///< what was wrong there
};

/// Rungs that answer one question, from coarse to exact.
struct Ladder {
    std::string name;      ///< "geometry", "distance", ...
    std::string question;  ///< what is asked, a sentence without a period
    std::string error;     ///< what Rung::error is
    std::string cases;     ///< what Rung::seconds are of: "pose", "frame", ...
    std::vector<Rung> rungs;
    std::vector<std::string> left_out;  ///< sentences: rungs and figures that are not there
};

/// A broken promise: the sentence names the ladder, the rung and the pose.
using Broken = std::vector<std::string>;

/// What every ladder is climbed with. All outlive it.
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
    /// A step begins.
    std::function<void(const std::string& step)> begins;

    [[nodiscard]] bool must_stop() const {
        return stop && stop();
    }
};

/// Fills in what follows from a rung's answers: errors by stratum, the share of wrong flags as
/// `error` (false hits where the rung promises no misses), and the worst pose. Adds what breaks
/// the promise.
void judge_answers(const std::string& ladder, const PoseSet& set, Rung& rung, Broken& broken);

/// Adds it when the rung's set of pairs breaks its promise: lacks a wanted pair where it promises
/// no misses, has one too many where it promises no false hits, either where it is exact.
void judge_pairs(const std::string& ladder, const Rung& rung, Broken& broken);

/// Fills in the error with its band.
void keep_error(const ShareBand& error, Rung& rung);

/// Fills in time, in all and by stratum, of timings by pose.
void keep_time(const PoseSet& set, const Timings& timings, Rung& rung);

/// "deep 3 (pose 12)": how pose number `pose` is called in sentences.
[[nodiscard]] std::string pose_name(const PoseSet& set, std::size_t pose);

/// Which rungs another one with the same question beats in time and in error, or in one and ties
/// in the other; those without an error are none.
[[nodiscard]] std::vector<bool> dominated(const std::vector<Rung>& rungs);

}  // namespace cdprep::study
