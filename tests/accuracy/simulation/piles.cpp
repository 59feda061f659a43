// SPDX-License-Identifier: MIT
// Scanned models fall into a box, and come to rest.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "accuracy/simulation/table.h"
#include "accuracy/simulation/worlds.h"
#include "support/seed_mesh.h"
#include "support/team.h"

namespace cdprep::test {
namespace {

constexpr double kSize = 0.8;    ///< metres: the diagonal of a falling model
constexpr double kInside = 2.4;  ///< metres: the width of the box
constexpr double kWall = 0.5;    ///< metres: how thick its floor and walls are
constexpr double kHeight = 6;    ///< metres: of its walls

void add_box(World& world) {
    const double side = kInside / 2 + kWall;
    world.add({.half = {side, side, kWall / 2}, .mass = 0, .at = {0, 0, -kWall / 2}});
    for (const int sign : {-1, 1}) {
        const double away = sign * (kInside + kWall) / 2;
        world.add(
            {.half = {side, kWall / 2, kHeight / 2}, .mass = 0, .at = {0, away, kHeight / 2}});
        world.add(
            {.half = {kWall / 2, side, kHeight / 2}, .mass = 0, .at = {away, 0, kHeight / 2}});
    }
}

constexpr std::uint32_t kFirst = 5;  ///< the number of the first falling body

struct Pile {
    std::string name;
    std::vector<TestMesh> meshes;  ///< of the falling bodies
    double seconds;
};

Actor falling(const Pile& pile, std::size_t i) {
    constexpr std::array<Double3, 5> kStarts = {{{-0.55, -0.55, 0.6},
                                                 {0.55, -0.55, 0.6},
                                                 {-0.55, 0.55, 0.6},
                                                 {0.55, 0.55, 0.6},
                                                 {0, 0, 1.1}}};
    const Double3 start = kStarts[i % kStarts.size()];
    const double level = static_cast<double>(i / kStarts.size());
    const double k = static_cast<double>(i);
    const double length = std::sqrt(1 + k * k + 4);
    return {.form = Form::mesh,
            .mesh = &pile.meshes[i],
            .mass = 10,
            .at = {start.x, start.y, start.z + 1.1 * level},
            .axis = {1 / length, k / length, 2 / length},
            .angle = 0.7 * k,
            .friction = 0.6,
            .damping = 0.05};
}

/// Fills the box. Mass 10 kg each.
void fill(World& world, const Pile& pile) {
    add_box(world);
    for (std::size_t i = 0; i < pile.meshes.size(); ++i) world.add(falling(pile, i));
}

double length(const Double3& a) {
    return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}

/// A bound of the speed of the points of a body, of any engine.
double speed_of(const World& world, std::uint32_t body) {
    return length(world.velocity(body)) + kSize / 2 * length(world.angular_velocity(body));
}

double fastest_of(const World& world, std::size_t count) {
    double most = 0;
    for (std::uint32_t i = 0; i < count; ++i) most = std::max(most, speed_of(world, kFirst + i));
    return most;
}

std::size_t outside(const World& world, std::size_t count) {
    std::size_t out = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Double3 p = world.position(kFirst + i);
        const double half = kInside / 2;
        out += std::abs(p.x) < half && std::abs(p.y) < half && p.z > 0 && p.z < kHeight ? 0 : 1;
    }
    return out;
}

double deepest(const dynamics::RigidBodies& bodies) {
    double least = 0;
    for (const auto& contact : bodies.contacts()) least = std::min(least, contact.distance);
    return std::fabs(least);
}

std::size_t awake(const dynamics::RigidBodies& bodies, std::size_t count) {
    std::size_t found = 0;
    for (std::uint32_t i = 0; i < count; ++i) found += bodies.is_asleep(kFirst + i) ? 0 : 1;
    return found;
}

struct Outcome {
    /// When all were slower than 1e-3 for a second; infinity: never.
    double rest_s = std::numeric_limits<double>::infinity();
    double speed = 0;              ///< at the end
    std::vector<double> frame_ms;  ///< in their order
    std::size_t outside = 0;
};

Outcome play(World& world, const Pile& pile, bool prints) {
    constexpr int kRate = 60;
    Outcome outcome;
    int still = 0;
    const std::size_t count = pile.meshes.size();
    for (int frame = 1; frame <= pile.seconds * kRate; ++frame) {
        const auto begin = std::chrono::steady_clock::now();
        world.step();
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        outcome.frame_ms.push_back(1e3 * taken.count());
        outcome.speed = fastest_of(world, count);
        still = outcome.speed < 1e-3 ? still + 1 : 0;
        if (still == kRate && std::isinf(outcome.rest_s)) {
            outcome.rest_s = double(frame) / kRate;
        }
        if (prints && frame % kRate == 0) {
            std::fflush(stdout);
            std::printf("# %5.2f s:", double(frame) / kRate);
            for (std::uint32_t i = 0; i < count; ++i) {
                std::printf(" %.2g", speed_of(world, kFirst + i));
            }
            if (auto* ours = world.ours()) {
                const auto& c = ours->counts();
                std::printf("; deepest %.2g, awake %zu, contacts %zu, deep %zu, shortened %zu",
                            deepest(*ours), awake(*ours, count), std::size_t(c.contacts),
                            std::size_t(c.deep), std::size_t(c.shortened));
            }
            std::printf("\n");
        }
        if (world.ours() != nullptr && awake(*world.ours(), count) == 0) break;
    }
    outcome.outside = outside(world, count);
    return outcome;
}

/// Returns the median of the first frames.
double median_of(std::vector<double> frame_ms, std::size_t frames) {
    frame_ms.resize(std::min(frames, frame_ms.size()));
    const auto middle = frame_ms.begin() + static_cast<std::ptrdiff_t>(frame_ms.size() / 2);
    std::nth_element(frame_ms.begin(), middle, frame_ms.end());
    return *middle;
}

dynamics::DynamicsOptions options_of_piles() {
    return {.tolerance = 0.01, .rest_gap = 5e-4, .most_speed = 2.2};
}

Outcome play_ours(Table& table, const Pile& pile, bool prints) {
    constexpr Promise kKept = Promise::kept;
    const auto world = make_our_world(options_of_piles());
    fill(*world, pile);
    const Outcome outcome = play(*world, pile, prints);
    const std::size_t count = pile.meshes.size();
    table.add(
        {"piles", pile.name + ": outside the box", "cdprep", double(outcome.outside), 0, kKept});
    table.add({"piles", pile.name + ": awake at the end", "cdprep",
               double(awake(*world->ours(), count)), 0, kKept});
    table.add(
        {"piles", pile.name + ": speed at the end, m/s", "cdprep", outcome.speed, 1e-3, kKept});
    table.add({"piles", pile.name + ": overlap at the end, sizes", "cdprep",
               deepest(*world->ours()) / kSize, 0.01, kKept});
    table.add({"piles", pile.name + ": at rest after, s (inf: never)", "cdprep", outcome.rest_s,
               pile.seconds, kKept});
    table.add({"piles", pile.name + ": median ms a frame", "cdprep",
               median_of(outcome.frame_ms, outcome.frame_ms.size())});
    return outcome;
}

/// Plays the same with GImpact, for fewer seconds, and compares the frames that both computed.
void play_peer(Table& table, Pile pile, double seconds, const Outcome& ours) {
    pile.seconds = seconds;
    const auto world = make_peer_world(Engine::gimpact, options_of_piles());
    fill(*world, pile);
    const Outcome outcome = play(*world, pile, false);
    const char* name = name_of(Engine::gimpact);
    const std::string after =
        pile.name + ", " + std::to_string(outcome.frame_ms.size()) + " frames";
    table.add({"piles", after + ": outside the box", name, double(outcome.outside), 0});
    table.add({"piles", after + ": speed at the end, m/s", name, outcome.speed, 1e-3});
    table.add({"piles", after + ": at rest after, s (inf: never)", name, outcome.rest_s, seconds});
    const std::size_t frames = std::min(outcome.frame_ms.size(), ours.frame_ms.size());
    const double median = median_of(outcome.frame_ms, frames);
    table.add({"piles", after + ": median ms a frame", name, median});
    table.add({"piles", after + ": median time, ours / GImpact", "cdprep",
               median_of(ours.frame_ms, frames) / median, 1.0 / 3});
}

}  // namespace

