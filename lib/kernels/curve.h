// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "cdprep/format/api.h"

/// Places along the Z-order curve, the middle part of an octree's keys (format/octree.h).
///
/// One call makes one code. With BMI2, three instructions distribute the bits of three numbers.
/// This takes 1.7 ns through a pointer. Shifts and masks take 3.4 ns even inline. Curves are
/// selected like the tables of kernels.h, and follow the same rules.
namespace cdprep::kernels {

/// One instruction set's implementation. All give the same numbers.
struct Curve {
    const char* name;  ///< "scalar", "bmi2": shown in tests and benchmarks

    /// Returns the code of finest cell x, y, z, each below 2^21. Bit 3 i is bit i of x, bit 3 i + 1
    /// that of y, bit 3 i + 2 that of z.
    std::uint64_t (*code)(std::uint32_t x, std::uint32_t y, std::uint32_t z) noexcept;

    /// Computes the cell of a code below 2^63: sets cell[0], cell[1], cell[2].
    void (*cell)(std::uint64_t code, std::uint32_t* cell) noexcept;
};

extern const Curve kScalarCurve;  ///< the reference, for any processor
#ifdef CDPREP_HAVE_AVX2
extern const Curve kBmi2Curve;  ///< call through it only if available_curves() lists it
#endif

/// The curves that this processor can run, the reference first.
struct AvailableCurves {
    const Curve* curve[2];
    std::size_t count;
};
[[nodiscard]] AvailableCurves available_curves() noexcept;

/// Returns the curve in use: BMI2 if the processor has it and it is fast, otherwise the reference.
/// AMD's BMI2 is fast from Zen 3 on; before, an instruction takes as long as it has bits. If
/// CDPREP_KERNELS is "scalar" at the first call of the process, returns the reference.
[[nodiscard]] CDPREP_API const Curve& active_curve() noexcept;

}  // namespace cdprep::kernels
