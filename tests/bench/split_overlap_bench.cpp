// SPDX-License-Identifier: MIT
// What one large overlap query gains from more threads: 0-based line 76 of
// dragon-armadillo.pose, and the dragon against itself shifted by 1 % of the diagonal.
// Each is asked on one thread by overlaps(), then by
// split_overlaps() with 1, 2, 4, ... workers, in turns. The threads are
// started beforehand and wait for work asleep.
//
// Usage: split_overlap_bench BAKES POSES [ROUNDS [MOST_WORKERS]]
// BAKES holds NAME.cdp.h5, baked with --normalize.
//
// Prints a CSV table: milliseconds, the median of the rounds with the spread of their
// middle half, and the least, each with the serial one by it: where others load the machine, the
// least tells more.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "bench_input.h"
#include "cdprep/parallel.h"

namespace cdprep {
namespace {

constexpr std::size_t kLine = 76;
constexpr double kShift = 0.01;  ///< of the diagonal, which is 1
constexpr std::size_t kMostPairs = 1U << 20;

/// Threads that sleep until there are tasks. The caller's thread takes tasks too, and
/// waits only for those that others have begun: on a busy machine a thread may wake late.
class Pool {
public:
    explicit Pool(std::size_t workers) {
        for (std::size_t i = 1; i < workers; ++i) {
            threads_.emplace_back([this] { serve(); });
        }
    }
    ~Pool() {
        ends_ = true;
        start_round(0);
        for (std::thread& thread : threads_) thread.join();
    }
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;

    /// As ParallelFor wants it.
    void operator()(std::size_t count, Task task) {
        task_ = task;
        left_ = count;
        start_round(count);
        work();
        for (std::size_t left = left_; left > 0; left = left_) left_.wait(left);
    }

private:
    static constexpr auto kNothing = [](std::size_t /*number*/) {};
    static constexpr std::uint64_t kNext = 0xffff;  ///< of a ticket: the next task
    static constexpr int kCountShift = 16;          ///< then how many there are
    static constexpr int kRoundShift = 32;          ///< then the round

    void start_round(std::size_t count) {
        const std::uint64_t round = (ticket_ >> kRoundShift) + 1;
        ticket_ = round << kRoundShift | count << kCountShift;
        ++rounds_;
        rounds_.notify_all();
    }
    /// Takes tasks of this round until there are no more.
    void work() {
        for (std::uint64_t ticket = ticket_;;) {
            const std::uint64_t number = ticket & kNext;
            if (number == (ticket >> kCountShift & kNext)) return;
            if (!ticket_.compare_exchange_weak(ticket, ticket + 1)) continue;
            task_(number);
            if (--left_ == 0) left_.notify_all();
            ticket = ticket_;
        }
    }
    void serve() {
        for (int seen = 0; !ends_; seen = rounds_) {
            rounds_.wait(seen);
            work();
        }
    }

    std::vector<std::thread> threads_;
    Task task_{kNothing};
    std::atomic<bool> ends_ = false;
    std::atomic<std::size_t> left_ = 0;
    std::atomic<int> rounds_ = 0;  ///< what sleepers wait for
    std::atomic<std::uint64_t> ticket_ = 0;
};

double least(const std::vector<double>& values) {
    return *std::min_element(values.begin(), values.end());
}

template <class Ask>
double ms(Ask ask) {
    const auto begun = std::chrono::steady_clock::now();
    ask();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun)
        .count();
}

void compare(const char* name, const Model& a, const Model& b, const Pose& pose,
             const std::vector<std::size_t>& workers, int rounds) {
    const Placement placement = Placement::b_moves(pose);
    std::vector<TrianglePair> expected(kMostPairs), pairs(kMostPairs);
    std::vector<Workspace> workspaces(workers.back());
    std::size_t count = 0;
    std::vector<double> serial;
    std::vector<std::vector<double>> split(workers.size());
    std::vector<std::unique_ptr<Pool>> pools;
    for (const std::size_t each : workers) pools.push_back(std::make_unique<Pool>(each));
    for (int round = 0; round < rounds; ++round) {
        serial.push_back(ms([&] { count = overlaps({a, b, placement}, workspaces[0], expected); }));
        for (std::size_t i = 0; i < workers.size(); ++i) {
            const std::span<Workspace> own = std::span(workspaces).first(workers[i]);
            std::size_t found = 0;
            split[i].push_back(ms([&] {
                found = split_overlaps({a, b, placement}, own, *pools[i], pairs);
            }));
            if (found != count ||
                !std::equal(pairs.begin(), pairs.begin() + count, expected.begin())) {
                stop("the split changed the answer");
            }
        }
    }
    const auto print = [&](const std::string& how, const std::vector<double>& taken) {
        std::printf("%s,%s,%zu,%.3f,%.3f,%.2f,%.3f,%.2f\n", name, how.c_str(), count, median(taken),
                    spread(taken), median(serial) / median(taken), least(taken),
                    least(serial) / least(taken));
    };
    print("serial", serial);
    for (std::size_t i = 0; i < workers.size(); ++i) {
        print(std::to_string(workers[i]) + " workers", split[i]);
    }
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    using namespace cdprep;
    if (count < 3) {
        std::fprintf(stderr, "usage: %s BAKES POSES [ROUNDS [MOST_WORKERS]]\n", arguments[0]);
        return 2;
    }
    const std::filesystem::path bakes = arguments[1];
    const std::filesystem::path poses = arguments[2];
    const int rounds = count > 3 ? std::max(1, std::atoi(arguments[3])) : 15;
    const std::size_t most =
        count > 4 ? std::max<std::size_t>(1, std::strtoul(arguments[4], nullptr, 10)) : 4;
    std::vector<std::size_t> workers;
    for (std::size_t i = 1; i <= most; i *= 2) workers.push_back(i);
    const Model dragon = open_or_stop(bakes / "dragon.cdp.h5");
    const Model armadillo = open_or_stop(bakes / "armadillo.cdp.h5");
    const Pose shifted = Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, kShift, 0, 0}).value();
    std::printf("question,how,pairs,median_ms,spread_ms,times,least_ms,times_least\n");
    compare("dragon-armadillo", dragon, armadillo,
            read_poses(poses / "dragon-armadillo.pose").at(kLine), workers, rounds);
    compare("dragon-dragon", dragon, dragon, shifted, workers, rounds);
}
