// SPDX-License-Identifier: MIT
// How fast two models answer "do they touch?", "which triangles overlap?", "how far
// apart?" and "within a tolerance?", beside FCL (boxes for the first two, swept spheres
// for the others) where it was found at configure time. For each pair of models and each set
// of poses (light, deep, near) every contender asks the whole set, contenders take
// turns, and that several times; the time of a pose is the median of its rounds.
// The cold rounds flush the caches before every question. One thread. Of bakes with pieces
// the hierarchy over them is a contender too.
//
// Usage: pair_queries_bench [--warm] BAKES POSES [ROUNDS [PAIR...]]
// --warm leaves the cold rounds out, which take most of the time.
// BAKES holds NAME.cdp.h5, baked with --normalize; POSES holds A-B.pose files of 12
// numbers a line, R row by row, then T; line i is of kind i mod 3. PAIR is A-B;
// without, all files of POSES are taken.
//
// Prints a CSV table, microseconds; `times` is the peer's median by ours. Then, for
// ours, what a question took in the mean: boxes against boxes, triangles against
// triangles, and pairs of triangles that were decided in float, by a common corner, in
// double and in exact arithmetic. Before each pair of models the bytes per triangle
// that a collision touches, A's and B's.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench_input.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/pairs.h"

#ifdef CDPREP_HAVE_FCL
#include "fcl_models.h"
#endif

namespace cdprep {
namespace {

constexpr std::size_t kMostPairs = 1U << 22;
constexpr std::array<const char*, 3> kKinds = {"light", "deep", "near"};

enum Question : std::size_t { overlap, collides, how_far, within_true, within_false };
constexpr std::array<const char*, 5> kQuestions = {"overlap", "collide", "distance", "within_true",
                                                   "within_false"};
/// The gap of the near poses is 1 % of the diagonal: these two lie around it.
constexpr double kTrueTolerance = 0.012;
constexpr double kFalseTolerance = 0.008;

class Contender {
public:
    virtual ~Contender() = default;
    [[nodiscard]] virtual const char* name() const = 0;
    /// Returns the number of pairs, or 1 for a collision.
    virtual std::size_t ask(std::size_t question, const Pose& pose) = 0;
    /// What one more asking of the set does, where that is counted.
    virtual QueryCounts counts(std::size_t /*question*/, const std::vector<Pose>& /*poses*/) {
        return {};
    }
};

class Ours final : public Contender {
public:
    Ours(const Model& a, const Model& b, Structure structure)
        : a_(a), b_(b), through_{.structure = structure}, pairs_(kMostPairs) {}
    [[nodiscard]] const char* name() const override {
        return through_.structure == Structure::pieces ? "pieces" : "cdprep";
    }
    std::size_t ask(std::size_t question, const Pose& pose) override {
        const Placement placement = Placement::b_moves(pose);
        switch (question) {
            case overlap:
                return overlaps_through({a_, b_, placement}, through_, workspace_, pairs_);
            case collides:
                return any_overlap_through({a_, b_, placement}, through_, workspace_) ? 1 : 0;
            case how_far:
                return distance({a_, b_, placement, {.through = through_.structure}}, workspace_)
                                   ->upper > 0
                           ? 1
                           : 0;
            case within_true:
                return is_within(kTrueTolerance, placement) ? 1 : 0;
            default:
                return is_within(kFalseTolerance, placement) ? 1 : 0;
        }
    }

    QueryCounts counts(std::size_t question, const std::vector<Pose>& poses) override {
        QueryCounts sum;
        workspace_.count_into(&sum);
        for (const Pose& pose : poses) ask(question, pose);
        workspace_.count_into(nullptr);
        return sum;
    }

private:
    bool is_within(double tolerance, const Placement& placement) {
        return within({a_, b_, placement, {.through = through_.structure}}, tolerance, workspace_);
    }

