// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#if defined(__x86_64__) || defined(_M_X64)
#include <xmmintrin.h>
#elif defined(_M_ARM64)
#include <intrin.h>
#endif

#include "cdprep/format/api.h"

namespace cdprep::format {

/// Returns the control register of the floating-point unit: MXCSR on x86-64, FPCR on ARM64. Returns
/// 0 on other processors; WebAssembly has no such register.
[[nodiscard]] inline std::uint64_t float_control() noexcept {
#if defined(__x86_64__) || defined(_M_X64)
    return _mm_getcsr();
#elif defined(_M_ARM64)
    return static_cast<std::uint64_t>(_ReadStatusReg(ARM64_FPCR));
#elif defined(__aarch64__)
    std::uint64_t control = 0;
    asm volatile("mrs %0, fpcr" : "=r"(control));
    return control;
#else
    return 0;
#endif
}

/// Returns whether a value of float_control() is the default: round to nearest, keep subnormal
/// operands and results, mask all exceptions. Flags of past exceptions are ignored.
[[nodiscard]] constexpr bool is_default_float_control(std::uint64_t control) noexcept {
#if defined(__x86_64__) || defined(_M_X64)
    constexpr std::uint64_t kFlagsOfPastExceptions = 0x3F;
    constexpr std::uint64_t kAllMasked = 0x1F80;
    return (control & 0xFFFF & ~kFlagsOfPastExceptions) == kAllMasked;
#else
    return control == 0;
#endif
}

/// Sets the register to a value that float_control() returned. Never inlined, so the compiler moves
/// no access to shared memory across the call. The compiler may still move arithmetic on values in
/// registers.
CDPREP_API void set_float_control(std::uint64_t control) noexcept;

/// Sets the default value of the register; see is_default_float_control().
CDPREP_API void set_default_float_control() noexcept;

/// A guard that gives its thread the default floating-point environment while it lives, and then
/// restores the caller's. Usually the caller's environment is already the default. The guard then
/// costs a read and two comparisons: eight instructions on x86-64.
///
/// Game engines flush subnormal numbers to zero on their threads, and -ffast-math does so for a
/// whole program. Some programs set another rounding mode or trap floating-point exceptions.
/// Exactness is proven for the default environment only, so each entry point of the library begins
/// with a guard. A guard must stay on the thread that made it.
class FloatEnvironment {
public:
    FloatEnvironment() noexcept : callers_(float_control()) {
        if (!is_default_float_control(callers_)) [[unlikely]] {
            set_default_float_control();
        }
    }
    ~FloatEnvironment() {
        if (!is_default_float_control(callers_)) [[unlikely]] {
            set_float_control(callers_);
        }
    }
    FloatEnvironment(const FloatEnvironment&) = delete;
    FloatEnvironment& operator=(const FloatEnvironment&) = delete;

    /// Runs call(), a visitor or hook of the caller, in the caller's environment. Returns its
    /// result. A mode that call() sets stays set for the caller.
    template <class Call>
    decltype(auto) outside(Call&& call) {
#if defined(__GNUC__)
        // The values that the call reads must be computed before the environment changes. This
        // barrier makes the compiler do so. With Visual C++, only set_float_control() keeps the
        // order, because it is never inlined.
        asm volatile("" : : "r"(&call) : "memory");
#endif
        const Outside left(*this);
        return call();
    }

private:
    class Outside {
    public:
        explicit Outside(FloatEnvironment& inside) noexcept : inside_(inside) {
            if (!is_default_float_control(inside_.callers_)) [[unlikely]] {
                set_float_control(inside_.callers_);
            }
        }
        ~Outside() {
            inside_.callers_ = float_control();
            if (!is_default_float_control(inside_.callers_)) [[unlikely]] {
                set_default_float_control();
            }
        }
        Outside(const Outside&) = delete;
        Outside& operator=(const Outside&) = delete;

    private:
        FloatEnvironment& inside_;
    };

    std::uint64_t callers_;
};

}  // namespace cdprep::format
