// SPDX-License-Identifier: MIT
// Times of impact of two models. The first stays, the second flies past or into it and turns. FCL
// does the same motions beside: by conservative advancement, and naively by 100 poses in turn.
// Processor time, one thread, the contenders in turn.
//
// Usage: impact_bench FIXED MOVING [MOTIONS [TOLERANCE]]
// Both are bakes with --effects distance. TOLERANCE is a share of the size of the fixed model.
//
// Prints a CSV table of one row: counts, microseconds, and errors as shares of that size. The width
// is how far a point may move between the two bounds. FCL gives one time: its error is how far a
// point moves between that time and the interval. A miss of FCL is a contact that it denies.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <vector>

#include "bench_input.h"
#include "cdprep/advanced/model_views.h"
#include "cdprep/time_of_impact.h"

#ifdef CDPREP_HAVE_FCL
#include "fcl_models.h"
#endif

namespace cdprep {
namespace {

/// A ball around a model.
struct Ball {
    Double3 centre;
    double radius;
};

Ball ball_of(const Model& model) {
    Double3 lower = {1e300, 1e300, 1e300}, upper = {-1e300, -1e300, -1e300};
    for (const Float3& p : model.mesh().positions_f32) {
        lower = {std::min(lower.x, double{p.x}), std::min(lower.y, double{p.y}),
                 std::min(lower.z, double{p.z})};
        upper = {std::max(upper.x, double{p.x}), std::max(upper.y, double{p.y}),
                 std::max(upper.z, double{p.z})};
    }
    return {{(lower.x + upper.x) / 2, (lower.y + upper.y) / 2, (lower.z + upper.z) / 2},
            std::hypot(upper.x - lower.x, upper.y - lower.y, upper.z - lower.z) / 2};
}

class Motions {
public:
    Motions(const Model& fixed, const Model& moving)
        : fixed_(ball_of(fixed)), moving_(ball_of(moving)) {}

    /// From one side of the fixed model to the other, past its centre by its radius at most.
    Motion next() {
        const double out = 1.2 * (fixed_.radius + moving_.radius);
        const Double3 from = direction(), aside = direction();
        const double off = fixed_.radius * share_(random_);
        const auto place = [&](double side) {
            return Double3{fixed_.centre.x + side * out * from.x + off * aside.x,
                           fixed_.centre.y + side * out * from.y + off * aside.y,
                           fixed_.centre.z + side * out * from.z + off * aside.z};
        };
        const Double3 begin = place(1), end = place(-1), axis = direction();
        const double angle = std::numbers::pi / 2 * share_(random_);
        const Pose turned = Pose::from_quaternion(gauss_(random_), gauss_(random_), gauss_(random_),
                                                  gauss_(random_), {})
                                .value();
        const Double3 c = transform_point(turned, moving_.centre);
        std::array<double, 12> rows{};
        std::copy(turned.rotation().begin(), turned.rotation().end(), rows.begin());
        rows[9] = begin.x - c.x;
        rows[10] = begin.y - c.y;
        rows[11] = begin.z - c.z;
        return Motion::by_velocity(Pose::from_rows(rows).value(),
                                   {end.x - begin.x, end.y - begin.y, end.z - begin.z},
                                   {angle * axis.x, angle * axis.y, angle * axis.z}, moving_.centre)
            .value();
    }
    [[nodiscard]] double size() const {
        return 2 * fixed_.radius;
    }
    /// No point moves faster than this.
    [[nodiscard]] double speed(const Motion& motion) const {
        const Double3& v = motion.parts().shift;
        return std::hypot(v.x, v.y, v.z) + motion.parts().angle * moving_.radius;
    }

private:
    Double3 direction() {
        const double x = gauss_(random_), y = gauss_(random_), z = gauss_(random_);
        const double length = std::hypot(x, y, z);
        return {x / length, y / length, z / length};
    }

