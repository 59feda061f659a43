// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "write/hulls_file.h"

namespace cdprep::write {

constexpr const char* kVisual = "visual";  ///< the name of the shown mesh; no hull has it

/// The data that all elements of a GLB, URDF, SDF or MJCF share.
struct RobotFile {
    std::string name;       ///< of the robot, link, model, body and shown node
    std::string mesh_stem;  ///< the names of mesh files begin with it
    std::span<const HullArrays> hulls;
    const HullsFileOptions& options;
    std::string scale;  ///< metres per unit, for each axis
};

/// Returns the path of the mesh file of a hull, relative to the robot's file.
[[nodiscard]] std::string mesh_name(const RobotFile& file, const std::string& hull);

[[nodiscard]] std::string glb_bytes(const RobotFile& file);
[[nodiscard]] std::string urdf_text(const RobotFile& file);
[[nodiscard]] std::string sdf_text(const RobotFile& file);
[[nodiscard]] std::string mjcf_text(const RobotFile& file);

}  // namespace cdprep::write
