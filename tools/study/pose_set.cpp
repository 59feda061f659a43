// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/pose_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cdprep/format/checksum.h"
#include "cdprep/pairs.h"
#include "mesh/vectors.h"
#include "study/rigid_truth.h"
#include "study/seeded_random.h"

namespace cdprep::study {
namespace {

using mesh::minus;
using mesh::plus;
using mesh::scaled;

// The following limits are shares of the diagonal.
constexpr double kDeepest = 0.15;
constexpr double kDeep = 1e-2;
constexpr double kBand = 1e-3;
constexpr double kLeastOfBand = 1e-9;
constexpr double kNear = 5e-2;
constexpr double kFarthest = 1;

/// The largest coordinate of a Pose.
constexpr double kMostShift = 0x1p1000;

constexpr int kTries = 12;
constexpr int kMostSteps = 200;
constexpr double kCloseEnough = 1e-6;  ///< advancement ends, halving begins
constexpr int kHalvings = 60;

double length_of(const Double3& v) {
    return std::hypot(v.x, v.y, v.z);
}

/// A model's box in the form that WayIn uses.
struct Extent {
    Double3 middle;
    Double3 half;

    [[nodiscard]] double diagonal() const {
        return 2 * length_of(half);
    }
};

Extent extent_of(const Model& model) {
    if (model.record().bounds == nullptr || model.triangle_count() == 0) return {};
    const format::Bounds& box = *model.record().bounds;
    const auto middle = [](double low, double high) { return low + 0.5 * (high - low); };
    return {{middle(box.lower.x, box.upper.x), middle(box.lower.y, box.upper.y),
             middle(box.lower.z, box.upper.z)},
            {0.5 * (box.upper.x - box.lower.x), 0.5 * (box.upper.y - box.lower.y),
             0.5 * (box.upper.z - box.lower.z)}};
}

/// The two models, with the length that measures the poses.
struct Pair {
    const Model& a;
    const Model& b;
    SourceTriangles triangles_a;
    SourceTriangles triangles_b;
    Extent of_a;
    Extent of_b;
    double diagonal;
};

Pair pair_of(const Model& a, const Model& b) {
    const Extent of_a = extent_of(a);
    const Extent of_b = extent_of(b);
    const double smaller = std::min(of_a.diagonal(), of_b.diagonal());
    const double larger = std::max(of_a.diagonal(), of_b.diagonal());
    return {
        a, b, SourceTriangles(a), SourceTriangles(b), of_a, of_b, smaller > 0 ? smaller : larger};
}

/// Returns whether B can be moved to wherever the poses, and walks that start there, lead.
bool can_move(const Pair& pair) {
    const double path = pair.of_a.diagonal() + pair.of_b.diagonal() + 1.1 * pair.diagonal;
    return length_of(pair.of_a.middle) + length_of(pair.of_a.half) + path +
               length_of(pair.of_b.middle) <
           kMostShift;
}

/// A straight path of B towards A: at `s` the middle of B is at target + s * direction.
class WayIn {
public:
    WayIn(const Pair& pair, SeededRandom& random) : pair_(pair) {
        quaternion_ = random.quaternion();
        direction_ = random.direction();
        const Double3& half = pair.of_a.half;
        target_ = {pair.of_a.middle.x + 0.5 * half.x * random.between(-1, 1),
                   pair.of_a.middle.y + 0.5 * half.y * random.between(-1, 1),
                   pair.of_a.middle.z + 0.5 * half.z * random.between(-1, 1)};
        const Pose turn = turned({0, 0, 0});
        offset_ = transform_point(turn, pair.of_b.middle);
    }

    [[nodiscard]] Pose at(double s) const {
        return turned(minus(plus(target_, scaled(direction_, s)), offset_));
    }
    [[nodiscard]] const std::array<double, 4>& quaternion() const {
        return quaternion_;
    }

