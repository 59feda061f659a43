// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/ladders.h"

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>

#include "accuracy/bytes_read.h"
#include "cdprep/advanced/convex_distance.h"
#include "cdprep/hulls.h"
#include "cdprep/pairs.h"

namespace cdprep::study {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Interval {
    double lower;
    double upper;
};

struct DistanceContender {
    Rung rung;
    std::function<Interval(std::size_t pose)> ask;
    bool is_bound = false;  ///< `lower` is the estimate, else `upper`
};

std::string number(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

/// Returns |estimate - truth| divided by the truth, for a pose in which the models do not touch.
double error_of(const StudyPose& truth, const Interval& found, bool is_bound) {
    const double estimate = is_bound ? found.lower : found.upper;
    return std::max(0.0, is_bound ? truth.gap_lower - estimate : estimate - truth.gap_upper) /
           truth.gap_upper;
}

/// Returns whether the intervals intersect: both must contain the truth.
bool holds(const StudyPose& truth, const Interval& found) {
    return found.lower <= truth.gap_upper && truth.gap_lower <= found.upper;
}

void judge(const Climb& climb, const std::vector<std::size_t>& poses, DistanceContender& contender,
           Broken& broken) {
    Rung& rung = contender.rung;
    std::vector<double> errors;
    DistanceErrors found;
    std::size_t held = 0;
    for (const std::size_t i : poses) {
        const StudyPose& truth = climb.set.poses[i];
        const Interval answer = contender.ask(i);
        const double error = error_of(truth, answer, contender.is_bound);
        if (errors.empty() || error > found.worst) {
            rung.worst_pose = i;
            rung.worst = "off by " + number(100 * error) + " % of the distance";
        }
        found.worst = std::max(found.worst, error);
        found.worst_of_diagonal =
            std::max(found.worst_of_diagonal, error * truth.gap_upper / climb.set.diagonal);
        errors.push_back(error);
        if (holds(truth, answer)) {
            ++held;
        } else {
            broken.push_back("distance, " + rung.name +
                             ": the interval does not contain the exact distance at " +
                             pose_name(climb.set, i) + ".");
        }
    }
    found.median = quantile(errors, 0.5);
    found.holds = clopper_pearson(held, poses.size());
    rung.distance = found;
    rung.error = found.worst;
    rung.error_low = quantile(errors, 0.5);
    rung.error_high = found.worst;
}

class DistanceContenders {
public:
    explicit DistanceContenders(const Climb& climb) : climb_(climb) {}

    [[nodiscard]] std::vector<DistanceContender>& all() {
        return contenders_;
    }

    void add_hull() {
        if (!climb_.a.model.serves(Ask::hulls) || !climb_.b.model.serves(Ask::hulls)) return;
        const auto number_a = find_hull(climb_.a.model, format::HullScope::whole);
        const auto number_b = find_hull(climb_.b.model, format::HullScope::whole);
        if (!number_a || !number_b) return;
        hull_a_ = convex_points(climb_.a.model, *number_a);
        hull_b_ = convex_points(climb_.b.model, *number_b);
        add("hull", "the distance of the hulls, a lower bound", [this](std::size_t i) {
            const auto found = convex_distance(hull_a_, hull_b_, placement(i));
            return Interval{found->lower, kInfinite};
        });
        contenders_.back().is_bound = true;
    }

    void add_errors() {
        constexpr std::array<double, 6> kRelative = {1, 0.1, 1e-2, 1e-3, 1e-6, 0};
        constexpr std::array<double, 4> kAbsolute = {0.1, 1e-2, 1e-3, 1e-6};
        for (const double share : kAbsolute) {
            DistanceOptions options;
            options.absolute_error = share * climb_.set.diagonal;
            add("within " + number(share) + " diagonals",
                "the upper bound exceeds the lower by at most this length", ask(options));
        }
        for (const double share : kRelative) {
            DistanceOptions options;
            options.relative_error = share;
            add(share > 0 ? "within " + number(100 * share) + " %" : "exact",
                share > 0 ? "the upper bound exceeds the lower by at most this share"
                          : "the tightest bounds in double",
                ask(options));
        }
    }

    [[nodiscard]] double bytes_read(const DistanceContender& contender,
                                    const std::vector<std::size_t>& poses) {
        return mean_bytes_read(climb_.a.model, climb_.b.model, workspace_, poses.size(),
                               [&](std::size_t k) { contender.ask(poses[k]); });
    }

private:
    [[nodiscard]] Placement placement(std::size_t pose) const {
        return Placement::b_moves(climb_.set.poses[pose].a_from_b);
    }

    std::function<Interval(std::size_t)> ask(const DistanceOptions& options) {
        return [this, options](std::size_t i) {
            const auto found =
                distance({climb_.a.model, climb_.b.model, placement(i)}, workspace_, options);
            return Interval{found->lower, found->upper};
        };
    }

    void add(const std::string& name, const std::string& how,
             std::function<Interval(std::size_t)> ask) {
        DistanceContender contender;
        contender.rung.name = name;
        contender.rung.how = how;
        contender.rung.promise = Promise::interval;
        contender.ask = std::move(ask);
        contenders_.push_back(std::move(contender));
    }

    const Climb& climb_;
    Workspace workspace_;
    ConvexPoints hull_a_;
    ConvexPoints hull_b_;
    std::vector<DistanceContender> contenders_;
};

/// Sets the rung's times, in total and by stratum. The timings are indexed as `poses`.
void keep_time_of(const Climb& climb, const std::vector<std::size_t>& poses, const Timings& timings,
                  Rung& rung) {
    rung.time = timing_of(timings);
    std::array<std::vector<std::size_t>, kStrata> by_stratum;
    for (std::size_t k = 0; k < poses.size(); ++k) {
        rung.seconds.push_back(seconds_of(timings, k));
        by_stratum[static_cast<std::size_t>(climb.set.poses[poses[k]].stratum)].push_back(k);
    }
    for (std::size_t s = 0; s < kStrata; ++s) {
        rung.strata[s].median_s = timing_of(timings, by_stratum[s]).median_s;
    }
}

}  // namespace

Ladder climb_distance(const Climb& climb, Broken& broken) {
    Ladder ladder;
    ladder.name = "distance";
    ladder.question = "how far apart are the surfaces, at poses where they do not touch";
    ladder.error = "greatest error, as a share of the distance";
    ladder.cases = "pose that does not touch";
    ladder.left_out.emplace_back(
        "Bytes read by the hull's rung are missing: the vertices that its search visits are not "
        "counted.");
    climb.begins("distance: queries");
    DistanceContenders contenders(climb);
    contenders.add_hull();
    contenders.add_errors();
    std::vector<std::size_t> poses;
    for (std::size_t i = 0; i < climb.set.poses.size(); ++i) {
        if (!climb.set.poses[i].hit) poses.push_back(i);
    }
    std::vector<Question> questions;
    for (DistanceContender& contender : contenders.all()) {
        judge(climb, poses, contender, broken);
        if (!contender.is_bound) contender.rung.touched = contenders.bytes_read(contender, poses);
        questions.push_back(question_of([&contender, &poses](std::size_t k) {
            return contender.ask(poses[k]).lower > 0 ? 1 : 0;
        }));
    }
    const std::vector<Timings> timings = time_questions(poses.size(), questions, climb.timing);
    if (climb.must_stop()) return ladder;
    std::size_t number = 0;
    for (DistanceContender& contender : contenders.all()) {
        keep_time_of(climb, poses, timings[number++], contender.rung);
        ladder.rungs.push_back(std::move(contender.rung));
    }
    return ladder;
}

}  // namespace cdprep::study
