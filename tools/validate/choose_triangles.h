// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"
#include "page/page_surface.h"
#include "validate/defects/finding.h"

namespace cdprep::report {

/// Returns all drawable triangles of a mesh of at most `limit` triangles. Otherwise returns at most
/// `limit` of them near the places of the findings, within the largest cells that the limit allows.
/// The result holds source numbers, ascending.
[[nodiscard]] std::vector<std::uint32_t> choose_triangles(std::span<const mesh::Double3> positions,
                                                          std::span<const mesh::Triangle> triangles,
                                                          const PageFrame& frame,
                                                          std::span<const mesh::Finding> findings,
                                                          std::size_t limit);

}  // namespace cdprep::report
