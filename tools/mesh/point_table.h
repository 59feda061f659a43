// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "cdprep/format/geometry.h"

namespace cdprep::mesh {

/// Finds points by equal coordinates (-0.0 equals 0.0) in a list that the caller keeps. Uses
/// open addressing over indices. Coordinates must be finite.
class PointTable {
public:
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    PointTable() = default;
    explicit PointTable(std::size_t most) : slots_(std::bit_ceil(2 * most + 16), kNone) {}

    /// Returns the index of the equal point among the added ones, or kNone.
    [[nodiscard]] std::uint32_t find(const std::vector<format::Double3>& points,
                                     const format::Double3& p) const {
        return slots_[slot_of(points, p)];
    }

    /// Returns the index of the equal point among the added ones; adds `index` if there is none.
    std::uint32_t find_or_add(const std::vector<format::Double3>& points, const format::Double3& p,
                              std::uint32_t index) {
        std::uint32_t& slot = slots_[slot_of(points, p)];
        if (slot == kNone) slot = index;
        return slot;
    }

private:
    static std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
        constexpr std::uint64_t kMultiplier = 0x9e3779b97f4a7c15;  // 2^64 / golden ratio, odd
        hash = (hash ^ word) * kMultiplier;
        return hash ^ (hash >> 29);
    }

    static std::uint64_t hash_of(const format::Double3& p) {
        // Adding 0.0 turns -0.0 into 0.0, so equal numbers have equal hashes.
        std::uint64_t hash = mixed(1, std::bit_cast<std::uint64_t>(p.x + 0.0));
        hash = mixed(hash, std::bit_cast<std::uint64_t>(p.y + 0.0));
        return mixed(hash, std::bit_cast<std::uint64_t>(p.z + 0.0));
    }

    [[nodiscard]] std::size_t slot_of(const std::vector<format::Double3>& points,
                                      const format::Double3& p) const {
        std::size_t slot = hash_of(p) & (slots_.size() - 1);
        while (slots_[slot] != kNone && points[slots_[slot]] != p) {
            slot = (slot + 1) & (slots_.size() - 1);
        }
        return slot;
    }

    std::vector<std::uint32_t> slots_;
};

}  // namespace cdprep::mesh
