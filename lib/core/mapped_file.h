// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "cdprep/result.h"

namespace cdprep {

/// Returns a path as text in UTF-8, for messages. What is no Unicode becomes question marks.
[[nodiscard]] std::string path_text(const std::filesystem::path& path);

/// Returns the path that a text in UTF-8 names, or nothing if the system takes no such text.
[[nodiscard]] std::optional<std::filesystem::path> path_from_utf8(const char* text);

/// Opens a file for reading, as std::fopen() does.
[[nodiscard]] std::FILE* open_to_read(const std::filesystem::path& path);

/// The bytes of a file, mapped or copied, read-only. The only part of the library that depends on
/// the operating system. Move-only; releases the memory on destruction.
class MappedFile {
public:
    /// Maps the file. Fails with `unreadable` if the path is not a regular file that can be read
    /// and mapped. An empty file maps to no bytes.
    [[nodiscard]] static Result<MappedFile> map(const std::filesystem::path& path);

    /// Reads the file into private pages, so later changes of the file have no effect. Fails as
    /// map() does, and if the file becomes shorter during the read.
    [[nodiscard]] static Result<MappedFile> copy(const std::filesystem::path& path);

    MappedFile() noexcept = default;
    MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
    MappedFile& operator=(MappedFile&& other) noexcept {
        std::swap(bytes_, other.bytes_);
        return *this;
    }
    ~MappedFile();

    [[nodiscard]] std::span<const std::byte> bytes() const noexcept {
        return bytes_;
    }

private:
    std::span<const std::byte> bytes_;
};

}  // namespace cdprep
