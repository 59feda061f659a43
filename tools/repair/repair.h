// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bitset>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "repair/repair_step.h"
#include "crossings/self_intersections.h"
#include "mesh/stop.h"
#include "repair/stored_verdict.h"

namespace cdprep::mesh {

/// Which steps are taken, by their number.
using RepairSteps = std::bitset<kRepairStepCount>;

/// "safe": a 2-manifold, oriented mesh of the same surface; nothing moves, no hole is
/// closed. "closed": and without boundaries. "solid": and without crossings. Nothing for
/// another name.
[[nodiscard]] std::optional<RepairSteps> find_repair_preset(std::string_view name) noexcept;

struct RepairOptions {
    RepairSteps steps;
    double weld_distance = 0;  ///< weld: model units; 0 joins equal positions
    double seam_width = 0;     ///< stitch_seams, resolve_t_junctions: model units; 0: exact
    /// fill_holes: the diagonal of a loop's box is at most this, model units.
    double hole_size = std::numeric_limits<double>::infinity();
    std::uint64_t least_triangles = 0;  ///< drop_components: what stays has as many
    /// resolve_self_intersections: refused, and said so, where it is not done so long after
    /// repair() began. What comes out then depends on the machine.
    double seconds = std::numeric_limits<double>::infinity();
    /// Pairs of triangles that meet: a search for them ends soon after so many, and
    /// resolve_self_intersections is refused.
    std::uint64_t max_pairs = kDefaultMaxPairs;
    StopCheck interrupted = {};  ///< ends repair() soon; what it returns then is of no use
    ParallelFor parallel_for = serial_for;
};

/// What became of the source triangles, each counted once, and what else there is.
struct RepairCounts {
    std::uint64_t source_triangles = 0;
    std::uint64_t kept = 0;      ///< with their winding, whole
    std::uint64_t reversed = 0;  ///< whole
    std::uint64_t cut = 0;       ///< into pieces, of which at least one is there
    std::uint64_t dropped = 0;
    std::uint64_t made = 0;  ///< output triangles without a source
    std::uint64_t source_vertices = 0;
    std::uint64_t merged_vertices = 0;  ///< source vertices that others stand for
    std::uint64_t unused_vertices = 0;  ///< source vertices left out
    std::uint64_t parted_vertices = 0;  ///< output vertices that are copies
    std::uint64_t made_vertices = 0;    ///< output vertices without a source
};

/// How far surfaces are apart: no point of one is farther than `upper` from the other.
struct MovedDistance {
    double lower = 0;  ///< some point is that far
    double upper = 0;  ///< 0: exactly nothing moved
};

struct RepairReport {
    std::vector<StepReport> steps;  ///< those that changed, refused or undid something
    RepairCounts counts;
    /// Of the input, after equal positions were joined and bad triangles left out.
    StoredVerdict before;
    StoredVerdict after;  ///< of the output as it is stored
    MovedDistance input_to_output;
    MovedDistance output_to_input;
    /// Another repair with the same options changes nothing: it was tried.
    bool settled = false;
};

struct Repaired {
    RepairMesh mesh;
    RepairReport report;
};

/// Mends what options.steps name, in the order of RepairStep.
///
/// Nothing is moved, dropped or made that the report does not list; a step that would
/// make the verdict worse (is_worse()) is undone, and says so. What it returns is a fixed
/// point: the steps are taken again, at most a few times, until nothing changes. The same
/// for any parallel_for. A triangle with a corner out of range that the soup does not list is
/// taken for one that an import marked: without drop_bad_numbers it stays, all its corners at
/// vertex 0. Where there is no vertex at all, it is dropped by whatever steps.
[[nodiscard]] Repaired repair(const TriangleSoup& soup, const RepairOptions& options);

}  // namespace cdprep::mesh
