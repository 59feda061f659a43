// SPDX-License-Identifier: MIT
// What a PairCache gains where a model moves little from question to question. From
// every pose of a file a walk begins: each step moves B by 1/1000 of the diagonal and
// turns it by 0.2 degrees about its middle, in one direction a walk. Whole sets of
// walks are asked with and without a cache, in turns; a cache lives as long as a walk.
// Processor time. The first step of a walk is timed on its own: there the cache is empty, and is
// filled. One thread. Of bakes with pieces, questions through these follow, with a PieceCache.
//
// Usage: coherent_motion_bench BAKES POSES [ROUNDS [PAIR...]]
// as pair_queries_bench: models normalised, line i of a file is of kind i mod 3.
//
// Prints a CSV table: microseconds a question, the median of the rounds, and the spread
// of their middle half; `times` is the one by the other. Then the first question of a walk with a
// cache, and what a question did: pairs of boxes and of triangles, distances measured in double.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "bench_input.h"
#include "cdprep/advanced/pair_front.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/pairs.h"

namespace cdprep {
namespace {

constexpr double kStep = 0.001;  ///< of the diagonal, which is 1
constexpr double kTurn = 0.2 * std::numbers::pi / 180;
constexpr int kSteps = 20;  ///< timed
constexpr std::array<const char*, 3> kKinds = {"light", "deep", "near"};
enum Question : std::size_t { collides, overlaps, how_far, within };
constexpr std::array<const char*, 4> kQuestions = {"collide", "overlap", "distance", "within"};
constexpr double kTolerance = 0.01;

using Walk = std::vector<Placement>;

Double3 random_direction(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const Double3 v = {normal(random), normal(random), normal(random)};
    const double length = std::hypot(v.x, v.y, v.z);
    return {v.x / length, v.y / length, v.z / length};
}

/// turned * r, brought back to right angles by the quaternion it came from.
Pose turned_about(const Pose& from, const Double3& axis, double angle, const Double3& shift) {
    const double s = std::sin(angle / 2);
    const Pose turn =
        Pose::from_quaternion(std::cos(angle / 2), s * axis.x, s * axis.y, s * axis.z, {}).value();
    std::array<double, 12> rows{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t k = 0; k < 3; ++k) {
                rows[3 * i + j] += turn.rotation()[3 * i + k] * from.rotation()[3 * k + j];
            }
        }
    }
    const Double3& t = from.translation();
    rows[9] = t.x + shift.x;
    rows[10] = t.y + shift.y;
    rows[11] = t.z + shift.z;
    return Pose::from_rows(rows).value();
}

Walk walk_from(const Pose& start, std::mt19937& random) {
    const Double3 along = random_direction(random);
    const Double3 axis = random_direction(random);
    Walk walk;
    for (int i = 0; i <= kSteps; ++i) {
        const double x = kStep * i;
        walk.push_back(Placement::b_moves(
            turned_about(start, axis, kTurn * i, {x * along.x, x * along.y, x * along.z})));
    }
    return walk;
}

bool ask(const StructureOptions& through, const Model& a, const Model& b, std::size_t question,
         const Placement& placement, Workspace& workspace, PieceCache* cache) {
    Pair pair = {a, b, placement, {.through = through.structure}};
    if (cache != nullptr) pair.cache = &cache->pair, pair.front = &cache->front;
    switch (question) {
        case collides:
            return any_overlap_through(pair, through, workspace);
        case overlaps:
            pair.options.through = Structure::bvh;
            return cdprep::overlaps(pair, workspace, {}) > 0;
        case within:
            return cdprep::within(pair, kTolerance, workspace);
        default:
            return distance(pair, workspace)->upper == 0;
    }
}

/// What one contender took for one set of walks.
struct Taken {
    double us = 0;         ///< a question
    double first_us = 0;   ///< the first question of a walk
    std::size_t hits = 0;  ///< questions answered with yes, or with a distance of 0
};

Taken ask_all(const StructureOptions& through, const Model& a, const Model& b, std::size_t question,
              const std::vector<Walk>& walks, bool cached, Workspace& workspace,
              QueryCounts* counts) {
    Taken taken;
    for (const Walk& walk : walks) {
        PieceCache cache;
        PieceCache* kept = cached ? &cache : nullptr;
        const double filled = thread_us();
        ask(through, a, b, question, walk[0], workspace, kept);
        taken.first_us += thread_us() - filled;
        workspace.count_into(counts);
        const double begun = thread_us();
        for (std::size_t i = 1; i < walk.size(); ++i) {
            taken.hits += ask(through, a, b, question, walk[i], workspace, kept) ? 1 : 0;
        }
        taken.us += thread_us() - begun;
        workspace.count_into(nullptr);
    }
    taken.first_us /= static_cast<double>(walks.size());
    taken.us /= static_cast<double>(walks.size() * kSteps);
    return taken;
}

