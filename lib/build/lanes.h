// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "cdprep/format/portable.h"

namespace cdprep::build {

/// Numbers side by side. GCC unrolls loops of four and eight before it looks for vectors, and then
/// finds none. The hint keeps the loops, so that one vector instruction replaces four scalar
/// ones.
template <class T, std::size_t kCount>
using Lanes = std::array<T, kCount>;

template <class T, std::size_t kCount>
[[nodiscard]] constexpr Lanes<T, kCount> all_lanes(T value) {
    Lanes<T, kCount> lanes{};
    lanes.fill(value);
    return lanes;
}

/// Calls body(lane) for each lane. Eight are twice four: of floats one vector each, and no loop
/// remains.
template <std::size_t kCount, class Body>
inline void for_lanes(const Body& body) {
    if constexpr (kCount == 8) {
        for_lanes<4>(body);
        for_lanes<4>([&](std::size_t lane) { body(lane + 4); });
    } else {
#if defined(__GNUC__)
#pragma GCC unroll 1
#endif
        for (std::size_t lane = 0; lane < kCount; ++lane) body(lane);
    }
}

template <class T, std::size_t kCount>
inline void take_lower(Lanes<T, kCount>& a, const Lanes<T, kCount>& b) {
    for_lanes<kCount>([&](std::size_t lane) { a[lane] = b[lane] < a[lane] ? b[lane] : a[lane]; });
}

template <class T, std::size_t kCount>
inline void take_upper(Lanes<T, kCount>& a, const Lanes<T, kCount>& b) {
    for_lanes<kCount>([&](std::size_t lane) { a[lane] = a[lane] < b[lane] ? b[lane] : a[lane]; });
}

/// Compares the halves first, so that vector instructions do most of the work.
template <class T>
[[nodiscard]] inline T least(const Lanes<T, 8>& lanes) {
    Lanes<T, 4> half;
    for_lanes<4>([&](std::size_t lane) {
        half[lane] = lanes[lane + 4] < lanes[lane] ? lanes[lane + 4] : lanes[lane];
    });
    const T even = half[2] < half[0] ? half[2] : half[0];
    const T odd = half[3] < half[1] ? half[3] : half[1];
    return odd < even ? odd : even;
}

template <class T>
[[nodiscard]] inline T greatest(const Lanes<T, 8>& lanes) {
    Lanes<T, 4> half;
    for_lanes<4>([&](std::size_t lane) {
        half[lane] = lanes[lane] < lanes[lane + 4] ? lanes[lane + 4] : lanes[lane];
    });
    const T even = half[0] < half[2] ? half[2] : half[0];
    const T odd = half[1] < half[3] ? half[3] : half[1];
    return even < odd ? odd : even;
}

}  // namespace cdprep::build
