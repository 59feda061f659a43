// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "crossings/self_intersections.h"
#include "mesh/stop.h"
#include "repair/repair_step.h"
#include "repair/stored_verdict.h"

namespace cdprep::mesh {

/// The set of steps to run, by their number.
using RepairSteps = std::bitset<kRepairStepCount>;

/// The names of presets.
inline constexpr const char* kSafePreset = "safe";
inline constexpr const char* kClosedPreset = "closed";
inline constexpr const char* kSolidPreset = "solid";
inline constexpr std::array kRepairPresets = {kSafePreset, kClosedPreset, kSolidPreset};

/// Returns the steps of a preset; nothing for another name. The goal of "safe" is a 2-manifold,
/// oriented mesh of the same surface; nothing moves and no hole is closed. For "closed" the mesh
/// also has no boundaries; for "solid" it also has no crossings.
[[nodiscard]] std::optional<RepairSteps> find_repair_preset(std::string_view name) noexcept;

struct RepairOptions {
    RepairSteps steps;
    double weld_distance = 0;  ///< weld: model units; 0 joins equal positions
    double seam_width = 0;     ///< stitch_seams, resolve_t_junctions: model units; 0: exact
    /// fill_holes: limit on the diagonal of a loop's box, in model units.
    double hole_size = std::numeric_limits<double>::infinity();
    std::uint64_t least_triangles = 0;  ///< drop_components: keeps those with as many
    /// resolve_self_intersections: limit on the time since repair() began. A step that takes
    /// longer is refused, with a report. The result then depends on the machine.
    double seconds = std::numeric_limits<double>::infinity();
    /// The limit on pairs of triangles that meet. A search for them ends soon after it, and
    /// resolve_self_intersections is refused.
    std::uint64_t max_pairs = kDefaultMaxPairs;
    StopCheck interrupted = {};  ///< ends repair() soon; its result is then useless
    ParallelFor parallel_for = serial_for;
};

/// The counts of source triangles, each counted once, and of other triangles and vertices.
struct RepairCounts {
    std::uint64_t source_triangles = 0;
    std::uint64_t kept = 0;      ///< whole, with their winding
    std::uint64_t reversed = 0;  ///< whole
    std::uint64_t cut = 0;       ///< into fragments, at least one of them present
    std::uint64_t dropped = 0;
    std::uint64_t made = 0;  ///< output triangles without a source
    std::uint64_t source_vertices = 0;
    std::uint64_t merged_vertices = 0;  ///< source vertices represented by others
    std::uint64_t unused_vertices = 0;  ///< source vertices left out
    std::uint64_t parted_vertices = 0;  ///< output vertices that are copies
    std::uint64_t made_vertices = 0;    ///< output vertices without a source
};

/// Bounds on a distance between surfaces: no point of one is farther than `upper` from the
/// other.
struct MovedDistance {
    double lower = 0;  ///< some point is at least that far
    double upper = 0;  ///< 0: exactly nothing moved
};

struct RepairReport {
    std::vector<StepReport> steps;  ///< the steps that changed, refused or undid something
    RepairCounts counts;
    /// The verdict on the input, after equal positions were joined and bad triangles left out.
    StoredVerdict before;
    StoredVerdict after;  ///< the verdict on the output as stored
    MovedDistance input_to_output;
    MovedDistance output_to_input;
    /// Another repair with the same options changes nothing; this was tested.
    bool settled = false;
};

struct Repaired {
    RepairMesh mesh;
    RepairReport report;
};

/// Repairs a mesh by the steps of asked.steps, in the order of RepairStep.
///
/// The report lists everything that is moved, dropped or made. A step that would make the
/// verdict worse (is_worse()) is undone, and the report states this. The result is a fixed
/// point: the steps repeat, at most a few times, until nothing changes. The result is the same
/// for any parallel_for.
///
/// A triangle may have a corner out of range that the soup does not list. It is treated like one
/// that an import marked. Without drop_bad_numbers it remains, with all corners at vertex 0. If
/// there are no vertices, all triangles are dropped, whatever the steps. If a position is not
/// finite, drop_bad_numbers runs, whatever the steps.
[[nodiscard]] Repaired repair(const TriangleSoup& soup, const RepairOptions& asked);

}  // namespace cdprep::mesh
