// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "crossings/meeting_search.h"
#include "mesh/vertex_stars.h"

namespace cdprep::mesh {

/// Searches the pairs of triangles with common vertices that also meet elsewhere. The triangles
/// of the stars must have area.
void search_neighbour_meetings(const Mesh& mesh, const VertexStars& stars, MeetingSearch& search);

}  // namespace cdprep::mesh
