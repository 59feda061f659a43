// SPDX-License-Identifier: MIT
#include <array>
#include <cstddef>

#include "c/c_pairs.h"
#include "c/motion_input.h"
#include "c/pair_answers.h"
#include "cdprep/c/motion.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/time_of_impact.h"

namespace cdprep::c {
namespace {

constexpr cdprep_motion kStill = {kIdentity, kIdentity, {}, {}, {}, CDPREP_MOTION_POSES, 0};

}  // namespace

template <>
struct Input<cdprep_moving_pair> {
    static const InputType type;
    static cdprep_moving_pair defaults() noexcept {
        cdprep_moving_pair pair{};
        pair.most_steps = ImpactOptions{}.most_steps;
        pair.motion_a = pair.motion_b = kStill;
        return pair;
    }
};

namespace {

constexpr std::array kFields = {
    Field{"a", offsetof(cdprep_moving_pair, a), Holds::pointer},
    Field{"b", offsetof(cdprep_moving_pair, b), Holds::pointer},
    Field{"body", offsetof(cdprep_moving_pair, body), Holds::choice, CDPREP_SOLID},
    Field{"tolerance", offsetof(cdprep_moving_pair, tolerance), Holds::length},
};

constexpr MotionNames kOfA = {{"pair"},        "motion_a",          "motion_a.start",
                              "motion_a.end",  "motion_a.centre",   "motion_a.shift",
                              "motion_a.turn", "motion_a.given_by", "motion_a.reserved"};
constexpr MotionNames kOfB = {{"pair"},        "motion_b",          "motion_b.start",
                              "motion_b.end",  "motion_b.centre",   "motion_b.shift",
                              "motion_b.turn", "motion_b.given_by", "motion_b.reserved"};

/// A moving pair whose every field was checked.
struct AskedMotion {
    cdprep_moving_pair given;
    Motion a, b;
};

int read_moving_pair(Call& call, const cdprep_moving_pair* from, AskedMotion& asked) {
    const Name name = {"pair"};
    cdprep_moving_pair& given = asked.given;
    if (const int code = read_input(call, name, from, given)) return code;
    if (const int code = read_motion(call, kOfA, given.motion_a, asked.a)) return code;
    if (const int code = read_motion(call, kOfB, given.motion_b, asked.b)) return code;
    const Ask needs = Ask::distance | (given.body == CDPREP_SOLID ? Ask::solid : Ask::nothing);
    if (const int code = check_serves(call, name.of("a"), *given.a, needs)) return code;
    return check_serves(call, name.of("b"), *given.b, needs);
}

}  // namespace

const InputType Input<cdprep_moving_pair>::type = {"cdprep_moving_pair", 0xcd500014U,
                                                   sizeof(cdprep_moving_pair),
                                                   sizeof(cdprep_moving_pair), kFields};

}  // namespace cdprep::c

using cdprep::c::Call;
using cdprep::c::guarded;

void cdprep_moving_pair_init(cdprep_moving_pair* pair, size_t size) {
    cdprep::c::initialise(pair, size);
}

int cdprep_motion_pose(const cdprep_motion* motion, double time, cdprep_pose* pose,
                       cdprep_error* error) {
    if (pose != nullptr) *pose = {};
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(motion, {"motion"})) return code;
        if (const int code = call.need(pose, {"pose"})) return code;
        if (const int code = check_number(call, "time", cdprep::c::Holds::length, time))
            return code;
        const cdprep::format::FloatEnvironment environment;
        if (time > 1) {
            return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"time"}, "is %.17g; it must be 0 to 1.",
                               time);
        }
        cdprep::Motion read;
        if (const int code = read_motion(call, cdprep::c::kMotionAlone, *motion, read)) return code;
        *pose = cdprep::c::stored(read.at(time));
        return CDPREP_OK;
    });
}

int cdprep_time_of_impact(const cdprep_moving_pair* pair, cdprep_workspace* workspace,
                          cdprep_impact* impact, cdprep_error* error) {
    if (impact != nullptr) *impact = {CDPREP_IMPACT_UNKNOWN, 0, 0, 0, {}};
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(pair, {"pair"})) return code;
        if (const int code = call.need(workspace, {"workspace"})) return code;
        if (const int code = call.need(impact, {"impact"})) return code;
        cdprep::c::AskedMotion asked;
        if (const int code = read_moving_pair(call, pair, asked)) return code;
        cdprep::c::InUse use;
        if (const int code = use.begin(call, *workspace)) return code;
        const cdprep::MovingPair moving = {
            asked.given.a->model, asked.given.b->model, asked.a, asked.b,
            asked.given.body == CDPREP_SOLID ? cdprep::Body::solid : cdprep::Body::surface};
        *impact = cdprep::c::in_c(time_of_impact(
            moving, workspace->lanes[0],
            {.tolerance = asked.given.tolerance, .most_steps = asked.given.most_steps}));
        return CDPREP_OK;
    });
}
