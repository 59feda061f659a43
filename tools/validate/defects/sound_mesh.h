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
    std::uint32_t vertex;    ///< of the mesh: the first corner that sound triangles use
    bool connected;          ///< such a corner exists
};

/// The input of the rules about shape: triangles with three different corners.
struct SoundMesh {
    Mesh mesh;                                   ///< vertices with equal positions joined
    std::vector<std::uint32_t> source_triangle;  ///< by triangle, ascending
    std::vector<RepeatedCorner> repeated;        ///< the triangles left out, ascending
    /// The vertices that only these use, as the lowest source numbers of their positions,
    /// ascending.
    std::vector<std::uint32_t> repeated_vertex;
};

/// Applies the rules that ignore shape (CDP0101, CDP0102, CDP0104, CDP0105, CDP0201). Leaves out
/// the triangles with such errors. O(n).
[[nodiscard]] SoundMesh find_sound_mesh(const TriangleSoup& soup, FindingList& findings,
                                        DefectCounts& counts);

}  // namespace cdprep::mesh
