// SPDX-License-Identifier: MIT
// A table for lanes that a bit set names. Included by kernel sources alone.
#pragma once

#include <cstdint>

namespace cdprep::kernels {
namespace {

/// For each set of eight bits, the numbers of the bits that are set, one after the other.
struct SetBits {
    alignas(8) std::uint8_t number[256][8];
};
constexpr SetBits set_bits() noexcept {
    SetBits set{};
    for (unsigned bits = 0; bits < 256; ++bits) {
        unsigned count = 0;
        for (unsigned i = 0; i < 8; ++i) {
            if ((bits >> i & 1) != 0) set.number[bits][count++] = static_cast<std::uint8_t>(i);
        }
    }
    return set;
}
inline constexpr SetBits kSetBits = set_bits();

}  // namespace
}  // namespace cdprep::kernels
