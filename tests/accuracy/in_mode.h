// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "support/float_modes.h"

namespace cdprep::test {

/// The floating-point environment that the scoreboard's questions are asked in. Cases and truths
/// are made in the default one: another would change what is asked.
inline FloatMode mode_of_questions = float_modes().front();

/// Sets it by its name. Returns false when this processor has none of this name.
[[nodiscard]] inline bool set_mode_of_questions(std::string_view name) {
    for (const FloatMode& mode : float_modes()) {
        if (name != mode.name) continue;
        mode_of_questions = mode;
        return true;
    }
    return false;
}

/// Returns question(), asked in that environment.
template <class Question>
[[nodiscard]] auto in_mode(Question&& question) {
    struct Mode {
        Mode() {
            format::set_float_control(mode_of_questions.control);
        }
        ~Mode() {
            format::set_default_float_control();
        }
    };
    const Mode mode;
    return question();
}

}  // namespace cdprep::test