    /// Returns the `s` at which B first touches A on its way in, or nothing if B passes by.
    [[nodiscard]] std::optional<double> first_touch(Workspace& workspace) const {
        const double outside = pair_.of_a.diagonal() + pair_.of_b.diagonal();
        double apart = outside;
        double gap = 0;
        for (int step = 0; step < kMostSteps; ++step) {
            gap = distance({pair_.a, pair_.b, Placement::b_moves(at(apart))}, workspace,
                           {.relative_error = 0.1})
                      ->lower;
            if (gap <= kCloseEnough * pair_.diagonal) break;
            apart -= gap;
            if (apart < -outside) return std::nullopt;
        }
        return between(apart, gap, workspace);
    }

private:
    [[nodiscard]] Pose turned(const Double3& shift) const {
        const auto& [w, x, y, z] = quaternion_;
        return Pose::from_quaternion(w, x, y, z, shift).value();
    }

    [[nodiscard]] bool touches(double s, Workspace& workspace) const {
        return collide({pair_.a, pair_.b, Placement::b_moves(at(s))}, workspace).hit == Answer::yes;
    }

    /// Returns the `s` of the touch shortly after `apart`, where the models do not touch yet.
    /// Returns nothing if there is no touch within the band of touching poses.
    [[nodiscard]] std::optional<double> between(double apart, double gap,
                                                Workspace& workspace) const {
        // A step of 0, which a share of a subnormal diagonal may be, would lead nowhere.
        double step =
            std::max({gap, 0x1p-40 * pair_.diagonal, std::numeric_limits<double>::denorm_min()});
        double inside = apart - step;
        while (!touches(inside, workspace)) {
            apart = inside;
            step *= 2;
            inside -= step;
            if (step > kBand * pair_.diagonal) return std::nullopt;  // B came near, but passes by
        }
        for (int i = 0; i < kHalvings; ++i) {
            const double middle = 0.5 * (apart + inside);
            if (middle <= inside || middle >= apart) break;
            (touches(middle, workspace) ? inside : apart) = middle;
        }
        return inside;
    }

    const Pair& pair_;
    std::array<double, 4> quaternion_{};
    Double3 direction_{};
    Double3 target_{};
    Double3 offset_{};
};

/// Returns how far B moves on from the first touch, as a share of the diagonal; below 0: back.
double further_in(Stratum stratum, std::size_t number, SeededRandom& random) {
    switch (stratum) {
        case Stratum::deep:
            return random.between(kDeep, kDeepest);
        case Stratum::shallow:
            return random.between_by_factors(kBand, kDeep);
        case Stratum::touching: {
            const double size = random.between_by_factors(kLeastOfBand, kBand);
            return number % 2 == 0 ? size : -size;
        }
        case Stratum::near:
            return -random.between_by_factors(kBand, 1.5 * kNear);
        default:
            return -random.between(kNear, kFarthest);
    }
}

/// Returns the pose with its answers.
StudyPose ask(const Pair& pair, const Pose& pose, double in, Workspace& workspace) {
    StudyPose asked;
    asked.a_from_b = pose;
    const Placement placement = Placement::b_moves(pose);
    const Collision solid = collide({pair.a, pair.b, placement, {.body = Body::solid}}, workspace);
    const std::optional<Distance> apart = distance({pair.a, pair.b, placement}, workspace);
    asked.hit = apart->upper == 0;
    asked.solid = solid.hit;
    asked.gap_lower = apart->lower;
    asked.gap_upper = apart->upper;
    if (asked.hit) asked.depth = std::max(0.0, in) * pair.diagonal;
    asked.is_rigid = asked.hit
                         ? crosses_when_rigid(pair.triangles_a, pair.triangles_b, pose, workspace)
                         : is_apart_when_rigid(pair.b, pose, apart->lower);
    return asked;
}

/// Returns whether the pose is in the stratum, and touches exactly if B moved on from first touch.
bool is_wanted(const StudyPose& pose, Stratum stratum, double in, double diagonal) {
    if (pose.hit != (in > 0)) return false;
    return stratum_of(pose.hit, pose.depth / diagonal, pose.gap_upper / diagonal) == stratum;
}

std::optional<StudyPose> draw(const Pair& pair, Stratum stratum, std::size_t number,
                              std::uint64_t seed, Workspace& workspace,
                              const std::function<bool()>& stop) {
    SeededRandom seeds(seed + 0x1000003U * static_cast<std::uint64_t>(stratum));
    SeededRandom random(seeds.bits() + 0x9e3779b97f4a7c15U * (number + 1));
    for (int i = 0; i < kTries && !(stop && stop()); ++i) {
        const WayIn way(pair, random);
        const double in = further_in(stratum, number, random);
        const std::optional<double> touch = way.first_touch(workspace);
        if (!touch) continue;
        StudyPose pose = ask(pair, way.at(*touch - in * pair.diagonal), in, workspace);
        pose.quaternion = way.quaternion();
        pose.stratum = stratum;
        if (is_wanted(pose, stratum, in, pair.diagonal)) return pose;
    }
    return std::nullopt;
}

/// Returns the stratum of a given pose.
Stratum sorted(const StudyPose& pose, std::optional<Stratum> said, double diagonal) {
    if (!pose.hit) {
        return stratum_of(false, 0, pose.gap_upper / diagonal).value_or(Stratum::far);
    }
    const bool can_touch = said && *said != Stratum::near && *said != Stratum::far;
    return can_touch ? *said : Stratum::deep;
}

}  // namespace

std::vector<std::size_t> PoseSet::of(Stratum stratum) const {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        if (poses[i].stratum == stratum) numbers.push_back(i);
    }
    return numbers;
}

