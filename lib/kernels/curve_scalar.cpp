// SPDX-License-Identifier: MIT
#include "curve.h"

#include <cassert>

namespace cdprep::kernels {
namespace {

/// Moves bit i of a number below 2^21 to bit 3 i: halves are moved apart, then their halves.
std::uint64_t spread(std::uint64_t x) noexcept {
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

/// Moves bit 3 i to bit i, the inverse of spread().
std::uint32_t gathered(std::uint64_t x) noexcept {
    x &= 0x1249249249249249;
    x = (x | x >> 2) & 0x10c30c30c30c30c3;
    x = (x | x >> 4) & 0x100f00f00f00f00f;
    x = (x | x >> 8) & 0x001f0000ff0000ff;
    x = (x | x >> 16) & 0x001f00000000ffff;
    return static_cast<std::uint32_t>((x | x >> 32) & 0x1fffff);
}

std::uint64_t code(std::uint32_t x, std::uint32_t y, std::uint32_t z) noexcept {
    assert(((x | y | z) >> 21) == 0);
    return spread(x) | spread(y) << 1 | spread(z) << 2;
}

void cell(std::uint64_t code, std::uint32_t* to) noexcept {
    assert(code >> 63 == 0);
    for (int axis = 0; axis < 3; ++axis) to[axis] = gathered(code >> axis);
}

}  // namespace

const Curve kScalarCurve = {"scalar", code, cell};

}  // namespace cdprep::kernels
