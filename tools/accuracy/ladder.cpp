// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/ladder.h"

#include <algorithm>

namespace cdprep::study {
namespace {

/// The poses in which a rung's answer is wrong.
struct Wrong {
    std::vector<std::size_t> misses;
    std::vector<std::size_t> false_hits;     ///< not called apart; unknown breaks no promise
    std::vector<std::size_t> false_promise;  ///< called a hit, but not even the solids touch
};

bool is_miss(const StudyPose& pose, Answer answer) {
    return pose.hit && answer == Answer::no;
}

bool is_false_hit(const StudyPose& pose, Answer answer) {
    return !pose.hit && answer != Answer::no;
}

/// Returns whether a hit is false even for solids. A rung may answer for solids: a model inside the
/// other is then a hit, although the surfaces do not touch.
bool is_false_yes(const StudyPose& pose, Answer answer) {
    return !pose.hit && answer == Answer::yes && pose.solid == Answer::no;
}

Wrong find_wrong(const PoseSet& set, const Rung& rung) {
    Wrong wrong;
    for (std::size_t i = 0; i < set.poses.size(); ++i) {
        const StudyPose& pose = set.poses[i];
        if (is_miss(pose, rung.answers[i])) wrong.misses.push_back(i);
        if (is_false_hit(pose, rung.answers[i])) wrong.false_hits.push_back(i);
        if (is_false_yes(pose, rung.answers[i])) wrong.false_promise.push_back(i);
    }
    return wrong;
}

/// The wrong answers in some of the poses.
struct WrongFlags {
    ShareInterval misses;
    ShareInterval false_hits;
};

WrongFlags wrong_flags(const PoseSet& set, const Rung& rung,
                       const std::vector<std::size_t>& poses) {
    std::size_t hits = 0;
    std::size_t misses = 0;
    std::size_t false_hits = 0;
    for (const std::size_t i : poses) {
        const StudyPose& pose = set.poses[i];
        if (pose.hit) ++hits;
        if (is_miss(pose, rung.answers[i])) ++misses;
        if (is_false_hit(pose, rung.answers[i])) ++false_hits;
    }
    return {clopper_pearson(misses, hits), clopper_pearson(false_hits, poses.size() - hits)};
}

StratumErrors errors_in(const PoseSet& set, const Rung& rung, Stratum stratum) {
    const std::vector<std::size_t> poses = set.of(stratum);
    const WrongFlags wrong = wrong_flags(set, rung, poses);
    const auto unknown = std::ranges::count_if(
        poses, [&](std::size_t i) { return rung.answers[i] == Answer::unknown; });
    return {wrong.misses, wrong.false_hits, static_cast<std::size_t>(unknown), 0};
}

RigidErrors rigid_errors(const PoseSet& set, const Rung& rung) {
    std::vector<std::size_t> proved;
    for (std::size_t i = 0; i < set.poses.size(); ++i) {
        if (set.poses[i].is_rigid) proved.push_back(i);
    }
    const WrongFlags wrong = wrong_flags(set, rung, proved);
    return {wrong.misses, wrong.false_hits, set.poses.size() - proved.size()};
}

/// Sets the worst pose: the deepest miss or, without misses, the false hit that is farthest apart.
void find_worst(const PoseSet& set, const Wrong& wrong, Rung& rung) {
    const auto depth = [&](std::size_t i) { return set.poses[i].depth; };
    const auto gap = [&](std::size_t i) { return set.poses[i].gap_upper; };
    if (!wrong.misses.empty()) {
        rung.worst_pose = *std::ranges::max_element(wrong.misses, {}, depth);
        rung.worst = "answers no";
    } else if (!wrong.false_hits.empty()) {
        rung.worst_pose = *std::ranges::max_element(wrong.false_hits, {}, gap);
        rung.worst =
            rung.answers[*rung.worst_pose] == Answer::unknown ? "answers unknown" : "answers yes";
    }
}

void assert_none(const std::string& ladder, const PoseSet& set, const Rung& rung,
                 const std::vector<std::size_t>& poses, const char* what, Broken& broken) {
    if (poses.empty()) return;
    broken.push_back(ladder + ", " + rung.name + ": breaks its promise: it " + what + " " +
                     pose_name(set, poses.front()) + " and " + std::to_string(poses.size() - 1) +
                     " more.");
}

}  // namespace

std::string pose_name(const PoseSet& set, std::size_t pose) {
    return std::string(kStratumNames[static_cast<std::size_t>(set.poses[pose].stratum)]) +
           " pose " + std::to_string(pose);
}

void judge_answers(const std::string& ladder, const PoseSet& set, Rung& rung, Broken& broken) {
    for (std::size_t s = 0; s < kStrata; ++s) {
        const double median = rung.strata[s].median_s;
        rung.strata[s] = errors_in(set, rung, static_cast<Stratum>(s));
        rung.strata[s].median_s = median;
    }
    rung.rigid = rigid_errors(set, rung);
    const Wrong wrong = find_wrong(set, rung);
    find_worst(set, wrong, rung);
    std::size_t apart = 0;
    for (const StudyPose& pose : set.poses) apart += pose.hit ? 0 : 1;
    const bool counts_false_hits =
        rung.promise == Promise::no_misses || rung.promise == Promise::both_sides;
    const ShareInterval share =
        counts_false_hits
            ? clopper_pearson(wrong.false_hits.size(), apart)
            : clopper_pearson(wrong.misses.size() + wrong.false_hits.size(), set.poses.size());
    rung.error = share.share();
    rung.error_low = share.low;
    rung.error_high = share.high;

    const Promise promise = rung.promise;
    const bool is_exact = promise == Promise::exact;
    const bool is_both = promise == Promise::both_sides;
    if (is_exact || is_both || promise == Promise::no_misses) {
        assert_none(ladder, set, rung, wrong.misses, "misses", broken);
    }
    if (is_exact) assert_none(ladder, set, rung, wrong.false_hits, "reports a hit at", broken);
    if (is_both || promise == Promise::no_false_hits) {
        assert_none(ladder, set, rung, wrong.false_promise, "reports a hit at", broken);
    }
}

void judge_pairs(const std::string& ladder, const Rung& rung, Broken& broken) {
    if (!rung.pairs) return;
    const PairCounts& all = rung.pairs->all;
    const bool is_exact = rung.promise == Promise::exact;
    const auto tell = [&](std::size_t pairs, const char* what) {
        broken.push_back(ladder + ", " + rung.name + ": " + std::to_string(pairs) +
                         " pairs of triangles " + what + ", which breaks its promise.");
    };
    if ((is_exact || rung.promise == Promise::no_misses) && all.both < all.wanted) {
        tell(all.wanted - all.both, "are missing");
    }
    if ((is_exact || rung.promise == Promise::no_false_hits) && all.both < all.found) {
        tell(all.found - all.both, "are wrong");
    }
}

void keep_error(const ShareBand& error, Rung& rung) {
    rung.error = error.share;
    rung.error_low = error.low;
    rung.error_high = error.high;
}

void keep_time(const PoseSet& set, const Timings& timings, Rung& rung) {
    rung.time = timing_of(timings);
    rung.seconds.clear();
    for (std::size_t i = 0; i < timings.seconds.size(); ++i) {
        rung.seconds.push_back(seconds_of(timings, i));
    }
    for (std::size_t s = 0; s < kStrata; ++s) {
        rung.strata[s].median_s = timing_of(timings, set.of(static_cast<Stratum>(s))).median_s;
    }
}

std::vector<bool> dominated(const std::vector<Rung>& rungs) {
    std::vector<bool> beaten(rungs.size());
    for (std::size_t i = 0; i < rungs.size(); ++i) {
        for (const Rung& other : rungs) {
            if (!rungs[i].error || !other.error || rungs[i].question != other.question) continue;
            const bool no_worse =
                *other.error <= *rungs[i].error && other.time.median_s <= rungs[i].time.median_s;
            const bool better =
                *other.error < *rungs[i].error || other.time.median_s < rungs[i].time.median_s;
            if (no_worse && better) beaten[i] = true;
        }
    }
    return beaten;
}

}  // namespace cdprep::study
