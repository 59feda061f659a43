// SPDX-License-Identifier: MIT
#include "cdprep/format/float_environment.h"

namespace cdprep::format {

[[gnu::noinline]] void set_float_control([[maybe_unused]] std::uint64_t control) noexcept {
#if defined(_M_X64)
    _mm_setcsr(static_cast<unsigned>(control));
#elif defined(__x86_64__)
    const auto word = static_cast<std::uint32_t>(control);
    asm volatile("ldmxcsr %0" : : "m"(word) : "memory");
#elif defined(_M_ARM64)
    _WriteStatusReg(ARM64_FPCR, static_cast<__int64>(control));
#elif defined(__aarch64__)
    asm volatile("msr fpcr, %0" : : "r"(control) : "memory");
#endif
}

void set_default_float_control() noexcept {
#if defined(__x86_64__) || defined(_M_X64)
    set_float_control(0x1F80);
#else
    set_float_control(0);
#endif
}

}  // namespace cdprep::format
