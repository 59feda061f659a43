// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

#include "cdprep/result.h"

namespace cdprep::cli {

enum class ProgressStyle { none, plain, bar };

/// "auto" is a bar when stderr is a terminal and nothing otherwise. Fails with
/// bad_argument on another word than auto, bar, plain, none.
[[nodiscard]] Result<ProgressStyle> parse_progress(const std::string& word);

/// Tells a person how far long work is, on stderr.
class Progress {
public:
    Progress(ProgressStyle style, std::size_t total) : style_(style), total_(total) {}
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress() {
        clear();
    }

    /// `done` of the total are finished; `what` is being worked at.
    void show(std::size_t done, const std::string& what);

    /// Takes the bar away, so that a line can be printed.
    void clear();

private:
    ProgressStyle style_;
    std::size_t total_;
    bool drawn_ = false;
};

}  // namespace cdprep::cli
