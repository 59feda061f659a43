// SPDX-License-Identifier: MIT
// Distances at the rate of a haptic loop: a probe glides over a large model (gliding_probe.h). The
// ways: the whole model, windows, budgets of work, and a model of which a fiftieth deforms each
// step. FCL answers the first 600 steps. Processor time, one thread; page faults after 50 steps.
//
// Usage: haptic_bench MODEL PROBE [STEPS [RADIUS]], 60,000 steps if left out
// MODEL was baked with --normalize --effects overlap,distance,closest. PROBE is a ball of radius
// 0.02 about 0, baked with --effects distance. A window is filled every 10 steps and used from 2
// steps later on. It has everything in RADIUS (default 0.05).
//
// Prints CSV tables: microseconds of a step; then late answers by budget.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "bench_input.h"
#include "cdprep/live_model.h"
#include "cdprep/window.h"
#include "gliding_probe.h"
#include "probe_steps.h"

#ifdef CDPREP_HAVE_FCL
#include "fcl_models.h"
#endif

namespace cdprep {
namespace {

constexpr std::size_t kFillEvery = 10;
constexpr std::size_t kFillLag = 2;
constexpr std::size_t kFclSteps = 600;

struct alignas(format::kSectionAlignment) Block {
    std::array<std::byte, format::kSectionAlignment> bytes;
};

std::vector<Block> room_of(const Result<std::size_t>& bytes) {
    if (!bytes) stop(bytes.error().message);
    return std::vector<Block>(*bytes / sizeof(Block) + 1);
}

/// Two windows in turn, as a slow loop fills them.
class Windows {
public:
    Windows(std::uint32_t leaves, double radius) : radius_(radius) {
        for (std::vector<Block>& room : rooms_) {
            room = room_of(Window::bytes({leaves}));
            auto made = Window::in(std::as_writable_bytes(std::span(room)), {leaves});
            if (!made) stop(made.error().message);
            windows_.push_back(std::move(made).value());
        }
    }
    [[nodiscard]] Window& of(std::size_t step) {
        const std::size_t number = step < kFillLag ? 0 : (step - kFillLag) / kFillEvery;
        return windows_[number % 2];
    }
    /// Fills a window for the steps to come, where one is due.
    void fill(const Model& model, const Model& probe, const std::vector<Double3>& way,
              std::size_t step) {
        if (step % kFillEvery != 0) return;
        const WindowFill held = fills_.time([&] {
            return windows_[step / kFillEvery % 2].fill({model, probe, placed_at(way[step])},
                                                        radius_);
        });
        leaves_ += held.leaves;
        ++count_;
    }
    void print_fills() const {
        fills_.print("window_fill", static_cast<double>(leaves_) / static_cast<double>(count_));
    }

private:
    double radius_;
    std::array<std::vector<Block>, 2> rooms_;
    std::vector<Window> windows_;
    Steps fills_;
    std::size_t leaves_ = 0, count_ = 0;
};

void time_windows(const Model& model, const Model& probe, const std::vector<Double3>& way,
                  double radius) {
    Windows windows(1U << 15, radius);
    Workspace workspace;
    PairCache cache;
    Steps steps;
    double complete = 0;
    for (std::size_t i = 0; i < way.size(); ++i) {
        windows.fill(model, probe, way, i);
        Window& window = windows.of(i);
        const BoundedDistance found = steps.time([&] {
            return window.distance({window.model(), probe, placed_at(way[i]), {}, &cache},
                                   workspace);
        });
        complete += found.is_complete ? 1 : 0;
    }
    steps.print("window", complete / static_cast<double>(way.size()));
    windows.print_fills();
}

#ifdef CDPREP_HAVE_FCL
template <class Volume>
void time_fcl(const char* way_name, const Model& model, const Model& probe,
              const std::vector<Double3>& way) {
    const fcl::BVHModel<Volume> a = fcl_model<Volume>(model), b = fcl_model<Volume>(probe);
    time_steps(way_name, std::min(kFclSteps, way.size()), [&](std::size_t i) {
        const fcl::DistanceRequestd request(false, false, 0, 0);
        fcl::DistanceResultd result;
        return fcl::distance(&a, fcl::Transform3d::Identity(), &b,
                             fcl_transform(placed_at(way[i]).pose_b()), request, result) > 0
                   ? 1.0
                   : 0.0;
    });
}
#endif

/// A fiftieth of the vertices, those around the probe, moves a little at each step.
void time_deforming(const Model& model, const Model& probe, const std::vector<Double3>& way) {
    std::vector<Block> room = room_of(LiveModel::bytes(model));
    auto made = LiveModel::in(std::as_writable_bytes(std::span(room)), model);
    if (!made) stop(made.error().message);
    LiveModel& live = made.value();
    const std::span<const Float3> rest = model.mesh().positions_f32;
    const std::span<const std::uint32_t> number = model.source().vertex;
    const std::size_t count = rest.size() / 50;
    std::vector<std::uint32_t> nearest(rest.size());
    std::iota(nearest.begin(), nearest.end(), 0U);
    std::vector<std::uint32_t> moved(count);
    std::vector<Float3> to(count);
    Workspace workspace;
    PairCache cache;
    const auto choose = [&](std::size_t i) {
        const auto far = [&](std::uint32_t v) {
            return std::hypot(rest[v].x - way[i].x, rest[v].y - way[i].y, rest[v].z - way[i].z);
        };
        std::ranges::nth_element(nearest, nearest.begin() + static_cast<std::ptrdiff_t>(count), {},
                                 far);
    };
    Steps steps, refits;
    for (std::size_t i = 0; i < way.size(); ++i) {
        if (i % 50 == 0) choose(i);
        const auto by = static_cast<float>(1e-4 * std::sin(0.3 * static_cast<double>(i)));
        for (std::size_t k = 0; k < count; ++k) {
            const Float3& p = rest[nearest[k]];
            moved[k] = number[nearest[k]];
            to[k] = {p.x + by, p.y - by, p.z + by};
        }
        const bool is_done = steps.time([&] {
            const bool is_fitted = refits.time([&] { return live.refit(moved, to).ok(); });
            (void)distance({live.model(), probe, placed_at(way[i]), {}, &cache}, workspace);
            return is_fitted;
        });
        if (!is_done) stop("A refit was refused.");
    }
    steps.print("deforming_2_percent", 0);
    refits.print("its_refit", 0);
}

/// The widths of late answers, by budget, with a cache that had a whole answer every 50 steps.
void print_budgets(const Model& model, const Model& probe, const std::vector<Double3>& way) {
    std::printf("work,complete,median_us,p999_us,max_us,us_per_work,late_width_median,max\n");
    for (const std::uint64_t work : {20, 50, 100, 200, 500, 1000, 2000, 5000, 0}) {
        Workspace workspace;
        PairCache cache;
        std::vector<double> times, widths = {0};
        double complete = 0, all_work = 0, all_time = 0;
        for (std::size_t i = 0; i < way.size(); ++i) {
            const bool is_whole = i % 50 == 0;
            const double begun = thread_us();
            const BoundedDistance found =
                bounded_distance({model, probe, placed_at(way[i]), {}, &cache}, workspace, {},
                                 {.work = is_whole ? 0 : work});
            const double took = thread_us() - begun;
            if (is_whole) continue;
            times.push_back(took);
            all_work += static_cast<double>(found.work);
            all_time += took;
            complete += found.is_complete ? 1 : 0;
            if (!found.is_complete && found.nearest) widths.push_back(found.upper - found.lower);
        }
        std::printf(
            "%llu,%.4f,%.2f,%.2f,%.2f,%.4f,%.5f,%.5f\n", static_cast<unsigned long long>(work),
            complete / static_cast<double>(times.size()), median(times, 0.5), median(times, 0.999),
            median(times, 1), all_time / all_work, median(widths, 0.5), median(widths, 1));
    }
}

void run(const Model& model, const Model& probe, std::size_t steps, double radius) {
    const std::vector<Double3> way = glide(model, steps);
    std::printf("triangles: %u and %u; touched ahead: %zu bytes\n", model.triangle_count(),
                probe.triangle_count(), model.touch() + probe.touch());
    Steps::print_header();
    Workspace workspace;
    PairCache cache, of_bounded;
    time_steps("distance", steps, [&](std::size_t i) {
        const auto found = distance({model, probe, placed_at(way[i])}, workspace);
        return found->upper == 0 ? 1.0 : 0.0;
    });
    time_steps("distance_cached", steps, [&](std::size_t i) {
        const Pair pair{model, probe, placed_at(way[i]), {}, &cache};
        return distance(pair, workspace)->upper == 0 ? 1.0 : 0.0;
    });
    time_steps("bounded_cached", steps, [&](std::size_t i) {
        const Pair pair{model, probe, placed_at(way[i]), {}, &of_bounded};
        return bounded_distance(pair, workspace).upper == 0 ? 1.0 : 0.0;
    });
    time_windows(model, probe, way, radius);
    time_deforming(model, probe, way);
#ifdef CDPREP_HAVE_FCL
    time_fcl<fcl::OBBRSSd>("fcl_obbrss", model, probe, way);
    time_fcl<fcl::RSSd>("fcl_rss", model, probe, way);
#endif
    print_budgets(model, probe, way);
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    if (count < 3) cdprep::stop("Usage: haptic_bench MODEL PROBE [STEPS [RADIUS]]");
    const std::size_t steps = count > 3 ? std::strtoull(arguments[3], nullptr, 10) : 60'000;
    const double radius = count > 4 ? std::strtod(arguments[4], nullptr) : 0.05;
    cdprep::run(cdprep::open_or_stop(arguments[1]), cdprep::open_or_stop(arguments[2]), steps,
                radius);
}
