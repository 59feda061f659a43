// SPDX-License-Identifier: MIT
// How long a program waits for its first answer: two files are opened and asked once,
// with their pages dropped from the cache of the system before (cold), and with the
// files lying there (warm). Each way of opening and each question take turns.
// Prints a CSV table of medians in microseconds: opening both, the first question, and
// the same question asked again.
//
// Usage: wake_up_bench A B POSES [-r ROUNDS]
// POSES is a file of 12 numbers a line, R row by row, then T; the first line is asked.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "bench_input.h"
#include "cdprep/pairs.h"

namespace cdprep {
namespace {

/// What these questions read of a model with exact leaves.
constexpr SectionSet kPair = {SectionId::bvh_nodes, SectionId::bvh_leaves,
                              SectionId::oriented_nodes, SectionId::degenerate_bits,
                              SectionId::source_triangle};

enum class Opening : std::uint8_t { all, pair, trusted };
constexpr std::array<const char*, 3> kOpenings = {"all_sections", "pair_sections", "trusted"};
enum class Question : std::uint8_t { collide, overlap, distance };
constexpr std::array<const char*, 3> kQuestions = {"collide", "overlap", "distance"};

Model open_or_stop(const char* path, Opening opening) {
    auto opened = opening == Opening::all    ? Model::open(path)
                  : opening == Opening::pair ? Model::open(path, kPair)
                                             : Model::open_trusted(path);
    if (!opened) stop(opened.error().message);
    return std::move(opened).value();
}

/// Pages that nothing maps and that are on disk leave the cache.
void drop_pages(const char* path) {
    const int file = ::open(path, O_RDONLY);
    if (file < 0) stop(std::string(path) + " cannot be opened.");
    ::fsync(file);
    ::posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
    ::close(file);
}

struct Files {
    const char* a;
    const char* b;
    Pose pose;
};

/// Microseconds.
struct Times {
    double open;
    double first;
    double second;
};

Times wake_up(const Files& files, Opening opening, Question question) {
    using Clock = std::chrono::steady_clock;
    const auto microseconds = [](auto duration) {
        return std::chrono::duration<double, std::micro>(duration).count();
    };
    const Placement placement = Placement::b_moves(files.pose);
    Workspace workspace;
    std::vector<TrianglePair> pairs(std::size_t{1} << 16);
    const auto begun = Clock::now();
    const Model a = open_or_stop(files.a, opening);
    const Model b = open_or_stop(files.b, opening);
    const auto ask = [&] {
        switch (question) {
            case Question::collide:
                return collide({a, b, placement}, workspace).hit == Answer::yes ? 1.0 : 0.0;
            case Question::overlap:
                return static_cast<double>(overlaps({a, b, placement}, workspace, pairs));
            default:
                return distance({a, b, placement}, workspace)->upper;
        }
    };
    const auto opened = Clock::now();
    const double answer = ask();
    const auto answered = Clock::now();
    if (ask() != answer) stop("The same question was answered differently.");
    const auto again = Clock::now();
    return {microseconds(opened - begun), microseconds(answered - opened),
            microseconds(again - answered)};
}

void measure(const Files& files, int rounds) {
    for (const bool cold : {true, false}) {
        for (std::size_t opening = 0; opening < kOpenings.size(); ++opening) {
            for (std::size_t question = 0; question < kQuestions.size(); ++question) {
                std::vector<double> open, first, second;
                for (int round = 0; round < rounds; ++round) {
                    if (cold) drop_pages(files.a);
                    if (cold) drop_pages(files.b);
                    const Times times = wake_up(files, static_cast<Opening>(opening),
                                                static_cast<Question>(question));
                    open.push_back(times.open);
                    first.push_back(times.first);
                    second.push_back(times.second);
                }
                std::printf("%s,%s,%s,%d,%.1f,%.1f,%.1f\n", cold ? "cold" : "warm",
                            kOpenings[opening], kQuestions[question], rounds, median(open),
                            median(first), median(second));
            }
        }
    }
}

}  // namespace
}  // namespace cdprep

int main(int argc, char** argv) {
    int rounds = 5;
    std::vector<const char*> files;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "-r") == 0 && i + 1 < argc) {
            rounds = std::max(1, std::atoi(argv[++i]));
        } else {
            files.push_back(argv[i]);
        }
    }
    if (files.size() != 3) {
        std::fprintf(stderr, "Usage: wake_up_bench A B POSES [-r ROUNDS]\n");
        return 2;
    }
    std::printf("cache,opening,question,rounds,open_us,first_us,second_us\n");
    cdprep::measure({files[0], files[1], cdprep::read_poses(files[2]).front()}, rounds);
    return 0;
}
