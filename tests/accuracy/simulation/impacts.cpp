// SPDX-License-Identifier: MIT
// Bodies that hit something.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "accuracy/simulation/table.h"
#include "accuracy/simulation/worlds.h"

namespace cdprep::test {
namespace {

constexpr double kGravity = 9.81;

/// A sphere flies at a shell, which its surface passes within a substep. Returns how far its centre
/// came beyond the shell.
double fly_at_shell(Engine engine, bool is_continuous) {
    const dynamics::DynamicsOptions options{
        .gravity = {0, 0, 0}, .substeps = 1, .tolerance = 1e-3, .rest_gap = 1e-4, .most_speed = 0};
    const auto world = make_world(engine, options);
    world->add({.half = {0.5, 0.5, 5e-4}, .mass = 0});
    const auto sphere = world->add({.form = Form::sphere,
                                    .radius = 0.1,
                                    .at = {0.013, 0.021, 1},
                                    .velocity = {0, 0, -10},
                                    .is_continuous = is_continuous});
    double lowest = std::numeric_limits<double>::infinity();
    for (int frame = 0; frame < 60; ++frame) {
        world->step();
        lowest = std::min(lowest, world->position(sphere).z);
    }
    return std::max(0.1 - lowest, 0.0);
}

/// A tiny sphere flies at a triangle. Returns the relative error of the time of the impact.
double time_bullet() {
    const dynamics::DynamicsOptions options{
        .gravity = {0, 0, 0}, .tolerance = 1e-3, .rest_gap = 1e-4, .most_speed = 0};
    const auto world = make_our_world(options);
    const TestMesh triangle = moved_by(right_triangle(), 1, {-1, -1, 0});
    world->add({.form = Form::mesh, .mesh = &triangle, .mass = 0});
    const TestMesh tiny = moved_by(icosphere(0), 1e-3, {0, 0, 0});
    world->add({.form = Form::mesh,
                .mesh = &tiny,
                .at = {0, 0, 4},
                .velocity = {0, 0, -500},
                .is_continuous = true});
    double lowest = 0;
    for (const Double3& p : tiny.positions) lowest = std::min(lowest, p.z);
    const double exact = (4 + lowest) / 500;
    for (int frame = 0; frame < 3; ++frame) {
        world->step();
        const auto impacts = world->ours()->impacts();
        if (!impacts.empty()) return std::fabs(impacts[0].time_s / exact - 1);
    }
    return std::numeric_limits<double>::infinity();
}

/// Returns the largest relative error of the heights of some bounces, above where the ball rests.
double play_bounces(Engine engine, int bounces) {
    constexpr double kRestitution = 0.8, kHeight = 1, kRadius = 0.1;
    const dynamics::DynamicsOptions options{.step_s = 1.0 / 960, .substeps = 1};
    const auto world = make_world(engine, options);
    const double rest = kRadius + (engine == Engine::cdprep ? options.rest_gap : 0);
    world->add({.half = {5, 5, 0.5}, .mass = 0, .at = {0, 0, -0.5}, .restitution = kRestitution});
    const auto ball = world->add({.form = Form::sphere,
                                  .radius = kRadius,
                                  .at = {0, 0, rest + kHeight},
                                  .restitution = kRestitution});
    double worst = 0, peak = 0, last = 0;
    int seen = 0;
    for (int frame = 0; frame < 20 * 960 && seen < bounces; ++frame) {
        world->step();
        const double speed = world->velocity(ball).z;
        const double height = world->position(ball).z - rest;
        if (last > 0 && speed <= 0) {
            const double wanted = kHeight * std::pow(kRestitution, 2 * ++seen);
            worst = std::max(worst, std::fabs(peak / wanted - 1));
            peak = 0;
        }
        // A peak between two frames: what is left to rise.
        if (speed > 0) peak = height + speed * speed / (2 * kGravity);
        last = speed;
    }
    return seen < bounces ? 1 : worst;
}

/// Five balls, of which the first hits the others.
void play_cradle(Table& table, Engine engine) {
    constexpr double kRadius = 0.1, kGap = 1e-4;
    const dynamics::DynamicsOptions options{
        .gravity = {0, 0, 0}, .tolerance = 0.01, .rest_gap = kGap};
    const auto world = make_world(engine, options);
    for (int i = 0; i < 5; ++i) {
        const double apart = i == 0 ? -0.1 : 0;
        world->add({.form = Form::sphere,
                    .radius = kRadius,
                    .at = {i * (2 * kRadius + kGap) + apart, 0, 0},
                    .friction = 0,
                    .restitution = 1,
                    .velocity = {i == 0 ? 1.0 : 0, 0, 0}});
    }
    double momentum = 0, energy = 0, most = 0;
    for (int frame = 0; frame < 60; ++frame) {
        world->step();
        momentum = energy = 0;
        for (std::uint32_t i = 0; i < 5; ++i) {
            const Double3 v = world->velocity(i);
            momentum += v.x;
            energy += v.x * v.x + v.y * v.y + v.z * v.z;
        }
        most = std::max(most, std::fabs(momentum - 1));
    }
    table.add({"S09", "cradle: momentum changed", name_of(engine), most, 1e-12});
    table.add({"S09", "cradle: energy changed", name_of(engine), std::fabs(energy - 1), 1});
}

}  // namespace

void play_impacts(Table& table, const Extent& extent) {
    table.add({"S03", "10 m/s at a shell of 1 mm, continuous: centre sank by", "cdprep",
               fly_at_shell(Engine::cdprep, true), 1e-3, Promise::kept});
    table.add({"S04", "500 m/s at a triangle, continuous: time is off by", "cdprep", time_bullet(),
               1e-6, Promise::kept});
    for (const Engine engine : {Engine::cdprep, Engine::bullet, Engine::gimpact}) {
        if (engine != Engine::cdprep && !extent.has_peers) continue;
        if (engine != Engine::cdprep) {
            table.add({"S03", "10 m/s at a shell of 1 mm: centre sank by", name_of(engine),
                       fly_at_shell(engine, false), 1e-3});
        }
        const int bounces = extent.is_full ? 10 : 5;
        table.add({"S08", std::to_string(bounces) + " bounces, e = 0.8: heights are off by",
                   name_of(engine), play_bounces(engine, bounces), 0.01,
                   engine == Engine::cdprep ? Promise::kept : Promise::measured});
        play_cradle(table, engine);
    }
}

}  // namespace cdprep::test
