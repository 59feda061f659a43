// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/run/simulation.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "text/number_text.h"

namespace cdprep::scenes {
namespace {

constexpr std::uint32_t kFirstPairs = 1024;   ///< room for pairs and lists at the beginning
constexpr std::uint64_t kPairsPerObject = 8;  ///< likewise
/// Room for twice as many pairs as meet makes the broad phase faster; lists grow seldom.
constexpr std::uint64_t kRoom = 2;
constexpr std::uint64_t kMostRoom = (std::uint64_t{1} << 32) - 1;

std::uint64_t nanoseconds() noexcept {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
}

std::uint32_t room_for(std::uint64_t needed, std::uint32_t now) {
    if (needed == 0) return now;
    return static_cast<std::uint32_t>(std::min(kRoom * needed, kMostRoom));
}

}  // namespace

bool are_equal(const Pose& p, const Pose& q) noexcept {
    return p.rotation() == q.rotation() && p.translation() == q.translation();
}

SceneLimits first_limits(const SceneFile& file, std::uint32_t threads) {
    SceneLimits limits;
    limits.objects = static_cast<std::uint32_t>(file.objects.size());
    limits.threads = threads;
    limits.pairs = file.most_pairs.value_or(static_cast<std::uint32_t>(
        std::max<std::uint64_t>(kFirstPairs, kPairsPerObject * limits.objects)));
    limits.triangle_pairs = limits.contacts = kFirstPairs;
    return limits;
}

Simulation::Simulation(const SceneFile& file, std::span<const SceneModel> models,
                       std::uint32_t threads, ParallelFor parallel_for)
    : file_(&file),
      models_(models),
      parallel_for_(parallel_for),
      limits_(first_limits(file, threads)),
      workspaces_(threads) {}

Result<Simulation> Simulation::make(const SceneFile& file, std::span<const SceneModel> models,
                                    std::uint32_t threads, ParallelFor parallel_for,
                                    BodyPoses body_poses) {
    Simulation simulation(file, models, threads, parallel_for);
    if (Result<Done> made = simulation.make_changing(); !made) return made.error();
    if (body_poses == BodyPoses::computed && has_response(file)) {
        auto response = Response::make(file, models, threads, parallel_for);
        if (!response) return response.error();
        simulation.response_.emplace(std::move(response).value());
    }
    if (Result<Done> filled = simulation.fill(0, {}); !filled) return filled.error();
    return simulation;
}

Result<Done> Simulation::make_changing() {
    changing_of_.assign(file_->objects.size(), kUnchanged);
    const bool has_none = std::ranges::all_of(
        file_->objects, [](const FileObject& object) { return object.change == kUnchanged; });
    if (has_none) return Done{};
    const Plan::Compiled compiled = compile_scene(*file_, limits_);
    if (!compiled.plan) return Error{ErrorCode::bad_argument, compiled.refusals.front()};
    auto made = make_changing_models(*file_, *compiled.plan, models_);
    if (!made) return made.error();
    changing_ = std::move(made).value();
    for (std::uint32_t i = 0; i < changing_.size(); ++i) {
        for (const std::uint32_t object : changing_[i].objects) changing_of_[object] = i;
    }
    return Done{};
}

/// Brings the live models to a time. Returns which of them changed.
Result<std::vector<bool>> Simulation::change(double time_s) {
    std::vector<bool> changed;
    for (ChangingObjects& one : changing_) {
        const Result<ChangeWork> work = one.live.set_time(time_s, parallel_for_);
        if (!work) {
            return Error{work.error().code, file_->name + ": object '" +
                                                file_->objects[one.objects.front()].name +
                                                "': at " + report::number_text(time_s) +
                                                " s: " + work.error().message};
        }
        work_.add(*work);
        changed.push_back(work->refits > 0);
    }
    return changed;
}

const Model& Simulation::model_of(std::uint32_t object) const noexcept {
    const std::uint32_t changing = changing_of_[object];
    if (changing != kUnchanged) return changing_[changing].live.model();
    return *models_[file_->objects[object].model].model;
}

/// Makes a scene, and adds the objects as they are at a time. `poses` are theirs by slot. If there
/// are none, they have those of their motions.
Result<Done> Simulation::fill(double time_s, const std::vector<Pose>& poses) {
    scene_.reset();
    objects_.clear();
    ids_.clear();
    poses_.clear();
    std::vector<std::string> names;
    Plan::Compiled compiled = compile_scene(*file_, limits_, uses_of(*file_, models_, names));
    if (!compiled.plan) return Error{ErrorCode::bad_argument, compiled.refusals.front()};
    plan_ = std::make_unique<const Plan>(std::move(*compiled.plan));
    scene_.emplace(*plan_);
    scene_->set_clock(nanoseconds);
    if (const auto changed = change(time_s); !changed) return changed.error();
    for (std::uint32_t i = 0; i < file_->objects.size(); ++i) {
        const FileObject& object = file_->objects[i];
        if (!is_asked(*file_, *plan_, object)) continue;
        const Result<Pose> pose =
            poses.empty() ? pose_of(*file_, object, time_s) : poses[objects_.size()];
        if (!pose) return pose.error();
        const auto id = scene_->add({&model_of(i), object.layer, *pose});
        if (!id) return Error{ErrorCode::internal, file_->name + ": the scene is full."};
        ids_.push_back(*id);
        poses_.push_back(*pose);
        objects_.push_back(i);
    }
    return Done{};
}

/// The poses of the next frame. Objects without a motion stay where they are.
Result<std::vector<Pose>> Simulation::poses_at(double time_s,
                                               std::span<const GivenPose> given) const {
    std::vector<Pose> poses = poses_;
    for (const GivenPose& one : given) {
        const auto at = std::ranges::lower_bound(objects_, one.object);
        const bool is_asked_for = at != objects_.end() && *at == one.object;
        if (is_asked_for) poses[static_cast<std::size_t>(at - objects_.begin())] = one.pose;
    }
    for (std::size_t slot = 0; slot < poses.size(); ++slot) {
        const FileObject& object = file_->objects[objects_[slot]];
        if (!file_->motions[object.motion].moves()) continue;
        const Result<Pose> pose = pose_of(*file_, object, time_s);
        if (!pose) return pose.error();
        poses[slot] = *pose;
    }
    return poses;
}

/// Brings the scene to a time, with these poses.
Result<Done> Simulation::move(double time_s, const std::vector<Pose>& poses) {
    const auto changed = change(time_s);
    if (!changed) return changed.error();
    for (std::size_t slot = 0; slot < ids_.size(); ++slot) {
        const std::uint32_t changing = changing_of_[objects_[slot]];
        const bool has_changed = changing != kUnchanged && (*changed)[changing];
        if (!has_changed && are_equal(poses[slot], poses_[slot])) continue;
        poses_[slot] = poses[slot];
        if (is_first_frame_) {
            scene_->put(ids_[slot], poses[slot]);
        } else {
            scene_->set_pose(ids_[slot], poses[slot]);
        }
    }
    return Done{};
}

/// Raises the limits that a step found too small.
Result<Done> Simulation::make_room(const SceneStep& step, std::uint64_t frame) {
    const auto refuse = [&](const char* what, std::uint64_t needed, std::uint64_t most) {
        return Error{ErrorCode::over_budget, file_->name + ": frame " + std::to_string(frame) +
                                                 " needs room for " + std::to_string(needed) + " " +
                                                 what + " is " + std::to_string(most) + "."};
    };
    if (file_->most_pairs && step.needed_pairs > *file_->most_pairs) {
        return refuse("pairs, but limits.pairs", step.needed_pairs, *file_->most_pairs);
    }
    const std::uint64_t most =
        std::max({step.needed_pairs, step.needed_triangle_pairs, step.needed_contacts});
    if (most > kMostRoom) return refuse("items in lists, but the maximum", most, kMostRoom);
    limits_.pairs = room_for(step.needed_pairs, limits_.pairs);
    limits_.triangle_pairs = room_for(step.needed_triangle_pairs, limits_.triangle_pairs);
    limits_.contacts = room_for(step.needed_contacts, limits_.contacts);
    return Done{};
}

/// Makes more room. A new scene knows nothing of the last frame, so that is computed again; its
/// events were reported before. With `continuous`, the way to that frame is needed too.
Result<Done> Simulation::grow(SceneStep step, std::uint64_t frame) {
    while (!step.complete) {
        if (Result<Done> made = make_room(step, frame); !made) return made;
        const std::uint64_t wanted = contains(plan_->effects(), Ask::continuous) ? 2 : 1;
        std::uint64_t back = std::min(frame, wanted);
        if (Result<Done> filled = fill(time_of(frame - back), history_[back]); !filled) {
            return filled;
        }
        if (frame == 0) return Done{};
        step = scene_->step(workspaces_, parallel_for_);
        while (--back > 0 && step.complete) {
            Result<Done> moved = move(time_of(frame - back), history_[back]);
            if (!moved) return moved;
            step = scene_->step(workspaces_, parallel_for_);
        }
    }
    return move(time_of(frame), history_[0]);
}

Result<Done> Simulation::step(std::uint64_t frame, std::span<const GivenPose> given) {
    is_first_frame_ = frame == 0;
    if (response_ && frame > 0) {
        if (Result<Done> done = response_->step(time_of(frame)); !done) return done;
        response_seconds_ = response_->seconds();
        given = response_->poses();
    }
    auto poses = poses_at(time_of(frame), given);
    if (!poses) return poses.error();
    std::rotate(history_.begin(), history_.end() - 1, history_.end());
    history_[0] = std::move(poses).value();
    if (frame > 0) work_ = {};
    if (frame > 0 || !given.empty()) {
        if (Result<Done> moved = move(time_of(frame), history_[0]); !moved) return moved;
    }
    bool has_grown = false;
    while (true) {
        const auto begin = std::chrono::steady_clock::now();
        const SceneStep step = scene_->step(workspaces_, parallel_for_);
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        step_seconds_ = taken.count();
        if (step.complete) break;
        const ChangeWork work = work_;
        if (Result<Done> grown = grow(step, frame); !grown) return grown;
        work_ = work;
        has_grown = true;
    }
    if (has_grown) ++grown_steps_;
    return Done{};
}

}  // namespace cdprep::scenes
