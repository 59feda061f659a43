// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress.h"

#include <unistd.h>

#include <cstdlib>
#include <iostream>

#include "quiet.h"

namespace cdprep::cli {
namespace {

constexpr std::size_t kBarWidth = 24;   ///< columns
constexpr std::size_t kTextWidth = 48;  ///< columns for what is being done

/// NO_COLOR asks for plain output; a bar without colour is fine.
bool colours_allowed() {
    const char* no_color = std::getenv("NO_COLOR");  // NOLINT(concurrency-mt-unsafe)
    return no_color == nullptr || *no_color == '\0';
}

std::string shortened(const std::string& text) {
    if (text.size() <= kTextWidth) return text;
    return "..." + text.substr(text.size() - kTextWidth + 3);
}

}  // namespace

Result<ProgressStyle> parse_progress(const std::string& word) {
    if (is_quiet() || word == "none") return ProgressStyle::none;
    if (word == "plain") return ProgressStyle::plain;
    if (word == "bar") return ProgressStyle::bar;
    if (word == "auto") {
        return ::isatty(STDERR_FILENO) != 0 ? ProgressStyle::bar : ProgressStyle::none;
    }
    return Error{ErrorCode::bad_argument,
                 "--progress is '" + word + "'; it must be auto, bar, plain or none."};
}

void Progress::show(std::size_t done, const std::string& what) {
    if (style_ == ProgressStyle::none) return;
    if (style_ == ProgressStyle::plain) {
        std::cerr << done << '/' << total_ << ' ' << what << '\n';
        return;
    }
    const std::size_t filled = total_ == 0 ? 0 : kBarWidth * done / total_;
    const bool coloured = colours_allowed();
    std::cerr << "\r\x1b[K[" << (coloured ? "\x1b[32m" : "") << std::string(filled, '#')
              << (coloured ? "\x1b[0m" : "") << std::string(kBarWidth - filled, '.') << "] " << done
              << '/' << total_ << ' ' << shortened(what) << std::flush;
    drawn_ = true;
}

void Progress::clear() {
    if (drawn_) std::cerr << "\r\x1b[K" << std::flush;
    drawn_ = false;
}

}  // namespace cdprep::cli
