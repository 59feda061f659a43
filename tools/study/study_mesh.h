// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "mesh/mesh.h"
#include "study/published.h"

namespace cdprep::study {

/// A mesh that is measured: what was read, and what structures are built from.
struct StudyMesh {
    std::string name;            ///< of the file, without its ending
    std::filesystem::path file;  ///< as it was named
    std::size_t read_vertices = 0;
    std::size_t read_triangles = 0;
    std::uint64_t read_hash = 0;  ///< geometry_hash()
    Likeness likeness;
    mesh::Mesh mesh;               ///< fitted to a box of diagonal 1, centred, and welded
    std::uint64_t built_hash = 0;  ///< of what structures are built from
    double normalize_factor = 1;   ///< model units by those of the file
};

/// Fits a mesh to a box of diagonal 1, centred, and welds it, as `bake --normalize` does. All
/// numbers of the soup are finite and in range.
[[nodiscard]] StudyMesh make_study_mesh(std::string name, std::filesystem::path file,
                                        mesh::TriangleSoup soup);

}  // namespace cdprep::study
