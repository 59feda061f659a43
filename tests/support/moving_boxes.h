// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "cdprep/broad_phase.h"

namespace cdprep::test {

/// How boxes lie and move. A step is given relative to the size of a box.
enum class BoxScene {
    uniform,   ///< spread out; each moves by 10 %
    resting,   ///< spread out; one of twenty moves by 10 %
    coherent,  ///< spread out; each moves by 0.5 %
    pile,      ///< three pairs a box; each moves by 1 %
    ratios,    ///< sizes from 1 to 1000; each moves by 0.5 %
    plates,    ///< flat, in one layer; each moves by 1 %
};
inline constexpr std::array kBoxScenes = {BoxScene::uniform, BoxScene::resting, BoxScene::coherent,
                                          BoxScene::pile,    BoxScene::ratios,  BoxScene::plates};
[[nodiscard]] const char* name_of(BoxScene scene) noexcept;

/// Boxes that move straight and turn back at the walls of the scene.
class MovingBoxes {
public:
    MovingBoxes(BoxScene scene, std::size_t count, std::uint32_t seed);

    void step();
    [[nodiscard]] std::span<const WorldBox> boxes() const noexcept {
        return boxes_;
    }
    /// The boxes that the last step moved.
    [[nodiscard]] std::span<const std::uint32_t> moved() const noexcept {
        return moved_;
    }

private:
    struct Body {
        std::array<double, 3> middle, half, step;
    };
    void add_body(BoxScene scene, std::mt19937_64& random);
    [[nodiscard]] static WorldBox box_of(const Body& body) noexcept;

    double side_ = 0;
    std::vector<Body> bodies_;
    std::vector<WorldBox> boxes_;
    std::vector<std::uint32_t> moved_;
};

/// Returns all pairs of boxes that meet, by comparing each with each.
[[nodiscard]] std::vector<BoxPair> brute_force_pairs(std::span<const WorldBox> boxes,
                                                     std::span<const BoxFilter> filters = {});

}  // namespace cdprep::test
