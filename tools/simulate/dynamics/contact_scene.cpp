// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/dynamics/contact_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cdprep::dynamics {
namespace {

// A model that serves Ask::solid also has contacts where a component is inside it. Solids come
// first.
enum Layer : std::uint32_t {
    slow_solid,
    fast_solid,
    still_solid,
    slow_surface,
    fast_surface,
    still_surface,
    layer_count
};

bool is_solid(std::uint32_t layer) {
    return layer < slow_surface;
}
bool is_still(std::uint32_t layer) {
    return layer == still_solid || layer == still_surface;
}
bool is_slow(std::uint32_t layer) {
    return !(layer == fast_solid || layer == fast_surface);
}

std::uint32_t layer_of(const RigidBody& body) {
    const bool solid = body.model->serves(Ask::solid);
    if (body.kind == BodyKind::moving) return solid ? fast_solid : fast_surface;
    return solid ? still_solid : still_surface;
}

/// The part of the way of a substep that slow bodies go.
constexpr double kSlowShare = 0.125;

double slow_way(const DynamicsOptions& options) {
    return kSlowShare * (options.tolerance - options.rest_gap);
}

LayerPair layer_pair(std::uint32_t a, std::uint32_t b, const DynamicsOptions& options) {
    LayerPair pair;
    pair.a = a;
    pair.b = b;
    pair.effects = Ask::contacts;
    pair.body = is_solid(a) && is_solid(b) ? Body::solid : Body::surface;
    const bool slow = is_slow(a) && is_slow(b);
    pair.contacts = {.tolerance = slow ? options.rest_gap + slow_way(options) : options.tolerance,
                     .manifold = Manifold::four,
                     .most = options.most_contacts,
                     .cluster_angle = options.cluster_angle};
    return pair;
}

std::vector<LayerPair> layer_pairs(const DynamicsOptions& options) {
    std::vector<LayerPair> pairs;
    for (std::uint32_t a = 0; a < layer_count; ++a) {
        for (std::uint32_t b = a; b < layer_count; ++b) {
            if (!(is_still(a) && is_still(b))) pairs.push_back(layer_pair(a, b, options));
        }
    }
    return pairs;
}

}  // namespace

double slow_speed(const DynamicsOptions& options) noexcept {
    const double substep_s = options.step_s / options.substeps;
    const Double3& g = options.gravity;
    const double fall = std::sqrt(g.x * g.x + g.y * g.y + g.z * g.z) * substep_s;
    return slow_way(options) / substep_s / 2 - fall;
}

ContactScene::ContactScene(const DynamicsOptions& options, ParallelFor parallel_for)
    : options_(options), parallel_for_(parallel_for), workspaces_(options.threads) {
    limits_ = {.objects = 0, .pairs = 64, .threads = options.threads, .contacts = 1024};
}

void ContactScene::add(const RigidBody& body) {
    objects_.push_back({body.model, layer_of(body), body.world_from_model});
    scene_.reset();
}

void ContactScene::set_pose(std::uint32_t object, const Pose& world_from_model) {
    objects_[object].world_from_model = world_from_model;
    if (scene_) scene_->set_pose(ids_[object], world_from_model);
}

void ContactScene::set_pace(std::uint32_t object, Pace pace) {
    const bool solid = is_solid(objects_[object].layer);
    const std::uint32_t slow = solid ? slow_solid : slow_surface;
    const std::uint32_t fast = solid ? fast_solid : fast_surface;
    const std::uint32_t layer = pace == Pace::slow ? slow : fast;
    if (layer == objects_[object].layer) return;
    objects_[object].layer = layer;
    if (scene_) scene_->set_layer(ids_[object], layer);
}

/// Makes a scene of all objects.
Result<Done> ContactScene::fill() {
    scene_.reset();
    limits_.objects = static_cast<std::uint32_t>(objects_.size());
    const std::vector<LayerPair> pairs = layer_pairs(options_);
    Plan::Compiled compiled = Plan::compile({.pairs = pairs, .limits = limits_});
    if (!compiled.plan) return Error{ErrorCode::bad_argument, compiled.refusals.front()};
    plan_ = std::make_unique<const Plan>(std::move(*compiled.plan));
    scene_.emplace(*plan_);
    ids_.clear();
    for (const SceneObject& object : objects_) {
        const auto id = scene_->add(object);
        if (!id) return Error{ErrorCode::internal, "The scene of the bodies is full."};
        ids_.push_back(*id);
    }
    return Done{};
}

void ContactScene::grow(const SceneStep& step) {
    // The largest number for which twice as much still fits.
    constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
    const auto room = [](std::uint64_t needed, std::uint32_t now) {
        return needed == 0 ? now : static_cast<std::uint32_t>(2 * std::min(needed, kMost - 1));
    };
    limits_.pairs = room(step.needed_pairs, limits_.pairs);
    limits_.contacts = room(step.needed_contacts, limits_.contacts);
}

Result<Done> ContactScene::step() {
    if (!scene_) {
        if (Result<Done> filled = fill(); !filled) return filled;
    }
    while (true) {
        const SceneStep step = scene_->step(workspaces_, parallel_for_);
        if (step.complete) return Done{};
        grow(step);
        if (Result<Done> filled = fill(); !filled) return filled;
    }
}

}  // namespace cdprep::dynamics
