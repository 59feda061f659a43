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
#include "write/mesh_file.h"

namespace cdprep::write {

/// Files that simulators read convex pieces from.
enum class HullsFormat : std::uint8_t { obj, glb, urdf, sdf, mjcf };

/// By the extension, in any case of letters: .obj, .glb, .urdf, .sdf, and .mjcf or .xml;
/// nothing for another one.
[[nodiscard]] std::optional<HullsFormat> hulls_format_of(const std::filesystem::path& path);

/// Whether a format tells what a body weighs.
[[nodiscard]] constexpr bool has_mass(HullsFormat format) noexcept {
    return format != HullsFormat::obj && format != HullsFormat::glb;
}

/// A convex hull as it is to stand in the file.
struct HullArrays {
    std::string name;  ///< letters, digits, '_' and '-'
    std::span<const format::Double3> points;
    std::span<const std::array<std::uint32_t, 3>> facets;
    int dimension = 3;
};

/// What a rigid body weighs, in metres and kilograms.
struct BodyMass {
    double mass = 0;
    format::Double3 centre = {};
    std::array<double, 6> inertia = {};  ///< about the centre: xx, yy, zz, xy, yz, zx
};

struct HullsFileOptions {
    double metres_per_unit = 0;  ///< scales what has a unit (URDF, SDF, MJCF); 0 stands for 1
    /// Of the link or body; nothing: none is written, and readers take one of their own.
    std::optional<BodyMass> mass = {};
    /// What URDF and SDF show instead of the pieces; nothing: they show nothing.
    std::optional<MeshArrays> visual = {};
};

/// Whether write_hulls() might put a mesh in the place of a file.
[[nodiscard]] bool may_replace(const std::filesystem::path& path, HullsFormat format,
                               const std::filesystem::path& file);

/// Writes hulls, each under its name: as objects of an OBJ, nodes of a GLB, collision
/// elements of one link of a URDF or SDF, mesh geoms of one body of an MJCF.
///
/// Coordinates are written in the fewest digits that are read back the same to the last
/// bit, but in GLB, which has floats only: corners are rounded to the nearest there. URDF
/// and SDF refer to meshes by file, relative to their own: each hull stands beside the file
/// as STEM_NAME.obj, and what is shown as STEM_visual.obj. STEM is the file's without its
/// extension; where that has more than letters, digits, '_', '-' and '.', the others become
/// '_' and a number keeps files of such names apart. Hulls of fewer than three dimensions
/// are left out of URDF, SDF and MJCF, whose readers want a volume; how many there are is
/// the return value. Each file appears under its name when it is whole, `path` last.
[[nodiscard]] Result<std::size_t> write_hulls(const std::filesystem::path& path, HullsFormat format,
                                              std::span<const HullArrays> hulls,
                                              const HullsFileOptions& options = {});

}  // namespace cdprep::write
