// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/dynamics/contact_scene.h"

#include <algorithm>
#include <array>
#include <utility>

namespace cdprep::dynamics {
namespace {

// A model that serves Ask::solid also has contacts where a component is inside it.
enum Layer : std::uint32_t {
    moving_solid,
    moving_surface,
    still_solid,
    still_surface,
    layer_count
};

Layer layer_of(const RigidBody& body) {
    const bool solid = body.model->serves(Ask::solid);
    if (body.kind == BodyKind::moving) return solid ? moving_solid : moving_surface;
    return solid ? still_solid : still_surface;
}

LayerPair layer_pair(Layer a, Layer b, const DynamicsOptions& options) {
    LayerPair pair;
    pair.a = a;
    pair.b = b;
    pair.effects = Ask::contacts;
    const bool solid = a == moving_solid && (b == moving_solid || b == still_solid);
    pair.body = solid ? Body::solid : Body::surface;
    pair.contacts = {.tolerance = options.tolerance,
                     .manifold = Manifold::four,
                     .most = options.most_contacts,
                     .cluster_angle = options.cluster_angle};
    return pair;
}

std::vector<LayerPair> layer_pairs(const DynamicsOptions& options) {
    std::vector<LayerPair> pairs;
    for (const Layer a : {moving_solid, moving_surface}) {
        for (const Layer b : {moving_solid, moving_surface, still_solid, still_surface}) {
            if (b >= a) pairs.push_back(layer_pair(a, b, options));
        }
    }
    return pairs;
}

}  // namespace

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
