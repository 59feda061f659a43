// SPDX-License-Identifier: MIT
// The text of a plan, with the size of its scene: c_scene.cpp knows that, and builds on c_plan.cpp.
#include <string>

#include "c/scene/c_plan.h"
#include "cdprep/format/float_environment.h"

using cdprep::c::Call;
using cdprep::c::guarded;

int cdprep_plan_text(const cdprep_plan* plan, char* text, size_t room, size_t* length,
                     cdprep_error* error) {
    if (length != nullptr) *length = 0;
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(plan, {"plan"})) return code;
        if (room > 0) {
            if (const int code = call.need(text, {"text"})) return code;
        }
        if (const int code = call.need(length, {"length"})) return code;
        const cdprep::format::FloatEnvironment environment;
        std::size_t bytes = 0;
        if (const int code = cdprep_scene_size(plan, &bytes, error)) return code;
        const std::string all = plan->plan.describe() +
                                "with the results of the C API: " + std::to_string(bytes) +
                                " bytes, as cdprep_scene_size() returns\n";
        *length = all.size();
        if (room == 0) return CDPREP_OK;
        text[all.copy(text, room - 1)] = 0;
        return CDPREP_OK;
    });
}
