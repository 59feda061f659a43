// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

#include "cdprep/result.h"

namespace cdprep::cli {

/// Turns SIGINT and SIGTERM into a flag; work stops at the next place that tests it. If work
/// continues for kPatience after the signal, the process ends with 130, wherever its threads
/// are. Outputs have no name before they are complete, so nothing is left behind. A second
/// signal ends the process at once. A write beyond the permitted file size fails instead of
/// ending the process. While the system syncs a file to a busy disk, or frees the one that it
/// replaces, no process ends: that may take longer.
void watch_for_interrupts();

/// The time that a stage may continue after a signal, for loops that test the flag. The system
/// needs another 70 ms for each gigabyte that it takes back.
inline constexpr std::chrono::milliseconds kPatience{30};

/// A function to call when work is abandoned, for example to complete a report. It returns the
/// sentence that says where the work stopped, or nothing. It is active while this object lives.
/// There may be several: the last one is called first. The call comes from another thread while
/// the work continues; it must not wait for that work.
class LastWords {
public:
    explicit LastWords(std::function<std::string()> words);
    LastWords(const LastWords&) = delete;
    LastWords& operator=(const LastWords&) = delete;
    /// Waits if the call has begun; the process then ends within it.
    ~LastWords();

    [[nodiscard]] std::string call() const {
        return words_();
    }

private:
    std::function<std::string()> words_;
};

/// Declares that the work has ended by itself. From now on a report has no time limit.
void end_by_itself();

[[nodiscard]] bool is_interrupted();

/// Returns true if the reader of our output has ended, as `head` does. An error message then has
/// no reader.
[[nodiscard]] bool is_output_closed();

/// Returns the error for an input that was not processed because of an interrupt.
[[nodiscard]] Error interrupted(const std::filesystem::path& input);

/// Ends the program with one message and Exit::unreadable if a page of a mapped file becomes
/// unreadable. The cause is a truncated file, or a disk or network share that failed. The message
/// names the file if the system provides its name (Linux does). Nothing else is done: incomplete
/// outputs keep their temporary names, as after a killed program. The next writer of the same
/// output removes them. Every other SIGBUS has its default effect, the end of the program.
void watch_for_lost_pages();

}  // namespace cdprep::cli
