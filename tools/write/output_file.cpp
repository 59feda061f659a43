// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/output_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace cdprep::write {
namespace {

constexpr int kMostWriters = 100;  ///< of one target at once

std::filesystem::path temporary_name(const std::filesystem::path& target, int number) {
    std::string name = ".";
    name += target.filename().string();
    name += ".tmp";
    if (number > 0) name += std::to_string(number);
    return target.parent_path() / name;
}

Error unwritable(const std::filesystem::path& target, const std::string& why) {
    std::error_code unknown;
    const bool was_there = std::filesystem::exists(target, unknown);
    return {ErrorCode::unwritable,
            target.string() + ": " + why +
                (was_there ? ". The previous content is unchanged." : ". Nothing was written.")};
}

/// Returns false for a device or a pipe, which a rename would replace by a file.
bool is_replaceable(const std::filesystem::path& target) {
    std::error_code error;
    const auto status = std::filesystem::status(target, error);
    return !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
}

/// Opens and locks one temporary; returns -1 and sets errno if it cannot. A link of that name is
/// not followed: what it leads to is somebody else's file. The lock is on the inode. After locking
/// we therefore test that the name still leads to the inode: another writer may just have renamed
/// or removed it.
int open_locked(const std::filesystem::path& temporary) {
    while (true) {
        const int descriptor =
            ::open(temporary.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (descriptor < 0) return -1;
        struct stat ours {};
        struct stat named {};
        if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && ::fstat(descriptor, &ours) == 0) {
            if (::stat(temporary.c_str(), &named) == 0 && ours.st_ino == named.st_ino) {
                return descriptor;
            }
            ::close(descriptor);
            continue;
        }
        const int cause = errno;
        ::close(descriptor);
        errno = cause;
        return -1;
    }
}

void remove_abandoned(const std::filesystem::path& temporary) {
    if (::access(temporary.c_str(), F_OK) != 0) return;
    const int descriptor = open_locked(temporary);
    if (descriptor < 0) return;
    ::unlink(temporary.c_str());
    ::close(descriptor);
}

std::filesystem::path folder_of(const std::filesystem::path& target) {
    return target.has_parent_path() ? target.parent_path() : ".";
}

/// Returns a path to an open file. It is valid while the file is open.
std::string path_of(int descriptor) {
    return "/proc/self/fd/" + std::to_string(descriptor);
}

/// Opens and locks a file without a name in a folder; returns -1 if that is not possible. The file
/// briefly has a temporary's name before its target's. The lock keeps others from taking it over
/// then.
int open_nameless(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    if (descriptor < 0) return -1;
    const bool can_be_named = ::access(path_of(descriptor).c_str(), R_OK) == 0;
    if (can_be_named && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
    ::close(descriptor);
    return -1;
}

/// Returns a clause that explains why a file was not created. It names a missing folder, which is
/// a likelier misspelling than the file. A folder of the kernel, such as /proc, fails in the same
/// way, but exists.
std::string why_not_created(const std::filesystem::path& target, int error) {
    const std::filesystem::path folder = folder_of(target);
    std::error_code unknown;
    if (error == ENOENT) {
        return "cannot be written, because the folder " + folder.string() +
               (std::filesystem::is_directory(folder, unknown) ? " accepts no new files"
                                                               : " does not exist");
    }
    return std::string("cannot be written: ") + std::strerror(error);
}

/// Lets this process open `count` more files, as far as the system permits.
void allow_open_files(std::size_t count) {
    constexpr rlim_t kOthers = 256;  // open already, or soon
    struct rlimit limit {};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    const rlim_t wanted = std::min<rlim_t>(limit.rlim_max, count + kOthers);
    if (limit.rlim_cur >= wanted) return;
    limit.rlim_cur = wanted;
    ::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

std::filesystem::path followed(std::filesystem::path target) {
    constexpr int kMostLinks = 40;  // the limit of the kernel
    std::error_code error;
    for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(target, error); ++i) {
        const std::filesystem::path next = std::filesystem::read_symlink(target, error);
        if (error) break;
        target = target.parent_path() / next;  // an absolute path replaces all
    }
    return target;
}

OutputFile::OutputFile(std::filesystem::path target, std::filesystem::path temporary,
                       int descriptor)
    : target_(std::move(target)), temporary_(std::move(temporary)), descriptor_(descriptor) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::move(other.temporary_)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputFile::~OutputFile() {
    if (descriptor_ < 0) return;
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
    ::close(descriptor_);
}

Result<OutputFile> OutputFile::create(const std::filesystem::path& wanted, Temporary kind) {
    const std::filesystem::path target = followed(wanted);
    if (!is_replaceable(target)) {
        return unwritable(wanted, "is a folder, a device or a pipe; only a file can be replaced");
    }
    if (kind == Temporary::nameless_if_possible) {
        const int descriptor = open_nameless(folder_of(target));
        if (descriptor >= 0) {
            for (const int number : {0, 1}) remove_abandoned(temporary_name(target, number));
            return OutputFile(target, {}, descriptor);
        }
    }
    for (int number = 0; number < kMostWriters; ++number) {
        const std::filesystem::path temporary = temporary_name(target, number);
        const int descriptor = open_locked(temporary);
        if (descriptor >= 0) {
            remove_abandoned(temporary_name(target, number + 1));
            OutputFile file(target, temporary, descriptor);
            if (::ftruncate(descriptor, 0) != 0) return file.failed("cannot be truncated");
            return file;
        }
        const bool is_taken = errno == EWOULDBLOCK || errno == ELOOP;  // ELOOP: by a link
        if (!is_taken) {
            return unwritable(target, why_not_created(target, errno));
        }
    }
    return unwritable(target, "is being written by " + std::to_string(kMostWriters) +
                                  " other programs, the maximum");
}

Error OutputFile::failed(const char* what) const {
    return unwritable(target_, std::string(what) + ": " + std::strerror(errno));
}

Result<std::uint64_t> OutputFile::size() const {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) return failed("cannot be examined");
    return static_cast<std::uint64_t>(status.st_size);
}

Result<Done> OutputFile::read_at(std::uint64_t offset, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t done =
            ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return failed("cannot be read back");
        bytes = bytes.subspan(static_cast<std::size_t>(done));
        offset += static_cast<std::uint64_t>(done);
    }
    return Done{};
}

