// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/space_name.h"

#include "text/number_text.h"

namespace cdprep::report {

const char* axis_name(format::UpAxis axis) noexcept {
    switch (axis) {
        case format::UpAxis::x:
            return "x";
        case format::UpAxis::y:
            return "y";
        case format::UpAxis::z:
            return "z";
        default:
            return "unknown";
    }
}

std::string unit_name(double metres_per_unit) {
    if (!(metres_per_unit > 0)) return "unknown";
    if (metres_per_unit == 0.001) return "mm";
    if (metres_per_unit == 0.01) return "cm";
    if (metres_per_unit == 1) return "m";
    if (metres_per_unit == 0.0254) return "in";
    if (metres_per_unit == 0.3048) return "ft";
    return number_text(metres_per_unit) + " m";
}

}  // namespace cdprep::report
