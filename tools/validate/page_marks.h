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

/// The shape that marks the places of a rule.
enum class MarkShape : std::uint8_t {
    point,     ///< a pin at the position
    path,      ///< a closed line along the vertices; one segment for two vertices
    triangle,  ///< the triangles, filled, and a pin
};

struct MarkStyle {
    MarkShape shape;
    bool pins;        ///< also a pin at each position
    bool wide;        ///< drawn wide, to remain visible under lines of another rule
    const char* hue;  ///< name of its colour in page.css
};

[[nodiscard]] MarkStyle mark_style(mesh::Rule rule) noexcept;

/// The marks of one finding's places, in page units. For each place, *_ends hold the end of its
/// range, counted from the start of the list.
struct Marks {
    std::vector<float> places;     ///< seven each: position, normal (0: none), radius
    std::vector<float> segments;   ///< six each
    std::vector<float> triangles;  ///< nine each
    std::vector<std::uint32_t> segment_ends;
    std::vector<std::uint32_t> triangle_ends;
};

/// Returns the marks of these places, with at most `max_parts` segments and triangles in total.
/// Places beyond that have only a position. Parts with a coordinate that is not finite are left
/// out; a place with such a position has NaN for it.
[[nodiscard]] Marks make_marks(std::span<const mesh::Double3> positions,
                               std::span<const mesh::Triangle> triangles, const PageFrame& frame,
                               mesh::Rule rule, std::span<const mesh::Place> places,
                               std::size_t max_parts);

}  // namespace cdprep::report
