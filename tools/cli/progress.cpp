// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/progress.h"

#include <unistd.h>

#include <cmath>
#include <iostream>

#include "cli/colour.h"
#include "cli/program_threads.h"
#include "cli/quiet.h"

namespace cdprep::cli {
namespace {

constexpr std::size_t kBarWidth = 24;   ///< columns
constexpr std::size_t kTextWidth = 48;  ///< columns for the work in progress

std::string shortened(const std::string& text) {
    if (text.size() <= kTextWidth) return text;
    return "..." + text.substr(text.size() - kTextWidth + 3);
}

}  // namespace

std::string time_left_text(std::chrono::duration<double> passed, std::size_t done,
                           std::size_t total) {
    if (done == 0 || done > total) return "";
    const double left =
        passed.count() / static_cast<double>(done) * static_cast<double>(total - done);
    if (left < 100) return ", " + std::to_string(std::llround(left)) + " s left";
    if (left < 6000) return ", " + std::to_string(std::llround(left / 60)) + " min left";
    return ", " + std::to_string(std::llround(left / 3600)) + " h left";
}

void LoopPace::advance(const Mark& now) {
    constexpr double kRatio = 1.25;
    if (now.time - begin_.time < kRatio * (next_.time - begin_.time)) return;
    recent_ = next_;
    next_ = now;
}

ProgressStyle parse_progress(const std::string& word) {
    if (is_quiet() || word == "none") return ProgressStyle::none;
    if (word == "plain") return ProgressStyle::plain;
    const bool shows_bar = word == "bar" || ::isatty(STDERR_FILENO) != 0;
    return shows_bar ? ProgressStyle::bar : ProgressStyle::none;
}

Progress::Progress(ProgressStyle style, std::size_t total)
    : style_(style), total_(total), begun_(Clock::now()) {
    if (style_ == ProgressStyle::none) return;
    watch_loops(true);
    teller_ = std::thread([this] { tell_while_it_lasts(); });
}

Progress::~Progress() {
    if (style_ == ProgressStyle::none) return;
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    ended_.notify_one();
    teller_.join();
    watch_loops(false);
    erase();
}

void Progress::show(std::size_t done, const std::string& what) {
    if (style_ == ProgressStyle::none) return;
    const std::lock_guard lock(mutex_);
    done_ = done;
    what_ = what;
    begun_ = Clock::now();
    is_loop_ = false;
    draw();
}

void Progress::advance(std::size_t done, const std::string& what) {
    if (style_ == ProgressStyle::none) return;
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    if (!is_loop_ || what_ != what) {
        what_ = what;
        begun_ = now;
        pace_.begin({now, done});
        is_loop_ = true;
    }
    pace_.advance({now, done});
    done_ = done;
    if (now - drawn_at_ >= pause()) draw();
}

Progress::Clock::duration Progress::pause() const noexcept {
    constexpr std::chrono::milliseconds kBar(250);
    constexpr std::chrono::seconds kPlain(10);
    return style_ == ProgressStyle::bar ? Clock::duration(kBar) : Clock::duration(kPlain);
}

void Progress::clear() {
    if (style_ == ProgressStyle::none) return;
    const std::lock_guard lock(mutex_);
    erase();
    what_.clear();
}

void Progress::tell_while_it_lasts() {
    std::unique_lock lock(mutex_);
    while (!over_) {
        ended_.wait_for(lock, pause());
        const Clock::time_point now = Clock::now();
        const bool is_long =
            now - drawn_at_ >= pause() && (style_ == ProgressStyle::bar || now - begun_ >= pause());
        if (!over_ && !what_.empty() && is_long) draw();
    }
}

/// Returns ", 12 s, 43 %": nothing in the first second, and a share only if there is one input.
std::string Progress::since() const {
    const Clock::time_point now = Clock::now();
    const auto passed = std::chrono::duration_cast<std::chrono::seconds>(now - begun_);
    if (passed.count() < 1) return "";
    std::string text = ", " + std::to_string(passed.count()) + " s";
    if (is_loop_) {
        const LoopPace::Mark& base = pace_.base(done_);
        return text + time_left_text(now - base.time, done_ - base.done, total_ - base.done);
    }
    const LoopShare share = watched_loop();
    if (total_ == 1 && share.count > 1) {
        text += ", " + std::to_string(100 * share.done / share.count) + " %";
    }
    return text;
}

void Progress::draw() {
    drawn_at_ = Clock::now();
    const std::string line = shortened(what_ + since());
    if (style_ == ProgressStyle::plain) {
        std::cerr << done_ << '/' << total_ << ' ' << what_ + since() << '\n';
        return;
    }
    const std::size_t filled = total_ == 0 ? 0 : kBarWidth * done_ / total_;
    const bool coloured = colours_allowed();
    std::cerr << "\r\x1b[K[" << (coloured ? "\x1b[32m" : "") << std::string(filled, '#')
              << (coloured ? "\x1b[0m" : "") << std::string(kBarWidth - filled, '.') << "] "
              << done_ << '/' << total_ << ' ' << line << std::flush;
    drawn_ = true;
}

void Progress::erase() {
    if (drawn_) std::cerr << "\r\x1b[K" << std::flush;
    drawn_ = false;
}

}  // namespace cdprep::cli
