// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/pair_study.h"

#include <algorithm>
#include <utility>

#include "study/flush_caches.h"

namespace cdprep::study {
namespace {

bool is_stopped(const TimingOptions& options) {
    return options.stop && options.stop();
}

/// The strategies for one pair of models, and the poses at which they are queried.
struct Asking {
    std::vector<StrategyPair> pairs;
    const PoseSet& poses;

    [[nodiscard]] Placement placement(std::size_t pose) const {
        return Placement::b_moves(poses.poses[pose].a_from_b);
    }
    std::uint64_t ask(std::size_t who, Asked asked, std::size_t pose) {
        StrategyPair& pair = pairs[who];
        const Placement placed = placement(pose);
        switch (asked) {
            case Asked::collide:
                return pair.collides(placed) ? 1 : 0;
            case Asked::overlap:
                return pair.count_pairs(placed);
            case Asked::distance:
                return pair.gap(placed).upper > 0 ? 1 : 0;
            case Asked::within:
                return pair.is_within(placed, kWithinShare * poses.diagonal) ? 1 : 0;
            default:
                return pair.contacts(placed, kContactShare * poses.diagonal);
        }
    }
};

/// Compares every strategy's answers with those of the last one, which is exact.
void compare_answers(Asking& asking, const TimingOptions& timing, PairStudy& study) {
    const std::size_t count = study.poses.poses.size();
    study.exact.hits.resize(count);
    study.exact.pairs.resize(count);
    for (std::size_t pose = 0; pose < count && !is_stopped(timing); ++pose) {
        const Placement placement = asking.placement(pose);
        StrategyPair& bvh = asking.pairs.back();
        const bool hit = bvh.collides(placement);
        const std::span<const TrianglePair> listed = bvh.pairs(placement);
        const std::vector<TrianglePair> exact(listed.begin(), listed.end());
        study.exact.hits[pose] = hit;
        study.exact.pairs[pose] = exact.size();
        for (std::size_t i = 0; i < asking.pairs.size(); ++i) {
            Contender& contender = study.contenders[i];
            if (!contender.reasons[static_cast<std::size_t>(Asked::collide)].empty()) continue;
            ++contender.answers;
            if (asking.pairs[i].collides(placement) == hit) ++contender.agreeing;
            if (!contender.reasons[static_cast<std::size_t>(Asked::overlap)].empty()) continue;
            ++contender.answers;
            const std::span<const TrianglePair> found = asking.pairs[i].pairs(placement);
            if (std::ranges::equal(found, exact)) ++contender.agreeing;
            contender.found += found.size();
            contender.pairs += exact.size();
        }
    }
}

/// Returns the mean work of a query.
QueryCounts counts_of(Asking& asking, std::size_t who, Asked asked,
                      std::span<const std::size_t> cases) {
    QueryCounts sum;
    asking.pairs[who].count_into(&sum);
    for (const std::size_t pose : cases) asking.ask(who, asked, pose);
    asking.pairs[who].count_into(nullptr);
    if (cases.empty()) return sum;
    sum.box_pairs /= cases.size();
    sum.cell_pairs /= cases.size();
    sum.leaf_pairs /= cases.size();
    sum.triangle_pairs /= cases.size();
    return sum;
}

/// Times all strategies that answer this query, over those poses. Returns one Timings per strategy,
/// without cases if it cannot answer.
std::vector<Timings> time_asked(Asked asked, std::span<const std::size_t> cases, Asking& asking,
                                TimingOptions timing, const PairStudy& study,
                                const std::function<void(std::size_t)>& before) {
    std::vector<Question> questions;
    std::vector<std::size_t> who;
    for (std::size_t i = 0; i < asking.pairs.size(); ++i) {
        if (!study.contenders[i].reasons[static_cast<std::size_t>(asked)].empty()) continue;
        who.push_back(i);
        questions.push_back(question_of([&asking, cases, i, asked](std::size_t number) {
            return asking.ask(i, asked, cases[number]);
        }));
    }
    if (before) timing.before = [&](std::size_t question) { before(who[question]); };
    std::vector<Timings> taken(asking.pairs.size());
    std::vector<Timings> timings = time_questions(cases.size(), questions, timing);
    for (std::size_t q = 0; q < who.size(); ++q) taken[who[q]] = std::move(timings[q]);
    return taken;
}

/// With fewer rounds, all would too often be on one side of 1 by chance.
constexpr std::size_t kRoundsAgainstItself = 9;

constexpr std::array<Stratum, 4> kOfCollide = {Stratum::deep, Stratum::shallow, Stratum::touching,
                                               Stratum::near};
constexpr std::array<Stratum, 3> kOfOverlap = {Stratum::deep, Stratum::shallow, Stratum::touching};
constexpr std::array<Stratum, 2> kOfDistance = {Stratum::near, Stratum::far};
constexpr std::array<Stratum, 1> kOfWithin = {Stratum::near};
constexpr std::array<Stratum, 2> kOfContacts = {Stratum::shallow, Stratum::touching};

}  // namespace

std::span<const Stratum> strata_of(Asked asked) noexcept {
    switch (asked) {
        case Asked::collide:
            return kOfCollide;
        case Asked::overlap:
            return kOfOverlap;
        case Asked::distance:
            return kOfDistance;
        case Asked::within:
            return kOfWithin;
        default:
            return kOfContacts;
    }
}

std::vector<std::size_t> cases_of(Asked asked, const PoseSet& poses) {
    const std::span<const Stratum> strata = strata_of(asked);
    std::vector<std::size_t> cases;
    for (std::size_t i = 0; i < poses.poses.size(); ++i) {
        if (std::ranges::find(strata, poses.poses[i].stratum) != strata.end()) cases.push_back(i);
    }
    return cases;
}

PairStudy study_pair(const ModelForms& a, const ModelForms& b, PoseSet poses,
                     const PairStudyOptions& options) {
    const TimingOptions& timing = options.timing;
    PairStudy study;
    study.poses = std::move(poses);
    Asking asking{{}, study.poses};
    for (const Strategy& strategy : strategies()) {
        const StrategyPair& pair = asking.pairs.emplace_back(strategy, a, b);
        Contender& contender = study.contenders.emplace_back();
        contender.name = strategy.name;
        contender.setting = strategy.setting;
        contender.is_approximate = strategy.is_approximate();
        for (std::size_t asked = 0; asked < kAsked; ++asked) {
            contender.reasons[asked] = pair.find_reason(static_cast<Asked>(asked));
        }
        if (strategy.is_literal && !options.literal) contender.reasons.fill("left out by --quick");
    }
    compare_answers(asking, timing, study);
    for (std::size_t i = 0; i < asking.pairs.size(); ++i) {
        for (std::size_t asked = 0; asked < kCounted; ++asked) {
            if (!study.contenders[i].reasons[asked].empty()) continue;
            for (std::size_t s = 0; s < kStrata; ++s) {
                study.contenders[i].counts[asked][s] = counts_of(
                    asking, i, static_cast<Asked>(asked), study.poses.of(static_cast<Stratum>(s)));
            }
        }
    }
    for (std::size_t number_of_asked = 0; number_of_asked < kAsked; ++number_of_asked) {
        if (is_stopped(timing)) break;
        const auto asked = static_cast<Asked>(number_of_asked);
        const std::vector<std::size_t> cases = cases_of(asked, study.poses);
        std::vector<Timings> taken = time_asked(asked, cases, asking, timing, study, {});
        for (std::size_t i = 0; i < taken.size(); ++i) {
            study.contenders[i].timings[number_of_asked] = std::move(taken[i]);
        }
    }
    const std::vector<std::size_t> deep = study.poses.of(Stratum::deep);
    if (!deep.empty() && !is_stopped(timing)) {
        TimingOptions more = timing;
        more.rounds = kRoundsAgainstItself;
        study.itself = ratio_to_itself(deep.size(), question_of([&](std::size_t number) {
                                           return asking.ask(asking.pairs.size() - 1,
                                                             Asked::collide, deep[number]);
                                       }),
                                       more);
    }
    const auto make_cold = [&](std::size_t who) {
        const Strategy& strategy = strategies()[who];
        flush(memory_of((a.*strategy.form).image.span(), (b.*strategy.form).image.span()));
    };
    for (const Asked asked : {Asked::collide, Asked::overlap}) {
        if (is_stopped(timing)) break;
        std::vector<Timings> taken = time_asked(asked, deep, asking, timing, study, make_cold);
        for (std::size_t i = 0; i < taken.size(); ++i) {
            study.contenders[i].cold[static_cast<std::size_t>(asked)] = std::move(taken[i]);
        }
    }
    return study;
}

std::string title_of(const Contender& contender) {
    if (contender.setting.empty()) return contender.name;
    return contender.name + ", " + contender.setting;
}

}  // namespace cdprep::study
