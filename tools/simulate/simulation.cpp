// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/simulation.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

namespace cdprep::scenes {
namespace {

constexpr std::uint64_t kFirstPairs = 1024;   ///< room for pairs at the beginning
constexpr std::uint64_t kPairsPerObject = 8;  ///< likewise
/// Room for twice as many pairs as meet makes the broad phase faster.
constexpr std::uint64_t kRoom = 2;
constexpr std::uint64_t kMostPairs = (std::uint64_t{1} << 32) - 1;

bool are_equal(const Pose& p, const Pose& q) {
    return p.rotation() == q.rotation() && p.translation() == q.translation();
}

}  // namespace

Simulation::Simulation(const SceneFile& file, std::span<const SceneModel> models,
                       std::uint32_t threads, ParallelFor parallel_for)
    : file_(&file), models_(models), parallel_for_(parallel_for), workspaces_(threads) {}

Result<Simulation> Simulation::make(const SceneFile& file, std::span<const SceneModel> models,
                                    std::uint32_t threads, ParallelFor parallel_for) {
    Simulation simulation(file, models, threads, parallel_for);
    const std::uint64_t pairs = file.most_pairs.value_or(
        static_cast<std::uint32_t>(std::max(kFirstPairs, kPairsPerObject * file.objects.size())));
    if (Result<Done> filled = simulation.fill(pairs, 0); !filled) return filled.error();
    return simulation;
}

/// Makes a scene with room for `pairs`, and adds the objects as they are at a time.
Result<Done> Simulation::fill(std::uint64_t pairs, double time_s) {
    scene_.reset();
    objects_.clear();
    ids_.clear();
    poses_.clear();
    const SceneLimits limits = {.objects = static_cast<std::uint32_t>(file_->objects.size()),
                                .pairs = static_cast<std::uint32_t>(std::min(pairs, kMostPairs)),
                                .threads = static_cast<std::uint32_t>(workspaces_.size())};
    Plan::Compiled compiled = compile_scene(*file_, limits);
    if (!compiled.plan) return Error{ErrorCode::bad_argument, compiled.refusals.front()};
    plan_ = std::make_unique<const Plan>(std::move(*compiled.plan));
    scene_.emplace(*plan_);
    for (std::uint32_t i = 0; i < file_->objects.size(); ++i) {
        const FileObject& object = file_->objects[i];
        if (!is_asked(*plan_, object)) continue;
        const Result<Pose> pose = pose_of(*file_, object, time_s);
        if (!pose) return pose.error();
        const auto id = scene_->add({&*models_[object.model].model, object.layer, *pose});
        if (!id) return Error{ErrorCode::internal, file_->name + ": the scene is full."};
        ids_.push_back(*id);
        poses_.push_back(*pose);
        objects_.push_back(i);
    }
    return Done{};
}

Result<Done> Simulation::move(double time_s) {
    for (std::size_t slot = 0; slot < ids_.size(); ++slot) {
        const FileObject& object = file_->objects[objects_[slot]];
        if (!file_->motions[object.motion].moves()) continue;
        const Result<Pose> pose = pose_of(*file_, object, time_s);
        if (!pose) return pose.error();
        if (are_equal(*pose, poses_[slot])) continue;
        poses_[slot] = *pose;
        scene_->set_pose(ids_[slot], *pose);
    }
    return Done{};
}

/// Makes room for more pairs. A new scene knows nothing of the last frame, so that is computed
/// again; its events were reported before.
Result<Done> Simulation::grow(std::uint64_t pairs, std::uint64_t frame) {
    std::uint64_t needed = pairs;
    do {
        if (Result<Done> filled = fill(kRoom * needed, time_of(frame == 0 ? 0 : frame - 1));
            !filled) {
            return filled;
        }
        if (frame == 0) return Done{};
        const SceneStep before = scene_->step(workspaces_, parallel_for_);
        needed = before.complete ? 0 : before.needed_pairs;
    } while (needed != 0);
    return move(time_of(frame));
}

Result<Done> Simulation::step(std::uint64_t frame) {
    if (frame > 0) {
        if (Result<Done> moved = move(time_of(frame)); !moved) return moved;
    }
    bool has_grown = false;
    while (true) {
        const auto begin = std::chrono::steady_clock::now();
        const SceneStep step = scene_->step(workspaces_, parallel_for_);
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        step_seconds_ = taken.count();
        if (step.complete) break;
        if (file_->most_pairs || step.needed_pairs > kMostPairs) {
            return Error{ErrorCode::over_budget,
                         file_->name + ": frame " + std::to_string(frame) + " needs room for " +
                             std::to_string(step.needed_pairs) + " pairs, but limits.pairs is " +
                             std::to_string(plan_->limits().pairs) + "."};
        }
        if (Result<Done> grown = grow(step.needed_pairs, frame); !grown) return grown;
        has_grown = true;
    }
    if (has_grown) ++grown_steps_;
    return Done{};
}

}  // namespace cdprep::scenes
