// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "validate/defects/find_defects.h"
#include "validate/defects/finding_list.h"

namespace cdprep::mesh {

/// A triangle that repeats a corner.
struct RepeatedCorner {
    std::uint32_t triangle;  ///< source number
    std::uint32_t vertex;    ///< of the mesh: its first corner that sound triangles use
    bool connected;          ///< there is one
};

/// What is left for the rules about shape: triangles with three different corners.
struct SoundMesh {
    Mesh mesh;                                   ///< vertices with equal positions joined
    std::vector<std::uint32_t> source_triangle;  ///< of each triangle, ascending
    std::vector<RepeatedCorner> repeated;        ///< left out, ascending
};

/// Finds what can be said of single vertices and of triangles without looking at shape
/// (CDP0101, 0102, 0104, 0105, 0201), and leaves those triangles out. O(n).
[[nodiscard]] SoundMesh find_sound_mesh(const TriangleSoup& soup, FindingList& findings,
                                        DefectCounts& counts);

}  // namespace cdprep::mesh
