// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <span>

#include "cells/cell_bounds.h"
#include "exact/triangle_contact.h"

namespace cdprep {

/// The triangles that hold a tetra-tree's centre, as a tree with one leaf: the whole frame.
class CentreCell {
public:
    static constexpr std::uint32_t kMostLevels = 1;
    static constexpr bool kOriented = false;

    struct Cell {
        std::uint32_t node;
    };

    explicit CentreCell(std::span<const std::uint32_t> references) noexcept
        : references_(references) {}

    [[nodiscard]] bool is_empty() const noexcept {
        return references_.empty();
    }
    [[nodiscard]] static Cell top() noexcept {
        return {kAboveRoots};
    }
    [[nodiscard]] static unsigned lanes(const Cell& /*cell*/) noexcept {
        return 1;
    }
    [[nodiscard]] static Cell child(const Cell& /*cell*/, unsigned /*lane*/) noexcept {
        return {0};
    }
    [[nodiscard]] static bool is_leaf(const Cell& /*cell*/) noexcept {
        return true;
    }
    [[nodiscard]] static unsigned leaf_lanes(const Cell& /*cell*/) noexcept {
        return 1;
    }
    [[nodiscard]] std::span<const std::uint32_t> references(const Cell& /*cell*/) const noexcept {
        return references_;
    }
    [[nodiscard]] static StoredBounds stored_bounds(const Cell& /*cell*/) noexcept {
        return {};
    }
    static void bound(const Cell& /*cell*/, MadeBounds& bounds) noexcept {
        for (std::size_t axis = 0; axis < 3; ++axis) bound_root(axis, -1, 1, bounds.boxes);
    }
    [[nodiscard]] unsigned lanes_listing(const Cell& /*cell*/, std::uint32_t triangle,
                                         const Corners& /*corners*/) const noexcept {
        return std::any_of(references_.begin(), references_.end(), [&](std::uint32_t reference) {
            return (reference & ~format::kSharedReference) == triangle;
        });
    }

private:
    std::span<const std::uint32_t> references_;
};

}  // namespace cdprep
