// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/ladders.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "accuracy/bytes_read.h"
#include "cdprep/pairs.h"
#include "study/seeded_random.h"

namespace cdprep::study {
namespace {

constexpr double kStep = 1e-3;  ///< of the diagonal
constexpr double kTurn = 0.2 * 3.14159265358979323846 / 180;
constexpr std::uint64_t kMostEvicted = 128U << 20U;  ///< bytes read to empty the caches
constexpr std::uint64_t kUsualCache = 32U << 20U;

using Walk = std::vector<Pose>;

/// Returns a walk on which B's middle moves in a straight line and B turns about it.
Walk walk_from(const Climb& climb, const StudyPose& start, std::size_t frames,
               SeededRandom& random) {
    const format::Bounds& box = *climb.b.model.record().bounds;
    const Double3 middle = {0.5 * (box.lower.x + box.upper.x), 0.5 * (box.lower.y + box.upper.y),
                            0.5 * (box.lower.z + box.upper.z)};
    const Double3 at = transform_point(start.a_from_b, middle);
    const Double3 along = random.direction();
    const Double3 axis = random.direction();
    const auto& [w, x, y, z] = start.quaternion;
    Walk walk;
    for (std::size_t i = 0; i < frames; ++i) {
        const double half = 0.5 * kTurn * static_cast<double>(i);
        const double c = std::cos(half);
        const double s = std::sin(half);
        const Double3 v = {s * axis.x, s * axis.y, s * axis.z};
        const std::array<double, 4> q = {
            c * w - v.x * x - v.y * y - v.z * z, c * x + v.x * w + v.y * z - v.z * y,
            c * y - v.x * z + v.y * w + v.z * x, c * z + v.x * y - v.y * x + v.z * w};
        const Pose turn = Pose::from_quaternion(q[0], q[1], q[2], q[3], {0, 0, 0}).value();
        const Double3 off = transform_point(turn, middle);
        const double gone = kStep * climb.set.diagonal * static_cast<double>(i);
        walk.push_back(
            Pose::from_quaternion(q[0], q[1], q[2], q[3],
                                  {at.x + gone * along.x - off.x, at.y + gone * along.y - off.y,
                                   at.z + gone * along.z - off.z})
                .value());
    }
    return walk;
}

/// Returns walks that start from poses of every stratum in turn.
std::vector<Walk> all_walks(const Climb& climb) {
    const std::size_t count = climb.is_quick ? kStrata : 2 * kStrata;
    const std::size_t frames = climb.is_quick ? 8 : 20;
    SeededRandom random(climb.set.seed ^ 0x5eedU);
    std::vector<Walk> walks;
    for (std::size_t i = 0; i < count; ++i) {
        const auto poses = climb.set.of(static_cast<Stratum>(i % kStrata));
        if (i / kStrata >= poses.size()) continue;
        walks.push_back(walk_from(climb, climb.set.poses[poses[i / kStrata]], frames, random));
    }
    return walks;
}

/// Evicts everything else from the caches by accessing a large array.
class Eviction {
public:
    explicit Eviction(std::uint64_t last_cache)
        : bytes_(std::min(kMostEvicted, 2 * (last_cache > 0 ? last_cache : kUsualCache))) {}

    void empty_caches() {
        for (std::size_t i = 0; i < bytes_.size(); i += 64) ++bytes_[i];
    }

private:
    std::vector<unsigned char> bytes_;
};

enum class CacheState : std::uint8_t { cold, warm, coherent };
constexpr std::array<const char*, 3> kCacheStates = {"cold", "warm", "coherent"};
constexpr std::array<const char*, 3> kHow = {"the models are not in the processor's caches",
                                             "the same query, repeated immediately",
                                             "consecutive frames with a PairCache"};

/// The answer in a frame.
struct Said {
    double lower;
    double upper;
};

class Asker {
public:
    Asker(const Climb& climb, bool is_distance) : climb_(climb), is_distance_(is_distance) {}

    Said ask(const Pose& pose, PairCache* cache) {
        const Placement placement = Placement::b_moves(pose);
        const Model& a = climb_.a.model;
        const Model& b = climb_.b.model;
        if (!is_distance_) {
            const double hit =
                collide({a, b, placement, {}, cache}, workspace_).hit == Answer::yes ? 1 : 0;
            return {hit, hit};
        }
        const auto found = distance({a, b, placement, {}, cache}, workspace_);
        return {found->lower, found->upper};
    }

