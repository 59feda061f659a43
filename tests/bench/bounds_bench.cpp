// SPDX-License-Identifier: MIT
// What the bounds of the hierarchy cost: the same questions about the same models baked
// with different --bounds, one folder each. For each pair of models and each set of
// poses (light, deep, near) the folders take turns, set by set, and that several times;
// the time of a pose is the median of its rounds, the figure the median of the poses.
// One thread, warm.
//
// Usage: bounds_bench POSES ROUNDS PAIR[,PAIR...] BAKES...
// BAKES holds NAME.cdp.h5, baked with --normalize; POSES holds A-B.pose files as
// pair_queries_bench reads them. PAIR is A-B.
//
// Prints a CSV table; `times` is the first folder's median by this one's, the spread
// that of the middle half of the rounds. Boxes and leaves are the pairs that the question
// looks at, on average over the poses.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "bench_input.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/pairs.h"

namespace cdprep {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 3> kKinds = {"light", "deep", "near"};
enum Question : std::size_t { overlap, collides, how_far, within };
constexpr std::array<const char*, 4> kQuestions = {"overlap", "collide", "distance", "within"};
constexpr double kTolerance = 0.008;  ///< the near poses are 1 % of the diagonal apart

/// One pair of models from one folder.
struct Baked {
    std::string name;
    Model a;
    Model b;
};

std::vector<TrianglePair> room(1U << 22);

std::size_t ask(const Baked& baked, std::size_t question, const Pose& pose, Workspace& workspace) {
    const Placement placement = Placement::b_moves(pose);
    switch (question) {
        case overlap:
            return overlaps({baked.a, baked.b, placement}, workspace, room);
        case collides:
            return collide({baked.a, baked.b, placement}, workspace).hit == Answer::yes ? 1 : 0;
        case how_far:
            return distance({baked.a, baked.b, placement}, workspace)->upper > 0 ? 1 : 0;
        default:
            return cdprep::within({baked.a, baked.b, placement}, kTolerance, workspace) ? 1 : 0;
    }
}

/// What the question looks at in all poses.
QueryCounts count_set(const Baked& baked, std::size_t question, const std::vector<Pose>& poses,
                      Workspace& workspace) {
    QueryCounts counts;
    workspace.count_into(&counts);
    for (const Pose& pose : poses) static_cast<void>(ask(baked, question, pose, workspace));
    workspace.count_into(nullptr);
    return counts;
}

/// Microseconds by pose and round.
using Times = std::vector<std::vector<double>>;

std::size_t ask_set(const Baked& baked, std::size_t question, const std::vector<Pose>& poses,
                    Workspace& workspace, Times& times) {
    times.resize(poses.size());
    std::size_t sum = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto begun = std::chrono::steady_clock::now();
        sum += ask(baked, question, poses[i], workspace);
        const std::chrono::duration<double, std::micro> taken =
            std::chrono::steady_clock::now() - begun;
        times[i].push_back(taken.count());
    }
    return sum;
}

double median_of(const Times& times) {
    std::vector<double> by_pose;
    for (const auto& rounds : times) by_pose.push_back(median(rounds));
    return median(by_pose);
}

/// How far apart the middle half of a pose's rounds lie: the median of the poses.
double spread_of(const Times& times) {
    std::vector<double> by_pose;
    for (const auto& rounds : times) by_pose.push_back(spread(rounds));
    return median(by_pose);
}

/// Ratios to the first folder, for the summary.
using Ratios = std::map<std::string, std::vector<double>>;

void compare(const std::string& pair, const std::vector<Baked>& folders,
             const std::vector<Pose>& poses, std::size_t kind, std::size_t question, int rounds,
             Ratios& ratios) {
    Workspace workspace;
    std::vector<Times> times(folders.size());
    std::vector<std::size_t> answers(folders.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t f = 0; f < folders.size(); ++f) {
            answers[f] = ask_set(folders[f], question, poses, workspace, times[f]);
        }
    }
    const double first = median_of(times[0]);
    for (std::size_t f = 0; f < folders.size(); ++f) {
        if (answers[f] != answers[0]) stop(pair + ": " + folders[f].name + " answers otherwise");
        const QueryCounts counts = count_set(folders[f], question, poses, workspace);
        const auto asked = static_cast<double>(poses.size());
        const double us = median_of(times[f]);
        const std::string key = std::string(kQuestions[question]) + "/" + kKinds[kind];
        std::printf("%s,%s,%s,%zu,%.2f,%.2f,%.2f,%.0f,%.0f\n", pair.c_str(), key.c_str(),
                    folders[f].name.c_str(), answers[f], us, spread_of(times[f]), first / us,
                    static_cast<double>(counts.box_pairs) / asked,
                    static_cast<double>(counts.leaf_pairs) / asked);
        ratios[key + "," + folders[f].name].push_back(first / us);
    }
    std::fflush(stdout);
}

void run_pair(const std::string& pair, const fs::path& poses_folder, int rounds,
              const std::vector<fs::path>& bakes, Ratios& ratios) {
    const std::size_t dash = pair.find('-');
    if (dash == std::string::npos) stop("'" + pair + "' is not two names with a dash between");
    std::vector<Baked> folders;
    for (const fs::path& folder : bakes) {
        folders.push_back({folder.filename().string(),
                           open_or_stop(folder / (pair.substr(0, dash) + ".cdp.h5")),
                           open_or_stop(folder / (pair.substr(dash + 1) + ".cdp.h5"))});
    }
    const std::vector<Pose> all = read_poses(poses_folder / (pair + ".pose"));
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
        const std::vector<Pose> poses = poses_of_kind(all, kind, kKinds.size());
        for (std::size_t question = 0; question < kQuestions.size(); ++question) {
            const bool is_near = kind == 2;
            if (question == overlap && is_near) continue;   // nothing overlaps
            if (question >= how_far && !is_near) continue;  // 0
            compare(pair, folders, poses, kind, question, rounds, ratios);
        }
    }
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    if (count < 5) {
        std::fprintf(stderr, "usage: %s POSES ROUNDS PAIR[,PAIR...] BAKES...\n", arguments[0]);
        return 2;
    }
    std::printf("pair,question,bounds,pairs,median_us,spread_us,times,boxes,leaves\n");
    cdprep::Ratios ratios;
    std::istringstream pairs(arguments[3]);
    for (std::string pair; std::getline(pairs, pair, ',');) {
        cdprep::run_pair(pair, arguments[1], std::max(1, std::atoi(arguments[2])),
                         {arguments + 4, arguments + count}, ratios);
    }
    for (const auto& [key, values] : ratios) {
        std::printf("median of %zu pairs,%s,,,,%.2f,,\n", values.size(), key.c_str(),
                    cdprep::median(values));
    }
}
