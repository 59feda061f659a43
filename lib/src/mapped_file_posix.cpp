// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "mapped_file.h"

namespace cdprep {
namespace {

Error unreadable(const std::filesystem::path& path, const std::string& why) {
    return {ErrorCode::unreadable, path.string() + ": " + why};
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

}  // namespace

Result<MappedFile> MappedFile::map(const std::filesystem::path& path) {
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.number() < 0) {
        return unreadable(path, std::string("cannot be opened: ") + std::strerror(errno) + ".");
    }
    struct stat status {};
    if (::fstat(file.number(), &status) != 0) {
        return unreadable(path, std::string("cannot be examined: ") + std::strerror(errno) + ".");
    }
    if (!S_ISREG(status.st_mode)) return unreadable(path, "is not a regular file.");
    MappedFile mapped;
    const auto size = static_cast<std::size_t>(status.st_size);
    if (size == 0) return mapped;
    void* start = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number(), 0);
    if (start == MAP_FAILED) {
        return unreadable(path, std::string("cannot be mapped: ") + std::strerror(errno) + ".");
    }
    mapped.bytes_ = {static_cast<const std::byte*>(start), size};
    return mapped;
}

MappedFile::MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
}

MappedFile::~MappedFile() {
    if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

}  // namespace cdprep