    /// Returns the mean bytes that the query of a frame reads, with or without a cache of earlier
    /// frames.
    [[nodiscard]] double bytes_read(const std::vector<Walk>& walks, bool is_coherent) {
        return mean_bytes_read(climb_.a.model, climb_.b.model, workspace_, walks.size(),
                               [&](std::size_t number) {
                                   PairCache cache;
                                   for (const Pose& pose : walks[number]) {
                                       static_cast<void>(ask(pose, is_coherent ? &cache : nullptr));
                                   }
                               }) /
               static_cast<double>(walks.front().size());
    }

private:
    const Climb& climb_;
    bool is_distance_;
    Workspace workspace_;
};

/// Runs the queries of all walks once in one way, and adds a round to `timings`.
std::vector<Said> ask_walks(Asker& asker, CacheState way, const std::vector<Walk>& walks,
                            Eviction& eviction, Timings& timings,
                            const std::function<bool()>& stop) {
    std::vector<Said> said;
    for (const Walk& walk : walks) {
        PairCache cache;
        for (std::size_t i = 0; i < walk.size(); ++i) {
            if (stop && stop()) return said;
            if (way == CacheState::cold) eviction.empty_caches();
            if (way == CacheState::warm) static_cast<void>(asker.ask(walk[i], nullptr));
            const double begun = thread_seconds();
            said.push_back(asker.ask(walk[i], way == CacheState::coherent ? &cache : nullptr));
            const double taken = thread_seconds() - begun;
            if (timings.seconds.size() < said.size()) {
                timings.seconds.emplace_back();
                timings.times.push_back(1);
            }
            timings.seconds[said.size() - 1].push_back(taken);
        }
    }
    return said;
}

/// Returns whether the intervals intersect, as two intervals of the same number must.
bool agree(const Said& one, const Said& other) {
    return one.lower <= other.upper && other.lower <= one.upper;
}

}  // namespace

Ladder climb_coherence(const Climb& climb, std::uint64_t last_cache, Broken& broken) {
    Ladder ladder;
    ladder.name = "coherence";
    ladder.question = "exact queries along motions: cold, warm and with a PairCache";
    ladder.error = "answers that differ from the warm ones";
    ladder.cases = "frame";
    climb.begins("coherence: queries");
    const std::vector<Walk> walks = all_walks(climb);
    if (walks.empty()) {
        ladder.left_out.push_back("All: there are no poses to start from.");
        return ladder;
    }
    Eviction eviction(last_cache);
    for (const bool is_distance : {false, true}) {
        Asker asker(climb, is_distance);
        std::array<Timings, kCacheStates.size()> timings;
        std::array<std::vector<Said>, kCacheStates.size()> said;
        for (std::size_t round = 0; round < climb.timing.rounds; ++round) {
            for (std::size_t w = 0; w < kCacheStates.size(); ++w) {
                said[w] = ask_walks(asker, static_cast<CacheState>(w), walks, eviction, timings[w],
                                    climb.stop);
                if (climb.must_stop()) return ladder;
            }
        }
        const std::vector<Said>& truth = said[static_cast<std::size_t>(CacheState::warm)];
        for (std::size_t w = 0; w < kCacheStates.size(); ++w) {
            Rung rung;
            rung.name = std::string(is_distance ? "distance, " : "collide, ") + kCacheStates[w];
            rung.how = kHow[w];
            rung.question = is_distance ? "how far apart" : "do they touch";
            rung.promise = Promise::exact;
            rung.touched =
                asker.bytes_read(walks, static_cast<CacheState>(w) == CacheState::coherent);
            rung.time = timing_of(timings[w]);
            for (std::size_t i = 0; i < truth.size(); ++i) {
                rung.seconds.push_back(seconds_of(timings[w], i));
            }
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < truth.size(); ++i) {
                if (agree(truth[i], said[w][i])) continue;
                if (++wrong == 1) {
                    broken.push_back("coherence, " + rung.name + ": the answer differs in frame " +
                                     std::to_string(i) + ".");
                }
            }
            const ShareInterval share = clopper_pearson(wrong, truth.size());
            rung.error = share.share();
            rung.error_low = share.low;
            rung.error_high = share.high;
            ladder.rungs.push_back(std::move(rung));
        }
    }
    return ladder;
}

}  // namespace cdprep::study
