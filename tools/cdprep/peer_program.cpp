// SPDX-License-Identifier: GPL-3.0-or-later
#include "peer_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "interrupt.h"
#include "study/cells.h"

extern "C" char** environ;  // NOLINT(readability-redundant-declaration)

namespace cdprep::cli {
namespace {

/// Bytes in memory that a program may open as a file.
class MemoryFile {
public:
    MemoryFile() : descriptor_(::memfd_create("cdprep-peers", MFD_CLOEXEC)) {}
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }

    [[nodiscard]] int descriptor() const noexcept {
        return descriptor_;
    }
    [[nodiscard]] bool write(std::span<const std::byte> bytes) const {
        while (!bytes.empty()) {
            const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) return false;
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        }
        return true;
    }
    [[nodiscard]] std::string read() const {
        std::string text;
        std::array<char, 1 << 16> part{};
        ::lseek(descriptor_, 0, SEEK_SET);
        for (;;) {
            const ssize_t size = ::read(descriptor_, part.data(), part.size());
            if (size < 0 && errno == EINTR) continue;
            if (size <= 0) return text;
            text.append(part.data(), static_cast<std::size_t>(size));
        }
    }

private:
    int descriptor_;
};

Error failure(const std::filesystem::path& program, const std::string& what) {
    return {ErrorCode::unreadable, program.string() + ", which asks peers, " + what};
}

/// The process's status; ends it when the person stops us.
int wait_for(pid_t process) {
    constexpr std::chrono::milliseconds kPause(10);
    int status = 0;
    for (;;) {
        const pid_t ended = ::waitpid(process, &status, WNOHANG);
        if (ended == process || (ended < 0 && errno != EINTR)) return status;
        if (is_interrupted()) ::kill(process, SIGKILL);
        std::this_thread::sleep_for(kPause);
    }
}

}  // namespace

Result<std::string> run_peers(const std::filesystem::path& program,
                              const PeerQuestions& questions) {
    const std::array<MemoryFile, 4> files;  // A, B, the poses, the answer
    if (!files[0].write(questions.a) || !files[1].write(questions.b) ||
        !files[2].write(std::as_bytes(std::span(questions.poses)))) {
        return failure(program,
                       "cannot be handed the models: " + std::generic_category().message(errno));
    }
    std::vector<std::string> words = {program.string(),
                                      "/proc/self/fd/3",
                                      "/proc/self/fd/4",
                                      "/proc/self/fd/5",
                                      study::formatted("%.17g", questions.tolerance),
                                      std::to_string(questions.rounds),
                                      study::formatted("%.17g", questions.budget_s)};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, files[3].descriptor(), STDOUT_FILENO);
    // By way of high numbers, so that none is overwritten before it is copied.
    constexpr int kAside = 200;
    constexpr int kFirst = 3;
    for (int i = 0; i < 3; ++i) {
        ::posix_spawn_file_actions_adddup2(
            &actions, files[static_cast<std::size_t>(i)].descriptor(), kAside + i);
    }
    for (int i = 0; i < 3; ++i) {
        ::posix_spawn_file_actions_adddup2(&actions, kAside + i, kFirst + i);
    }
    pid_t process = 0;
    const int failed =
        ::posix_spawn(&process, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) {
        return failure(program,
                       "cannot be started: " + std::generic_category().message(failed) + ".");
    }
    const int status = wait_for(process);
    if (is_interrupted()) return interrupted(program);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        const bool crashed = WIFSIGNALED(status);
        return failure(program, (crashed ? "ended by signal " + std::to_string(WTERMSIG(status))
                                         : "ended with " + std::to_string(WEXITSTATUS(status))) +
                                    ".");
    }
    return files[3].read();
}

}  // namespace cdprep::cli
