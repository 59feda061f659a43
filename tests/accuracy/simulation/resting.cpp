// SPDX-License-Identifier: MIT
// Bodies that rest, stick or slide.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "accuracy/simulation/table.h"
#include "accuracy/simulation/worlds.h"

namespace cdprep::test {
namespace {

constexpr double kRestGap = 5e-4;
constexpr double kGravity = 9.81;

Double3 operator-(const Double3& a, const Double3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
double dot(const Double3& a, const Double3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
double length(const Double3& a) {
    return std::sqrt(dot(a, a));
}

double gap_of(Engine engine) {
    return engine == Engine::cdprep ? kRestGap : 0;
}

double energy_of(const World& world, std::uint32_t body) {
    const Double3 v = world.velocity(body), w = world.angular_velocity(body);
    return dot(v, v) / 2 + dot(w, w) / 2;
}

/// A box at rest on a floor. Whether ours sleeps is said.
void play_drift(Table& table, const Extent& extent, Engine engine, bool sleeps) {
    const dynamics::DynamicsOptions options{
        .substeps = 1, .tolerance = 0.05, .rest_gap = kRestGap, .sleeps = sleeps};
    const auto world = make_world(engine, options);
    world->add({.half = {5, 5, 0.5}, .mass = 0, .at = {0, 0, -0.5}});
    const auto box = world->add({.at = {0, 0, 0.5 + gap_of(engine)}});
    constexpr int kSettled = 60;
    const int frames = extent.is_full ? 1'000'000 : 5'000;
    Double3 start{};
    double most = 0, energy = 0;
    for (int frame = 0; frame < frames; ++frame) {
        world->step();
        if (frame == kSettled) start = world->position(box);
        if (frame < kSettled) continue;
        most = std::max(most, length(world->position(box) - start));
        energy = std::max(energy, energy_of(*world, box));
    }
    const std::string how =
        std::to_string(frames) + " steps" + (sleeps ? "" : " without sleep") + ": ";
    const bool promised = engine == Engine::cdprep;
    const Promise promise = promised ? Promise::kept : Promise::measured;
    table.add({"S06", "box on a floor, " + how + "drift", name_of(engine), most, 1e-6, promise});
    table.add({"S06", "box on a floor, " + how + "energy", name_of(engine), energy, 1e-6, promise});
}

/// A box on an incline. Returns the ways along it after one second and after three.
std::array<double, 2> slide(Engine engine, double tangent) {
    const dynamics::DynamicsOptions options{.rest_gap = kRestGap, .sleeps = false};
    const auto world = make_world(engine, options);
    const double angle = std::atan(tangent), c = std::cos(angle), s = std::sin(angle);
    const Double3 up = {-s, 0, c}, down = {-c, 0, -s};
    const auto along = [](const Double3& d, double way) {
        return Double3{way * d.x, way * d.y, way * d.z};
    };
    // The turn about y by -angle takes x to (c, 0, s).
    world->add({.half = {20, 20, 0.5},
                .mass = 0,
                .at = along(up, -0.5),
                .axis = {0, 1, 0},
                .angle = -angle});
    const Double3 start = along(up, 0.25 + gap_of(engine));
    const auto box =
        world->add({.half = {0.25, 0.25, 0.25}, .at = start, .axis = {0, 1, 0}, .angle = -angle});
    std::array<double, 2> ways{};
    for (int frame = 1; frame <= 180; ++frame) {
        world->step();
        const double way = dot(world->position(box) - start, down);
        if (frame == 60) ways[0] = way;
        if (frame == 180) ways[1] = way;
    }
    return ways;
}

void play_friction(Table& table, Engine engine) {
    constexpr double kFriction = 0.5;
    const Promise promise = engine == Engine::cdprep ? Promise::kept : Promise::measured;
    const auto stuck = slide(engine, kFriction * 0.99);
    table.add({"S07", "incline 1 % too flat: way in 3 s", name_of(engine), std::fabs(stuck[1]),
               1e-3, promise});
    for (const double steeper : {1.01, 1.1}) {
        const double angle = std::atan(kFriction * steeper);
        const double wanted = kGravity * (std::sin(angle) - kFriction * std::cos(angle));
        // a (9 - 1) / 2
        const auto ways = slide(engine, kFriction * steeper);
        const double found = (ways[1] - ways[0]) / 4;
        const std::string how = steeper > 1.05 ? "10 %" : "1 %";
        table.add({"S07", "incline " + how + " too steep: acceleration is off by", name_of(engine),
                   std::fabs(found / wanted - 1), 0.01, promise});
    }
}

/// A box slides over edges of a flat floor, along it and across.
void play_edges(Table& table, Engine engine) {
    TestMesh sheet = moved_by(grid_sheet(100, 100), 0.1, {-5, -5, 0});
    const dynamics::DynamicsOptions options{
        .tolerance = 0.02, .rest_gap = kRestGap, .most_speed = 4, .sleeps = false};
    double vertical = 0, slower = 0;
    for (const Double3& velocity : {Double3{3, 0, 0}, Double3{2.1, 1.3, 0}}) {
        const auto world = make_world(engine, options);
        world->add({.form = Form::mesh, .mesh = &sheet, .mass = 0, .friction = 0});
        const auto box = world->add({.half = {0.25, 0.25, 0.25},
                                     .at = {-3.03, -2.01, 0.25 + gap_of(engine)},
                                     .friction = 0,
                                     .velocity = velocity});
        for (int frame = 0; frame < 110; ++frame) {
            world->step();
            const Double3 v = world->velocity(box);
            if (frame >= 10) vertical = std::max(vertical, std::fabs(v.z));
            slower = std::max(slower, length(v - velocity));
        }
    }
    const Promise promise = engine == Engine::cdprep ? Promise::kept : Promise::measured;
    table.add({"S10", "box slides over 20,000 triangles: vertical speed", name_of(engine), vertical,
               1e-6, promise});
    table.add({"S10", "box slides over 20,000 triangles: velocity changed", name_of(engine), slower,
               1e-3, promise});
}

/// A sphere in the corner of three planes.
void play_corner(Table& table, Engine engine) {
    constexpr double kPull = 5.66;
    const dynamics::DynamicsOptions options{
        .gravity = {-kPull, -kPull, -kPull}, .rest_gap = kRestGap, .sleeps = false};
    const auto world = make_world(engine, options);
    world->add({.half = {0.5, 5, 5}, .mass = 0, .at = {-0.5, 0, 0}});
    world->add({.half = {5, 0.5, 5}, .mass = 0, .at = {0, -0.5, 0}});
    world->add({.half = {5, 5, 0.5}, .mass = 0, .at = {0, 0, -0.5}});
    const auto ball = world->add({.form = Form::sphere, .radius = 0.3, .at = {0.35, 0.36, 0.34}});
    Double3 lower{1, 1, 1}, upper{-1, -1, -1};
    double energy = 0;
    for (int frame = 0; frame < 300; ++frame) {
        world->step();
        if (frame < 180) continue;
        const Double3 p = world->position(ball);
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
        energy = std::max(energy, energy_of(*world, ball));
    }
    const Promise promise = engine == Engine::cdprep ? Promise::kept : Promise::measured;
    table.add({"S11", "sphere in a corner, 3 s to 5 s: jitter", name_of(engine),
               length(upper - lower), kRestGap, promise});
    table.add(
        {"S11", "sphere in a corner, 3 s to 5 s: energy", name_of(engine), energy, 1e-4, promise});
}

/// A rough body on one large box.
TestMesh rough_ball() {
    TestMesh mesh = icosphere(3);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> height(0.8, 1);
    for (Double3& p : mesh.positions) {
        const double r = 0.3 * height(random);
        p = {r * p.x, r * p.y, 0.8 * r * p.z};
    }
    return mesh;
}

void play_rough(Table& table, Engine engine) {
    const TestMesh rough = rough_ball();
    const dynamics::DynamicsOptions options{.rest_gap = kRestGap, .most_speed = 2};
    const auto world = make_world(engine, options);
    world->add({.half = {20, 20, 0.5}, .mass = 0, .at = {0, 0, -0.5}});
    const auto body = world->add({.form = Form::mesh, .mesh = &rough, .at = {0, 0, 0.4}});
    double fastest = 0, lowest = 1, last = 0;
    for (int frame = 0; frame < 600; ++frame) {
        world->step();
        fastest = std::max(fastest, length(world->velocity(body)));
        lowest = std::min(lowest, world->position(body).z);
        if (frame >= 540) {
            last = std::max(
                last, length(world->velocity(body)) + 0.3 * length(world->angular_velocity(body)));
        }
    }
    const Promise promise = engine == Engine::cdprep ? Promise::kept : Promise::measured;
    table.add({"S16", "rough ball on one large box: greatest speed", name_of(engine), fastest, 2,
               promise});
    table.add({"S16", "rough ball on one large box: centre sank below its height", name_of(engine),
               std::max(0.8 * 0.8 * 0.3 - lowest, 0.0), 6e-3, promise});
    table.add({"S16", "rough ball on one large box: speed after 9 s", name_of(engine), last, 1e-3,
               promise});
}

}  // namespace

void play_resting(Table& table, const Extent& extent) {
    play_drift(table, extent, Engine::cdprep, true);
    for (const Engine engine : {Engine::cdprep, Engine::bullet, Engine::gimpact}) {
        if (engine != Engine::cdprep && !extent.has_peers) continue;
        play_drift(table, extent, engine, false);
        play_friction(table, engine);
        play_edges(table, engine);
        play_corner(table, engine);
        play_rough(table, engine);
    }
}

}  // namespace cdprep::test
