// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/signals.h"

#include <semaphore.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/command.h"

namespace cdprep::cli {
namespace {

// Set by a signal handler and read by every thread. A handler may only write lock-free atomics.
std::atomic<bool> has_signal = false;
std::atomic<bool> has_closed_pipe = false;
static_assert(std::atomic<bool>::is_always_lock_free);

// Posted by the signal handler, which POSIX permits.
sem_t signalled;

// Held while the last words change or run, and by the thread that ends the process.
std::mutex ending;
std::vector<const LastWords*> last_words;
bool is_over = false;

/// Handles SIGPIPE: the reader of our output has ended. Acts like a first interrupt, however
/// often the signal arrives.
void on_closed_pipe(int) {
    has_closed_pipe = true;
    has_signal = true;
}

void on_signal(int signal) {
    if (has_signal.exchange(true)) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
    ::sem_post(&signalled);
}

/// Ends the process kPatience after a signal, unless the work ends first. Runs on its own thread.
void give_up_after_signal() {
    while (::sem_wait(&signalled) != 0) {
    }
    std::this_thread::sleep_for(kPatience);
    const std::lock_guard lock(ending);
    if (is_over) return;
    std::string sentence;
    for (auto words = last_words.rbegin(); words != last_words.rend(); ++words) {
        const std::string said = (*words)->call();
        if (sentence.empty()) sentence = said;
    }
    if (sentence.empty()) sentence = "cdprep: stopped before the work was done.";
    sentence += '\n';
    // Other threads may be using the streams.
    [[maybe_unused]] const ssize_t told = ::write(STDERR_FILENO, sentence.data(), sentence.size());
    ::_exit(static_cast<int>(Exit::interrupted));
}

}  // namespace

void watch_for_interrupts() {
    ::sem_init(&signalled, 0, 0);
    std::thread(give_up_after_signal).detach();
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    std::signal(SIGPIPE, on_closed_pipe);
    // A write beyond the permitted file size then fails, and we report it.
    std::signal(SIGXFSZ, SIG_IGN);
}

LastWords::LastWords(std::function<std::string()> words) : words_(std::move(words)) {
    const std::lock_guard lock(ending);
    last_words.push_back(this);
}

LastWords::~LastWords() {
    const std::lock_guard lock(ending);
    std::erase(last_words, this);
}

void end_by_itself() {
    const std::lock_guard lock(ending);
    is_over = true;
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