using Ratios = std::map<std::string, std::vector<double>>;

void compare(Structure structure, const std::string& pair, const Model& a, const Model& b,
             const std::vector<Pose>& poses, int rounds, Ratios& ratios) {
    std::mt19937 random(1);
    Workspace workspace;
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
        std::vector<Walk> walks;
        for (std::size_t i = kind; i < poses.size(); i += kKinds.size()) {
            walks.push_back(walk_from(poses[i], random));
        }
        for (std::size_t question = 0; question < kQuestions.size(); ++question) {
            if (question > overlaps && kind != 2) continue;  // touching: as collide
            const bool is_pieces = structure == Structure::pieces;
            if (is_pieces && question == overlaps) continue;  // has no cache
            std::array<std::vector<double>, 2> us;
            std::vector<double> first_us;
            std::array<std::size_t, 2> hits{};
            for (int round = 0; round < rounds; ++round) {
                for (const std::size_t cached : {0, 1}) {
                    const Taken taken = ask_all({.structure = structure}, a, b, question, walks,
                                                cached == 1, workspace, nullptr);
                    if (cached == 1) first_us.push_back(taken.first_us);
                    us[cached].push_back(taken.us);
                    hits[cached] = taken.hits;
                }
            }
            if (hits[0] != hits[1]) stop("a cache changed an answer");
            const std::string key =
                std::string(is_pieces ? "pieces/" : "") + kQuestions[question] + "/" + kKinds[kind];
            const double ratio = median(us[0]) / median(us[1]);
            std::printf("%s,%s,%zu,%zu,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f", pair.c_str(), key.c_str(),
                        walks.size() * kSteps, hits[0], median(us[0]), spread(us[0]), median(us[1]),
                        spread(us[1]), ratio, median(first_us));
            for (const bool cached : {false, true}) {
                QueryCounts counts;
                ask_all({.structure = structure}, a, b, question, walks, cached, workspace,
                        &counts);
                const auto of_one = [&](std::uint64_t count) {
                    return static_cast<double>(count) / static_cast<double>(walks.size() * kSteps);
                };
                std::printf(",%.1f,%.1f,%.1f", of_one(counts.box_pairs),
                            of_one(counts.triangle_pairs),
                            of_one(counts.measured + counts.measured_again));
            }
            std::printf("\n");
            ratios[key].push_back(ratio);
        }
        std::fflush(stdout);
    }
}

void run(const std::filesystem::path& bakes, const std::filesystem::path& poses_folder,
         const std::vector<std::string>& pairs, int rounds) {
    std::printf(
        "pair,question,questions,yes,plain_us,plain_spread_us,cached_us,cached_spread_us,times,"
        "first_us,plain_box_pairs,plain_triangle_pairs,plain_measured,cached_box_pairs,"
        "cached_triangle_pairs,cached_measured\n");
    Ratios ratios;
    for (const std::string& pair : pairs) {
        const std::size_t dash = pair.find('-');
        if (dash == std::string::npos) stop("'" + pair + "' is not two names with a dash between");
        const Model a = open_or_stop(bakes / (pair.substr(0, dash) + ".cdp.h5"));
        const Model b = open_or_stop(bakes / (pair.substr(dash + 1) + ".cdp.h5"));
        const std::vector<Pose> poses = read_poses(poses_folder / (pair + ".pose"));
        compare(Structure::bvh, pair, a, b, poses, rounds, ratios);
        if (!a.pieces().nodes.empty() && !b.pieces().nodes.empty()) {
            compare(Structure::pieces, pair, a, b, poses, rounds, ratios);
        }
    }
    for (const auto& [key, values] : ratios) {
        std::printf("median of %zu pairs,%s,,,,,,,%.2f\n", values.size(), key.c_str(),
                    median(values));
        std::printf("worst of %zu pairs,%s,,,,,,,%.2f\n", values.size(), key.c_str(),
                    *std::min_element(values.begin(), values.end()));
    }
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    const auto [bakes, poses, pairs, rounds] = cdprep::pair_arguments(count, arguments);
    cdprep::run(bakes, poses, pairs, rounds);
}
