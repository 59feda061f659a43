// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "import/import_file.h"
#include "import/source_file.h"

namespace cdprep::import {

/// The bytes that a child wrote, mapped. Move-only. No other process holds this shared memory any
/// more.
class ChildResult {
public:
    /// Maps what is behind the descriptor. There are no bytes if that is impossible.
    explicit ChildResult(int descriptor);
    ChildResult(ChildResult&& other) noexcept;
    ChildResult& operator=(ChildResult&&) = delete;
    ~ChildResult();

    [[nodiscard]] std::span<const std::byte> bytes() const noexcept {
        return bytes_;
    }

private:
    std::span<const std::byte> bytes_;
};

/// Reads any format that our child supports, in a child process. The result has an outcome of
/// `read`; PlacedScene checks the rest of it.
///
/// The child is the program cdprep-import-child, found beside the running program,
/// in ../libexec/cdprep, or in the build tree. It gets no descriptors except the one
/// for its result. It may open only files in the folder of `path` and below. It is
/// killed if it exceeds options.time or options.memory_bytes. Every failure of the child
/// becomes one error message here. Its result is checked like an untrusted file.
[[nodiscard]] Result<ChildResult> read_in_child(const SourceFile& file,
                                                const std::filesystem::path& path,
                                                const ImportOptions& options);

/// Reads a file in a child, and makes one soup of its nodes.
[[nodiscard]] Result<mesh::TriangleSoup> import_in_child(const SourceFile& file,
                                                         const std::filesystem::path& path,
                                                         const ImportOptions& options);

}  // namespace cdprep::import
