// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/result.h"
#include "import/source_file.h"
#include "mesh/mesh.h"

namespace cdprep::import {

/// The limits and settings of an import. An import that exceeds a limit fails with over_budget,
/// or with `unreadable` if the file states a false size.
struct ImportOptions {
    std::uint64_t memory_bytes = std::uint64_t{8} << 30;  ///< --import-memory
    std::chrono::seconds time{300};                       ///< --import-time
    std::uint64_t file_bytes = std::uint64_t{16} << 30;   ///< --import-file-size
    bool allow_empty = false;                             ///< --allow-empty
    std::optional<double> metres_per_unit;                ///< --unit: replaces the unit of the file
    std::optional<format::UpAxis> up_axis;                ///< --up-axis: likewise; rotates nothing
    ParallelFor parallel_for = serial_for;
    /// Called with each other file that was read. An error ends the import. May be empty. Threads
    /// may call it at once.
    std::function<std::optional<Error>(const std::filesystem::path& file)> find_conflict = {};
};

/// Reads a mesh file. Our own readers read OBJ, STL, PLY and OFF. In a child process, our own
/// readers read 3MF and glTF, and assimp reads every other format. sniff_format() selects the
/// reader.
///
/// NaN, infinity and indices out of range are returned as data (bad_numbers). Fails with
/// `unreadable` on a file that violates its format; the message gives file, place, number found and
/// number allowed. Also fails on a file that refers to a mesh which was not read. Fails on a file
/// without triangles, unless options.allow_empty is set.
[[nodiscard]] Result<mesh::TriangleSoup> import_file(const std::filesystem::path& path,
                                                     const ImportOptions& options = {});

/// Sets the hash of the source, and of each other file that was read, so that a changed buffer
/// changes the source. Fails if one of these files can no longer be read, or is in conflict by
/// options.find_conflict.
[[nodiscard]] std::optional<Error> note_files(const SourceFile& file,
                                              const std::filesystem::path& path,
                                              const ImportOptions& options,
                                              mesh::TriangleSoup& soup);

}  // namespace cdprep::import
