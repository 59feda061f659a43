// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/format/float_environment.h"

namespace cdprep::test {

/// A floating-point environment that a caller may have.
struct FloatMode {
    const char* name;
    std::uint64_t control;  ///< as format::float_control() returns it
};

/// Returns the default, then modes that programs are known to set. A processor without
/// modes has only the default.
[[nodiscard]] inline std::span<const FloatMode> float_modes() {
#if defined(__x86_64__) || defined(_M_X64)
    static constexpr std::array<FloatMode, 6> kModes = {{{"default", 0x1F80},
                                                         {"flush_to_zero", 0x9FC0},
                                                         {"downwards", 0x3F80},
                                                         {"upwards", 0x5F80},
                                                         {"towards_zero", 0x7F80},
                                                         {"trapping", 0x0000}}};
#elif defined(__aarch64__) || defined(_M_ARM64)
    static constexpr std::array<FloatMode, 5> kModes = {{{"default", 0},
                                                         {"flush_to_zero", 0x01000000},
                                                         {"downwards", 0x00800000},
                                                         {"upwards", 0x00400000},
                                                         {"towards_zero", 0x00C00000}}};
#else
    static constexpr std::array<FloatMode, 1> kModes = {{{"default", 0}}};
#endif
    return kModes;
}

/// Returns the bits of a control register that control arithmetic. The others are status flags.
[[nodiscard]] constexpr std::uint64_t control_bits(std::uint64_t control) {
#if defined(__x86_64__) || defined(_M_X64)
    return control & 0xFFC0;
#else
    return control;
#endif
}

/// Returns the bits of the environment that `call` leaves after it runs in `mode`. Restores the
/// test's own environment afterwards.
template <class Call>
[[nodiscard]] std::uint64_t run_in(const FloatMode& mode, Call&& call) {
    const std::uint64_t own = format::float_control();
    format::set_float_control(mode.control);
    call();
    const std::uint64_t left = format::float_control();
    format::set_float_control(own);
    return control_bits(left);
}

}  // namespace cdprep::test
