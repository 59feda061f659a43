// SPDX-License-Identifier: MIT
#include "cdprep/format/elements.h"

namespace cdprep::format {

using enum Scalar;

std::uint32_t scalar_size(Scalar scalar) noexcept {
    switch (scalar) {
        case u8:
            return 1;
        case u64:
        case f64:
            return 8;
        default:
            return 4;
    }
}

const char* scalar_name(Scalar scalar) noexcept {
    switch (scalar) {
        case u8:
            return "u8";
        case u32:
            return "u32";
        case i32:
            return "i32";
        case u64:
            return "u64";
        case f32:
            return "f32";
        default:
            return "f64";
    }
}

}  // namespace cdprep::format
