// SPDX-License-Identifier: MIT
// Contacts at the rate of a haptic loop: a probe glides over a large model (gliding_probe.h), and
// each step asks for at most 8 contacts with their manifolds. Processor time, one thread.
//
// Usage: contact_probe_bench MODEL PROBE [STEPS [TOLERANCE [WORK]]]
// Both are bakes with --effects contacts,closest: a model normalised to a diagonal of 1, and a ball
// of radius 0.02 about 0.
//
// Prints a CSV table: microseconds of a step, and how many had contacts.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "bench_input.h"
#include "cdprep/contacts.h"
#include "gliding_probe.h"

namespace cdprep {
namespace {

void run(const Model& model, const Model& probe, std::size_t steps, const ContactOptions& options) {
    const std::vector<Double3> centres = glide(model, steps);
    Workspace workspace;
    std::array<Contact, 8> room;
    std::vector<double> microseconds;
    std::size_t touched = 0, left_out = 0, unsearched = 0;
    double found = 0, computed = 0;
    for (const Double3& c : centres) {
        const std::clock_t begun = std::clock();
        const ContactsVerdict verdict =
            contacts({model, probe, placed_at(c)}, workspace, room, options);
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
