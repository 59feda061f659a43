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
             "Triangles that use it are left out of all other rules.",
             "No box, distance or crossing is defined for such a vertex; bake refuses the file.",
             "Correct the vertex at its source, or delete it and its triangles. The exporter "
             "divided by zero or applied a broken transform.",
             kExact, ""},
    RuleText{Rule::index_out_of_range, "index-out-of-range", Severity::error,
             "Triangle uses a vertex that does not exist",
             "A triangle with a corner whose number is not that of a vertex of the file. It is "
             "left out of all other rules.",
             "The triangle has no place in space; bake refuses the file.",
             "Export the file again: it was cut short, or its indices count from another number.",
             kExact, "the vertex number as the file has it"},
    RuleText{Rule::extent_beyond_float, "extent-beyond-float", Severity::warning,
             "Extent is beyond the largest float",
             "A vertex that triangles use with a coordinate larger in size than the largest float "
             "(3.4028235e38), or an axis along which the box of all such vertices is longer than "
             "that though none of them is beyond. Beyond 2^1000 bake refuses the mesh.",
             "Programs that hold positions or extents as floats read infinity. Answers of this "
             "library stay right up to 2^1000.",
             "Scale the model, or remove the stray vertex that makes it so large.", kExact,
             "the coordinate or the extent, in model units"},
    RuleText{Rule::unreferenced_vertex, "unreferenced-vertex", Severity::note, "Vertex is not used",
             "A vertex of the file that no triangle uses as a corner.",
             "None for collision: baking leaves it out. It can make a box taken from the file too "
             "large.",
             "Nothing needs mending; repair's weld leaves it out.", kExact, ""},
    RuleText{Rule::duplicate_vertex, "duplicate-vertex", Severity::note,
             "Vertices have equal positions",
             "A vertex of the file, used or not, whose three coordinates equal those of one with "
             "a lower number (-0 equals 0). It is joined to that one for all rules from "
             "CDP0201 on.",
             "None for collision: baking joins them. By index alone the mesh falls apart into "
             "more pieces than its surface has.",
             "Nothing needs mending; weld joins them.", kExact, ""},
    RuleText{
        Rule::near_vertex, "near-vertex", Severity::warning, "Vertices nearly have equal positions",
        "A vertex that welding at the given distance would join to one with a lower number, "
        "and that does not have its position. Looked for only when a weld distance is given.",
        "Triangles that should share a vertex do not: the surface has cracks, and nothing "
        "can be said to be inside.",
        "Weld with that distance.", "by distances in double, rounded, as weld does; chains join",
        "the distance to the vertex it would be joined to, in model units"},
    RuleText{Rule::empty_mesh, "empty-mesh", Severity::warning, "Mesh has no triangles",
             "No triangle is left to ask: the file has none, or all of them are left out by "
             "CDP0101, CDP0102 and CDP0201.",
             "Nothing is hit, nothing is inside, and nothing else can be found wrong: a model that "
             "was lost on the way looks flawless.",
             "Export the file again, with its faces: only points or lines came, or they were cut "
             "off.",
             kExact, ""},
    RuleText{Rule::repeated_corner, "repeated-corner", Severity::warning,
             "Triangle repeats a corner",
             "A triangle with two corners that are one vertex, or have equal positions. The "
             "rules after this one leave it out.",
             "It is a segment or a point: it can touch things, but bounds nothing.",
             "Drop degenerate triangles.", kExact, ""},
    RuleText{Rule::zero_area, "zero-area", Severity::warning, "Triangle has no area",
             "A triangle with three different corners that lie on one line.",
             "It is a segment: it has no normal, crosses nothing, and usually hides a "
             "T-junction.",
             "Drop zero-area triangles, then resolve T-junctions.", kExact,
             "its longest edge, in model units"},
    RuleText{Rule::sliver, "sliver", Severity::note, "Triangle is a sliver",
             "A triangle whose area is less than the sliver ratio (1e-10 unless said otherwise) "
             "times the square of its longest edge, and not zero.",
             "Answers stay exact. Normals and contact points computed from it in floating point "
             "are unreliable.",
             "Flip or collapse its longest edge in the modelling program, or weld.",
             "area and ratio in double; a triangle whose ratio lies within rounding of the limit "
             "may be missed or reported",
             "its area by the square of its longest edge"},
    RuleText{Rule::duplicate_triangle, "duplicate-triangle", Severity::warning,
             "Triangle occurs twice",
             "A triangle with the same three corners as one with a lower number, in the same "
             "winding as the lowest such.",
             "Every contact is reported twice, the edges are non-manifold, and the winding "
             "number inside is 2.",
             "Drop duplicate triangles.", kExact, ""},
    RuleText{Rule::opposite_triangle, "opposite-triangle", Severity::warning,
             "Triangle occurs with both windings",
             "A triangle with the same three corners as one with a lower number, in the winding "
             "opposite to the lowest such.",
             "The two together enclose nothing: a two-sided sheet has no inside, and every "
             "contact is reported twice.",
             "Drop duplicate triangles when the sheet was meant to be one-sided.", kExact, ""},
    RuleText{Rule::boundary_edge, "boundary-edge", Severity::warning, "Edge has one triangle",
             "An edge that exactly one triangle uses.",
             "The surface is open there: inside is not defined, and only questions about the "
             "surface are exact.",
             "Weld, stitch seams, resolve T-junctions, or fill the hole.", kExact,
             "its length, in model units"},
    RuleText{Rule::boundary_loop, "boundary-loop", Severity::warning, "Surface has a hole",
             "A connected set of boundary edges (CDP0301). Loops that share a vertex are one. "
             "The vertices of the place run along it, as many as it has edges, the first 1000 at "
             "most.",
             "A hole, a crack or the rim of a sheet: inside is not defined.",
             "Fill holes up to its size, or stitch it when it is a crack.", kExact,
             "the size of the hole: the diagonal of the box around it, in model units"},
    RuleText{Rule::non_manifold_edge, "non-manifold-edge", Severity::warning,
             "Edge has more than two triangles", "An edge that more than two triangles use.",
             "Questions about the surface stay exact. Which triangle is the neighbour is not "
             "defined: convex pieces end there, and inside is defined only when the windings "
             "cancel.",
             "Drop duplicate triangles; then split non-manifold edges.", kExact,
             "how many triangles use it"},
    RuleText{Rule::non_manifold_vertex, "non-manifold-vertex", Severity::warning,
             "Vertex has several fans",
             "A vertex whose triangles are not all connected to one another across the edges "
             "that end at it.",
             "The surface is pinched to a point there: walks from triangle to triangle do not "
             "pass.",
             "Split non-manifold vertices.", kExact, "how many fans it has"},
    RuleText{Rule::inconsistent_winding, "inconsistent-winding", Severity::warning,
             "Neighbours are wound differently",
             "An edge that exactly two triangles use, both running through it in the same "
             "direction.",
             "One of them shows its back: winding numbers, volumes and normals are wrong.",
             "Orient consistently.", kExact, "its length, in model units"},
    RuleText{Rule::non_orientable, "non-orientable", Severity::warning,
             "Component cannot be oriented",
             "A component for which no choice of windings makes all edges of exactly two "
             "triangles run through in both directions, as on a Moebius strip.",
             "It has one side only: nothing is inside.",
             "Cut it, or split the edges where it was glued wrongly. Orienting stops there.",
             kExact, ""},
    RuleText{Rule::t_junction, "t-junction", Severity::warning, "Vertex lies within an edge",
             "A boundary edge (CDP0301) and an end of another that lies on it, between its ends. "
             "One that rounding has moved off the edge is a near seam (CDP0308).",
             "The neighbours beyond do not share their edge: a crack of no width that makes the "
             "mesh open.",
             "Resolve T-junctions.", kExact, "where on the edge, from 0 at its first end to 1"},
    RuleText{Rule::near_seam, "near-seam", Severity::warning, "Seam has a gap",
             "An end of a boundary edge that is at most the seam width from another boundary edge, "
             "not on it and no corner of its triangle: an edge of another loop (CDP0302), or of "
             "the same loop and more than four widths away along it. The nearest such edge is "
             "named. Looked for only when a seam width is given.",
             "Small things fall through the gap, and the mesh is open.",
             "Stitch seams with that width, or weld with a distance.",
             "by distances in double, rounded; strips of surface narrower than the width are "
             "reported like gaps",
             "the width of the gap, in model units"},
    RuleText{Rule::inverted_component, "inverted-component", Severity::warning,
             "Component is inside out",
             "A component of which every edge is run through as often in one direction as in the "
             "other, and of negative volume. Right for the wall of a cavity.",
             "Its winding number is -1 inside. Solid questions still count that as inside; "
             "normals point the wrong way.",
             "Orient outward.",
             "exact: where the sum of volumes in double is not clear of its error, all is added "
             "up in integers",
             "its volume, in cubic model units"},
    RuleText{Rule::nested_component, "nested-component", Severity::note,
             "Component lies in another",
             "A component and another, both with a defined inside (every edge is run through as "
             "often in one direction as in the other), of which the first vertex of the one that "
             "is not on the other's surface has a winding number other than 0 around it, and, "
             "where crossings are examined, whose triangles do not cross. Each such pair.",
             "The wall of a cavity, if it is wound inwards; else the winding number is 2 inside, "
             "and contacts within a solid are reported.",
             "Orient it inward for a cavity; delete it when it is hidden.", "exact",
             "the winding number of the other around it"},
    RuleText{Rule::overlapping_components, "overlapping-components", Severity::warning,
             "Components run through each other",
             "Two components with triangles that cross or share area in a plane (CDP0501, "
             "CDP0503). Looked for when crossings are.",
             "Volume and inertia count the common part twice.",
             "Remove self-intersections, or bake the parts as models of their own.", kExact,
             "how many pairs of triangles"},
    RuleText{Rule::several_components, "several-components", Severity::note,
             "Mesh has several components",
             "More than one set of triangles connected by shared vertices. The count is that of "
             "all components; each place is one, by its lowest triangle.",
             "None by itself; parts of an assembly are often meant to be models of their own.",
             "Nothing needs mending. Tiny ones can be dropped when told to.", kExact,
             "how many triangles it has"},
    RuleText{
        Rule::crossing_triangles, "crossing-triangles", Severity::warning, "Triangles cross",
        "Two triangles without a common vertex, an edge of one of which runs through the inside of "
        "the other; or with exactly one common vertex, not in one plane, that meet elsewhere too.",
        "The surface is not that of a solid: winding numbers other than 0 and 1, and a volume that "
        "counts parts twice.",
        "Remove self-intersections.", kExact, ""},
    RuleText{Rule::touching_triangles, "touching-triangles", Severity::note, "Triangles touch",
             "Two triangles without a common vertex, not in one plane, that have a common point "
             "where no edge of one runs through the inside of the other.",
             "Often the far side of a T-junction; else parts in contact.",
             "Resolve T-junctions; parts in contact need nothing.", kExact, ""},
    RuleText{Rule::coplanar_overlap, "coplanar-overlap", Severity::warning,
             "Triangles overlap in a plane",
             "Two triangles in one plane, not with the same three corners, that share area. They "
             "may share a vertex, or an edge onto which one is folded.",
             "Which of them is on the outside is not defined; contacts are reported twice.",
             "Remove self-intersections, or delete one of them.", kExact,
             "how many vertices they share"},
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
