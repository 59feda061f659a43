// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#if defined(_MSC_VER) && !defined(__clang__)
#include <intrin.h>
#else
#include <cpuid.h>
#endif

namespace cdprep::kernels {

/// What an x86-64 processor and its operating system offer.
struct Processor {
    bool avx2 = false;    ///< and what compilers use with it: FMA, BMI 1 and 2, LZCNT
    bool avx512 = false;  ///< F, CD, BW, DQ and VL
    bool bmi2 = false;
    bool is_intel = false;
    bool is_amd = false;
    unsigned family = 0;  ///< as the vendor counts
};

struct CpuidWords {
    unsigned a, b, c, d;
};

[[nodiscard]] inline CpuidWords cpuid(unsigned leaf) noexcept {
    CpuidWords words{};
#if defined(_MSC_VER) && !defined(__clang__)
    int read[4] = {};
    __cpuidex(read, static_cast<int>(leaf), 0);
    words = {static_cast<unsigned>(read[0]), static_cast<unsigned>(read[1]),
             static_cast<unsigned>(read[2]), static_cast<unsigned>(read[3])};
#else
    __cpuid_count(leaf, 0, words.a, words.b, words.c, words.d);
#endif
    return words;
}

/// Returns which registers the operating system keeps, of XCR0. Bit 27 of leaf 1's c must be set.
[[nodiscard]] inline std::uint64_t kept_registers() noexcept {
#if defined(_MSC_VER) && !defined(__clang__)
    return _xgetbv(0);
#else
    std::uint32_t low = 0, high = 0;
    asm volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return std::uint64_t{high} << 32 | low;
#endif
}

/// Asks the processor. Bits are as in Intel's manual, volume 2, CPUID.
[[nodiscard]] inline Processor ask_processor() noexcept {
    const auto has = [](std::uint64_t word, std::uint64_t bits) { return (word & bits) == bits; };
    Processor processor;
    const CpuidWords vendor = cpuid(0);
    processor.is_intel = vendor.b == 0x756e6547;  // "Genu"
    processor.is_amd = vendor.b == 0x68747541;    // "Auth"
    if (vendor.a < 7) return processor;
    const CpuidWords first = cpuid(1), seventh = cpuid(7);
    processor.family = (first.a >> 8 & 0xf) + (first.a >> 20 & 0xff);
    processor.bmi2 = has(seventh.b, 1U << 8);
    constexpr std::uint64_t kSse = 2, kAvx = 4, kMasks = 0x20, kUpper = 0xc0;
    const std::uint64_t kept = has(first.c, 1U << 27) ? kept_registers() : 0;
    constexpr unsigned kFma = 1U << 12, kAvxInstructions = 1U << 28, kLzcnt = 1U << 5;
    constexpr unsigned kBmi1 = 1U << 3, kAvx2Bit = 1U << 5, kBmi2 = 1U << 8;
    processor.avx2 = has(kept, kSse | kAvx) && has(first.c, kFma | kAvxInstructions) &&
                     has(seventh.b, kBmi1 | kAvx2Bit | kBmi2) && has(cpuid(0x80000001).c, kLzcnt);
    constexpr unsigned kF = 1U << 16, kDq = 1U << 17, kCd = 1U << 28, kBw = 1U << 30,
                       kVl = 1U << 31;
    processor.avx512 =
        processor.avx2 && has(kept, kMasks | kUpper) && has(seventh.b, kF | kDq | kCd | kBw | kVl);
    return processor;
}

}  // namespace cdprep::kernels
