// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "cdprep/model.h"
#include "cdprep/pose.h"

namespace cdprep {

/// Ends the program with a sentence.
[[noreturn]] inline void stop(const std::string& message) {
    std::fprintf(stderr, "%s\n", message.c_str());
    std::exit(2);
}

inline Model open_or_stop(const std::filesystem::path& path) {
    auto opened = Model::open(path);
    if (!opened) stop(opened.error().message);
    return std::move(opened).value();
}

/// Poses of 12 numbers a line, R row by row, then T.
inline std::vector<Pose> read_poses(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::vector<Pose> poses;
    std::array<double, 12> rows{};
    for (std::size_t i = 0; file >> rows[i % 12]; ++i) {
        if (i % 12 != 11) continue;
        auto pose = Pose::from_rows(rows);
        if (!pose) stop(path.string() + ": " + pose.error().message);
        poses.push_back(pose.value());
    }
    if (poses.empty()) stop(path.string() + " contains no pose.");
    return poses;
}

/// Every `kinds`-th pose from `kind` on.
inline std::vector<Pose> poses_of_kind(const std::vector<Pose>& all, std::size_t kind,
                                       std::size_t kinds) {
    std::vector<Pose> poses;
    for (std::size_t i = kind; i < all.size(); i += kinds) poses.push_back(all[i]);
    return poses;
}

/// The pairs A-B that were named, or, when none was, all that the folder has poses of.
inline std::vector<std::string> pairs_or_all(std::vector<std::string> named,
                                             const std::filesystem::path& poses) {
    if (!named.empty()) return named;
    for (const auto& entry : std::filesystem::directory_iterator(poses)) {
        if (entry.path().extension() == ".pose") named.push_back(entry.path().stem().string());
    }
    std::sort(named.begin(), named.end());
    return named;
}

/// What a bench of pairs is asked: BAKES POSES [ROUNDS [PAIR...]].
struct PairArguments {
    std::filesystem::path bakes;
    std::filesystem::path poses;
    std::vector<std::string> pairs;
    int rounds = 5;
};

inline PairArguments pair_arguments(int count, char** arguments, const std::string& options = "") {
    if (count < 3) {
        stop(std::string("usage: ") + arguments[0] + options + " BAKES POSES [ROUNDS [PAIR...]]");
    }
    PairArguments asked = {arguments[1], arguments[2], {}};
    if (count > 3) asked.rounds = std::max(1, std::atoi(arguments[3]));
    asked.pairs = pairs_or_all({arguments + std::min(count, 4), arguments + count}, asked.poses);
    return asked;
}

/// The processor time of this thread: questions are short, others' turns among them are not.
inline double thread_us() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

/// The median, or another quantile; there is at least one value.
inline double median(std::vector<double> values, double share = 0.5) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// How far apart the middle half of the values lies; there is at least one.
inline double spread(const std::vector<double>& values) {
    return median(values, 0.75) - median(values, 0.25);
}

}  // namespace cdprep
