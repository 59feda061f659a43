// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "validate/defects/finding.h"
#include "mesh/mesh.h"
#include "validate/page_surface.h"

namespace cdprep::report {

/// How the places of a rule are drawn.
enum class MarkShape : std::uint8_t {
    point,     ///< a pin at the position
    path,      ///< a closed line along the vertices; of two, one segment
    triangle,  ///< the triangles, filled, and a pin
};

struct MarkStyle {
    MarkShape shape;
    bool pins;        ///< a pin at each position too
    bool wide;        ///< drawn wide, to show beneath the lines of another rule
    const char* hue;  ///< name of its colour in page.css
};

[[nodiscard]] MarkStyle mark_style(mesh::Rule rule) noexcept;

/// What is drawn for the places of one finding, page units. *_ends say per place where
/// its own end, counted from the first of all.
struct Marks {
    std::vector<float> places;     ///< seven each: position, normal (0: none), radius
    std::vector<float> segments;   ///< six each
    std::vector<float> triangles;  ///< nine each
    std::vector<std::uint32_t> segment_ends;
    std::vector<std::uint32_t> triangle_ends;
};

/// The marks of these places. At most `max_parts` segments and triangles in all; of a
/// place beyond that, the position only. What cannot be drawn (a coordinate that is not
/// finite) is left out; such a place has NaN for its position.
[[nodiscard]] Marks make_marks(std::span<const mesh::Double3> positions,
                               std::span<const mesh::Triangle> triangles, const PageFrame& frame,
                               mesh::Rule rule, std::span<const mesh::Place> places,
                               std::size_t max_parts);

}  // namespace cdprep::report
