// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/result.h"
#include "mesh/mesh.h"

namespace cdprep::import {

/// What an import may use before it is stopped with over_budget, or, where the
/// file lies about its size, unreadable.
struct ImportOptions {
    std::uint64_t memory_bytes = std::uint64_t{8} << 30;  ///< --import-memory
    std::chrono::seconds time{300};                       ///< --import-time
    std::uint64_t file_bytes = std::uint64_t{16} << 30;   ///< --import-file-size
    bool allow_empty = false;                             ///< --allow-empty
    std::optional<double> metres_per_unit;  ///< --unit: in place of what the file says
    std::optional<format::UpAxis> up_axis;  ///< --up-axis: likewise; nothing is turned
    ParallelFor parallel_for = serial_for;
};

/// Reads OBJ, STL, PLY and OFF by our own readers, 3MF and glTF by our own readers in a child
/// process, and every other format by assimp there. sniff_format() says who reads.
///
/// NaN, infinity and indices out of range come back as data (bad_numbers). A file that cannot be
/// read as its format says is `unreadable`, with file, place, number found and number allowed. So
/// is one that refers to a mesh which was not read, and, unless allowed, one without triangles.
[[nodiscard]] Result<mesh::TriangleSoup> import_file(const std::filesystem::path& path,
                                                     const ImportOptions& options = {});

}  // namespace cdprep::import
