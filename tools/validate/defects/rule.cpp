// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/rule.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace cdprep::mesh {
namespace {

constexpr const char* kExact = "exact";

// RULES.md holds the same texts; a test compares them.
constexpr std::array kRules = {
    RuleText{Rule::non_finite_coordinate, "non-finite-coordinate", Severity::error,
             "Coordinate is not a number",
             "A vertex of the file, used or not, with a coordinate that is NaN or infinite. "
             "All other rules leave out the triangles that use it.",
             "No box, distance or crossing is defined for such a vertex; bake refuses the "
             "file.",
             "Correct the vertex at its source, or delete it and its triangles. The exporter "
             "divided by zero or applied a broken transform.",
             kExact, ""},
    RuleText{Rule::index_out_of_range, "index-out-of-range", Severity::error,
             "Triangle uses a vertex that does not exist",
             "A triangle with a corner whose number is not that of a vertex of the file. All "
             "other rules leave it out.",
             "The triangle has no position; bake refuses the file.",
             "Export the file again: it was cut short, or its indices start at another number.",
             kExact, "the vertex number in the file"},
    RuleText{Rule::extent_beyond_float, "extent-beyond-float", Severity::warning,
             "Extent is beyond the largest float",
             "A vertex that triangles use, with a coordinate whose magnitude exceeds the "
             "largest float (3.4028235e38). Or an axis along which the box of all such "
             "vertices is longer than that, although no coordinate exceeds it. Bake refuses a "
             "mesh beyond 2^1000.",
             "Programs that store positions or extents as floats read infinity. Answers of "
             "this library stay correct up to 2^1000.",
             "Scale the model, or remove the stray vertex that makes it so large.", kExact,
             "the coordinate or the extent, in model units"},
    RuleText{Rule::unreferenced_vertex, "unreferenced-vertex", Severity::note, "Vertex is not used",
             "A vertex of the file that no triangle uses as a corner.",
             "No effect on collision: baking leaves it out. A box computed from all vertices "
             "of the file can become too large.",
             "No repair is necessary; weld in repair leaves it out.", kExact, ""},
    RuleText{Rule::duplicate_vertex, "duplicate-vertex", Severity::note,
             "Vertices have equal positions",
             "A vertex of the file, used or not, with the coordinates of one with a lower number "
             "(-0 equals 0). For all rules from CDP0201 on, the two are one vertex.",
             "No effect on collision: baking joins them. By index alone, the mesh has more "
             "components than its surface.",
             "No repair is necessary; weld joins them.", kExact, ""},
    RuleText{Rule::near_vertex, "near-vertex", Severity::warning,
             "Vertices have nearly equal positions",
             "A vertex that welding at the given distance would join to a vertex with a lower "
             "number and another position. Examined only if a weld distance is given.",
             "Triangles that should share a vertex do not: the surface has cracks, and inside "
             "is not defined.",
             "Weld with that distance.",
             "by distances in double, rounded, as in weld; chains of near vertices are joined",
             "the distance to the vertex that it would join, in model units"},
    RuleText{Rule::empty_mesh, "empty-mesh", Severity::warning, "Mesh has no triangles",
             "No triangle is left for queries: the file has none, or CDP0101, CDP0102 and "
             "CDP0201 leave out all of them.",
             "Nothing is hit, nothing is inside, and no other rule can find anything: a mesh "
             "that lost its triangles looks flawless.",
             "Export the file again, with its faces: it contains only points or lines, or it was "
             "cut short.",
             kExact, ""},
    RuleText{Rule::repeated_corner, "repeated-corner", Severity::warning,
             "Triangle repeats a corner",
             "A triangle with two corners that are the same vertex or have equal positions. "
             "All later rules leave it out.",
             "It is a segment or a point: it can touch other objects, but bounds nothing.",
             "Drop degenerate triangles.", kExact, ""},
    RuleText{Rule::zero_area, "zero-area", Severity::warning, "Triangle has no area",
             "A triangle with three different corners on one line.",
             "It is a segment: it has no normal, crosses nothing, and usually hides a "
             "T-junction.",
             "Drop zero-area triangles, then resolve T-junctions.", kExact,
             "its longest edge, in model units"},
    RuleText{Rule::sliver, "sliver", Severity::note, "Triangle is a sliver",
             "A triangle with a positive area, less than 1e-10 times the square of its longest "
             "edge.",
             "Answers stay exact. Normals and contact points computed from it in floating "
             "point are unreliable.",
             "Flip or collapse its longest edge in the modelling program, or weld.",
             "area and ratio in double; a triangle whose ratio is within rounding of the limit "
             "may be missed or reported",
             "its area divided by the square of its longest edge"},
    RuleText{Rule::duplicate_triangle, "duplicate-triangle", Severity::warning,
             "Triangle occurs twice",
             "A triangle with the same corners as one with a lower number, wound like the lowest "
             "of them.",
             "Every contact is reported twice, the edges are non-manifold, and the winding "
             "number inside is 2.",
             "Drop duplicate triangles.", kExact, ""},
    RuleText{Rule::opposite_triangle, "opposite-triangle", Severity::warning,
             "Triangle occurs with both windings",
             "A triangle with the same corners as one with a lower number, wound opposite to the "
             "lowest of them.",
             "The two together enclose nothing: a two-sided sheet has no inside, and every "
             "contact is reported twice.",
             "Drop duplicate triangles if the sheet was meant to be one-sided.", kExact, ""},
    RuleText{Rule::boundary_edge, "boundary-edge", Severity::warning, "Edge has one triangle",
             "An edge that exactly one triangle uses.",
             "The surface is open there: inside is not defined, and only surface queries are "
             "exact.",
             "Weld, stitch seams, resolve T-junctions, or fill the hole.", kExact,
             "its length, in model units"},
    RuleText{Rule::boundary_loop, "boundary-loop", Severity::warning, "Surface has a hole",
             "A connected set of boundary edges (CDP0301). Loops that share a vertex are one. "
             "The vertices of the place follow the loop: as many as it has edges, but at most "
             "the first 1000.",
             "A hole, a crack or the rim of a sheet: inside is not defined.",
             "Fill holes up to its size, or stitch it if it is a crack.", kExact,
             "the size of the hole: the diagonal of its bounding box, in model units"},
    RuleText{Rule::non_manifold_edge, "non-manifold-edge", Severity::warning,
             "Edge has more than two triangles", "An edge that more than two triangles use.",
             "Surface queries stay exact. The neighbour across the edge is not defined: convex "
             "pieces end there. Inside is defined only if the windings cancel.",
             "Drop duplicate triangles; then split non-manifold edges.", kExact,
             "the number of triangles that use it"},
    RuleText{Rule::non_manifold_vertex, "non-manifold-vertex", Severity::warning,
             "Vertex has several fans",
             "A vertex whose triangles are not all connected to each other across the edges "
             "that end at it.",
             "The surface is pinched to a point there: a walk from triangle to triangle cannot "
             "pass it.",
             "Split non-manifold vertices.", kExact, "the number of its fans"},
    RuleText{Rule::inconsistent_winding, "inconsistent-winding", Severity::warning,
             "Neighbours are wound differently",
             "An edge that exactly two triangles use, both in the same direction.",
             "One of them shows its back: winding numbers, volumes and normals are wrong.",
             "Orient consistently.", kExact, "its length, in model units"},
    RuleText{Rule::non_orientable, "non-orientable", Severity::warning,
             "Component cannot be oriented",
             "A component that no choice of windings orients. Some edge of exactly two "
             "triangles is always used twice in the same direction, as on a Moebius strip.",
             "It has one side only: nothing is inside.",
             "Cut it, or split the edges that were joined by mistake. Orienting stops there.",
             kExact, ""},
    RuleText{Rule::t_junction, "t-junction", Severity::warning, "Vertex lies within an edge",
             "A boundary edge (CDP0301) and an end of another boundary edge that lies on it, "
             "between its ends. An end that rounding has moved off the edge is a near seam "
             "(CDP0308).",
             "The triangles on its two sides do not share the edge: a crack of zero width "
             "makes the mesh open.",
             "Resolve T-junctions.", kExact,
             "the position on the edge, from 0 at its first end to 1"},
    RuleText{Rule::near_seam, "near-seam", Severity::warning, "Seam has a gap",
             "An end of a boundary edge that is at most the seam width from another boundary "
             "edge. It is not on that edge and not a corner of its triangle. The other edge "
             "belongs to another loop (CDP0302), or is more than four widths away along the "
             "same loop. The place has the nearest such edge. Examined only if a seam width is "
             "given.",
             "Small objects fall through the gap, and the mesh is open.",
             "Stitch seams with that width, or weld with a distance.",
             "by distances in double, rounded; strips of surface narrower than the width are "
             "reported like gaps",
             "the width of the gap, in model units"},
    RuleText{Rule::inverted_component, "inverted-component", Severity::warning,
             "Component is inside out",
             "A component with negative volume that uses every edge equally often in both "
             "directions. This is correct for the wall of a cavity.",
             "The winding number inside it is -1. Solid queries still count that as inside; "
             "normals point the wrong way.",
             "Orient outward.",
             "exact: where the sum of volumes in double is within its error bound of zero, "
             "integers replace it",
             "its volume, in cubic model units"},
    RuleText{Rule::nested_component, "nested-component", Severity::note,
             "Component lies in another",
             "Each pair of components, one inside the other. Both have a defined inside (every "
             "edge is used equally often in both directions). The winding number of the outer "
             "one is not 0 at the first inner vertex that is off its surface. Where crossings "
             "are examined, the triangles of the two do not cross.",
             "The inner one is the wall of a cavity if it is wound inwards. Otherwise the "
             "winding number inside is 2, and contacts within a solid are reported.",
             "Orient it inwards for a cavity; delete it if it is hidden.", kExact,
             "the winding number of the outer component around the inner one"},
    RuleText{Rule::overlapping_components, "overlapping-components", Severity::warning,
             "Components overlap",
             "Two components whose triangles cross (CDP0501, or CDP0502 where edges cross) or "
             "share area in a plane (CDP0503). Examined only if crossings are examined.",
             "Volume and inertia count the common part twice.",
             "Remove self-intersections, or bake the components as separate models.", kExact,
             "the number of pairs of triangles"},
    RuleText{Rule::several_components, "several-components", Severity::note,
             "Mesh has several components",
             "More than one set of triangles connected by shared vertices. The count includes "
             "all components; each place is one component, by its lowest-numbered triangle.",
             "No effect by itself; parts of an assembly are often meant to be separate models.",
             "No repair is necessary. Tiny components can be dropped on request.", kExact,
             "the number of its triangles"},
    RuleText{Rule::crossing_triangles, "crossing-triangles", Severity::warning, "Triangles cross",
             "Two triangles without a common vertex, where an edge of one passes through the "
             "interior of the other. Or two triangles with exactly one common vertex, not in "
             "one plane, that also meet elsewhere.",
             "The surface is not that of a solid: there are winding numbers other than 0 and "
             "1, and the volume counts parts twice.",
             "Remove self-intersections.", kExact, ""},
    RuleText{Rule::touching_triangles, "touching-triangles", Severity::note, "Triangles touch",
             "Two triangles without a common vertex, not in one plane, that have a common "
             "point. No edge of one passes through the interior of the other.",
             "Often the far side of a T-junction; otherwise parts in contact.",
             "Resolve T-junctions; parts in contact need no repair.", kExact, ""},
    RuleText{Rule::coplanar_overlap, "coplanar-overlap", Severity::warning,
             "Triangles overlap in a plane",
             "Two triangles in one plane that share area and do not have the same three "
             "corners. They may share a vertex, or an edge over which one is folded.",
             "It is not defined which of them is outside; contacts are reported twice.",
             "Remove self-intersections, or delete one of them.", kExact,
             "the number of vertices that they share"},
};

char lower(char c) noexcept {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool same_letters(std::string_view a, std::string_view b) noexcept {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

std::span<const RuleText> all_rules() noexcept {
    return kRules;
}

const RuleText& text_of(Rule rule) noexcept {
    const auto* found =
        std::lower_bound(kRules.begin(), kRules.end(), rule,
                         [](const RuleText& text, Rule wanted) { return text.rule < wanted; });
    assert(found != kRules.end() && found->rule == rule);
    return *found;
}

std::string id_of(Rule rule) {
    constexpr std::size_t kDigits = 4;
    const std::string number = std::to_string(static_cast<unsigned>(rule));
    return "CDP" + std::string(kDigits - std::min(kDigits, number.size()), '0') + number;
}

std::optional<Rule> find_rule(std::string_view id_or_name) noexcept {
    for (const RuleText& text : kRules) {
        if (same_letters(id_or_name, text.name)) return text.rule;
        if (same_letters(id_or_name, id_of(text.rule))) return text.rule;
    }
    return std::nullopt;
}

}  // namespace cdprep::mesh
