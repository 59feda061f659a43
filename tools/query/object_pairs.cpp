// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/object_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace cdprep::cli {
namespace {

/// A list of so many pairs takes 6 GiB.
constexpr std::uint64_t kMostCandidates = std::uint64_t{1} << 28;

/// Returns the number of pairs of objects whose layers are paired.
std::uint64_t count_possible(std::span<const PlacedObject> objects, const Plan& plan) {
    std::array<std::uint64_t, kLayers> sizes{};
    for (const PlacedObject& object : objects) ++sizes[object.layer];
    std::uint64_t count = 0;
    for (const LayerPair& pair : plan.pairs()) {
        count += pair.a == pair.b
                     ? sizes[pair.a] * (std::max<std::uint64_t>(sizes[pair.a], 1) - 1) / 2
                     : sizes[pair.a] * sizes[pair.b];
    }
    return count;
}

/// Returns a point near the objects, to which their boxes are relative.
Double3 origin_of(std::span<const PlacedObject> objects) {
    for (const PlacedObject& object : objects) {
        if (object.model->triangle_count() == 0) continue;
        const auto [x, y, z] = root_box(*object.model, object.pose, 0).middle;
        return {x, y, z};
    }
    return {};
}

}  // namespace

Result<std::vector<PlacedObject>> objects_of(const scenes::SceneFile& scene, const Plan& plan,
                                             std::span<const scenes::SceneModel> models) {
    std::vector<PlacedObject> placed;
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const scenes::FileObject& object = scene.objects[i];
        if (plan.asks_of(object.layer) == Ask::nothing) continue;
        const Result<Pose> pose = scenes::pose_of(scene, object, 0);
        if (!pose) return pose.error();
        placed.push_back({i, object.layer, &*models[object.model].model, *pose});
    }
    return placed;
}

double size_of(std::span<const PlacedObject> objects) {
    const Double3 origin = origin_of(objects);
    std::array<double, 3> lower{}, upper{};
    bool is_empty = true;
    for (const PlacedObject& object : objects) {
        const WorldBox box = world_box(root_box(*object.model, object.pose, 0), origin);
        if (box.lower[0] > box.upper[0]) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double low = box.lower[axis], high = box.upper[axis];
            lower[axis] = is_empty ? low : std::min(lower[axis], low);
            upper[axis] = is_empty ? high : std::max(upper[axis], high);
        }
        is_empty = false;
    }
    return std::hypot(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]);
}

Result<ObjectPairs> ObjectPairs::find(std::span<const PlacedObject> objects, const Plan& plan) {
    ObjectPairs found(objects, plan);
    found.possible_ = count_possible(objects, plan);
    std::vector<WorldBox> boxes;
    std::vector<BoxFilter> filters;
    const Double3 origin = origin_of(objects);
    for (const PlacedObject& object : objects) {
        found.roots_.push_back(root_box(*object.model, object.pose, plan.reach_of(object.layer)));
        boxes.push_back(world_box(found.roots_.back(), origin));
        filters.push_back(plan.filter_of(object.layer));
    }
    const auto count = static_cast<std::uint32_t>(objects.size());
    for (std::uint64_t room = 8 * std::uint64_t{count} + 64;;) {
        BroadPhase broad_phase({.boxes = count, .pairs = static_cast<std::uint32_t>(room)});
        const BroadPhaseUpdate update = broad_phase.update(boxes, filters);
        if (update.complete) {
            found.candidates_.assign(update.pairs.begin(), update.pairs.end());
            return found;
        }
        if (update.needed > kMostCandidates) {
            return Error{ErrorCode::over_budget,
                         "The boxes of " + std::to_string(update.needed) +
                             " pairs of objects meet or are near; at most " +
                             std::to_string(kMostCandidates) +
                             " are supported. Choose a smaller distance, or pair fewer layers."};
        }
        room = update.needed;
    }
}

const LayerPair& ObjectPairs::asked(const BoxPair& candidate) const noexcept {
    const PlacedObject& a = objects_[candidate.a];
    const PlacedObject& b = objects_[candidate.b];
    return plan_->pairs()[*plan_->find_pair(a.layer, b.layer)];
}

Pair ObjectPairs::pair(const BoxPair& candidate) const noexcept {
    const PlacedObject& a = objects_[candidate.a];
    const PlacedObject& b = objects_[candidate.b];
    return {*a.model, *b.model, Placement::world(a.pose, b.pose)};
}

}  // namespace cdprep::cli
