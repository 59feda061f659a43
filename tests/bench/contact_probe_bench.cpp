// SPDX-License-Identifier: MIT
// Contacts at the rate of a haptic loop: a probe glides over a large model (gliding_probe.h), and
// each step asks for at most 8 contacts with their manifolds. FCL gives pairs of triangles, without
// a tolerance, in the first 6,000 steps. Processor time, one thread; page faults after 50 steps.
//
// Usage: contact_probe_bench MODEL PROBE [STEPS [TOLERANCE [WORK]]], 60,000 steps if left out
// Both are bakes with --effects contacts,closest: a model normalised to a diagonal of 1, and a ball
// of radius 0.02 about 0.
//
// Prints a CSV table: microseconds of a step, and the share of steps with contacts.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "bench_input.h"
#include "cdprep/contacts.h"
#include "gliding_probe.h"
#include "probe_steps.h"

#ifdef CDPREP_HAVE_FCL
#include "fcl_models.h"
#endif

namespace cdprep {
namespace {

#ifdef CDPREP_HAVE_FCL
constexpr std::size_t kFclSteps = 6'000;
#endif

void time_ours(const Model& model, const Model& probe, const std::vector<Double3>& centres,
               const ContactOptions& options) {
    Workspace workspace;
    std::array<Contact, 8> room;
    std::size_t touched = 0, left_out = 0, unsearched = 0;
    double found = 0, computed = 0;
    Steps steps;
    for (const Double3& c : centres) {
        const ContactsVerdict verdict = steps.time([&] {
            return contacts({model, probe, placed_at(c)}, workspace, room, options);
        });
        touched += verdict.count > 0 ? 1 : 0;
        left_out += verdict.complete ? 0 : 1;
        unsearched += verdict.searched ? 0 : 1;
        found += static_cast<double>(verdict.found);
        computed += static_cast<double>(verdict.computed);
    }
    const auto count = static_cast<double>(centres.size());
    steps.print("contacts", static_cast<double>(touched) / count);
    std::printf("with_more,out_of_work,found,computed\n%zu,%zu,%.1f,%.1f\n", left_out, unsearched,
                found / count, computed / count);
}

#ifdef CDPREP_HAVE_FCL
/// The contacts of FCL: pairs of triangles, the first `most` that it meets or all.
void time_fcl(const char* way, const Model& model, const Model& probe,
              const std::vector<Double3>& centres, std::size_t most) {
    using Volume = fcl::OBBRSSd;
    const fcl::BVHModel<Volume> a = fcl_model<Volume>(model), b = fcl_model<Volume>(probe);
    time_steps(way, std::min(kFclSteps, centres.size()), [&](std::size_t i) {
        const fcl::CollisionRequestd request(most, true);
        fcl::CollisionResultd result;
        fcl::collide(&a, fcl::Transform3d::Identity(), &b,
                     fcl_transform(placed_at(centres[i]).pose_b()), request, result);
        return result.isCollision() ? 1.0 : 0.0;
    });
}
#endif

void run(const Model& model, const Model& probe, std::size_t steps, const ContactOptions& options) {
    const std::vector<Double3> centres = glide(model, steps);
    Steps::print_header();
#ifdef CDPREP_HAVE_FCL
    time_fcl("fcl_obbrss_8", model, probe, centres, 8);
    time_fcl("fcl_obbrss_all", model, probe, centres, std::size_t{1} << 20);
#endif
    time_ours(model, probe, centres, options);
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    if (count < 3)
        cdprep::stop("Usage: contact_probe_bench MODEL PROBE [STEPS [TOLERANCE [WORK]]]");
    const std::size_t steps = count > 3 ? std::strtoull(arguments[3], nullptr, 10) : 60'000;
    cdprep::ContactOptions options = {
        .tolerance = 0.004, .manifold = cdprep::Manifold::four, .most = 8};
    if (count > 4) options.tolerance = std::strtod(arguments[4], nullptr);
    if (count > 5) options.work = std::strtoull(arguments[5], nullptr, 10);
    cdprep::run(cdprep::open_or_stop(arguments[1]), cdprep::open_or_stop(arguments[2]), steps,
                options);
}
