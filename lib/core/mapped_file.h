// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "cdprep/result.h"

namespace cdprep {

/// The bytes of a file, mapped or copied, read-only. The only part of the library that
/// knows the operating system. Move-only; gives the memory back when it ends.
class MappedFile {
public:
    /// Fails with `unreadable` when the path is no regular file that can be
    /// read and mapped. An empty file maps to no bytes.
    [[nodiscard]] static Result<MappedFile> map(const std::filesystem::path& path);

    /// Reads the file into pages of its own, so that what happens to the file later changes
    /// nothing. Fails as map() does, and when the file becomes shorter while it is read.
    [[nodiscard]] static Result<MappedFile> copy(const std::filesystem::path& path);

    MappedFile() noexcept = default;
    MappedFile(MappedFile&& other) noexcept;
    MappedFile& operator=(MappedFile&& other) noexcept;
    ~MappedFile();

    [[nodiscard]] std::span<const std::byte> bytes() const noexcept {
        return bytes_;
    }

private:
    std::span<const std::byte> bytes_;
};

}  // namespace cdprep
