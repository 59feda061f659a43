// SPDX-License-Identifier: GPL-3.0-or-later
#include "interrupt.h"

#include <atomic>
#include <csignal>

namespace cdprep::cli {
namespace {

// Set by a signal, read by every thread: without a lock a signal may touch it.
std::atomic<bool> has_signal = false;
std::atomic<bool> has_closed_pipe = false;
static_assert(std::atomic<bool>::is_always_lock_free);

/// Nobody reads what we write: as if the person had stopped us, but however often.
void on_closed_pipe(int) {
    has_closed_pipe = true;
    has_signal = true;
}

void on_signal(int signal) {
    if (has_signal) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
    has_signal = true;
}

}  // namespace

void watch_for_interrupts() {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    std::signal(SIGPIPE, on_closed_pipe);
    // A file longer than permitted is then an error of the write that we report.
    std::signal(SIGXFSZ, SIG_IGN);
}

bool is_interrupted() {
    return has_signal;
}

bool is_output_closed() {
    return has_closed_pipe;
}

Error interrupted(const std::filesystem::path& input) {
    return {ErrorCode::interrupted, input.string() + ": stopped; nothing was written."};
}

}  // namespace cdprep::cli
