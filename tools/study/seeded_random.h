// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "cdprep/format/geometry.h"

namespace cdprep::study {

/// Random numbers from a seed: SplitMix64 (Steele, Lea, Flood 2014). They are the same on every
/// machine and with every standard library; the distributions of <random> do not promise this.
class SeededRandom {
public:
    explicit SeededRandom(std::uint64_t seed) noexcept : state_(seed) {}

    [[nodiscard]] std::uint64_t bits() noexcept {
        std::uint64_t x = (state_ += 0x9e3779b97f4a7c15U);
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
        return x ^ (x >> 31);
    }

    /// Returns a uniform number in [0, 1), in steps of 2^-53.
    [[nodiscard]] double share() noexcept {
        return static_cast<double>(bits() >> 11) * 0x1p-53;
    }
    [[nodiscard]] double between(double low, double high) noexcept {
        return low + (high - low) * share();
    }
    /// Returns a log-uniform number between two limits: every factor of 10 is equally likely. Both
    /// limits must be above 0.
    [[nodiscard]] double between_by_factors(double low, double high) noexcept {
        return low * std::pow(high / low, share());
    }
    /// Returns a whole number below `count`, which must be above 0 and at most 2^53.
    [[nodiscard]] std::size_t below(std::size_t count) noexcept {
        return static_cast<std::size_t>(share() * static_cast<double>(count));
    }

    /// Returns a vector of length 1, up to rounding, uniform in all directions.
    [[nodiscard]] format::Double3 direction() noexcept {
        while (true) {
            const format::Double3 v = {between(-1, 1), between(-1, 1), between(-1, 1)};
            const double square = v.x * v.x + v.y * v.y + v.z * v.z;
            if (square > 1 || square < 1e-6) continue;
            const double length = std::sqrt(square);
            return {v.x / length, v.y / length, v.z / length};
        }
    }

    /// Returns a quaternion of a length above 0 and at most 1. Its rotation is uniform.
    [[nodiscard]] std::array<double, 4> quaternion() noexcept {
        while (true) {
            const std::array<double, 4> q = {between(-1, 1), between(-1, 1), between(-1, 1),
                                             between(-1, 1)};
            const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
            if (square <= 1 && square > 1e-6) return q;
        }
    }

private:
    std::uint64_t state_;
};

}  // namespace cdprep::study
