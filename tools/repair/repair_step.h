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

/// The repair steps, in the order in which they run.
enum class RepairStep : std::uint8_t {
    drop_bad_numbers,       ///< triangles with a corner that is not finite or out of range
    weld,                   ///< join vertices with equal positions, or within a distance
    stitch_seams,           ///< join boundaries that run within a width of each other
    drop_repeated_corners,  ///< triangles that repeat a corner
    resolve_t_junctions,    ///< cut boundary edges where a vertex of a boundary lies on them
    drop_duplicates,        ///< triangles that repeat another, with the same winding
    orient,                 ///< wind neighbours the same way
    split_non_manifold,     ///< split edges of more than two triangles, vertices of several fans
    drop_zero_area,         ///< triangles whose corners are exactly collinear
    fill_holes,             ///< close boundary loops with new triangles
    orient_outward,         ///< wind balanced components so that their volume is positive
    resolve_self_intersections,  ///< keep the boundary of the solid, cut where triangles cross
    drop_components,             ///< components of few triangles
};
inline constexpr std::size_t kRepairStepCount = 13;

/// Returns the name of a step, such as "fill-holes".
[[nodiscard]] std::string_view name_of(RepairStep step) noexcept;
[[nodiscard]] std::optional<RepairStep> find_repair_step(std::string_view name) noexcept;

/// The origin of an output vertex or triangle.
struct Origin {
    std::uint32_t source = kNone;    ///< its number in the input, or kNone: new
    std::optional<RepairStep> step;  ///< the last step that made or cut it; none: unchanged
    bool turned = false;             ///< a triangle: its winding is not that of the source
    bool operator==(const Origin&) const = default;
};

/// A mesh between the steps.
struct RepairMesh {
    std::vector<Double3> positions;
    std::vector<Triangle> triangles;
    std::vector<Origin> vertex_origin;    ///< one per position
    std::vector<Origin> triangle_origin;  ///< one per triangle
    /// Coordinates are floats; new ones are then rounded to floats.
    bool single_precision = false;
};

enum class DropReason : std::uint8_t {
    out_of_range,
    not_finite,
    repeated_corner,
    duplicate,        ///< `because` is the triangle that stays
    zero_area,        ///< its neighbours cover the same surface
    inside,           ///< inside the solid, or part of a sheet that bounds none
    small_component,  ///< fewer triangles than requested
};

struct DroppedTriangle {
    std::uint32_t source;  ///< kNone: a step had made the triangle
    DropReason reason;
    std::uint32_t because = kNone;  ///< a source triangle
};

/// One vertex that was merged into another.
struct MergedVertex {
    std::uint32_t source;
    std::uint32_t into;  ///< source number
    double distance;     ///< between the two, in model units
};

/// An action that a step refused, and the reason.
struct Refusal {
    std::string sentence;
    std::vector<std::uint32_t> triangles;  ///< source numbers; kNone: made by a step
    std::vector<std::uint32_t> vertices;   ///< source numbers, a loop in its order
    Double3 position{};                    ///< a point of the place
    double measure = 0;                    ///< the value that was too large; see the sentence
};

/// All changes of a step. Source numbers are those of the input.
struct StepReport {
    explicit StepReport(RepairStep which) : step(which) {}

    RepairStep step;
    std::vector<DroppedTriangle> dropped;
    std::vector<std::uint32_t> reversed;  ///< source triangles with reversed winding
    std::vector<std::uint32_t> cut;       ///< source triangles cut into fragments
    std::vector<MergedVertex> merged;
    std::vector<std::uint32_t> unused;  ///< source vertices left out: no triangle uses them
    std::vector<std::uint32_t> parted;  ///< source vertices; one entry per added copy
    std::uint64_t added_triangles = 0;  ///< without a source
    std::uint64_t added_vertices = 0;   ///< with new positions
    double moved = 0;                   ///< no vertex moved farther, model units
    std::vector<Refusal> refused;
    std::string undone;  ///< why the whole step was undone; empty: not undone

    [[nodiscard]] bool changed() const noexcept {
        return !dropped.empty() || !reversed.empty() || !cut.empty() || !merged.empty() ||
               !unused.empty() || !parted.empty() || added_triangles + added_vertices != 0;
    }
};

struct Stepped {
    RepairMesh mesh;
    StepReport report;
};

/// Reverses the winding of a triangle.
void turn(RepairMesh& mesh, std::uint32_t triangle);

/// Removes the triangles for which `kept` is false.
void keep_triangles(RepairMesh& mesh, const std::vector<bool>& kept);

/// Removes the vertices that no triangle uses, and adds their source numbers to `unused`.
void drop_unused_vertices(RepairMesh& mesh, std::vector<std::uint32_t>& unused);

/// Adds a vertex at p, rounded to the stored type, and returns its number.
std::uint32_t add_vertex(RepairMesh& mesh, const Double3& p, RepairStep step);

/// Gives every fan its own vertex; the fan of the lowest corner keeps the vertex. Adds the
/// source numbers of copied vertices to `parted`.
void part_fans(RepairMesh& mesh, std::span<const HalfEdge> twins,
               std::vector<std::uint32_t>& parted, RepairStep step);

}  // namespace cdprep::mesh
