// SPDX-License-Identifier: MIT
#pragma once

#include "c/pose_input.h"
#include "cdprep/c/motion.h"
#include "cdprep/motion.h"

namespace cdprep::c {

/// The names of a motion and its fields in an error.
struct MotionNames {
    Name whole;
    const char* motion;  ///< null: `whole` is the motion
    const char* start;
    const char* end;
    const char* centre;
    const char* shift;
    const char* turn;
    const char* given_by;
    const char* reserved;
};

inline constexpr MotionNames kMotionAlone = {{"motion"}, nullptr, "start",    "end",     "centre",
                                             "shift",    "turn",  "given_by", "reserved"};
/// Reads a motion and checks all of it.
int read_motion(Call& call, const MotionNames& names, const cdprep_motion& given, Motion& motion);

}  // namespace cdprep::c
