// SPDX-License-Identifier: MIT
#include "support/moving_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdprep::test {
namespace {

constexpr double kRatio = 1000;
constexpr double kThickness = 0.01;     // of plates
constexpr std::size_t kRestingOf = 20;  // one of so many moves

/// The volume for each box, if edges are 1.
double volume_of(BoxScene scene) {
    switch (scene) {
        case BoxScene::pile:
            return 8.0 / 6;
        case BoxScene::plates:
            return 4;  // an area
        case BoxScene::ratios:
            return 8;
        default:
            return 8;
    }
}

double step_of(BoxScene scene) {
    switch (scene) {
        case BoxScene::uniform:
        case BoxScene::resting:
            return 0.1;
        case BoxScene::pile:
        case BoxScene::plates:
            return 0.01;
        default:
            return 0.005;
    }
}

/// The box with infinite numbers as they count.
WorldBox finite(WorldBox box) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(box.lower[axis] <= box.upper[axis])) return {{1, 1, 1}, {0, 0, 0}};
        box.lower[axis] = std::clamp(box.lower[axis], -kLargest, kLargest);
        box.upper[axis] = std::clamp(box.upper[axis], -kLargest, kLargest);
    }
    return box;
}

bool meet(const WorldBox& a, const WorldBox& b) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(a.lower[axis] <= a.upper[axis] && b.lower[axis] <= b.upper[axis] &&
              a.lower[axis] <= b.upper[axis] && b.lower[axis] <= a.upper[axis])) {
            return false;
        }
    }
    return true;
}

}  // namespace

const char* name_of(BoxScene scene) noexcept {
    constexpr std::array kNames = {"uniform", "resting", "coherent", "pile", "ratios", "plates"};
    return kNames[static_cast<std::size_t>(scene)];
}

MovingBoxes::MovingBoxes(BoxScene scene, std::size_t count, std::uint32_t seed) {
    std::mt19937_64 random(seed);
    const double room = static_cast<double>(count) * volume_of(scene);
    side_ = scene == BoxScene::plates ? std::sqrt(room) : std::cbrt(room);
    for (std::size_t i = 0; i < count; ++i) add_body(scene, random);
    if (scene == BoxScene::resting) {
        for (std::size_t i = 0; i < count; ++i) {
            if (i % kRestingOf != 0) bodies_[i].step = {0, 0, 0};
        }
    }
    for (const Body& body : bodies_) boxes_.push_back(box_of(body));
}

void MovingBoxes::add_body(BoxScene scene, std::mt19937_64& random) {
    std::uniform_real_distribution<double> any(0, 1);
    std::normal_distribution<double> normal;
    Body body{};
    const double size =
        scene == BoxScene::ratios ? 4 * std::pow(kRatio, any(random) - 1) : 0.8 + 0.4 * any(random);
    double length = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        body.middle[axis] = side_ * any(random);
        body.half[axis] = size / 2;
        body.step[axis] = normal(random);
        length += body.step[axis] * body.step[axis];
    }
    for (double& step : body.step) step *= size * step_of(scene) / std::sqrt(length);
    if (scene == BoxScene::plates) {
        body.middle[2] = body.step[2] = 0;
        body.half[2] = kThickness / 2;
    }
    bodies_.push_back(body);
}

WorldBox MovingBoxes::box_of(const Body& body) noexcept {
    WorldBox box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = static_cast<float>(body.middle[axis] - body.half[axis]);
        box.upper[axis] = static_cast<float>(body.middle[axis] + body.half[axis]);
    }
    return box;
}

void MovingBoxes::step() {
    moved_.clear();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        Body& body = bodies_[i];
        if (body.step == std::array<double, 3>{}) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            body.middle[axis] += body.step[axis];
            const bool is_out = body.middle[axis] < 0 || body.middle[axis] > side_;
            if (is_out) body.step[axis] = -body.step[axis];
        }
        boxes_[i] = box_of(body);
        moved_.push_back(static_cast<std::uint32_t>(i));
    }
}

std::vector<BoxPair> brute_force_pairs(std::span<const WorldBox> given,
                                       std::span<const BoxFilter> filters) {
    std::vector<BoxPair> pairs;
    std::vector<WorldBox> boxes;
    for (const WorldBox& box : given) boxes.push_back(finite(box));
    for (std::uint32_t a = 0; a < boxes.size(); ++a) {
        for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
            if (!meet(boxes[a], boxes[b])) continue;
            if (filters.empty() || filters[a].allows(filters[b])) pairs.push_back({a, b});
        }
    }
    return pairs;
}

}  // namespace cdprep::test
