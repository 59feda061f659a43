// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/source_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace cdprep::import {
namespace {

struct OpenFile {
    int number;
    ~OpenFile() {
        if (number >= 0) ::close(number);
    }
};

std::string reason(int error) {
    return std::generic_category().message(error);
}

}  // namespace

Result<SourceFile> SourceFile::open(const std::filesystem::path& path, std::uint64_t max_bytes) {
    SourceFile file(path.string(), {});
    // Without O_NONBLOCK, opening a pipe would wait for its writer.
    const OpenFile descriptor{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    struct stat status {};
    if (descriptor.number < 0 || ::fstat(descriptor.number, &status) != 0) {
        return file.unreadable("cannot be opened: " + reason(errno));
    }
    if (!S_ISREG(status.st_mode)) return file.unreadable("is not a regular file");
    const auto size = static_cast<std::uint64_t>(status.st_size);
    if (size > max_bytes) {
        return file.over_budget("has " + std::to_string(size) + " bytes; at most " +
                                std::to_string(max_bytes) +
                                " are allowed. Raise --import-file-size to read it");
    }
    if (size == 0) return file.unreadable("is empty");
    void* const memory =
        ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE | MAP_POPULATE, descriptor.number, 0);
    if (memory == MAP_FAILED) return file.unreadable("cannot be mapped: " + reason(errno));
    file.bytes_ = {static_cast<const char*>(memory), size};
    file.mapped_ = true;
    return file;
}

SourceFile::SourceFile(std::string name, std::string_view bytes) noexcept
    : name_(std::move(name)), bytes_(bytes) {}

SourceFile::SourceFile(SourceFile&& other) noexcept
    : name_(std::move(other.name_)),
      bytes_(std::exchange(other.bytes_, {})),
      mapped_(std::exchange(other.mapped_, false)) {}

SourceFile& SourceFile::operator=(SourceFile&& other) noexcept {
    std::swap(name_, other.name_);
    std::swap(bytes_, other.bytes_);
    std::swap(mapped_, other.mapped_);
    return *this;
}

SourceFile::~SourceFile() {
    if (mapped_) ::munmap(const_cast<char*>(bytes_.data()), bytes_.size());
}

Error SourceFile::unreadable(std::string_view what) const {
    return {ErrorCode::unreadable, name_ + ": " + std::string(what) + "."};
}

Error SourceFile::unreadable_line(const char* at, std::string_view what) const {
    const auto line = 1 + std::count(bytes_.data(), at, '\n');
    return unreadable("line " + std::to_string(line) + ": " + std::string(what));
}

Error SourceFile::over_budget(std::string_view what) const {
    return {ErrorCode::over_budget, name_ + ": " + std::string(what) + "."};
}

std::string quoted_word(const char* at, const char* end) {
    constexpr std::size_t kShown = 24;
    std::string word = "'";
    for (; at<end&& static_cast<unsigned char>(*at)> ' '; ++at) {
        if (word.size() > kShown) return word + "...'";
        word += *at < 127 && *at > ' ' ? *at : '?';
    }
    return word + "'";
}

}  // namespace cdprep::import
