// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/run/response.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "scene_file/compile_scene.h"
#include "simulate/dynamics/body_mass.h"
#include "text/printable.h"

namespace cdprep::scenes {
namespace {

// In metres, kilograms and seconds. A body may come to rest at half a millimetre, and a hand moves
// things at 2 m/s.
constexpr double kRestGap = 5e-4;
constexpr double kMostSpeed = 2;
constexpr double kSleepSpeed = 1e-2;
constexpr double kDensity = 1000;  ///< of water
/// The tolerance is so many times what most_speed needs.
constexpr double kMargin = 1.1;

/// Returns the unit of the models, or a metre if it is not stated.
double metres_per_unit(const SceneFile& scene) {
    return scene.metres_per_unit > 0 ? scene.metres_per_unit : 1;
}

dynamics::BodyKind kind_of(const SceneFile& scene, const FileObject& object) {
    if (object.body != kNoBody) return dynamics::BodyKind::moving;
    return scene.motions[object.motion].moves() ? dynamics::BodyKind::driven
                                                : dynamics::BodyKind::fixed;
}

dynamics::RigidBody rigid_body_of(const SceneFile& scene, const FileObject& object) {
    dynamics::RigidBody body;
    body.name = scene.name + ": object '" + report::printable(object.name) + "'";
    body.kind = kind_of(scene, object);
    body.group = object.layer;
    body.friction = object.material.friction;
    body.restitution = object.material.restitution;
    if (object.body == kNoBody) return body;
    const BodyMotion& motion = scene.bodies[object.body];
    const double unit = metres_per_unit(scene);
    body.mass = motion.mass;
    body.density = motion.density.value_or(kDensity * unit * unit * unit);
    body.linear_damping = motion.linear_damping;
    body.angular_damping = motion.angular_damping;
    body.velocity = motion.velocity;
    body.angular_velocity = motion.turn;
    body.is_continuous = motion.is_continuous;
    return body;
}

}  // namespace

bool has_response(const SceneFile& scene) {
    return std::ranges::any_of(scene.pairs, [](const AskedPair& pair) {
        return contains(pair.asked.effects, Ask::response);
    });
}

dynamics::DynamicsOptions dynamics_options_of(const SceneFile& scene) {
    const Dynamics& given = scene.dynamics;
    const double unit = metres_per_unit(scene);
    dynamics::DynamicsOptions options;
    options.gravity = given.gravity.value_or(Double3{});
    options.step_s = scene.step_s;
    options.substeps = given.substeps;
    options.iterations = given.iterations;
    options.rest_gap = given.rest_gap.value_or(kRestGap / unit);
    options.most_speed = given.most_speed.value_or(kMostSpeed / unit);
    const double way = options.most_speed * options.step_s / options.substeps;
    options.tolerance = given.tolerance.value_or(kMargin * (options.rest_gap + way));
    options.sleep_speed = given.sleep_speed.value_or(kSleepSpeed / unit);
    options.most_contacts = given.most_contacts;
    options.sleeps = given.sleeps;
    for (const AskedPair& pair : scene.pairs) {
        if (!contains(pair.asked.effects, Ask::response)) continue;
        options.groups.emplace_back(pair.asked.a, pair.asked.b);
    }
    return options;
}

std::vector<std::string> response_refusals(const SceneFile& scene,
                                           std::span<const SceneModel> models) {
    std::vector<std::string> refusals;
    if (!has_response(scene)) return refusals;
    const auto made = dynamics::make_rigid_bodies(dynamics_options_of(scene));
    if (!made) refusals.push_back(scene.name + ": response: " + made.error().message);
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;  // models and bodies
    std::vector<bool> is_refused;                            // by model_refusals()
    for (const SceneModel& model : models) {
        is_refused.push_back(lacking_asks(model) != Ask::nothing);
    }
    for (const FileObject& object : scene.objects) {
        const SceneModel& opened = models[object.model];
        if (!responds(scene, object.layer) || !opened.model) continue;
        if (is_refused[object.model] || object.body == kNoBody) continue;
        if (!seen.insert({object.model, object.body}).second) continue;
        dynamics::RigidBody body = rigid_body_of(scene, object);
        body.model = &*opened.model;
        const Result<dynamics::BodyMass> mass = dynamics::mass_of(body);
        if (!mass) refusals.push_back(mass.error().message);
    }
    const bool lacks_some = std::ranges::any_of(models, [](const SceneModel& model) {
        return !model.model && model.needs.asks != Ask::nothing;
    });
    if (!refusals.empty() || lacks_some || std::ranges::count(is_refused, true) > 0) {
        return refusals;
    }
    // What else may be wrong is found where the bodies are made.
    const Result<Response> whole = Response::make(scene, models, 1, serial_for);
    if (!whole) refusals.push_back(whole.error().message);
    return refusals;
}

Result<Response> Response::make(const SceneFile& file, std::span<const SceneModel> models,
                                std::uint32_t threads, ParallelFor parallel_for) {
    dynamics::DynamicsOptions options = dynamics_options_of(file);
    options.threads = threads;
    auto bodies = dynamics::make_rigid_bodies(options, parallel_for);
    if (!bodies) return bodies.error();
    Response response(file, std::move(bodies).value());
    for (std::uint32_t i = 0; i < file.objects.size(); ++i) {
        const FileObject& object = file.objects[i];
        if (!responds(file, object.layer)) continue;
        const Result<Done> added = response.add(i, *models[object.model].model);
        if (!added) return added.error();
    }
    return response;
}

Result<Done> Response::add(std::uint32_t object, const Model& model) {
    const FileObject& described = file_->objects[object];
    const Result<Pose> start = pose_of(*file_, described, 0);
    if (!start) return start.error();
    dynamics::RigidBody body = rigid_body_of(*file_, described);
    body.model = &model;
    body.world_from_model = *start;
    const Result<std::uint32_t> number = bodies_->add_body(body);
    if (!number) return number.error();
    objects_.push_back(object);
    if (body.kind == dynamics::BodyKind::driven) driven_.push_back(*number);
    if (body.kind == dynamics::BodyKind::moving) {
        box_count_ += dynamics::mass_of(body)->is_box ? 1 : 0;
        moving_.push_back(*number);
        poses_.push_back({object, *start});
        sleeps_.push_back(false);
    }
    return Done{};
}

Result<Done> Response::drive(double time_s) {
    for (const std::uint32_t body : driven_) {
        const Result<Pose> pose = pose_of(*file_, file_->objects[objects_[body]], time_s);
        if (!pose) return pose.error();
        // An object that stands still wakes nothing.
        const Pose& now = bodies_->pose(body);
        if (pose->rotation() == now.rotation() && pose->translation() == now.translation()) {
            continue;
        }
        if (Result<Done> driven = bodies_->drive(body, *pose); !driven) return driven;
    }
    return Done{};
}

std::size_t Response::awake_count() const noexcept {
    return static_cast<std::size_t>(std::ranges::count_if(
        moving_, [&](std::uint32_t body) { return !bodies_->is_asleep(body); }));
}

/// Bodies are in the order of their objects, and so are contacts.
void Response::find_pushing() {
    pushed_.swap(pushing_);
    pushing_.clear();
    for (const dynamics::BodyContact& contact : bodies_->contacts()) {
        const ObjectPair pair = {objects_[contact.a], objects_[contact.b]};
        if (contact.impulse <= 0 || (!pushing_.empty() && pushing_.back() == pair)) continue;
        pushing_.push_back(pair);
    }
}

/// Both lists of pairs rise.
void Response::find_push_events() {
    push_events_.clear();
    auto before = pushed_.begin();
    for (const ObjectPair& pair : pushing_) {
        for (; before != pushed_.end() && *before < pair; ++before) {
            push_events_.push_back({EventKind::ends, *before});
        }
        const bool stays = before != pushed_.end() && *before == pair;
        push_events_.push_back({stays ? EventKind::stays : EventKind::begins, pair});
        if (stays) ++before;
    }
    for (; before != pushed_.end(); ++before) push_events_.push_back({EventKind::ends, *before});
}

void Response::find_events(double time_s) {
    events_.clear();
    for (const dynamics::BodyImpact& impact : bodies_->impacts()) {
        events_.push_back(
            {BodyEventKind::impact, objects_[impact.body], objects_[impact.other], impact.time_s});
    }
    std::ranges::stable_sort(events_, {}, &BodyEvent::time_s);
    for (std::size_t i = 0; i < moving_.size(); ++i) {
        const bool sleeps = bodies_->is_asleep(moving_[i]);
        if (sleeps == sleeps_[i]) continue;
        sleeps_[i] = sleeps;
        const std::uint32_t object = objects_[moving_[i]];
        events_.push_back(
            {sleeps ? BodyEventKind::sleeps : BodyEventKind::wakes, object, object, time_s});
    }
}

Result<Done> Response::step(double time_s) {
    if (Result<Done> driven = drive(time_s); !driven) return driven;
    const auto begin = std::chrono::steady_clock::now();
    if (Result<Done> stepped = bodies_->step(); !stepped) return stepped;
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    seconds_ = taken.count();
    for (std::size_t i = 0; i < moving_.size(); ++i) poses_[i].pose = bodies_->pose(moving_[i]);
    find_pushing();
    find_push_events();
    find_events(time_s);
    return Done{};
}

}  // namespace cdprep::scenes
