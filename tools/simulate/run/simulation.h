// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/scene.h"
#include "scene_file/changing_model.h"
#include "scene_file/load_models.h"
#include "simulate/run/response.h"

namespace cdprep::scenes {

/// Where the poses of bodies come from.
enum class BodyPoses : std::uint8_t {
    computed,  ///< from contacts and gravity, if a pair of layers asks for `response`
    given,     ///< from the caller
};

/// Returns whether two poses have the same numbers.
[[nodiscard]] bool are_equal(const Pose& p, const Pose& q) noexcept;

/// Returns the room that a simulation begins with.
[[nodiscard]] SceneLimits first_limits(const SceneFile& file, std::uint32_t threads);

/// The objects of a scene file, moved from frame to frame.
class Simulation {
public:
    /// Adds the objects that pairs of layers ask for, as they are at time 0. All arguments must
    /// outlive the object. The models must serve the plan of the file. Objects that deform or tear
    /// get live models: fails as make_changing_models(). Also fails as Response::make().
    [[nodiscard]] static Result<Simulation> make(const SceneFile& file,
                                                 std::span<const SceneModel> models,
                                                 std::uint32_t threads, ParallelFor parallel_for,
                                                 BodyPoses body_poses = BodyPoses::computed);

    /// Computes a frame; 0 is first. Objects whose pose and shape have not changed count as not
    /// moved. If the frame needs more room, makes it, unless the file limits the pairs: then fails
    /// with over_budget. Fails with bad_argument if an object leaves the range of coordinates.
    /// Objects with a given pose have it from this frame on, unless their motion moves them. With
    /// computed poses of bodies, frames must come one after the other, and no pose is given.
    [[nodiscard]] Result<Done> step(std::uint64_t frame, std::span<const GivenPose> given = {});

    /// Results of the last frame. The ticks of its counts are nanoseconds.
    [[nodiscard]] const Scene& scene() const noexcept {
        return *scene_;
    }
    [[nodiscard]] const Plan& plan() const noexcept {
        return *plan_;
    }
    [[nodiscard]] std::span<const SceneModel> models() const noexcept {
        return models_;
    }
    [[nodiscard]] const FileObject& object(ObjectId id) const noexcept {
        return file_->objects[objects_[id.slot]];
    }
    /// The poses in the last frame, by slot. Slots are in the order of the objects in the file.
    [[nodiscard]] std::span<const Pose> poses() const noexcept {
        return poses_;
    }
    /// Returns the number of the object in a slot, in SceneFile::objects.
    [[nodiscard]] std::uint32_t object_number(std::size_t slot) const noexcept {
        return objects_[slot];
    }
    /// The bodies, or null if their poses are given or no pair of layers asks for `response`.
    [[nodiscard]] const Response* response() const noexcept {
        return response_ ? &*response_ : nullptr;
    }
    /// The wall time that `response` took for the last frame.
    [[nodiscard]] double response_seconds() const noexcept {
        return response_seconds_;
    }
    /// The wall time of the last frame: `response`, the changes of live models, and the library's
    /// step.
    [[nodiscard]] double frame_seconds() const noexcept {
        return step_seconds_ + response_seconds_ + work_.seconds;
    }
    [[nodiscard]] std::size_t thread_count() const noexcept {
        return workspaces_.size();
    }
    [[nodiscard]] std::uint64_t grown_steps() const noexcept {
        return grown_steps_;
    }
    /// The live models, as they are in the last frame.
    [[nodiscard]] std::span<const ChangingObjects> changing() const noexcept {
        return changing_;
    }
    /// What the live models of the last frame took. Work that was repeated for more room is left
    /// out, but after it other subtrees may be rebuilt than without it.
    [[nodiscard]] const ChangeWork& change_work() const noexcept {
        return work_;
    }

private:
    Simulation(const SceneFile& file, std::span<const SceneModel> models, std::uint32_t threads,
               ParallelFor parallel_for);

    [[nodiscard]] Result<Done> make_changing();
    [[nodiscard]] Result<Done> fill(double time_s, const std::vector<Pose>& poses);
    [[nodiscard]] Result<std::vector<bool>> change(double time_s);
    [[nodiscard]] const Model& model_of(std::uint32_t object) const noexcept;
    [[nodiscard]] Result<std::vector<Pose>> poses_at(double time_s,
                                                     std::span<const GivenPose> given) const;
    [[nodiscard]] Result<Done> move(double time_s, const std::vector<Pose>& poses);
    [[nodiscard]] Result<Done> make_room(const SceneStep& step, std::uint64_t frame);
    [[nodiscard]] Result<Done> grow(SceneStep step, std::uint64_t frame);
    [[nodiscard]] double time_of(std::uint64_t frame) const noexcept {
        return static_cast<double>(frame) * file_->step_s;
    }

    const SceneFile* file_;
    std::span<const SceneModel> models_;
    ParallelFor parallel_for_;
    SceneLimits limits_;
    std::vector<Workspace> workspaces_;   ///< one for each thread
    std::vector<std::uint32_t> objects_;  ///< by slot
    std::vector<ObjectId> ids_;           ///< by slot
    std::vector<Pose> poses_;             ///< by slot, as the scene has them
    /// The poses of this frame, the last one and the one before. Growing repeats these frames.
    std::array<std::vector<Pose>, 3> history_;
    std::optional<Response> response_;
    double response_seconds_ = 0;
    std::vector<ChangingObjects> changing_;
    std::vector<std::uint32_t> changing_of_;  ///< by object: its number in changing_, or kUnchanged
    std::unique_ptr<const Plan> plan_;        ///< outlives the scene
    std::optional<Scene> scene_;
    bool is_first_frame_ = true;  ///< objects have no way before it
    double step_seconds_ = 0;     ///< of the library; without poses, more room and `response`
    ChangeWork work_;
    std::uint64_t grown_steps_ = 0;
};

}  // namespace cdprep::scenes