    const Model& a_;
    const Model& b_;
    StructureOptions through_;
    Workspace workspace_;
    std::vector<TrianglePair> pairs_;
};

#ifdef CDPREP_HAVE_FCL
class Fcl final : public Contender {
public:
    Fcl(const Model& a, const Model& b)
        : a_(fcl_model<fcl::OBBd>(a)),
          b_(fcl_model<fcl::OBBd>(b)),
          spheres_a_(fcl_model<fcl::RSSd>(a)),
          spheres_b_(fcl_model<fcl::RSSd>(b)) {}
    [[nodiscard]] const char* name() const override {
        return "fcl";
    }
    std::size_t ask(std::size_t question, const Pose& pose) override {
        const fcl::Transform3d a_from_b = fcl_transform(pose);
        if (question >= how_far) return far_apart(question, a_from_b);
        fcl::CollisionResultd result;
        fcl::collide(&a_, fcl::Transform3d::Identity(), &b_, a_from_b,
                     fcl::CollisionRequestd(question == overlap ? kMostPairs : 1, false), result);
        return result.numContacts();
    }

private:
    /// FCL has no tolerance query: its distance answers that too.
    std::size_t far_apart(std::size_t question, const fcl::Transform3d& a_from_b) {
        fcl::DistanceRequestd request(false, false, 0, 0);
        fcl::DistanceResultd result;
        fcl::distance(&spheres_a_, fcl::Transform3d::Identity(), &spheres_b_, a_from_b, request,
                      result);
        const double d = result.min_distance;
        if (question == how_far) return d > 0 ? 1 : 0;
        return d <= (question == within_true ? kTrueTolerance : kFalseTolerance) ? 1 : 0;
    }

    fcl::BVHModel<fcl::OBBd> a_;
    fcl::BVHModel<fcl::OBBd> b_;
    fcl::BVHModel<fcl::RSSd> spheres_a_;
    fcl::BVHModel<fcl::RSSd> spheres_b_;
};
#endif

/// Writes over more memory than any cache holds.
void flush_caches() {
    static std::vector<char> memory(std::size_t{256} << 20);
    for (std::size_t i = 0; i < memory.size(); i += 64) ++memory[i];
}

/// What one contender took for one question over one set.
struct Times {
    std::vector<std::vector<double>> us;  ///< [pose][round]
    std::size_t pairs = 0;                ///< of all poses

    [[nodiscard]] std::vector<double> by_pose() const {
        std::vector<double> result;
        for (const auto& rounds : us) result.push_back(median(rounds));
        return result;
    }
};

void ask_set(Contender& contender, std::size_t question, const std::vector<Pose>& poses, bool cold,
             Times& times) {
    times.us.resize(poses.size());
    times.pairs = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        if (cold) flush_caches();
        const auto begun = std::chrono::steady_clock::now();
        times.pairs += contender.ask(question, poses[i]);
        const std::chrono::duration<double, std::micro> taken =
            std::chrono::steady_clock::now() - begun;
        times.us[i].push_back(taken.count());
    }
}

/// The columns for a set, a question's mean each.
std::string count_columns(const QueryCounts& counts, std::size_t questions) {
    std::string columns;
    for (const std::uint64_t count : {counts.box_pairs, counts.triangle_pairs, counts.by_kernel,
                                      counts.by_corner, counts.by_filter, counts.by_exact}) {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), ",%.1f",
                      static_cast<double>(count) / static_cast<double>(questions));
        columns += text.data();
    }
    return columns;
}

/// Medians of a pair of models, for the summary.
using Ratios = std::map<std::string, std::vector<double>>;

