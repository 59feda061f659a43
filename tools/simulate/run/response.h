// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cdprep/scene.h"
#include "scene_file/load_models.h"
#include "simulate/dynamics/rigid_bodies.h"

namespace cdprep::scenes {

/// A pose that an object has without a motion: that of a body, or one of a recording.
struct GivenPose {
    std::uint32_t object;  ///< its number in SceneFile::objects
    Pose pose;
};

/// Two objects, by their numbers in SceneFile::objects; a < b.
struct ObjectPair {
    std::uint32_t a;
    std::uint32_t b;

    auto operator<=>(const ObjectPair&) const = default;
};

enum class BodyEventKind : std::uint8_t {
    sleeps,
    wakes,
    impact,  ///< a continuous body meets another one in a substep
};

/// Something that happened to a body in a frame.
struct BodyEvent {
    BodyEventKind kind;
    std::uint32_t body;   ///< the number of an object in SceneFile::objects
    std::uint32_t other;  ///< of an impact: the object that was met; else the body
    double time_s;        ///< of an impact; else of the frame
};

/// Two objects that begin to push each other, go on, or end.
struct PushEvent {
    EventKind kind;
    ObjectPair pair;
};

/// Returns whether a pair of layers asks for `response`.
[[nodiscard]] bool has_response(const SceneFile& scene);

/// Returns the options of the dynamics that a scene file states or leaves to its unit.
[[nodiscard]] dynamics::DynamicsOptions dynamics_options_of(const SceneFile& scene);

/// Returns why `response` cannot be computed with these models, a sentence for each reason. Models
/// that are not open are not judged, nor those that model_refusals() names.
[[nodiscard]] std::vector<std::string> response_refusals(const SceneFile& scene,
                                                         std::span<const SceneModel> models);

/// The objects of a scene that push each other, moved from frame to frame.
class Response {
public:
    /// Adds the objects of all layers that respond, as they are at time 0. Bodies move freely,
    /// objects with a motion are driven, and all others are fixed. All arguments must outlive the
    /// object. Fails if has_response() is false, and as RigidBodies::add_body().
    [[nodiscard]] static Result<Response> make(const SceneFile& file,
                                               std::span<const SceneModel> models,
                                               std::uint32_t threads, ParallelFor parallel_for);

    /// Computes the frame after the last one; frame 0 is first, and computed already. `time_s` is
    /// its time, for driven objects.
    [[nodiscard]] Result<Done> step(double time_s);

    /// Where the bodies are.
    [[nodiscard]] std::span<const GivenPose> poses() const noexcept {
        return poses_;
    }
    /// The objects that push each other at the end of the last frame, rising.
    [[nodiscard]] std::span<const ObjectPair> pushing() const noexcept {
        return pushing_;
    }
    /// How pushing() differs from that of the frame before, in the order of the pairs. Each begin
    /// is followed by one end before the next begin of the pair. A pair that sleeps goes on.
    [[nodiscard]] std::span<const PushEvent> push_events() const noexcept {
        return push_events_;
    }
    /// What happened in the last frame. Impacts come in the order of their times, then bodies that
    /// sleep or wake in the order of their objects.
    [[nodiscard]] std::span<const BodyEvent> events() const noexcept {
        return events_;
    }
    [[nodiscard]] const dynamics::RigidBodies& bodies() const noexcept {
        return *bodies_;
    }
    /// Returns the number of the object of a body, in SceneFile::objects.
    [[nodiscard]] std::uint32_t object_of(std::uint32_t body) const noexcept {
        return objects_[body];
    }
    /// The bodies that move freely, by their places in poses().
    [[nodiscard]] std::span<const std::uint32_t> moving() const noexcept {
        return moving_;
    }
    [[nodiscard]] std::size_t awake_count() const noexcept;
    [[nodiscard]] std::size_t driven_count() const noexcept {
        return driven_.size();
    }
    /// The bodies that move freely and resist as boxes: BodyMass::is_box.
    [[nodiscard]] std::size_t box_count() const noexcept {
        return box_count_;
    }
    /// The wall time of the last step().
    [[nodiscard]] double seconds() const noexcept {
        return seconds_;
    }

private:
    Response(const SceneFile& file, std::unique_ptr<dynamics::RigidBodies> bodies)
        : file_(&file), bodies_(std::move(bodies)) {}
    [[nodiscard]] Result<Done> add(std::uint32_t object, const Model& model);
    [[nodiscard]] Result<Done> drive(double time_s);
    void find_pushing();
    void find_push_events();
    void find_events(double time_s);

    const SceneFile* file_;
    std::unique_ptr<dynamics::RigidBodies> bodies_;
    std::vector<std::uint32_t> objects_;  ///< by body
    std::vector<std::uint32_t> moving_;
    std::vector<std::uint32_t> driven_;
    std::size_t box_count_ = 0;
    std::vector<GivenPose> poses_;  ///< of the moving bodies
    std::vector<ObjectPair> pushing_;
    std::vector<ObjectPair> pushed_;  ///< pushing_ of the frame before
    std::vector<PushEvent> push_events_;
    std::vector<BodyEvent> events_;
    std::vector<bool> sleeps_;  ///< by place in moving_, in the last frame
    double seconds_ = 0;
};

}  // namespace cdprep::scenes
