// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "cdprep/result.h"

namespace cdprep::import {

/// A mesh file, mapped for reading, and its name in messages.
///
/// Move-only. The bytes are those of the disk. If another program truncates the file during the
/// import, the import ends with a bus error, as for any mapped file.
class SourceFile {
public:
    /// Maps a regular file of at most `max_bytes` bytes. Fails with `unreadable` if it is missing,
    /// not a regular file or not permitted, and with `over_budget` if it is too long.
    static Result<SourceFile> open(const std::filesystem::path& path, std::uint64_t max_bytes);

    /// Reads from memory that must outlive the object. Tests use this.
    SourceFile(std::string name, std::string_view bytes) noexcept;

    SourceFile(SourceFile&& other) noexcept;
    SourceFile& operator=(SourceFile&& other) noexcept;
    ~SourceFile();

    [[nodiscard]] const std::string& name() const noexcept {
        return name_;
    }
    [[nodiscard]] std::string_view bytes() const noexcept {
        return bytes_;
    }

    /// Returns the error "NAME: WHAT." with code `unreadable`.
    [[nodiscard]] Error unreadable(std::string_view what) const;

    /// Returns the error "NAME: line N: WHAT.". N is the line of `at`, a place in bytes().
    [[nodiscard]] Error unreadable_line(const char* at, std::string_view what) const;

    /// Returns the error "NAME: WHAT." with code `over_budget`.
    [[nodiscard]] Error over_budget(std::string_view what) const;

private:
    std::string name_;
    std::string_view bytes_;
    bool mapped_ = false;
};

/// Returns the start of the word at `at`, quoted and short enough for a message. '?' replaces
/// characters that do not print.
[[nodiscard]] std::string quoted_word(const char* at, const char* end);

}  // namespace cdprep::import
