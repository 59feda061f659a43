// SPDX-License-Identifier: MIT
// A haptic loop: a small ring glides over a torus. The fast loop asks for the distance at every
// step. It reads only a window, the part of the torus near the ring. The slow loop fills another
// window around the present place, then hands it over.
//
//     sample_haptic
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <iostream>
#include <thread>
#include <vector>

#include "cdprep/build.h"
#include "cdprep/window.h"

namespace {

using cdprep::Double3;
using cdprep::Window;
using cdprep::format::Triangle;

constexpr double kPi = 3.141592653589793;
constexpr int kSteps = 4000;

/// A torus about z: rings of radius `tube` around a circle of radius `ring`.
cdprep::Result<cdprep::build::ModelArrays> torus(double ring, double tube, std::uint32_t n) {
    std::vector<Double3> points;
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i < n * n; ++i) {
        const std::uint32_t ring_number = i / n;
        const double u = 2 * kPi * ring_number / n, v = 2 * kPi * (i % n) / n;
        const double out = ring + tube * std::cos(v);
        points.push_back({out * std::cos(u), out * std::sin(u), tube * std::sin(v)});
        const std::uint32_t next = (i + n) % (n * n);  // the same place of the next ring
        const std::uint32_t turn = i % n + 1 == n ? 1 - n : 1;
        triangles.push_back({{i, next, next + turn}});
        triangles.push_back({{i, next + turn, i + turn}});
    }
    return cdprep::build::build_model(points, triangles);
}

/// Memory that starts where a model may: at a multiple of 64 bytes.
struct alignas(cdprep::format::kSectionAlignment) Line {
    std::byte bytes[cdprep::format::kSectionAlignment];
};

/// The place of the small ring at a step.
cdprep::Placement place(int step) {
    const double turn = 2 * kPi * step / kSteps, height = 0.37 + 0.05 * std::sin(40 * turn);
    return cdprep::Placement::b_moves(
        cdprep::Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, std::cos(turn), std::sin(turn), height})
            .value());
}

}  // namespace

int main() {
    // Models live in memory here; Model::open() takes a baked file as well.
    std::array<std::vector<Line>, 4> memory;
    const auto model = [&](std::vector<Line>& room, double ring, double tube, std::uint32_t n) {
        const auto arrays = torus(ring, tube, n);
        room.resize(cdprep::LiveModel::bytes(arrays.value()).value() / sizeof(Line) + 1);
        return cdprep::LiveModel::in(std::as_writable_bytes(std::span(room)), arrays.value());
    };
    const auto organ = model(memory[0], 1, 0.3, 300), probe = model(memory[1], 0.02, 0.01, 20);
    std::vector<Window> windows;
    for (std::size_t i = 0; i < 2; ++i) {
        memory[2 + i].resize(Window::bytes({2000}).value() / sizeof(Line) + 1);
        windows.push_back(
            Window::in(std::as_writable_bytes(std::span(memory[2 + i])), {2000}).value());
    }
    organ->model().touch();  // no page of it is met for the first time later

    // The slow loop fills the window that is not ready, once the fast loop has taken the other.
    std::atomic<int> ready = 0, taken = 0, now = 0;
    std::atomic<bool> ends = false;
    int fills = 0;
    std::thread slow([&] {
        for (; !ends; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
            if (taken != ready) continue;  // the fast loop still reads the other window
            const int next = 1 - ready;
            windows[next].fill({organ->model(), probe->model(), place(now)}, 0.1);
            ready = next;
            ++fills;
        }
    });

    int complete = 0, late = 0;
    double nearest = 1;
    std::thread fast([&] {
        cdprep::Workspace workspace;
        cdprep::PairCache cache;
        cdprep::LastDistance last;
        for (int step = 0; step < kSteps; ++step) {
            now = step;
            taken = ready.load();
            const Window& window = windows[taken];
            const cdprep::Pair pair{window.model(), probe->model(), place(step), {}, &cache};
            const auto found = window.distance(pair, workspace, {}, {.work = 2000, .last = &last});
            // A late answer has bounds; the last complete one is in `last`.
            ++(found.is_complete ? complete : late);
            if (found.is_complete) nearest = std::min(nearest, found.upper);
            std::this_thread::sleep_for(std::chrono::microseconds(100));  // the device's rate
        }
        ends = true;
    });
    fast.join();
    slow.join();
    std::cout << fills << " windows, " << complete << " complete answers, " << late << " late\n"
              << "nearest: " << nearest << "\n";
    return complete > 0 ? 0 : 1;
}
