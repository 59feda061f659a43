// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <string>

#include "core/mapped_file.h"

namespace cdprep {
namespace {

Error unreadable(const std::filesystem::path& path, const std::string& why) {
    return {ErrorCode::unreadable, path_text(path) + ": " + why};
}

/// A descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int number) noexcept : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    [[nodiscard]] int number() const noexcept {
        return number_;
    }

private:
    int number_;
};

/// A regular file, open for reading, and its size.
struct OpenFile {
    Descriptor descriptor;
    std::size_t size = 0;
    std::optional<Error> error;

    explicit OpenFile(const std::filesystem::path& path)
        : descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
        struct stat status {};
        if (descriptor.number() < 0) {
            error =
                unreadable(path, std::string("cannot be opened: ") + std::strerror(errno) + ".");
        } else if (::fstat(descriptor.number(), &status) != 0) {
            error =
                unreadable(path, std::string("cannot be examined: ") + std::strerror(errno) + ".");
        } else if (!S_ISREG(status.st_mode)) {
            error = unreadable(path, "is not a regular file.");
        } else {
            size = static_cast<std::size_t>(status.st_size);
        }
    }
};

/// Fills all of `bytes` from the start of the file. Returns the number of bytes read, or -1.
std::ptrdiff_t read_whole(int descriptor, std::span<std::byte> bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t got =
            ::pread(descriptor, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return -1;
        if (got == 0) break;
        done += static_cast<std::size_t>(got);
    }
    return static_cast<std::ptrdiff_t>(done);
}

}  // namespace

std::string path_text(const std::filesystem::path& path) {
    return path.native();
}

std::optional<std::filesystem::path> path_from_utf8(const char* text) {
    return std::filesystem::path(std::string(text));
}

std::FILE* open_to_read(const std::filesystem::path& path) {
    return std::fopen(path.c_str(), "rb");
}

Result<MappedFile> MappedFile::map(const std::filesystem::path& path) {
    const OpenFile file(path);
    if (file.error) return *file.error;
    MappedFile mapped;
    if (file.size == 0) return mapped;
    void* start = ::mmap(nullptr, file.size, PROT_READ, MAP_PRIVATE, file.descriptor.number(), 0);
    if (start == MAP_FAILED) {
        return unreadable(path, std::string("cannot be mapped: ") + std::strerror(errno) + ".");
    }
    mapped.bytes_ = {static_cast<const std::byte*>(start), file.size};
    return mapped;
}

Result<MappedFile> MappedFile::copy(const std::filesystem::path& path) {
    const OpenFile file(path);
    if (file.error) return *file.error;
    MappedFile copied;
    if (file.size == 0) return copied;
    void* start =
        ::mmap(nullptr, file.size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED) {
        return unreadable(path, std::string("cannot be copied: ") + std::strerror(errno) + ".");
    }
    copied.bytes_ = {static_cast<const std::byte*>(start), file.size};
    const std::ptrdiff_t read =
        read_whole(file.descriptor.number(), {static_cast<std::byte*>(start), file.size});
    if (read < 0) {
        return unreadable(path, std::string("cannot be read: ") + std::strerror(errno) + ".");
    }
    if (static_cast<std::size_t>(read) < file.size) {
        return unreadable(path, "had " + std::to_string(file.size) +
                                    " bytes when it was opened, but only " + std::to_string(read) +
                                    " could be read. Copy the file again, or bake it again.");
    }
    ::mprotect(start, file.size, PROT_READ);  // a stray write stops the program, as in a mapping
    return copied;
}

MappedFile::~MappedFile() {
    if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

}  // namespace cdprep