void compare(const std::string& pair, const std::vector<std::unique_ptr<Contender>>& contenders,
             const std::vector<Pose>& all, int rounds, bool cold, Ratios& ratios) {
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
        const std::vector<Pose> poses = poses_of_kind(all, kind, kKinds.size());
        for (std::size_t question = 0; question < kQuestions.size(); ++question) {
            const bool is_near = kind == 2;
            if (question == overlap && is_near) continue;   // nothing overlaps
            if (question >= how_far && !is_near) continue;  // 0
            std::vector<Times> times(contenders.size());
            for (int round = 0; round < rounds; ++round) {
                for (std::size_t c = 0; c < contenders.size(); ++c) {
                    ask_set(*contenders[c], question, poses, cold, times[c]);
                }
            }
            const double ours = median(times[0].by_pose());
            const double ours95 = median(times[0].by_pose(), 0.95);
            for (std::size_t c = 0; c < contenders.size(); ++c) {
                const std::vector<double> us = times[c].by_pose();
                const std::string key = std::string(kQuestions[question]) + "/" + kKinds[kind] +
                                        (cold ? "/cold," : "/warm,") + contenders[c]->name();
                const QueryCounts counts = contenders[c]->counts(question, poses);
                std::printf("%s,%s,%zu,%zu,%.2f,%.2f,%.2f,%.2f%s\n", pair.c_str(), key.c_str(),
                            poses.size(), times[c].pairs, median(us), median(us, 0.95),
                            median(us) / ours, median(us, 0.95) / ours95,
                            count_columns(counts, poses.size()).c_str());
                if (c > 0) ratios[key].push_back(median(us) / ours);
            }
            std::fflush(stdout);
        }
    }
}

/// Of the sections that collisions, overlaps and distances read.
double bytes_per_triangle(const Model& model) {
    std::size_t bytes = model.bvh().nodes.size_bytes() + model.bvh().oriented.size_bytes() +
                        model.bvh().leaves.size_bytes() + model.source().triangle.size_bytes();
    if (!model.has_exact_leaves()) {
        bytes += model.mesh().triangles.size_bytes() + model.mesh().positions_f32.size_bytes() +
                 model.mesh().positions_f64.size_bytes();
    }
    return static_cast<double>(bytes) / model.triangle_count();
}

void run(const std::filesystem::path& bakes, const std::filesystem::path& poses_folder,
         const std::vector<std::string>& pairs, int rounds, bool warm_alone) {
    std::printf(
        "pair,question,contender,poses,pairs,median_us,p95_us,times,times_p95,"
        "box_pairs,triangle_pairs,by_kernel,by_corner,by_filter,by_exact\n");
    Ratios ratios;
    for (const std::string& pair : pairs) {
        const std::size_t dash = pair.find('-');
        if (dash == std::string::npos) stop("'" + pair + "' is not two names with a dash between");
        const Model a = open_or_stop(bakes / (pair.substr(0, dash) + ".cdp.h5"));
        const Model b = open_or_stop(bakes / (pair.substr(dash + 1) + ".cdp.h5"));
        const std::vector<Pose> poses = read_poses(poses_folder / (pair + ".pose"));
        std::vector<std::unique_ptr<Contender>> contenders;
        contenders.push_back(std::make_unique<Ours>(a, b, Structure::bvh));
        if (!a.pieces().nodes.empty() && !b.pieces().nodes.empty()) {
            contenders.push_back(std::make_unique<Ours>(a, b, Structure::pieces));
        }
#ifdef CDPREP_HAVE_FCL
        contenders.push_back(std::make_unique<Fcl>(a, b));
#endif
        std::printf("bytes per triangle of %s,,,,,%.1f,,%.1f,\n", pair.c_str(),
                    bytes_per_triangle(a), bytes_per_triangle(b));
        compare(pair, contenders, poses, rounds, false, ratios);
        if (!warm_alone) compare(pair, contenders, poses, 1, true, ratios);
    }
    for (const auto& [key, values] : ratios) {
        std::printf("median of %zu pairs,%s,,,,,%.2f,\n", values.size(), key.c_str(),
                    median(values));
        std::printf("worst of %zu pairs,%s,,,,,%.2f,\n", values.size(), key.c_str(),
                    *std::min_element(values.begin(), values.end()));
    }
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    const bool warm_alone = count > 1 && std::string(arguments[1]) == "--warm";
    if (warm_alone) {
        ++arguments;
        --count;
    }
    const auto [bakes, poses, pairs, rounds] =
        cdprep::pair_arguments(count, arguments, " [--warm]");
    cdprep::run(bakes, poses, pairs, rounds, warm_alone);
}