    Ball fixed_;
    Ball moving_;
    std::mt19937 random_{1};
    std::normal_distribution<double> gauss_;
    std::uniform_real_distribution<double> share_{0, 1};
};

struct Tally {
    std::vector<double> us;
    std::vector<double> errors;
    std::vector<double> steps;
    int hits = 0;
    int others = 0;  ///< neither a hit nor a miss
    int misses = 0;  ///< of hits
};

#ifdef CDPREP_HAVE_FCL
/// FCL turns a model about its origin: so this is the centre.
fcl::BVHModel<fcl::RSSd> centred_fcl_model(const Model& model, const Double3& centre) {
    fcl::BVHModel<fcl::RSSd> made = fcl_model<fcl::RSSd>(model);
    std::vector<fcl::Vector3d> points(made.vertices, made.vertices + made.num_vertices);
    for (fcl::Vector3d& p : points) p -= fcl::Vector3d(centre.x, centre.y, centre.z);
    made.beginReplaceModel();
    made.replaceSubModel(points);
    made.endReplaceModel(false);
    return made;
}

fcl::Transform3d centred(const Pose& pose, const Double3& centre) {
    return fcl_transform(pose) * Eigen::Translation3d(centre.x, centre.y, centre.z);
}

class FclPair {
public:
    FclPair(const Model& fixed, const Model& moving, fcl::CCDSolverType solver)
        : centre_(ball_of(moving).centre),
          fixed_(fcl_model<fcl::RSSd>(fixed)),
          moving_(centred_fcl_model(moving, centre_)) {
        request_.num_max_iterations = 100;
        request_.ccd_motion_type = fcl::CCDM_LINEAR;
        request_.ccd_solver_type = solver;
    }
    void ask(const Motion& motion, const Impact& impact, double scale, Tally& tally) {
        const fcl::Transform3d still = fcl::Transform3d::Identity();
        const fcl::Transform3d begin = centred(motion.at(0), centre_);
        const fcl::Transform3d end = centred(motion.at(1), centre_);
        fcl::ContinuousCollisionResultd result;
        const double from = thread_us();
        fcl::continuousCollide(&fixed_, still, still, &moving_, begin, end, request_, result);
        tally.us.push_back(thread_us() - from);
        if (!result.is_collide) {
            if (impact.kind == ImpactKind::touching) ++tally.misses;
            return;
        }
        ++tally.hits;
        if (impact.kind != ImpactKind::touching) return;
        const double time = result.time_of_contact;
        const double off = std::max({0.0, impact.lower - time, time - impact.upper});
        tally.errors.push_back(off * scale);
    }

private:
    Double3 centre_;
    fcl::BVHModel<fcl::RSSd> fixed_;
    fcl::BVHModel<fcl::RSSd> moving_;
    fcl::ContinuousCollisionRequestd request_;
};
#endif

void print(const char* name, const Tally& tally) {
    const auto of = [](const std::vector<double>& values, double share) {
        return values.empty() ? 0.0 : median(values, share);
    };
    std::printf("%s,%zu,%d,%d,%d,%.1f,%.1f,%.1f,%.3g,%.3g,%.3g,%.0f,%.0f\n", name, tally.us.size(),
                tally.hits, tally.others, tally.misses, of(tally.us, 0.5), of(tally.us, 0.95),
                of(tally.us, 1), of(tally.errors, 0.5), of(tally.errors, 0.95), of(tally.errors, 1),
                of(tally.steps, 0.5), of(tally.steps, 1));
}

void run(const Model& fixed, const Model& moving, int count, double tolerance) {
    Motions motions(fixed, moving);
    Workspace workspace;
    Tally ours, advanced, stepped;
#ifdef CDPREP_HAVE_FCL
    FclPair advancing(fixed, moving, fcl::CCDC_CONSERVATIVE_ADVANCEMENT);
    FclPair stepping(fixed, moving, fcl::CCDC_NAIVE);
#endif
    for (int i = 0; i < count; ++i) {
        const Motion motion = motions.next();
        const double scale = motions.speed(motion) / motions.size();
        const double from = thread_us();
        const Impact impact = time_of_impact({fixed, moving, Motion(), motion}, workspace,
                                             {.tolerance = tolerance * motions.size()});
        ours.us.push_back(thread_us() - from);
        ours.steps.push_back(impact.steps);
        if (impact.kind == ImpactKind::touching) {
            ++ours.hits;
            ours.errors.push_back((impact.upper - impact.lower) * scale);
        } else if (impact.kind != ImpactKind::none) {
            ++ours.others;
        }
#ifdef CDPREP_HAVE_FCL
        advancing.ask(motion, impact, scale, advanced);
        stepping.ask(motion, impact, scale, stepped);
#endif
    }
    std::printf(
        "by,motions,hits,neither,misses,us,us_p95,us_max,error,error_p95,error_max,steps,"
        "steps_max\n");
    print("cdprep", ours);
#ifdef CDPREP_HAVE_FCL
    print("FCL conservative", advanced);
    print("FCL naive", stepped);
    std::printf("FCL / cdprep,,,,,%.1f,%.1f\n", median(advanced.us) / median(ours.us),
                median(stepped.us) / median(ours.us));
#endif
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    if (count < 3) cdprep::stop("usage: impact_bench FIXED MOVING [MOTIONS [TOLERANCE]]");
    const int motions = count > 3 ? std::max(1, std::atoi(arguments[3])) : 100;
    const double tolerance = count > 4 ? std::atof(arguments[4]) : 1e-6;
    cdprep::run(cdprep::open_or_stop(arguments[1]), cdprep::open_or_stop(arguments[2]), motions,
                tolerance);
}
