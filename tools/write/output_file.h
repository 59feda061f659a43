// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "cdprep/result.h"

namespace cdprep::write {

/// A file that appears under its name only when it is whole.
///
/// Lives as a temporary beside its target, locked while this object lives. A
/// temporary that a killed process left has no lock; the next one for that
/// target takes it over. Destroyed before commit(), it leaves nothing behind.
class OutputFile {
public:
    /// A symbolic link stays, and what it leads to is replaced. Fails with `unwritable`
    /// when that is there and no regular file, and when no temporary can be made.
    [[nodiscard]] static Result<OutputFile> create(const std::filesystem::path& wanted);

    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    [[nodiscard]] const std::filesystem::path& temporary() const noexcept {
        return temporary_;
    }

    [[nodiscard]] Result<std::uint64_t> size() const;
    [[nodiscard]] Result<Done> read_at(std::uint64_t offset, std::span<std::byte> bytes) const;
    [[nodiscard]] Result<Done> write_at(std::uint64_t offset, std::span<const std::byte> bytes);

    /// Forces the bytes to disk and renames the temporary to the target.
    [[nodiscard]] Result<Done> commit();

private:
    OutputFile(std::filesystem::path target, std::filesystem::path temporary, int descriptor);
    [[nodiscard]] Error failed(const char* what) const;

    std::filesystem::path target_;
    std::filesystem::path temporary_;
    int descriptor_;
};

/// Creates, writes and commits a file that is at hand whole.
[[nodiscard]] Result<Done> write_whole(const std::filesystem::path& path, std::string_view bytes);

}  // namespace cdprep::write