Result<Done> OutputFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t done =
            ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (done < 0 && errno == EINTR) continue;
        if (done < 0) return failed("cannot be written");
        bytes = bytes.subspan(static_cast<std::size_t>(done));
        offset += static_cast<std::uint64_t>(done);
    }
    return Done{};
}

Result<Done> OutputFile::commit() {
    if (::fsync(descriptor_) != 0) return failed("cannot be synced to disk");
    if (temporary_.empty() && !give_name()) return failed("cannot be named");
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) return failed("cannot be renamed");
    ::close(std::exchange(descriptor_, -1));
    // The name must also survive a power cut. If a folder cannot be synced, the file is
    // complete all the same.
    const std::filesystem::path folder = folder_of(target_);
    const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (handle >= 0) {
        ::fsync(handle);
        ::close(handle);
    }
    return Done{};
}

std::filesystem::path OutputFile::readable_path() const {
    return temporary_.empty() ? std::filesystem::path(path_of(descriptor_)) : temporary_;
}

/// Gives the file the name of a temporary until rename(): a link cannot replace an existing file.
bool OutputFile::give_name() {
    const std::string own = path_of(descriptor_);
    for (int number = 0; number < kMostWriters; ++number) {
        const std::filesystem::path name = temporary_name(target_, number);
        remove_abandoned(name);
        if (::linkat(AT_FDCWD, own.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
            temporary_ = name;
            return true;
        }
        if (errno != EEXIST) return false;
    }
    return false;
}

Result<Done> write_whole(const std::filesystem::path& path, std::string_view bytes) {
    Result<OutputFile> file = OutputFile::create(path);
    if (!file) return file.error();
    const Result<Done> written = file.value().write_at(0, std::as_bytes(std::span(bytes)));
    if (!written) return written.error();
    return file.value().commit();
}

Result<Done> write_all(std::span<const FileBytes> files) {
    allow_open_files(files.size());
    std::vector<OutputFile> open;
    open.reserve(files.size());
    for (const FileBytes& file : files) {
        Result<OutputFile> created = OutputFile::create(file.path);
        if (!created) return created.error();
        open.push_back(std::move(created).value());
        const Result<Done> written =
            open.back().write_at(0, std::as_bytes(std::span(std::string_view(file.bytes))));
        if (!written) return written.error();
    }
    std::vector<std::filesystem::path> added;
    for (std::size_t i = 0; i < files.size(); ++i) {
        std::error_code unknown;
        const bool was_there = std::filesystem::exists(files[i].path, unknown);
        const Result<Done> committed = open[i].commit();
        if (committed) {
            if (!was_there) added.push_back(files[i].path);
            continue;
        }
        for (const std::filesystem::path& path : added) std::filesystem::remove(path, unknown);
        return committed.error();
    }
    return Done{};
}

}  // namespace cdprep::write
