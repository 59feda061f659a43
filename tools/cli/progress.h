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

/// Returns the style that a word of --progress names: bar, plain or none. "auto" is a bar if stderr
/// is a terminal, and none otherwise.
[[nodiscard]] ProgressStyle parse_progress(const std::string& word);

/// Returns ", 2 min left": how long the rest of a loop takes at the pace of `done` steps of `total`
/// in the time that passed. Empty at first.
[[nodiscard]] std::string time_left_text(std::chrono::duration<double> passed, std::size_t done,
                                         std::size_t total);

/// Remembers a step of a loop at about four fifths of its time. The steps since then tell how fast
/// it is now, also if it becomes slower and slower.
class LoopPace {
public:
    using Clock = std::chrono::steady_clock;
    /// A time, and how many steps were done then.
    struct Mark {
        Clock::time_point time;
        std::size_t done = 0;
    };

    void begin(const Mark& now) {
        begin_ = recent_ = next_ = now;
    }
    void advance(const Mark& now);
    /// Returns the mark from which to measure the pace: the begin, if no step is done since.
    [[nodiscard]] const Mark& base(std::size_t done) const noexcept {
        return done > recent_.done ? recent_ : begin_;
    }

private:
    Mark begin_;
    Mark recent_;
    Mark next_;  ///< recent_ from a quarter more time on
};

/// Shows the progress of long work on stderr. During a stage it shows the elapsed time and the
/// finished share of a loop that takes longer than a second. A bar is updated four times a
/// second; plain lines follow every ten seconds.
class Progress {
public:
    Progress(ProgressStyle style, std::size_t total);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress();

    /// Shows that `done` of the total are finished and that `what` is in progress.
    void show(std::size_t done, const std::string& what);

    /// The same for a loop whose steps take about as long. It may be called often: the line changes
    /// four times a second, or every ten seconds if it is plain. Also tells the time that is left.
    void advance(std::size_t done, const std::string& what);

    /// Removes the bar, so that a line can be printed.
    void clear();

private:
    using Clock = LoopPace::Clock;

    void tell_while_it_lasts();
    [[nodiscard]] Clock::duration pause() const noexcept;
    void draw();
    void erase();
    [[nodiscard]] std::string since() const;

    ProgressStyle style_;
    std::size_t total_;
    std::mutex mutex_;  ///< guards all members below
    std::condition_variable ended_;
    std::size_t done_ = 0;
    std::string what_;
    Clock::time_point begun_;
    LoopPace pace_;
    bool is_loop_ = false;
    Clock::time_point drawn_at_;
    bool drawn_ = false;
    bool over_ = false;
    std::thread teller_;
};

}  // namespace cdprep::cli
