// SPDX-License-Identifier: MIT
// Contacts at the rate of a haptic loop: a small probe glides over a large model, 1 mm a step, and
// each step asks for at most 8 contacts with their manifolds. A normalised model counts as 250 mm
// long. Every probe's centre stays about its radius above the nearest point of the surface, so that
// most steps touch. Processor time, one thread.
//
// Usage: contact_probe_bench MODEL PROBE [STEPS [TOLERANCE [WORK]]]
// Both are bakes with --effects contacts,closest: a model normalised to a diagonal of 1, and a ball
// of radius 0.02 about 0.
//
// Prints a CSV table: microseconds of a step, and how many had contacts.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "bench_input.h"
#include "cdprep/contacts.h"
#include "cdprep/points.h"

namespace cdprep {
namespace {

constexpr double kStep = 0.004;  ///< 1 mm
constexpr double kRadius = 0.02;

Double3 plus(const Double3& p, double by, const Double3& d) {
    return {p.x + by * d.x, p.y + by * d.y, p.z + by * d.z};
}

Double3 unit(const Double3& v) {
    const double length = std::hypot(v.x, v.y, v.z);
    return length > 0 ? Double3{v.x / length, v.y / length, v.z / length} : Double3{1, 0, 0};
}

/// The centres of a probe that glides over a surface.
std::vector<Double3> glide(const Model& model, std::size_t steps) {
    Workspace workspace;
    std::mt19937 random(8);
    std::normal_distribution<double> side;
    Double3 at = {0.6, 0, 0}, along = {0, 1, 0};
    std::vector<Double3> centres;
    for (std::size_t i = 0; i < steps; ++i) {
        const auto near = closest_point(model, at, workspace);
        const Double3 up = unit(plus(at, -1, near->point));
        const double height = kRadius * (1 + 0.03 * std::sin(0.11 * static_cast<double>(i)));
        centres.push_back(plus(near->point, height, up));
        along = unit(plus(along, 0.2, {side(random), side(random), side(random)}));
        const double rise = along.x * up.x + along.y * up.y + along.z * up.z;
        along = unit(plus(along, -rise, up));
        at = plus(centres.back(), kStep, along);
    }
    return centres;
}

void run(const Model& model, const Model& probe, std::size_t steps, const ContactOptions& options) {
    const std::vector<Double3> centres = glide(model, steps);
    Workspace workspace;
    std::array<Contact, 8> room;
    std::vector<double> microseconds;
    std::size_t touched = 0, left_out = 0, unsearched = 0;
    double found = 0, computed = 0;
    for (const Double3& c : centres) {
        const Pose pose = Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, c.x, c.y, c.z}).value();
        const std::clock_t begun = std::clock();
        const ContactsVerdict verdict =
            contacts({model, probe, Placement::b_moves(pose)}, workspace, room, options);
        microseconds.push_back(1e6 * static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC);
        touched += verdict.count > 0 ? 1 : 0;
        left_out += verdict.complete ? 0 : 1;
        unsearched += verdict.searched ? 0 : 1;
        found += static_cast<double>(verdict.found);
        computed += static_cast<double>(verdict.computed);
    }
    std::sort(microseconds.begin(), microseconds.end());
    const auto at = [&](double share) {
        return microseconds[static_cast<std::size_t>(share * static_cast<double>(steps - 1))];
    };
    const auto count = static_cast<double>(steps);
    std::printf(
        "steps,touching,with_more,out_of_work,found,computed,median_us,p99_us,p999_us,max_us\n");
    std::printf("%zu,%zu,%zu,%zu,%.1f,%.1f,%.1f,%.1f,%.1f,%.1f\n", steps, touched, left_out,
                unsearched, found / count, computed / count, at(0.5), at(0.99), at(0.999), at(1));
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    if (count < 3)
        cdprep::stop("Usage: contact_probe_bench MODEL PROBE [STEPS [TOLERANCE [WORK]]]");
    const std::size_t steps = count > 3 ? std::strtoull(arguments[3], nullptr, 10) : 5000;
    cdprep::ContactOptions options = {
        .tolerance = 0.004, .manifold = cdprep::Manifold::four, .most = 8};
    if (count > 4) options.tolerance = std::strtod(arguments[4], nullptr);
    if (count > 5) options.work = std::strtoull(arguments[5], nullptr, 10);
    cdprep::run(cdprep::open_or_stop(arguments[1]), cdprep::open_or_stop(arguments[2]), steps,
                options);
}
