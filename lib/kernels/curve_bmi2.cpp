// SPDX-License-Identifier: MIT
#include <immintrin.h>

#include "curve.h"

#include <cassert>

namespace cdprep::kernels {
namespace {

constexpr std::uint64_t kX = 0x1249249249249249;

std::uint64_t code(std::uint32_t x, std::uint32_t y, std::uint32_t z) noexcept {
    assert(((x | y | z) >> 21) == 0);
    return _pdep_u64(x, kX) | _pdep_u64(y, kX << 1) | _pdep_u64(z, kX << 2);
}

void cell(std::uint64_t code, std::uint32_t* to) noexcept {
    assert(code >> 63 == 0);
    for (int axis = 0; axis < 3; ++axis) {
        to[axis] = static_cast<std::uint32_t>(_pext_u64(code, kX << axis));
    }
}

}  // namespace

const Curve kBmi2Curve = {"bmi2", code, cell};

}  // namespace cdprep::kernels
