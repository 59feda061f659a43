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

/// File formats from which simulators read convex hulls.
enum class HullsFormat : std::uint8_t { obj, glb, urdf, sdf, mjcf };

/// Returns the format that the extension names, in upper or lower case: .obj, .glb, .urdf, .sdf,
/// and .mjcf or .xml. Returns nothing for another extension.
[[nodiscard]] std::optional<HullsFormat> hulls_format_of(const std::filesystem::path& path);

/// Returns true if a format stores the mass of a body.
[[nodiscard]] constexpr bool has_mass(HullsFormat format) noexcept {
    return format != HullsFormat::obj && format != HullsFormat::glb;
}

/// Returns true if a format refers to mesh files of its own: a file per hull.
[[nodiscard]] constexpr bool has_mesh_files(HullsFormat format) noexcept {
    return format == HullsFormat::urdf || format == HullsFormat::sdf;
}

/// A convex hull in the form in which the file stores it.
struct HullArrays {
    std::string name;  ///< letters, digits, '_' and '-'
    std::span<const format::Double3> points;
    std::span<const std::array<std::uint32_t, 3>> facets;
    int dimension = 3;
};

/// The mass, centre of mass and inertia of a rigid body, in metres and kilograms.
struct BodyMass {
    double mass = 0;
    format::Double3 centre = {};
    std::array<double, 6> inertia = {};  ///< about the centre: xx, yy, zz, xy, yz, zx
};

struct HullsFileOptions {
    double metres_per_unit = 0;  ///< scales formats with a unit (URDF, SDF, MJCF); 0 means 1
    /// Of the link or body. Nothing: no mass is written, and readers use their own default.
    std::optional<BodyMass> mass = {};
    /// The mesh that is shown instead of the hulls. Nothing: only MJCF and GLB show the hulls.
    /// An OBJ never contains it.
    std::optional<MeshArrays> visual = {};
    bool is_floating = false;     ///< MJCF: a free joint; otherwise the body is fixed to the world
    std::string hulls_node = {};  ///< GLB: the name of a node above the hulls; empty: none
    /// GLB: small hulls are stored larger by a power of two, in nodes that scale them down. For
    /// Unity, which cooks a mesh before its node scales it: PhysX drops points of small ones.
    bool stores_hulls_large = false;
    /// URDF: the package and the folder in it, as in package://PACKAGE/FOLDER, where the meshes are
    /// found. Empty: paths relative to the file.
    std::string package = {};
};

/// What write_hulls() did to the hulls.
struct WrittenHulls {
    std::size_t left_out = 0;  ///< hulls without a volume that the format cannot hold
    double rounding = 0;       ///< GLB: corners moved by at most this when they became floats
};

/// Returns the name of the robot, model or body in a file: the file's name without its extension.
/// Characters other than letters, digits, '_', '-' and '.' become '_'.
[[nodiscard]] std::string model_name(const std::filesystem::path& path);

/// Returns true if write_hulls() to `path` might replace `file` by a mesh.
[[nodiscard]] bool may_replace(const std::filesystem::path& path, HullsFormat format,
                               const std::filesystem::path& file);

/// Returns the error with which write_hulls() to `path` will fail for the mesh file of this hull:
/// it exists, and another program wrote it.
[[nodiscard]] std::optional<Error> find_foreign_mesh(const std::filesystem::path& path,
                                                     HullsFormat format, const std::string& hull);

/// Writes hulls, each under its name. They become objects of an OBJ, nodes of a GLB, or mesh
/// geoms of one body of an MJCF. In a URDF or SDF, they become collision elements of one link.
/// A shown mesh becomes the first node of a GLB, named as the model, or a geom without collisions.
///
/// Coordinates are written in the fewest digits that read back bit for bit. GLB has only
/// floats: its corners are rounded to the nearest float, and the result says how far they moved.
/// Then a hull may miss what it enclosed by as much. URDF and SDF refer to mesh files by paths
/// relative to their own. Each hull is written beside the file as STEM_NAME.obj. The mesh that
/// URDF, SDF and MJCF show is written as STEM_visual.obj. STEM is model_name(); if that replaced
/// characters, a number distinguishes such names. URDF, SDF and MJCF omit hulls of fewer than three
/// dimensions, because their readers require a volume. All formats omit hulls without points.
///
/// Fails with `bad_argument` if a GLB would exceed 4 GiB, or one of its coordinates the largest
/// float. So it does if rounding moves a corner by more than a thousandth of the size of the whole.
/// Mesh files begin with a line by which later runs know them. It also fails if one would replace a
/// file without that line: no argument names these files. All files appear when they are complete,
/// or none does (write_all()).
[[nodiscard]] Result<WrittenHulls> write_hulls(const std::filesystem::path& path,
                                               HullsFormat format,
                                               std::span<const HullArrays> hulls,
                                               const HullsFileOptions& options = {});

}  // namespace cdprep::write
