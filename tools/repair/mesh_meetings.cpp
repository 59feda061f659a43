// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/mesh_meetings.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "mesh/weld.h"

namespace cdprep::mesh {

bool search_meetings(const RepairMesh& mesh, const SearchOptions& options,
                     const TakeMeetings& take) {
    TriangleSoup soup;
    soup.positions = mesh.positions;
    soup.triangles = mesh.triangles;
    return search_self_intersections(weld(soup).mesh, options, take);
}

bool has_meetings(const RepairMesh& mesh, const SearchOptions& options) {
    SearchOptions first = options;
    first.limits.pairs = 1;
    bool found = false;
    search_meetings(mesh, first, [&found](std::span<const TriangleMeeting> some) {
        found = found || !some.empty();
    });
    return found;
}

Meetings find_meetings(const RepairMesh& mesh, const SearchOptions& options) {
    Meetings found{{}, true};
    found.is_complete =
        search_meetings(mesh, options, [&found](std::span<const TriangleMeeting> some) {
            found.pairs.insert(found.pairs.end(), some.begin(), some.end());
        });
    std::sort(found.pairs.begin(), found.pairs.end(),
              [](const TriangleMeeting& x, const TriangleMeeting& y) {
                  return std::tie(x.a, x.b) < std::tie(y.a, y.b);
              });
    return found;
}

std::string triangle_in_words(const RepairMesh& mesh, std::uint32_t triangle) {
    const Origin& origin = mesh.triangle_origin[triangle];
    if (origin.source != kNone) return "triangle " + std::to_string(origin.source);
    return "a triangle made by " + std::string(origin.step ? name_of(*origin.step) : "a step");
}

}  // namespace cdprep::mesh
