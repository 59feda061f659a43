// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/object_box.h"
#include "cdprep/pairs.h"
#include "cdprep/plan.h"
#include "scene_file/load_models.h"

namespace cdprep::cli {

/// An object of a scene at time 0.
struct PlacedObject {
    std::uint32_t number;  ///< in SceneFile::objects
    std::uint32_t layer;
    const Model* model;
    Pose pose;
};

/// Returns the objects of a scene that pairs of layers ask for. The models must outlive the result.
/// Fails with bad_argument if one leaves the range of coordinates.
[[nodiscard]] Result<std::vector<PlacedObject>> objects_of(
    const scenes::SceneFile& scene, const Plan& plan, std::span<const scenes::SceneModel> models);

/// Returns the diagonal of the axis-aligned box around all objects, rounded up a little; 0 without
/// triangles.
[[nodiscard]] double size_of(std::span<const PlacedObject> objects);

/// The pairs of objects that may be near enough for what their layers are asked.
class ObjectPairs {
public:
    /// Finds them by their boxes. The arguments must outlive the object. Fails with over_budget if
    /// there are more pairs than a list can hold.
    [[nodiscard]] static Result<ObjectPairs> find(std::span<const PlacedObject> objects,
                                                  const Plan& plan);

    /// The number of pairs of objects whose layers are paired.
    [[nodiscard]] std::uint64_t possible() const noexcept {
        return possible_;
    }
    /// The pairs whose axis-aligned boxes meet, sorted.
    [[nodiscard]] std::span<const BoxPair> candidates() const noexcept {
        return candidates_;
    }
    /// Returns false if the boxes of a candidate along the axes of its models are apart.
    [[nodiscard]] bool may_meet(const BoxPair& candidate) const noexcept {
        return cdprep::may_meet(roots_[candidate.a], roots_[candidate.b]);
    }
    /// Returns what the layers of a candidate are asked.
    [[nodiscard]] const LayerPair& asked(const BoxPair& candidate) const noexcept;
    /// Returns both objects, each moved by its own pose.
    [[nodiscard]] Pair pair(const BoxPair& candidate) const noexcept;

private:
    ObjectPairs(std::span<const PlacedObject> objects, const Plan& plan)
        : objects_(objects), plan_(&plan) {}

    std::span<const PlacedObject> objects_;
    const Plan* plan_;
    std::vector<RootBox> roots_;
    std::vector<BoxPair> candidates_;
    std::uint64_t possible_ = 0;
};

}  // namespace cdprep::cli
