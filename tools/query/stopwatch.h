// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iomanip>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

namespace cdprep::cli {

/// Runs a query `repeat` times and keeps the time of each run.
class Stopwatch {
public:
    template <class Ask>
    std::invoke_result_t<Ask> timed(std::size_t repeat, bool wanted, Ask ask) {
        for (std::size_t i = 1;; ++i) {
            const Clock::time_point begin = Clock::now();
            auto answer = ask();
            const std::chrono::duration<double, std::micro> taken = Clock::now() - begin;
            if (wanted) microseconds_.push_back(taken.count());
            if (i >= repeat) return answer;
        }
    }

    /// Returns the distribution of the times as one line of text.
    [[nodiscard]] std::string line() {
        if (microseconds_.empty()) return "";
        std::sort(microseconds_.begin(), microseconds_.end());
        const auto at = [&](double share) {
            return microseconds_[static_cast<std::size_t>(
                share * static_cast<double>(microseconds_.size() - 1))];
        };
        std::ostringstream line;
        line << microseconds_.size() << " queries: median " << std::fixed << std::setprecision(2)
             << at(0.5) << " us, 95 % below " << at(0.95) << " us, maximum " << at(1) << " us\n";
        return line.str();
    }

private:
    using Clock = std::chrono::steady_clock;

    std::vector<double> microseconds_;
};

}  // namespace cdprep::cli
