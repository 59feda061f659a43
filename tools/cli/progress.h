// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>

#include "cdprep/result.h"

namespace cdprep::cli {

enum class ProgressStyle { none, plain, bar };

/// "auto" is a bar when stderr is a terminal and nothing otherwise. Fails with
/// bad_argument on another word than auto, bar, plain, none.
[[nodiscard]] Result<ProgressStyle> parse_progress(const std::string& word);

/// Tells a person how far long work is, on stderr. While a stage lasts it says for how long, and
/// how much of a loop that takes longer than a second is done: a bar four times a second, plain
/// lines every ten seconds.
class Progress {
public:
    Progress(ProgressStyle style, std::size_t total);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress();

    /// `done` of the total are finished; `what` is being worked at.
    void show(std::size_t done, const std::string& what);

    /// Takes the bar away, so that a line can be printed.
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    void tell_while_it_lasts();
    void draw();
    void erase();
    [[nodiscard]] std::string since() const;

    ProgressStyle style_;
    std::size_t total_;
    std::mutex mutex_;  ///< of all that follows
    std::condition_variable ended_;
    std::size_t done_ = 0;
    std::string what_;
    Clock::time_point begun_;
    bool drawn_ = false;
    bool over_ = false;
    std::thread teller_;
};

}  // namespace cdprep::cli
