// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/scene.h"
#include "simulate/dynamics/rigid_bodies.h"

namespace cdprep::dynamics {

/// How fast a body is. Slow bodies have contacts in a smaller distance, which takes less time.
enum class Pace : std::uint8_t { slow, fast };

/// The speed up to which a body is slow. In a substep, two such bodies meet no surface that is
/// beyond their distance of contacts.
[[nodiscard]] double slow_speed(const DynamicsOptions& options) noexcept;

/// The collision world: a scene that computes contacts, and grows as it must. The slot of an object
/// is its number.
class ContactScene {
public:
    ContactScene(const DynamicsOptions& options, ParallelFor parallel_for);

    /// Fails with bad_argument if the groups and kinds of the bodies need too many layers.
    [[nodiscard]] Result<Done> add(const RigidBody& body);
    void set_pose(std::uint32_t object, const Pose& world_from_model);
    /// Returns whether contacts of two objects are looked for.
    [[nodiscard]] bool are_paired(std::uint32_t a, std::uint32_t b) const {
        return push_each_other(layers_[objects_[a].layer], layers_[objects_[b].layer]);
    }
    /// Of a moving or driven body.
    void set_pace(std::uint32_t object, Pace pace);
    /// Finds the contacts of all objects as they are now.
    [[nodiscard]] Result<Done> step();

    [[nodiscard]] std::span<const SceneContacts> contacts() const noexcept {
        return scene_->contacts();
    }
    [[nodiscard]] const SceneCounts& counts() const noexcept {
        return scene_->counts();
    }
    [[nodiscard]] std::size_t bytes() const noexcept {
        return plan_ ? Scene::size(*plan_) : 0;
    }
    [[nodiscard]] Workspace& workspace() noexcept {
        return workspaces_.front();
    }

private:
    /// The bodies that have contacts in the same distance with the same others.
    struct BodyLayer {
        std::uint32_t group;
        bool solid;  ///< the models serve Ask::solid
        bool still;  ///< fixed or driven
        Pace pace;   ///< of fixed ones: slow

        bool operator==(const BodyLayer&) const = default;
    };

    [[nodiscard]] std::uint32_t layer_of(const BodyLayer& layer);
    [[nodiscard]] bool push_each_other(const BodyLayer& a, const BodyLayer& b) const;
    [[nodiscard]] LayerPair layer_pair(std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] std::vector<LayerPair> layer_pairs() const;
    [[nodiscard]] Result<Done> fill();
    void grow(const SceneStep& step);

    DynamicsOptions options_;
    ParallelFor parallel_for_;
    SceneLimits limits_;
    std::vector<Workspace> workspaces_;
    std::vector<BodyLayer> layers_;  ///< those that occur, in the order of their bodies
    std::vector<SceneObject> objects_;
    std::vector<ObjectId> ids_;
    std::unique_ptr<const Plan> plan_;  ///< outlives the scene
    std::optional<Scene> scene_;
};

}  // namespace cdprep::dynamics
