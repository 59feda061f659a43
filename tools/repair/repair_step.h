// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/half_edges.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

/// What can be done to mend a mesh, in the order in which it is done.
enum class RepairStep : std::uint8_t {
    drop_bad_numbers,       ///< triangles with a corner that is not finite or out of range
    weld,                   ///< join vertices with equal positions, or within a distance
    stitch_seams,           ///< join boundaries that run beside each other within a width
    drop_repeated_corners,  ///< triangles that repeat a corner
    resolve_t_junctions,    ///< cut boundary edges where a vertex of a boundary lies on them
    drop_duplicates,        ///< triangles that repeat another, with the same winding
    orient,                 ///< wind neighbours the same way
    split_non_manifold,     ///< part edges of more than two triangles, vertices of several fans
    drop_zero_area,         ///< triangles whose corners are exactly collinear
    fill_holes,             ///< close boundary loops with new triangles
    orient_outward,         ///< wind closed components so that their volume is positive
    resolve_self_intersections,  ///< keep what bounds the solid, cut where triangles cross
    drop_components,             ///< components of few triangles
};
inline constexpr std::size_t kRepairStepCount = 13;

/// "fill-holes".
[[nodiscard]] std::string_view name_of(RepairStep step) noexcept;
[[nodiscard]] std::optional<RepairStep> find_repair_step(std::string_view name) noexcept;

/// Where an output vertex or triangle comes from.
struct Origin {
    std::uint32_t source = kNone;    ///< its number in the input, or kNone: new
    std::optional<RepairStep> step;  ///< the last step that made or cut it; none: as it was
    bool operator==(const Origin&) const = default;
};

/// A mesh on its way through the steps.
struct RepairMesh {
    std::vector<Double3> positions;
    std::vector<Triangle> triangles;
    std::vector<Origin> vertex_origin;    ///< one a position
    std::vector<Origin> triangle_origin;  ///< one a triangle
    /// Coordinates are floats; new ones are rounded to floats then.
    bool single_precision = false;
};

enum class DropReason : std::uint8_t {
    out_of_range,
    not_finite,
    repeated_corner,
    duplicate,        ///< `because` is the triangle that stays
    zero_area,        ///< what it covered, its neighbours cover
    inside,           ///< within the solid, or of a sheet that bounds none
    small_component,  ///< of fewer triangles than asked for
};

struct DroppedTriangle {
    std::uint32_t source;  ///< kNone: a triangle that a step had made
    DropReason reason;
    std::uint32_t because = kNone;  ///< a source triangle
};

/// One vertex that became another one.
struct MergedVertex {
    std::uint32_t source;
    std::uint32_t into;  ///< source number
    double distance;     ///< that it moved, model units
};

/// Something that a step would not do, and what stopped it.
struct Refusal {
    std::string sentence;
    std::vector<std::uint32_t> triangles;  ///< source numbers; kNone: made by a step
    std::vector<std::uint32_t> vertices;   ///< source numbers, a loop in its order
    Double3 position{};                    ///< a point of it
    double measure = 0;                    ///< what was too large, as the sentence says
};

/// All that a step changed. Source numbers are those of the input.
struct StepReport {
    explicit StepReport(RepairStep which) : step(which) {}

    RepairStep step;
    std::vector<DroppedTriangle> dropped;
    std::vector<std::uint32_t> reversed;  ///< source triangles now wound the other way
    std::vector<std::uint32_t> cut;       ///< source triangles cut into pieces
    std::vector<MergedVertex> merged;
    std::vector<std::uint32_t> unused;  ///< source vertices left out: no triangle uses them
    std::vector<std::uint32_t> parted;  ///< source vertices that got one more copy each time
    std::uint64_t added_triangles = 0;  ///< without a source
    std::uint64_t added_vertices = 0;   ///< with positions of their own
    double moved = 0;                   ///< no vertex moved farther, model units
    std::vector<Refusal> refused;
    std::string undone;  ///< why all of it was undone; empty: it stands

    [[nodiscard]] bool changed() const noexcept {
        return !dropped.empty() || !reversed.empty() || !cut.empty() || !merged.empty() ||
               !unused.empty() || !parted.empty() || added_triangles + added_vertices != 0;
    }
};

struct Stepped {
    RepairMesh mesh;
    StepReport report;
};

/// Leaves out the triangles that `kept` says false of.
void keep_triangles(RepairMesh& mesh, const std::vector<bool>& kept);

/// Leaves out the vertices that no triangle uses; their source numbers go to `unused`.
void drop_unused_vertices(RepairMesh& mesh, std::vector<std::uint32_t>& unused);

/// Adds a vertex at p, rounded to the stored type, and returns its number.
std::uint32_t add_vertex(RepairMesh& mesh, const Double3& p, RepairStep step);

/// Gives every fan a vertex of its own; the fan of the lowest corner keeps the vertex.
/// Source numbers of vertices that were copied go to `parted`.
void part_fans(RepairMesh& mesh, std::span<const HalfEdge> twins,
               std::vector<std::uint32_t>& parted, RepairStep step);

}  // namespace cdprep::mesh
