// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "cdprep/result.h"

namespace cdprep::write {

/// Returns the end of a chain of symbolic links, which need not exist. A file that is written there
/// replaces it, and the links stay.
[[nodiscard]] std::filesystem::path followed(std::filesystem::path target);

/// A file that appears under its name only when it is complete.
///
/// The file has no name until commit(), so a killed process leaves nothing behind. Where the file
/// system has no nameless files, it is a temporary beside its target, locked while this object
/// lives. A temporary of a killed process has no lock; the next one for that target takes it
/// over. An object destroyed before commit() leaves nothing behind.
class OutputFile {
public:
    enum class Temporary : std::uint8_t { nameless_if_possible, named };

    /// Creates the file. A symbolic link stays, and its target is replaced. Fails with
    /// `unwritable` if the target exists but is not a regular file, or if no temporary can be
    /// created.
    [[nodiscard]] static Result<OutputFile> create(
        const std::filesystem::path& wanted, Temporary kind = Temporary::nameless_if_possible);

    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    /// Returns a path by which this process can open the bytes written so far.
    [[nodiscard]] std::filesystem::path readable_path() const;

    [[nodiscard]] Result<std::uint64_t> size() const;
    [[nodiscard]] Result<Done> read_at(std::uint64_t offset, std::span<std::byte> bytes) const;
    [[nodiscard]] Result<Done> write_at(std::uint64_t offset, std::span<const std::byte> bytes);

    /// Forces the bytes to disk and renames the temporary to the target.
    [[nodiscard]] Result<Done> commit();

private:
    OutputFile(std::filesystem::path target, std::filesystem::path temporary, int descriptor);
    [[nodiscard]] Error failed(const char* what) const;
    [[nodiscard]] bool give_name();

    std::filesystem::path target_;
    std::filesystem::path temporary_;  ///< empty: the file has no name
    int descriptor_;
};

/// Creates, writes and commits a file whose bytes are complete.
[[nodiscard]] Result<Done> write_whole(const std::filesystem::path& path, std::string_view bytes);

/// The complete bytes of a file.
struct FileBytes {
    std::filesystem::path path;
    std::string bytes;
};

/// Writes files that belong together, then gives each its name, in order. If one cannot be
/// written, none appears and files of these names are unchanged. If one cannot be named, the files
/// named before it are removed, unless they replaced others.
[[nodiscard]] Result<Done> write_all(std::span<const FileBytes> files);

}  // namespace cdprep::write
