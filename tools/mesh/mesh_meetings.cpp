// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mesh_meetings.h"

#include "mesh/weld.h"

namespace cdprep::mesh {

std::vector<TriangleMeeting> find_meetings(const RepairMesh& mesh, ParallelFor parallel_for) {
    TriangleSoup soup;
    soup.positions = mesh.positions;
    soup.triangles = mesh.triangles;
    return find_self_intersections(weld(soup).mesh, parallel_for);
}

std::string triangle_in_words(const RepairMesh& mesh, std::uint32_t triangle) {
    const Origin& origin = mesh.triangle_origin[triangle];
    if (origin.source != kNone) return "triangle " + std::to_string(origin.source);
    return "a triangle of " + std::string(origin.step ? name_of(*origin.step) : "a step");
}

}  // namespace cdprep::mesh
