// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "mesh/mesh.h"
#include "study/published.h"

namespace cdprep::study {

/// A mesh of a study: the facts about the file that was read, and the mesh for structures.
struct StudyMesh {
    std::string name;            ///< of the file, without its extension
    std::filesystem::path file;  ///< as the user named it
    std::size_t read_vertices = 0;
    std::size_t read_triangles = 0;
    std::uint64_t read_hash = 0;  ///< geometry_hash()
    Likeness likeness;
    mesh::Mesh mesh;               ///< fitted to a box of diagonal 1, centred, and welded
    std::uint64_t built_hash = 0;  ///< of the mesh that structures are built from
    double normalize_factor = 1;   ///< model units per unit of the file
};

/// Fits a mesh to a centred box of diagonal 1 and welds it, as `bake --normalize` does. All numbers
/// of the soup must be finite and in range.
[[nodiscard]] StudyMesh make_study_mesh(std::string name, std::filesystem::path file,
                                        mesh::TriangleSoup soup);

}  // namespace cdprep::study
