// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "cdprep/format/geometry.h"
#include "cdprep/result.h"

namespace cdprep::write {

/// Files that simulators read convex pieces from.
enum class HullsFormat : std::uint8_t { obj, glb, urdf, sdf, mjcf };

/// By the extension, in any case of letters: .obj, .glb, .urdf, .sdf, and .mjcf or .xml;
/// nothing for another one.
[[nodiscard]] std::optional<HullsFormat> hulls_format_of(const std::filesystem::path& path);

/// A convex hull as it is to stand in the file.
struct HullArrays {
    std::string name;  ///< letters, digits, '_' and '-'
    std::span<const format::Double3> points;
    std::span<const std::array<std::uint32_t, 3>> facets;
    int dimension = 3;
};

/// Writes hulls, each under its name: as objects of an OBJ, nodes of a GLB, collision
/// elements of one link of a URDF or SDF, mesh geoms of one body of an MJCF.
///
/// Coordinates are written in the fewest digits that are read back the same to the last
/// bit, but in GLB, which has floats only: corners are rounded to the nearest there. URDF
/// and SDF refer to meshes by file: each hull stands beside the file as STEM_NAME.obj.
/// metres_per_unit scales what has a unit (URDF, SDF, MJCF); 0 stands for 1. Hulls of
/// fewer than three dimensions are left out of URDF, SDF and MJCF, whose readers want a
/// volume; how many there are is the return value.
[[nodiscard]] Result<std::size_t> write_hulls(const std::filesystem::path& path, HullsFormat format,
                                              std::span<const HullArrays> hulls,
                                              double metres_per_unit);

}  // namespace cdprep::write
