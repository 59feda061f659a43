// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/source_faces.h"

#include <numeric>

namespace cdprep::mesh {

std::vector<std::uint32_t> source_faces(const TriangleSoup& soup) {
    if (!soup.face.empty()) return soup.face;
    std::vector<std::uint32_t> faces(soup.triangles.size());
    std::iota(faces.begin(), faces.end(), 0U);
    for (const format::Instance& instance : soup.instances) {
        const auto first = faces.begin() + instance.first_triangle;
        std::iota(first, first + instance.triangle_count, 0U);
    }
    return faces;
}

}  // namespace cdprep::mesh