/// Five rough balls fall on each other, on one thread and on eight.
void play_threads(Table& table, const Extent& extent) {
    TestMesh lump = moved_by(icosphere(2), 0.3, {0, 0, 0});
    for (std::size_t i = 0; i < lump.positions.size(); ++i) {
        const double r = 0.8 + 0.05 * static_cast<double>(i % 5);
        Double3& p = lump.positions[i];
        p = {r * p.x, r * p.y, r * p.z};
    }
    const Pile pile{"lumps", std::vector<TestMesh>(5, lump), extent.is_full ? 5.0 : 1.5};
    std::vector<std::uint64_t> hashes;
    for (const unsigned threads : {1U, 8U, 1U}) {
        const Team team(threads);
        dynamics::DynamicsOptions options = options_of_piles();
        options.threads = threads;
        const auto world = make_our_world(options, team);
        fill(*world, pile);
        (void)play(*world, pile, false);
        hashes.push_back(world->ours()->state_hash());
    }
    const double different = (hashes[0] != hashes[1] ? 1 : 0) + (hashes[0] != hashes[2] ? 1 : 0);
    table.add(
        {"S15", "1, 8 and 1 threads: different states", "cdprep", different, 0, Promise::kept});
}

namespace {

/// The scanned models of these names that are there, at their size.
std::vector<TestMesh> scanned(std::initializer_list<const char*> names) {
    std::vector<TestMesh> meshes;
    for (const char* name : names) {
        if (const auto mesh = seed_mesh(name)) {
            meshes.push_back(moved_by(*mesh, kSize, {0, 0, 0}));
        } else {
            std::printf("# no model %s beside the checkout (set CDPREP_SHARED)\n", name);
        }
    }
    return meshes;
}

}  // namespace

