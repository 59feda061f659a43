// SPDX-License-Identifier: MIT
// Bodies that hit something.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

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

dynamics::DynamicsOptions options_of_bullet() {
    return {.gravity = {0, 0, 0}, .tolerance = 1e-3, .rest_gap = 1e-4, .most_speed = 0};
}

TestMesh target() {
    return moved_by(right_triangle(), 1, {-1, -1, 0});
}

/// A tiny sphere flies at a triangle. Returns the relative error of the time of the impact.
double time_bullet() {
    const auto world = make_our_world(options_of_bullet());
    const TestMesh triangle = target();
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

/// The same of a peer, which tells no time. Returns how far the sphere came behind the triangle.
double pass_bullet(Engine engine, bool is_continuous) {
    const auto world = make_world(engine, options_of_bullet());
    const TestMesh triangle = target();
    world->add({.form = Form::mesh, .mesh = &triangle, .mass = 0});
    const auto tiny = world->add({.form = Form::sphere,
                                  .radius = 1e-3,
                                  .at = {0, 0, 4},
                                  .velocity = {0, 0, -500},
                                  .is_continuous = is_continuous});
    double lowest = std::numeric_limits<double>::infinity();
    for (int frame = 0; frame < 3; ++frame) {
        world->step();
        lowest = std::min(lowest, world->position(tiny).z);
    }
    return std::max(-lowest, 0.0);
}

struct Bounces {
    int seen = 0;      ///< of those that are wanted
    double worst = 0;  ///< relative error of the heights of those that were seen
};

/// Plays bounces of a ball. Heights are above where it rests.
Bounces play_bounces(Engine engine, int bounces) {
    constexpr double kRestitution = 0.8, kHeight = 1, kRadius = 0.1;
    const dynamics::DynamicsOptions options{.step_s = 1.0 / 960, .substeps = 1};
    const auto world = make_world(engine, options);
    const double rest = kRadius + (engine == Engine::cdprep ? options.rest_gap : 0);
    world->add({.half = {5, 5, 0.5}, .mass = 0, .at = {0, 0, -0.5}, .restitution = kRestitution});
    const auto ball = world->add({.form = Form::sphere,
                                  .radius = kRadius,
                                  .at = {0, 0, rest + kHeight},
                                  .restitution = kRestitution});
    Bounces found;
    double peak = 0, last = 0;
    for (int frame = 0; frame < 20 * 960 && found.seen < bounces; ++frame) {
        world->step();
        const double speed = world->velocity(ball).z;
        const double height = world->position(ball).z - rest;
        if (last > 0 && speed <= 0) {
            const double wanted = kHeight * std::pow(kRestitution, 2 * ++found.seen);
            found.worst = std::max(found.worst, std::fabs(peak / wanted - 1));
            peak = 0;
        }
        // A peak between two frames: what is left to rise.
        if (speed > 0) peak = height + speed * speed / (2 * kGravity);
        last = speed;
    }
    return found;
}

/// The time between two flips of a body that turns nearly about its middle axis. It is half the
/// period of Euler's equations (Landau and Lifshitz, Mechanics, section 37). Moments and spin are
/// by axis, with the smallest moment first.
double flip_time(std::array<double, 3> moments, std::array<double, 3> spin) {
    double twice_energy = 0, momentum2 = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        twice_energy += moments[i] * spin[i] * spin[i];
        momentum2 += moments[i] * moments[i] * spin[i] * spin[i];
    }
    if (momentum2 < twice_energy * moments[1]) std::swap(moments[0], moments[2]);
    const auto [one, two, three] = moments;
    const double fast = (three - two) * (momentum2 - twice_energy * one);
    const double slow = (two - one) * (twice_energy * three - momentum2);
    return 2 * std::comp_ellint_1(std::sqrt(slow / fast)) * std::sqrt(one * two * three / fast);
}

