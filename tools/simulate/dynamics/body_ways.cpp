// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/dynamics/body_ways.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "cdprep/time_of_impact.h"
#include "mesh/vectors.h"

namespace cdprep::dynamics {
namespace {

/// Times as near as this to the end of a motion count as its end.
constexpr double kSameTime = 1e-9;

double length_of(const Double3& p) {
    return std::sqrt(mesh::dot(p, p));
}

bool is_at_rest(const Motion& motion) {
    return motion.parts().angle == 0 && motion.parts().shift == Double3{};
}

/// Returns how far a point that the motion takes along may go.
double way_of(const Motion& motion, const Double3& start) {
    const Motion::Parts& parts = motion.parts();
    return length_of(parts.shift) +
           parts.angle * mesh::euclidean_distance(parts.start_of_centre, start);
}

}  // namespace

BodyWays::BodyWays(std::span<const BodyWay> ways,
                   std::function<bool(std::uint32_t, std::uint32_t)> are_paired,
                   Workspace& workspace, double tolerance)
    : are_paired_(std::move(are_paired)), workspace_(workspace), tolerance_(tolerance) {
    for (const BodyWay& way : ways) bodies_.push_back({.way = way});
}

bool BodyWays::moves(std::uint32_t body) const {
    return !std::ranges::all_of(bodies_[body].way.motions, is_at_rest);
}

BodyWays::Role BodyWays::role_of(std::uint32_t body) const {
    const Body& met = bodies_[body];
    if (!met.way.is_free) return moves(body) ? Role::drives : Role::stays;
    if (met.phase == Phase::carried) return Role::drives;
    return met.phase == Phase::squeezed ? Role::stays : Role::yields;
}

bool BodyWays::may_meet(std::uint32_t a, std::uint32_t b) const {
    const Body &first = bodies_[a], &second = bodies_[b];
    if (!first.way.is_continuous && !second.way.is_continuous) return false;
    const bool go_together = first.phase == Phase::carried && second.phase == Phase::carried &&
                             first.carrier == second.carrier;
    return !go_together && (moves(a) || moves(b)) && are_paired_(a, b) &&
           !left_out_.contains(std::minmax(a, b));
}

/// Returns the time at which the motion that goes at a time ends.
double BodyWays::next_motion(std::uint32_t body, double time) const {
    const double count = static_cast<double>(bodies_[body].way.motions.size());
    const double begin = bodies_[body].begin;
    const double share = (time - begin) / (1 - begin);
    const double next = begin + (1 - begin) * (std::floor(share * count + kSameTime) + 1) / count;
    return next > 1 - kSameTime ? 1 : next;
}

/// Returns the motion of a body between two times, which one of its motions contains.
Result<Motion> BodyWays::motion_in(std::uint32_t body, double from, double to) const {
    const std::vector<Motion>& motions = bodies_[body].way.motions;
    const double count = static_cast<double>(motions.size());
    const double begin = bodies_[body].begin;
    const double first = (from - begin) / (1 - begin) * count;
    const double number = std::min(std::floor(first + kSameTime), count - 1);
    const Motion& motion = motions[static_cast<std::size_t>(number)];
    const double start = std::max(first - number, 0.0);
    const double end = (to - begin) / (1 - begin) * count - number;
    const bool is_whole = start <= kSameTime && end >= 1 - kSameTime;
    if (is_whole || is_at_rest(motion)) return motion;
    const Motion::Parts& parts = motion.parts();
    const double share = std::min(end, 1.0) - start;
    return Motion::by_velocity(motion.at(start), mesh::scaled(parts.shift, share),
                               mesh::scaled(parts.axis, parts.angle * share), parts.centre);
}

/// Adds the first meeting of two bodies after a time, if there is one.
Result<Done> BodyWays::find_meeting(std::uint32_t a, std::uint32_t b, double from) {
    if (a > b) std::swap(a, b);
    const BodyWay &first = bodies_[a].way, &second = bodies_[b].way;
    for (double to = 1; from < 1 && may_meet(a, b); from = to) {
        to = std::min(next_motion(a, from), next_motion(b, from));
        const Result<Motion> of_a = motion_in(a, from, to), of_b = motion_in(b, from, to);
        if (!of_a) return of_a.error();
        if (!of_b) return of_b.error();
        const Double3 at_a = transform_point(of_a->parts().start, first.centre);
        const Double3 at_b = transform_point(of_b->parts().start, second.centre);
        const double reach =
            first.radius + second.radius + way_of(*of_a, at_a) + way_of(*of_b, at_b);
        if (mesh::euclidean_distance(at_a, at_b) > reach) continue;
        const Impact impact = time_of_impact({*first.model, *second.model, *of_a, *of_b},
                                             workspace_, {.tolerance = tolerance_});
        if (impact.kind == ImpactKind::none || impact.lower >= 1) continue;
        if (from == 0 && impact.lower <= 0) {
            left_out_.insert({a, b});
            return Done{};
        }
        const double time = from + impact.lower * (to - from);
        meetings_.push_back({std::min(time, 1 - kSameTime), a, b});
        return Done{};
    }
    return Done{};
}

/// Forgets the meetings of a body whose way has changed, and finds those of the new way.
Result<Done> BodyWays::find_again(std::uint32_t body, double from) {
    std::erase_if(meetings_, [&](const Meeting& m) { return m.a == body || m.b == body; });
    for (std::uint32_t other = 0; other < bodies_.size(); ++other) {
        if (other == body) continue;
        if (Result<Done> found = find_meeting(body, other, from); !found) return found;
    }
    return Done{};
}

/// Ends the way of a free body. Returns whether it went on before.
Result<bool> BodyWays::stop(std::uint32_t body, double time, Phase phase) {
    Body& stopped = bodies_[body];
    if (stopped.phase >= phase || !moves(body)) return false;
    const Result<Motion> rest = motion_in(body, time, next_motion(body, time));
    if (!rest) return rest.error();
    stopped.way.motions = {Motion(rest->parts().start)};
    stopped.begin = time;
    stopped.phase = phase;
    return true;
}

/// Lets a free body go along with another one, as if they were one. Bodies that are not free have
/// one motion.
Result<bool> BodyWays::carry(std::uint32_t body, std::uint32_t carrier, double time) {
    if (bodies_[carrier].phase == Phase::carried) carrier = bodies_[carrier].carrier;
    Body& carried = bodies_[body];
    const Result<Motion> here = motion_in(body, time, next_motion(body, time));
    const Result<Motion> along = motion_in(carrier, time, 1);
    if (!here) return here.error();
    if (!along) return along.error();
    const Motion::Parts& parts = along->parts();
    const Pose start = here->parts().start;
    const Result<Pose> model_from_world = inverse_pose(start);
    if (!model_from_world) return model_from_world.error();
    const Result<Motion> motion =
        Motion::by_velocity(start, parts.shift, mesh::scaled(parts.axis, parts.angle),
                            transform_point(*model_from_world, parts.start_of_centre));
    if (!motion) return motion.error();
    carried.way.motions = {*motion};
    carried.begin = time;
    carried.phase = Phase::carried;
    carried.carrier = carrier;
    left_out_.insert(std::minmax(body, carrier));
    return true;
}

/// Changes the way of a body where it meets another one. Returns whether it is another way now.
Result<bool> BodyWays::change(std::uint32_t body, Role own, std::uint32_t other, Role met,
                              double time) {
    if (own == Role::yields) {
        return met == Role::drives ? carry(body, other, time) : stop(body, time, Phase::stopped);
    }
    const bool is_carried = own == Role::drives && bodies_[body].way.is_free;
    return is_carried && met != Role::yields ? stop(body, time, Phase::squeezed) : false;
}

Result<Done> BodyWays::meet(const Meeting& meeting) {
    const auto [time, a, b] = meeting;
    const Role of_a = role_of(a), of_b = role_of(b);
    const Result<bool> a_changes = change(a, of_a, b, of_b, time);
    if (!a_changes) return a_changes.error();
    const Result<bool> b_changes = change(b, of_b, a, of_a, time);
    if (!b_changes) return b_changes.error();
    if (!*a_changes && !*b_changes) {
        left_out_.insert({a, b});
        return find_again(a, time);
    }
    const bool is_of_a = bodies_[a].way.is_continuous;
    impacts_.push_back({is_of_a ? a : b, is_of_a ? b : a, time});
    if (*a_changes) {
        if (Result<Done> found = find_again(a, time); !found) return found;
    }
    return *b_changes ? find_again(b, time) : Done{};
}

Result<Done> BodyWays::run() {
    for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
        for (std::uint32_t a = 0; a < b; ++a) {
            if (Result<Done> found = find_meeting(a, b, 0); !found) return found;
        }
    }
    const auto order = [](const Meeting& m) { return std::tuple(m.time, m.a, m.b); };
    while (!meetings_.empty()) {
        const Meeting next = *std::ranges::min_element(meetings_, {}, order);
        if (Result<Done> met = meet(next); !met) return met;
    }
    return Done{};
}

std::optional<Pose> BodyWays::changed_end(std::uint32_t body) const {
    const Body& moved = bodies_[body];
    if (moved.phase == Phase::going) return std::nullopt;
    return moved.way.motions.back().parts().end;
}

}  // namespace cdprep::dynamics