void play_small_pile(Table& table, const Extent& extent) {
    const std::vector<TestMesh> found = scanned({"horse"});
    if (found.empty()) return;
    // Three horses, which start lowest.
    const Pile pile{"3 of horse", std::vector<TestMesh>(3, found[0]), 12};
    const Outcome ours = play_ours(table, pile, extent.is_full);
    if (extent.has_peers) play_peer(table, pile, extent.is_full ? 5 : 2, ours);
}

void play_piles(Table& table, const Extent& extent) {
    for (const char* name : {"horse", "bunny"}) {
        const std::vector<TestMesh> found = scanned({name});
        if (found.empty()) continue;
        const Pile pile{std::string("5 of ") + name, std::vector<TestMesh>(5, found[0]), 20};
        const Outcome ours = play_ours(table, pile, extent.is_full);
        if (extent.has_peers) play_peer(table, pile, 5, ours);
    }
}

void play_mixed_pile(Table& table, const Extent& extent) {
    const std::vector<TestMesh> found = scanned({"horse", "bunny", "skull", "armadillo"});
    if (found.empty()) return;
    Pile pile{"20 mixed", {}, 20};
    for (std::size_t i = 0; i < 20; ++i) pile.meshes.push_back(found[i % found.size()]);
    const Outcome ours = play_ours(table, pile, true);
    if (extent.has_peers) play_peer(table, pile, 5, ours);
}

}  // namespace cdprep::test
