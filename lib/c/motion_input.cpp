// SPDX-License-Identifier: MIT
#include "c/motion_input.h"

#include "cdprep/format/float_environment.h"

namespace cdprep::c {
namespace {

bool is_zero(const double (&numbers)[3]) noexcept {
    const format::FloatEnvironment environment;
    return numbers[0] == 0 && numbers[1] == 0 && numbers[2] == 0;
}

Double3 point(const double (&numbers)[3]) noexcept {
    return {numbers[0], numbers[1], numbers[2]};
}

int check_all_numbers(Call& call, const MotionNames& names, const cdprep_motion& given) noexcept {
    const auto check = [&](const char* field, const double* numbers, std::size_t count) {
        return check_numbers(call, names.whole.of(field), Holds::number, numbers, count);
    };
    if (const int code = check(names.start, given.start.rows, 12)) return code;
    if (const int code = check(names.end, given.end.rows, 12)) return code;
    if (const int code = check(names.centre, given.centre, 3)) return code;
    if (const int code = check(names.shift, given.shift, 3)) return code;
    return check(names.turn, given.turn, 3);
}

int refuse_unused(Call& call, const Name& name) noexcept {
    return call.refuse(CDPREP_WHY_NO_MEANING, name,
                       "is set, but given_by does not use it; leave it at its default.");
}

/// Refuses fields that this kind of motion does not use.
int check_use(Call& call, const MotionNames& names, const cdprep_motion& given) noexcept {
    const Name& whole = names.whole;
    if (given.given_by > CDPREP_MOTION_VELOCITY) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, whole.of(names.given_by),
                           "is %u; the greatest value is %d.", given.given_by,
                           static_cast<int>(CDPREP_MOTION_VELOCITY));
    }
    if (given.reserved != 0) {
        return call.refuse(CDPREP_WHY_NEWER_FIELD, whole.of(names.reserved),
                           "is %u; this version of the library needs 0.", given.reserved);
    }
    if (given.given_by == CDPREP_MOTION_VELOCITY) {
        return is_identity(given.end) ? CDPREP_OK : refuse_unused(call, whole.of(names.end));
    }
    if (!is_zero(given.shift)) return refuse_unused(call, whole.of(names.shift));
    if (!is_zero(given.turn)) return refuse_unused(call, whole.of(names.turn));
    return CDPREP_OK;
}

}  // namespace

int read_motion(Call& call, const MotionNames& names, const cdprep_motion& given, Motion& motion) {
    if (const int code = check_all_numbers(call, names, given)) return code;
    if (const int code = check_use(call, names, given)) return code;
    Pose start, end;
    if (const int code = read_rigid(call, names.whole.of(names.start), given.start, start))
        return code;
    if (const int code = read_rigid(call, names.whole.of(names.end), given.end, end)) return code;
    const Result<Motion> made = given.given_by == CDPREP_MOTION_POSES
                                    ? Motion::between(start, end, point(given.centre))
                                    : Motion::by_velocity(start, point(given.shift),
                                                          point(given.turn), point(given.centre));
    if (!made) {
        return call.refuse_with(CDPREP_WHY_OUT_OF_RANGE, names.whole.of(names.motion),
                                made.error().message);
    }
    motion = made.value();
    return CDPREP_OK;
}

}  // namespace cdprep::c
