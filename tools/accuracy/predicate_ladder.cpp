// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/ladders.h"

#include <algorithm>

#include "cdprep/exact/triangles.h"
#include "cdprep/pairs.h"
#include "study/naive_contact.h"
#include "study/seeded_random.h"
#include "study/source_triangles.h"

namespace cdprep::study {
namespace {

constexpr double kNearby = 1e-4;  ///< of the diagonal
constexpr std::size_t kPairsAPose = 2000;
constexpr std::size_t kPairsACase = 64;

/// Two triangles in a pose.
struct Candidate {
    Corners a;
    Corners b;
    std::size_t pose;
    bool touch;  ///< the exact answer
};

/// Returns a sample of the hard pairs of each pose: those that are near or touch.
std::vector<Candidate> find_candidates(const Climb& climb) {
    std::vector<Candidate> candidates;
    Workspace workspace;
    SeededRandom random(climb.set.seed);
    const SourceTriangles in_a(climb.a.model);
    const SourceTriangles in_b(climb.b.model);
    for (std::size_t i = 0; i < climb.set.poses.size() && !climb.must_stop(); ++i) {
        const Pose& pose = climb.set.poses[i].a_from_b;
        std::vector<TrianglePair> pairs;
        std::size_t met = 0;
        const auto keep = [&](const TrianglePair& pair) {
            // Reservoir sampling: every pair is equally likely to be kept.
            ++met;
            if (pairs.size() < kPairsAPose) {
                pairs.push_back(pair);
            } else if (const std::size_t at = random.below(met); at < kPairsAPose) {
                pairs[at] = pair;
            }
            return true;
        };
        visit_pairs_within({climb.a.model, climb.b.model, Placement::b_moves(pose)},
                           kNearby * climb.set.diagonal, workspace, keep);
        std::ranges::sort(pairs);
        for (const TrianglePair& pair : pairs) {
            const Corners a = in_a.corners(pair.a);
            const Corners b = in_b.corners(pair.b, pose);
            const bool touch = exact::contact_without_filter(a, b) != TriangleContact::disjoint;
            candidates.push_back({a, b, i, touch});
        }
    }
    return candidates;
}

struct PredicateContender {
    Rung rung;
    std::function<bool(const Candidate&)> ask;
};

template <class Number>
std::function<bool(const Candidate&)> naive(Number tolerance) {
    using Naive = NaiveContact<Number>;
    return [test = Naive(tolerance)](const Candidate& pair) {
        return test.touch(Naive::rounded(pair.a), Naive::rounded(pair.b));
    };
}

std::vector<PredicateContender> all_contenders(bool has_float) {
    std::vector<PredicateContender> contenders;
    const auto add = [&](const char* name, const char* how, Promise promise,
                         std::function<bool(const Candidate&)> ask) {
        PredicateContender contender;
        contender.rung.name = name;
        contender.rung.how = how;
        contender.rung.promise = promise;
        contender.rung.touched = 2 * sizeof(Corners);
        contender.ask = std::move(ask);
        contenders.push_back(std::move(contender));
    };
    if (has_float) {
        add("float, 1e-6", "signs in float; magnitudes below 1e-6 count as 0", Promise::none,
            naive<float>(1e-6F));
        add("float", "signs in float, without a threshold", Promise::none, naive<float>(0));
    }
    add("double, 1e-12", "signs in double; magnitudes below 1e-12 count as 0", Promise::none,
        naive<double>(1e-12));
    add("double", "signs in double, without a threshold", Promise::none, naive<double>(0));
    add("filter, then exact", "signs in double if certain, else integers", Promise::exact,
        [](const Candidate& pair) { return exact::triangles_touch(pair.a, pair.b); });
    add("always exact", "integers or expansions for every pair", Promise::exact,
        [](const Candidate& pair) {
            return exact::contact_without_filter(pair.a, pair.b) != TriangleContact::disjoint;
        });
    return contenders;
}

/// The counts of right answers by pose: `wanted` and `found` count all answers, `both` the right
/// ones.
using RightAnswers = std::vector<PairCounts>;

/// Sets the share of wrong answers. Its band covers two intervals. One is a bootstrap over poses,
/// since pairs of one pose are correlated. The other is by Clopper and Pearson, which is not too
/// narrow if no answer is wrong.
void keep_wrong_share(const RightAnswers& right, Rung& rung) {
    const PairErrors drawn = pair_errors(right);
    const std::size_t wrong = drawn.all.wanted - drawn.all.both;
    const ShareInterval share = clopper_pearson(wrong, drawn.all.wanted);
    keep_error({share.share(), std::min(share.low, 1 - drawn.recall.high),
                std::max(share.high, 1 - drawn.recall.low)},
               rung);
}

void judge(const Climb& climb, const std::vector<Candidate>& pairs, PredicateContender& contender,
           Broken& broken) {
    Rung& rung = contender.rung;
    rung.pair_counts.resize(climb.set.poses.size());
    RightAnswers right(climb.set.poses.size());
    for (const Candidate& pair : pairs) {
        const bool found = contender.ask(pair);
        PairCounts& counts = rung.pair_counts[pair.pose];
        if (pair.touch) ++counts.wanted;
        if (found) ++counts.found;
        if (found && pair.touch) ++counts.both;
        ++right[pair.pose].wanted;
        ++right[pair.pose].found;
        if (found == pair.touch) ++right[pair.pose].both;
    }
    rung.pairs = pair_errors(rung.pair_counts);
    keep_wrong_share(right, rung);
    const auto wrong = [](const PairCounts& counts) { return counts.wanted - counts.both; };
    const auto worst = std::ranges::max_element(right, {}, wrong);
    if (worst == right.end() || wrong(*worst) == 0) return;
    rung.worst_pose = static_cast<std::size_t>(worst - right.begin());
    rung.worst = std::to_string(wrong(*worst)) + " pairs wrong";
    if (rung.promise == Promise::exact) {
        broken.push_back("predicates, " + rung.name + ": wrong for a pair at " +
                         pose_name(climb.set, *rung.worst_pose) + ".");
    }
}

}  // namespace

Ladder climb_predicates(const Climb& climb, Broken& broken) {
    Ladder ladder;
    ladder.name = "predicates";
    ladder.question = "do two triangles touch, for pairs at most 1e-4 diagonals apart";
    ladder.error = "wrong answers, as a share of the pairs";
    ladder.cases = "64 pairs of triangles; seconds per pair";
    climb.begins("predicates: queries");
    const std::vector<Candidate> pairs = find_candidates(climb);
    const std::size_t cases = std::min<std::size_t>(400, pairs.size() / kPairsACase);
    if (cases == 0) {
        ladder.left_out.push_back("All: too few pairs of triangles come near each other.");
        return ladder;
    }
    const bool has_float = fits_float(climb.mesh_a) && fits_float(climb.mesh_b);
    if (!has_float)
        ladder.left_out.emplace_back("float: coordinates are outside the range of float.");
    std::vector<PredicateContender> contenders = all_contenders(has_float);
    std::vector<Question> questions;
    // The cases are spread over all poses.
    const std::size_t stride = pairs.size() / kPairsACase / cases * kPairsACase;
    for (PredicateContender& contender : contenders) {
        judge(climb, pairs, contender, broken);
        questions.push_back(question_of([&contender, &pairs, stride](std::size_t number) {
            std::uint64_t hits = 0;
            for (std::size_t i = 0; i < kPairsACase; ++i) {
                hits += contender.ask(pairs[number * stride + i]) ? 1 : 0;
            }
            return hits;
        }));
    }
    std::vector<Timings> timings = time_questions(cases, questions, climb.timing);
    if (climb.must_stop()) return ladder;
    for (std::size_t q = 0; q < contenders.size(); ++q) {
        for (auto& rounds : timings[q].seconds) {
            for (double& seconds : rounds) seconds /= kPairsACase;
        }
        contenders[q].rung.time = timing_of(timings[q]);
        for (std::size_t i = 0; i < cases; ++i) {
            contenders[q].rung.seconds.push_back(seconds_of(timings[q], i));
        }
        ladder.rungs.push_back(std::move(contenders[q].rung));
    }
    return ladder;
}

}  // namespace cdprep::study
