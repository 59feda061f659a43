// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/dynamics/contact_scene.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace cdprep::dynamics {
namespace {

/// The part of the way of a substep that slow bodies go.
constexpr double kSlowShare = 0.125;

double slow_way(const DynamicsOptions& options) {
    return kSlowShare * (options.tolerance - options.rest_gap);
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

/// Returns the number of a layer, also of one that does not occur yet.
std::uint32_t ContactScene::layer_of(const BodyLayer& layer) {
    const auto at = std::ranges::find(layers_, layer);
    const auto number = static_cast<std::uint32_t>(at - layers_.begin());
    if (at == layers_.end()) layers_.push_back(layer);
    return number;
}

Result<Done> ContactScene::add(const RigidBody& body) {
    const std::size_t before = layers_.size();
    const bool still = body.kind != BodyKind::moving;
    BodyLayer layer{body.group, body.model->serves(Ask::solid), still, Pace::slow};
    std::uint32_t number = layer_of(layer);
    layer.pace = Pace::fast;
    // Until its speed is known.
    if (body.kind != BodyKind::fixed) number = layer_of(layer);
    const std::size_t needed = layers_.size();
    if (needed > kLayers) {
        layers_.resize(before);
        return Error{ErrorCode::bad_argument, body.name + ": the groups and kinds of bodies need " +
                                                  std::to_string(needed) + " layers; at most " +
                                                  std::to_string(kLayers) + " are supported."};
    }
    objects_.push_back({body.model, number, body.world_from_model});
    scene_.reset();
    return Done{};
}

bool ContactScene::push_each_other(const BodyLayer& a, const BodyLayer& b) const {
    if (a.still && b.still) return false;
    return options_.groups.empty() || std::ranges::any_of(options_.groups, [&](const auto& pair) {
               return std::minmax(pair.first, pair.second) == std::minmax(a.group, b.group);
           });
}

/// A model that serves Ask::solid also has contacts where a component is inside it.
LayerPair ContactScene::layer_pair(std::uint32_t a, std::uint32_t b) const {
    const BodyLayer &first = layers_[a], &second = layers_[b];
    const bool slow = first.pace == Pace::slow && second.pace == Pace::slow;
    LayerPair pair;
    pair.a = a;
    pair.b = b;
    pair.effects = Ask::contacts;
    pair.body = first.solid && second.solid ? Body::solid : Body::surface;
    pair.contacts = {
        .tolerance = slow ? options_.rest_gap + slow_way(options_) : options_.tolerance,
        .manifold = Manifold::four,
        .most = options_.most_contacts,
        .cluster_angle = options_.cluster_angle};
    return pair;
}

std::vector<LayerPair> ContactScene::layer_pairs() const {
    std::vector<LayerPair> pairs;
    for (std::uint32_t a = 0; a < layers_.size(); ++a) {
        for (std::uint32_t b = a; b < layers_.size(); ++b) {
            if (push_each_other(layers_[a], layers_[b])) pairs.push_back(layer_pair(a, b));
        }
    }
    return pairs;
}

void ContactScene::set_pose(std::uint32_t object, const Pose& world_from_model) {
    objects_[object].world_from_model = world_from_model;
    if (scene_) scene_->set_pose(ids_[object], world_from_model);
}

void ContactScene::set_pace(std::uint32_t object, Pace pace) {
    BodyLayer wanted = layers_[objects_[object].layer];
    wanted.pace = pace;
    const std::uint32_t layer = layer_of(wanted);
    if (layer == objects_[object].layer) return;
    objects_[object].layer = layer;
    if (scene_) scene_->set_layer(ids_[object], layer);
}

/// Makes a scene of all objects.
Result<Done> ContactScene::fill() {
    scene_.reset();
    limits_.objects = static_cast<std::uint32_t>(objects_.size());
    const std::vector<LayerPair> pairs = layer_pairs();
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