/// A needle turns about its middle axis, and flips again and again.
void play_needle(Table& table, Engine engine) {
    constexpr double kSeconds = 100, kSpin = 2, kTilt = 1e-3;
    constexpr Double3 kHalf = {0.5, 0.05, 0.0005};
    const auto world = make_world(engine, {.gravity = {0, 0, 0}, .sleeps = false});
    const auto needle = world->add({.half = kHalf, .turn = {kTilt, kSpin, 0}});
    const double x2 = kHalf.x * kHalf.x, y2 = kHalf.y * kHalf.y, z2 = kHalf.z * kHalf.z;
    const std::array moments = {(y2 + z2) / 3, (x2 + z2) / 3, (x2 + y2) / 3};
    const double exact = flip_time(moments, {kTilt, kSpin, 0});
    const auto energy_of = [&](const Double3& w) {
        return moments[0] * w.x * w.x + moments[1] * w.y * w.y + moments[2] * w.z * w.z;
    };
    const double energy = energy_of({kTilt, kSpin, 0});
    double last = kSpin, first_flip = 0, last_flip = 0;
    int flips = 0;
    for (int frame = 1; frame <= kSeconds * 60; ++frame) {
        world->step();
        const double spin = world->spin(needle).y;  // about the middle axis
        if (spin * last < 0) {
            const double now = (frame - spin / (spin - last)) / 60;
            (flips++ == 0 ? first_flip : last_flip) = now;
        }
        last = spin;
    }
    const double found = flips > 1 ? (last_flip - first_flip) / (flips - 1) : 0;
    const Promise promise = engine == Engine::cdprep ? Promise::kept : Promise::measured;
    table.add({"S05", "needle, " + std::to_string(flips) + " flips in 100 s: time is off by",
               name_of(engine), std::fabs(found / exact - 1), 0.01, promise});
    table.add({"S05", "needle, 100 s: energy changed", name_of(engine),
               std::fabs(energy_of(world->spin(needle)) / energy - 1), 1e-6, promise});
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
    table.add({"S09", "cradle: energy changed", name_of(engine), std::fabs(energy - 1)});
}

}  // namespace

namespace {

void play_flights(Table& table, Engine engine) {
    const char* const name = name_of(engine);
    const std::string shell = "10 m/s at a shell of 1 mm", triangle = "500 m/s at a triangle";
    if (engine == Engine::cdprep) {
        table.add({"S03", shell + ", continuous: centre sank by", name, fly_at_shell(engine, true),
                   1e-3, Promise::kept});
        table.add({"S04", triangle + ", continuous: time is off by", name, time_bullet(), 1e-6,
                   Promise::kept});
        return;
    }
    for (const bool is_continuous : {false, true}) {
        // Bullet sweeps no GImpact.
        if (is_continuous && engine == Engine::gimpact) continue;
        const std::string how = is_continuous ? ", its CCD" : "";
        table.add({"S03", shell + how + ": centre sank by", name,
                   fly_at_shell(engine, is_continuous), 1e-3});
        table.add({"S04", triangle + how + ": centre came behind it by", name,
                   pass_bullet(engine, is_continuous), 0});
    }
}

void play_ball(Table& table, Engine engine, int wanted) {
    const Bounces found = play_bounces(engine, wanted);
    const Promise promise = engine == Engine::cdprep ? Promise::kept : Promise::measured;
    const std::string all = std::to_string(wanted) + " bounces, e = 0.8";
    table.add({"S08", all + ": not seen in 20 s", name_of(engine), double(wanted - found.seen), 0,
               promise});
    if (found.seen == 0) return;
    table.add({"S08", all + ": heights of " + std::to_string(found.seen) + " are off by",
               name_of(engine), found.worst, 0.01, promise});
}

}  // namespace

void play_impacts(Table& table, const Extent& extent) {
    for (const Engine engine : {Engine::cdprep, Engine::bullet, Engine::gimpact}) {
        if (engine != Engine::cdprep && !extent.has_peers) continue;
        play_flights(table, engine);
        play_needle(table, engine);
        play_ball(table, engine, extent.is_full ? 10 : 5);
        play_cradle(table, engine);
    }
}

}  // namespace cdprep::test
