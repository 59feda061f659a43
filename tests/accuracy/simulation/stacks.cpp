// SPDX-License-Identifier: MIT
// Boxes on boxes.
#include <algorithm>
#include <cmath>
#include <string>

#include "accuracy/simulation/table.h"
#include "accuracy/simulation/worlds.h"

namespace cdprep::test {
namespace {

constexpr double kRestGap = 5e-4;

std::uint32_t add_floor(World& world) {
    return world.add({.half = {5, 5, 0.5}, .mass = 0, .at = {0, 0, -0.5}});
}

/// The bodies of a stack lie a rest gap apart, so that ours has no way to fall.
double start_height(Engine engine, int below) {
    const double gap = engine == Engine::cdprep ? kRestGap : 0;
    return 0.5 + gap + below * (1 + gap);
}

struct Shift {
    double aside = 0;
    double down = 0;
};

Shift play_stack(Engine engine, int boxes, double seconds, std::uint32_t iterations) {
    const dynamics::DynamicsOptions options{.iterations = iterations, .rest_gap = kRestGap};
    const auto world = make_world(engine, options);
    add_floor(*world);
    for (int i = 0; i < boxes; ++i) world->add({.at = {0, 0, start_height(engine, i)}});
    const int frames = static_cast<int>(std::lround(seconds / options.step_s));
    Shift most;
    for (int frame = 0; frame < frames; ++frame) {
        world->step();
        for (int i = 0; i < boxes; ++i) {
            const Double3 p = world->position(static_cast<std::uint32_t>(i + 1));
            most.aside = std::max(most.aside, std::hypot(p.x, p.y));
            most.down = std::max(most.down, start_height(engine, i) - p.z);
        }
    }
    return most;
}

void play_ten_boxes(Table& table, const Extent& extent, Engine engine) {
    const double seconds = extent.is_full ? 60 : 4;
    for (const std::uint32_t iterations : {50U, 500U}) {
        const Shift most = play_stack(engine, 10, seconds, iterations);
        const std::string how = " in " + std::to_string(static_cast<int>(seconds)) + " s, " +
                                std::to_string(iterations) + " iterations";
        const Promise promise = engine == Engine::cdprep ? Promise::kept : Promise::measured;
        table.add({"S01", "stack of 10: drift" + how, name_of(engine), most.aside, 1e-3});
        table.add({"S01", "stack of 10: height lost" + how, name_of(engine), most.down,
                   10 * kRestGap, promise});
    }
}

/// Two boxes, one 1,000 times as heavy. Returns the deepest overlap after 10 s.
double play_two(Engine engine, std::uint32_t iterations, double below, double above,
                double seconds) {
    dynamics::DynamicsOptions options{.iterations = iterations, .rest_gap = kRestGap};
    const auto world = make_world(engine, options);
    add_floor(*world);
    const auto low = world->add({.mass = below, .at = {0, 0, start_height(engine, 0)}});
    const auto high = world->add({.mass = above, .at = {0, 0, start_height(engine, 1)}});
    const int frames = static_cast<int>(std::lround(seconds / options.step_s));
    for (int frame = 0; frame < frames; ++frame) world->step();
    const double z = world->position(low).z;
    return std::max({0.5 - z, 1 - (world->position(high).z - z), 0.0});
}

void play_mass_ratios(Table& table, const Extent& extent, Engine engine) {
    for (const std::uint32_t iterations : {4U, 16U, 50U, 64U}) {
        if (!extent.is_full && iterations != 50) continue;
        const std::string how = ", " + std::to_string(iterations) + " iterations: overlap";
        const double seconds = extent.is_full ? 10 : 3;
        const bool promised = engine == Engine::cdprep && iterations >= 50;
        const Promise promise = promised ? Promise::kept : Promise::measured;
        table.add({"S02", "1000 kg on 1 kg" + how, name_of(engine),
                   play_two(engine, iterations, 1, 1000, seconds), 0.01, promise});
        table.add({"S02", "1 kg on 1000 kg" + how, name_of(engine),
                   play_two(engine, iterations, 1000, 1, seconds), 0.01, promise});
    }
}

}  // namespace

void play_stacks(Table& table, const Extent& extent) {
    for (const Engine engine : {Engine::cdprep, Engine::bullet, Engine::gimpact}) {
        if (engine != Engine::cdprep && !extent.has_peers) continue;
        play_ten_boxes(table, extent, engine);
        play_mass_ratios(table, extent, engine);
    }
}

}  // namespace cdprep::test
