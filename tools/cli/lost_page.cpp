// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/signals.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "cli/command.h"

// A signal handler may only call functions that POSIX lists as async-signal-safe, and cannot
// allocate. This file therefore reads the list of mappings byte by byte, with open(), read(),
// write() and _exit().

namespace cdprep::cli {
namespace {

constexpr std::size_t kMostPath = 4096;

/// Reads a file byte by byte. next() returns -1 at its end, or if it cannot be read.
class ByteReader {
public:
    explicit ByteReader(const char* path) : descriptor_(::open(path, O_RDONLY | O_CLOEXEC)) {}
    ByteReader(const ByteReader&) = delete;
    ByteReader& operator=(const ByteReader&) = delete;
    ~ByteReader() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }

    int next() {
        if (at_ == filled_) {
            const ssize_t got =
                descriptor_ < 0 ? 0 : ::read(descriptor_, buffer_.data(), buffer_.size());
            if (got <= 0) return -1;
            at_ = 0;
            filled_ = static_cast<std::size_t>(got);
        }
        return static_cast<unsigned char>(buffer_[at_++]);
    }

private:
    int descriptor_;
    std::array<char, 1024> buffer_{};
    std::size_t at_ = 0;
    std::size_t filled_ = 0;
};

/// Reads a hexadecimal number. `last` becomes the character after it.
std::uintptr_t read_number(ByteReader& from, int& last) {
    std::uintptr_t number = 0;
    while (true) {
        last = from.next();
        const bool is_digit = last >= '0' && last <= '9';
        const bool is_letter = last >= 'a' && last <= 'f';
        if (!is_digit && !is_letter) return number;
        number = number * 16 + static_cast<std::uintptr_t>(is_digit ? last - '0' : last - 'a' + 10);
    }
}

/// The path of a mapped file, cut at the size of the buffer.
struct MappedPath {
    std::array<char, kMostPath> letters{};
    std::size_t size = 0;

    void add(int letter) {
        const bool is_control = letter < ' ' || letter == 127;
        if (size < letters.size()) letters[size++] = static_cast<char>(is_control ? '?' : letter);
    }
    [[nodiscard]] std::string_view text() const {
        return {letters.data(), size};
    }
};

/// Finds the file that is mapped at `address`. A line is "first-last access offset device inode
/// path". Other memory has no path, or one that does not begin with '/'.
void find_path(std::uintptr_t address, MappedPath& path) {
    ByteReader from("/proc/self/maps");
    int letter = 0;
    while (letter != -1) {
        const std::uintptr_t first = read_number(from, letter);
        const std::uintptr_t last = letter == '-' ? read_number(from, letter) : 0;
        const bool is_it = first <= address && address < last;
        while (letter != -1 && letter != '\n') {
            if (is_it && (letter == '/' || path.size > 0)) path.add(letter);
            letter = from.next();
        }
        if (is_it) return;
    }
}

/// Removes the suffix that the system adds to the path of a deleted file.
std::string_view without_deleted(std::string_view path) {
    constexpr std::string_view kDeleted = " (deleted)";
    if (path.ends_with(kDeleted)) path.remove_suffix(kDeleted.size());
    return path;
}

/// A line made of several parts, printed by one write() so that threads do not mix lines.
class Line {
public:
    void add(std::string_view part) {
        const std::size_t count = std::min(part.size(), letters_.size() - size_);
        std::copy_n(part.data(), count, letters_.data() + size_);
        size_ += count;
    }
    void write() const {
        const ssize_t ignored = ::write(STDERR_FILENO, letters_.data(), size_);
        static_cast<void>(ignored);  // a failure cannot be reported anywhere
    }

private:
    std::array<char, kMostPath + 512> letters_{};
    std::size_t size_ = 0;
};

std::atomic_flag is_told;

void on_bus_error(int signal, siginfo_t* info, void* /*context*/) {
    const bool is_page = info->si_code == BUS_ADRERR
#ifdef BUS_MCEERR_AR
                         || info->si_code == BUS_MCEERR_AR
#endif
        ;
    MappedPath path;
    if (is_page) find_path(reinterpret_cast<std::uintptr_t>(info->si_addr), path);
#ifdef __linux__
    const bool is_of_file = path.size > 0;
#else
    const bool is_of_file = is_page;
#endif
    if (!is_of_file) {
        // Other memory, or a signal sent by another process: act as if there were no handler.
        std::signal(signal, SIG_DFL);
        std::raise(signal);
        return;
    }
    while (is_told.test_and_set()) ::pause();  // another thread reports it and ends the program
    Line line;
    line.add("cdprep: ");
    line.add(path.size > 0 ? without_deleted(path.text()) : "a file that was read");
    line.add(
        ": was truncated or became unreadable while in use. The output is incomplete. "
        "Restore the file and run the command again.\n");
    line.write();
    ::_exit(static_cast<int>(Exit::unreadable));
}

}  // namespace

void watch_for_lost_pages() {
    struct sigaction action {};
    action.sa_sigaction = on_bus_error;
    action.sa_flags = SA_SIGINFO;
    sigemptyset(&action.sa_mask);
    sigaction(SIGBUS, &action, nullptr);
}

}  // namespace cdprep::cli
