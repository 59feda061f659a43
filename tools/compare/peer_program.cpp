// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/peers.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <deque>
#include <system_error>
#include <thread>
#include <vector>

#include "cli/signals.h"

extern "C" char** environ;  // NOLINT(readability-redundant-declaration)

namespace cdprep::cli {
namespace {

/// Bytes in memory that a program can open as a file.
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
    return {ErrorCode::unreadable, program.string() + ": the peer program " + what};
}

/// Returns the process's status; ends the process if the user stops us.
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
    // Descriptors are moved to high numbers first, so that none is overwritten before its copy.
    constexpr int kAside = 200;
    constexpr int kFirst = 3;
    const MemoryFile answer;
    std::deque<MemoryFile> files;
    std::vector<std::string> words = {program.string(), questions.what};
    for (const std::span<const std::byte> bytes : questions.files) {
        if (!files.emplace_back().write(bytes)) {
            return failure(program,
                           "cannot receive the models: " + std::generic_category().message(errno));
        }
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
        words.insert(words.end(), "/proc/self/fd/" + std::to_string(kFirst + i));
    }
    words.insert(words.end(), questions.words.begin(), questions.words.end());
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, answer.descriptor(), STDOUT_FILENO);
    const int count = static_cast<int>(files.size());
    for (int i = 0; i < count; ++i) {
        ::posix_spawn_file_actions_adddup2(
            &actions, files[static_cast<std::size_t>(i)].descriptor(), kAside + i);
    }
    for (int i = 0; i < count; ++i) {
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
        return failure(program,
                       (crashed ? "was ended by signal " + std::to_string(WTERMSIG(status))
                                : "ended with exit code " + std::to_string(WEXITSTATUS(status))) +
                           ".");
    }
    return answer.read();
}

}  // namespace cdprep::cli
