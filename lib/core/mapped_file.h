// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "cdprep/result.h"

namespace cdprep {

/// Returns a path as text in UTF-8, for messages.
[[nodiscard]] inline std::string path_text(const std::filesystem::path& path) {
    const std::u8string text = path.u8string();
    return {text.begin(), text.end()};
}

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
