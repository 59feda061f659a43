// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/carver.h"
#include "kernels/kernels.h"

namespace cdprep {

/// A tree over padded boxes (kernels.h), eight a node, in the order of the Z-order curve. Boxes
/// larger than an eighth of the scene follow in an order of their own, so that they widen no node
/// of small ones. There are always two levels or more.
class WorldTree {
public:
    /// Takes memory for trees of at most `most` boxes.
    WorldTree(Carver& carver, std::uint32_t most) noexcept;

    /// Chooses the order of the boxes, then builds.
    void build(const float* boxes, std::uint32_t count) noexcept;
    /// Builds the tree over boxes that have moved, in the order that was chosen.
    void rebuild(const float* boxes) noexcept;
    /// Sets one box, and the boxes around it.
    void set(std::uint32_t number, const float* box) noexcept;

    [[nodiscard]] const kernels::BoxTree& view() const noexcept {
        return view_;
    }
    [[nodiscard]] const float* node(unsigned level, std::size_t number) const noexcept {
        return view_.level[level] + number * kernels::kBoxNode;
    }
    /// Returns how many nodes hold boxes.
    [[nodiscard]] std::uint32_t leaf_count() const noexcept {
        return static_cast<std::uint32_t>((count_ + kernels::kLanes - 1) / kernels::kLanes);
    }
    /// Returns the number of the box at a place: 8 node + lane.
    [[nodiscard]] std::uint32_t box_at(std::size_t place) const noexcept {
        return box_at_[place];
    }

private:
    void choose_order(const float* boxes) noexcept;
    void shape() noexcept;
    void set_lane(unsigned level, std::size_t place, const float* box) noexcept;

    std::uint32_t count_ = 0;
    kernels::BoxTree view_{};
    std::array<float*, kernels::kMostBoxLevels> level_{};  ///< as in view_
    float* nodes_;                                         ///< of all levels
    std::uint32_t* box_at_;                                ///< [place]
    std::uint32_t* place_of_;                              ///< [box]
    std::uint64_t* keys_;
    std::uint64_t* sorted_;
};

}  // namespace cdprep
