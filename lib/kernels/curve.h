// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

/// Places along the z curve, the middle of an octree's keys (format/octree.h).
///
/// One call makes one code: with the bits of three numbers dealt out by three instructions
/// it takes 1.7 ns through a pointer, where shifts and masks take 3.4 ns even inline. They
/// are told apart like the tables of kernels.h, and obey the same rules.
namespace cdprep::kernels {

/// One instruction set's way. All give the same numbers.
struct Curve {
    const char* name;  ///< "scalar", "bmi2": shown in tests and benchmarks

    /// The code of finest cell x, y, z, each below 2^21: bit 3 i is bit i of x, bit 3 i + 1
    /// that of y, bit 3 i + 2 that of z.
    std::uint64_t (*code)(std::uint32_t x, std::uint32_t y, std::uint32_t z) noexcept;

    /// The cell of a code below 2^63: sets cell[0], cell[1], cell[2].
    void (*cell)(std::uint64_t code, std::uint32_t* cell) noexcept;
};

extern const Curve kScalarCurve;  ///< the reference, for any processor
#ifdef CDPREP_HAVE_AVX2
extern const Curve kBmi2Curve;  ///< call through it only if available_curves() lists it
#endif

/// Those that this processor can run, the reference first.
struct AvailableCurves {
    const Curve* curve[2];
    std::size_t count;
};
[[nodiscard]] AvailableCurves available_curves() noexcept;

/// The one that is used: BMI2 where the processor has it and has it fast, which AMD's do
/// from Zen 3 on (before, an instruction takes as long as it has bits); or the reference
/// where CDPREP_KERNELS is "scalar" when the process first asks.
[[nodiscard]] const Curve& active_curve() noexcept;

}  // namespace cdprep::kernels
