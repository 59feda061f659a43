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
struct Part {
    std::uint32_t object;  ///< its number in SceneFile::objects
    std::uint32_t layer;
    const Model* model;
    Pose pose;
};

/// Returns the objects of a scene that pairs of layers ask for. The models must outlive the result.
/// Fails with bad_argument if one leaves the range of coordinates.
[[nodiscard]] Result<std::vector<Part>> parts_of(const scenes::SceneFile& scene, const Plan& plan,
                                                 std::span<const scenes::SceneModel> models);

/// Returns the diagonal of the axis-aligned box around all parts, rounded up a little; 0 without
/// triangles.
[[nodiscard]] double size_of(std::span<const Part> parts);

/// The pairs of parts that may be near enough for what their layers are asked.
class PartPairs {
public:
    /// Finds them by their boxes. The arguments must outlive the object. Fails with over_budget if
    /// there are more pairs than a list can hold.
    [[nodiscard]] static Result<PartPairs> find(std::span<const Part> parts, const Plan& plan);

    /// The number of pairs of parts whose layers are paired.
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
    /// Returns both parts, each moved by its own pose.
    [[nodiscard]] Pair pair(const BoxPair& candidate) const noexcept;

private:
    PartPairs(std::span<const Part> parts, const Plan& plan) : parts_(parts), plan_(&plan) {}

    std::span<const Part> parts_;
    const Plan* plan_;
    std::vector<RootBox> roots_;
    std::vector<BoxPair> candidates_;
    std::uint64_t possible_ = 0;
};

}  // namespace cdprep::cli