std::optional<Stratum> stratum_of(bool hit, double depth, double gap) noexcept {
    if (hit) {
        if (depth <= kBand) return Stratum::touching;
        if (depth <= kDeep) return Stratum::shallow;
        if (depth <= kDeepest) return Stratum::deep;
        return std::nullopt;
    }
    if (gap <= kBand) return Stratum::touching;
    if (gap <= kNear) return Stratum::near;
    if (gap <= kFarthest) return Stratum::far;
    return std::nullopt;
}

PoseSet make_pose_set(const Model& a, const Model& b, const PoseSetOptions& options) {
    PoseSet set;
    set.seed = options.seed;
    const Pair pair = pair_of(a, b);
    set.diagonal = pair.diagonal;
    const bool is_empty = a.triangle_count() == 0 || b.triangle_count() == 0;
    if (is_empty || !(pair.diagonal > 0) || !can_move(pair)) return set;
    const std::size_t per_stratum = options.per_stratum;
    std::vector<std::optional<StudyPose>> drawn(kStrata * per_stratum);
    options.parallel_for(drawn.size(), [&](std::size_t i) {
        Workspace workspace;
        drawn[i] = draw(pair, static_cast<Stratum>(i / per_stratum), i % per_stratum, options.seed,
                        workspace, options.stop);
    });
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        if (drawn[i]) {
            set.poses.push_back(*drawn[i]);
        } else {
            ++set.missing[i / per_stratum];
        }
    }
    return set;
}

PoseSet ask_poses(const Model& a, const Model& b, std::span<const GivenPose> given,
                  std::string source, const PoseSetOptions& options) {
    PoseSet set;
    set.source = std::move(source);
    const Pair pair = pair_of(a, b);
    set.diagonal = pair.diagonal;
    const bool is_empty = a.triangle_count() == 0 || b.triangle_count() == 0;
    if (is_empty || !(pair.diagonal > 0)) return set;
    std::vector<std::optional<StudyPose>> asked(given.size());
    options.parallel_for(given.size(), [&](std::size_t i) {
        if (options.stop && options.stop()) return;
        Workspace workspace;
        asked[i] = ask(pair, given[i].a_from_b, 0, workspace);
        asked[i]->stratum = sorted(*asked[i], given[i].stratum, pair.diagonal);
    });
    for (const auto& pose : asked) {
        if (pose) set.poses.push_back(*pose);
    }
    std::ranges::stable_sort(set.poses, {}, &StudyPose::stratum);
    return set;
}

std::uint64_t hash_of(const PoseSet& set) {
    std::vector<double> numbers;
    for (const StudyPose& pose : set.poses) {
        const auto& rotation = pose.a_from_b.rotation();
        const Double3& t = pose.a_from_b.translation();
        numbers.insert(numbers.end(), rotation.begin(), rotation.end());
        numbers.insert(numbers.end(), {t.x, t.y, t.z});
    }
    return format::checksum(std::as_bytes(std::span(numbers)));
}

std::optional<Stratum> find_stratum(std::string_view name) noexcept {
    const auto at = std::ranges::find(kStratumNames, name);
    if (at == kStratumNames.end()) return std::nullopt;
    return static_cast<Stratum>(at - kStratumNames.begin());
}

}  // namespace cdprep::study
