// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>

#include "cdprep/result.h"

namespace cdprep::cli {

/// Turns SIGINT and SIGTERM into a flag, so that work stops at the next place that looks at
/// it. Work that goes on for kPatience after the signal is given up: the process ends with 130,
/// wherever its threads are. Outputs have no name before they are whole, so nothing is left
/// behind. A second signal ends the process at once. A write beyond the permitted file size
/// fails instead of ending the process.
void watch_for_interrupts();

/// How long after a signal a stage may go on: time for loops that look at the flag. The system
/// needs another 70 ms for each gigabyte that it takes back.
inline constexpr std::chrono::milliseconds kPatience{30};

/// What is still to be done when work is given up, as to end a report. While it lives only.
/// Called from another thread than the work, which goes on; must not wait for it.
class LastWords {
public:
    explicit LastWords(std::function<void()> words);
    LastWords(const LastWords&) = delete;
    LastWords& operator=(const LastWords&) = delete;
    /// Waits for words that have begun: they end the process.
    ~LastWords();
};

/// Work has ended by itself: a report may take its time from now on.
void end_by_itself();

[[nodiscard]] bool is_interrupted();

/// Whether who read our output has ended, as `head` does: then there is nobody to complain to.
[[nodiscard]] bool is_output_closed();

/// Why nothing came of an input after that.
[[nodiscard]] Error interrupted(const std::filesystem::path& input);

/// Ends the program with one sentence and Exit::unreadable when a page of a mapped file can
/// not be read any more: somebody truncated the file, or its disk or network share failed.
/// The sentence names the file where the system tells which it is (Linux does). Nothing else is
/// done: outputs that are not complete keep their temporary names, and the next writer of the
/// same output removes them, as after a killed program. Every other SIGBUS ends the program as
/// if nobody watched.
void watch_for_lost_pages();

}  // namespace cdprep::cli
