// SPDX-License-Identifier: GPL-3.0-or-later
#include "interrupt.h"

#include <csignal>

namespace cdprep::cli {
namespace {

volatile std::sig_atomic_t has_signal = 0;

/// Nobody reads what we write: as if the person had stopped us, but however often.
void on_closed_pipe(int) {
    has_signal = 1;
}

void on_signal(int signal) {
    if (has_signal != 0) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
    has_signal = 1;
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
    return has_signal != 0;
}

Error interrupted(const std::filesystem::path& input) {
    return {ErrorCode::interrupted, input.string() + ": stopped; nothing was written."};
}

}  // namespace cdprep::cli
