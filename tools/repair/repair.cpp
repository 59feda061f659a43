// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/repair.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "mesh/vectors.h"
#include "repair/mesh_meetings.h"
#include "repair/moved_distance.h"
#include "repair/repair_steps.h"

namespace cdprep::mesh {
namespace {

constexpr int kMostRounds = 6;

RepairSteps steps_of(std::initializer_list<RepairStep> steps) {
    RepairSteps set;
    for (const RepairStep step : steps) set.set(static_cast<std::size_t>(step));
    return set;
}

RepairMesh as_repair_mesh(const TriangleSoup& soup) {
    RepairMesh mesh;
    mesh.positions = soup.positions;
    mesh.triangles = soup.triangles;
    mesh.single_precision = soup.single_precision;
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.vertex_origin.push_back({i, std::nullopt});
    }
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        mesh.triangle_origin.push_back({i, std::nullopt});
    }
    return mesh;
}

/// Returns the soup as an import would: `out_of_range` lists triangles with a corner out of range,
/// and their corners are at vertex 0. Returns nothing if there are no such corners.
std::optional<TriangleSoup> marked(const TriangleSoup& soup) {
    const std::size_t limit = soup.positions.size();
    std::optional<TriangleSoup> result;
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
        const auto& corners = soup.triangles[t].vertex;
        const auto* const bad =
            std::find_if(corners.begin(), corners.end(),
                         [limit](std::uint32_t vertex) { return vertex >= limit; });
        if (bad == corners.end()) continue;
        if (!result) result = soup;
        result->out_of_range.push_back({t, *bad});
        result->triangles[t] = {{0, 0, 0}};
    }
    if (result) std::ranges::sort(result->out_of_range, {}, &OutOfRange::triangle);
    return result;
}

/// Returns the options, with drop_bad_numbers if a position is not finite: no other step accepts
/// one.
RepairOptions with_finite_steps(const TriangleSoup& soup, RepairOptions options) {
    if (!std::all_of(soup.positions.begin(), soup.positions.end(), is_finite)) {
        options.steps.set(static_cast<std::size_t>(RepairStep::drop_bad_numbers));
    }
    return options;
}

StoredVerdict verdict_of(const RepairMesh& mesh) {
    return find_stored_verdict(mesh.positions, mesh.triangles);
}

SearchOptions search_of(const RepairOptions& options, const StopCheck& stop) {
    return {{options.max_pairs, SearchLimits::kNone}, stop, options.parallel_for};
}

/// Runs steps, and undoes those that make the verdict worse.
class Repair {
public:
    /// `stop` ends resolve_self_intersections().
    Repair(const TriangleSoup& soup, const RepairOptions& options, const StopCheck& stop)
        : options_(options), stop_(stop), bad_(soup.out_of_range), mesh_(as_repair_mesh(soup)) {
        // The first verdict is on the mesh as find_defects() sees it.
        joined_ = weld_vertices(drop_bad_numbers(mesh_, bad_).mesh, 0).mesh;
        before_ = verdict_of(joined_);
    }

    /// Runs each step once.
    void run_round() {
        reports_.clear();
        take(RepairStep::drop_bad_numbers,
             [&](RepairMesh mesh) { return drop_bad_numbers(std::move(mesh), bad_); });
        take(RepairStep::weld, [&](RepairMesh mesh) {
            if (!joining_equal_positions_gains()) return drop_unused(std::move(mesh));
            return weld_vertices(std::move(mesh), 0);
        });
        if (options_.weld_distance > 0) {
            take(
                RepairStep::weld,
                [&](RepairMesh mesh) {
                    return weld_vertices(std::move(mesh), options_.weld_distance);
                },
                known_[kRepairStepCount]);
        }
        if (options_.seam_width > 0) {
            take(RepairStep::stitch_seams, [&](RepairMesh mesh) {
                return stitch_seams(std::move(mesh), options_.seam_width);
            });
        }
        take(RepairStep::drop_repeated_corners, drop_repeated_corners);
        take(RepairStep::resolve_t_junctions, [&](RepairMesh mesh) {
            return resolve_t_junctions(std::move(mesh), options_.seam_width);
        });
        take(RepairStep::drop_duplicates, drop_duplicates);
        take(RepairStep::orient, orient);
        take(RepairStep::drop_duplicates, drop_duplicates);
        take(RepairStep::split_non_manifold, split_non_manifold);
        take(RepairStep::drop_zero_area, drop_zero_area);
        if (is_manifold()) {
            take(RepairStep::fill_holes, [&](RepairMesh mesh) {
                return fill_holes(std::move(mesh),
                                  {options_.hole_size, asked(RepairStep::resolve_self_intersections)
                                                           ? Crossing::resolved_later
                                                           : Crossing::refused},
                                  search_of(options_, options_.interrupted));
            });
            take(RepairStep::drop_zero_area, drop_zero_area);
        }
        take(RepairStep::orient_outward, orient_outward);
        if (is_manifold()) {
            take(RepairStep::resolve_self_intersections, [&](RepairMesh mesh) {
                return resolve_self_intersections(std::move(mesh),
                                                  search_of(options_, options_.interrupted), stop_);
            });
        }
        take(RepairStep::drop_components, [&](RepairMesh mesh) {
            return drop_components(std::move(mesh), options_.least_triangles);
        });
    }

    [[nodiscard]] const RepairMesh& mesh() const {
        return mesh_;
    }
    [[nodiscard]] const StoredVerdict& before() const {
        return before_;
    }
    [[nodiscard]] const StoredVerdict& after() {
        return verdict();
    }
    /// Returns a number that differs for every mesh that the steps produced.
    [[nodiscard]] std::uint64_t revision() const {
        return revision_;
    }
    [[nodiscard]] const std::vector<StepReport>& reports() const {
        return reports_;
    }

private:
    /// Returns whether joining equal positions improves the mesh. False if the stored mesh is
    /// 2-manifold and oriented, and joining gives no boundary edge a partner. Copies of a vertex
    /// were then made on purpose.
    [[nodiscard]] bool joining_equal_positions_gains() {
        const StoredVerdict& stored = verdict();
        constexpr std::uint32_t kBoth = format::verdict_two_manifold | format::verdict_oriented;
        if ((stored.verdict.facts & kBoth) != kBoth) return true;
        const RepairMesh joined = weld_vertices(mesh_, 0).mesh;
        return count_unpaired_uses(joined.positions, joined.triangles) < stored.boundary_edges;
    }

    [[nodiscard]] bool is_manifold() {
        constexpr std::uint32_t kBoth = format::verdict_two_manifold | format::verdict_oriented;
        return (verdict().verdict.facts & kBoth) == kBoth;
    }

    [[nodiscard]] bool asked(RepairStep step) const {
        return options_.steps.test(static_cast<std::size_t>(step));
    }

    /// The report of a step on a mesh that it did not change.
    struct Known {
        std::uint64_t revision = std::numeric_limits<std::uint64_t>::max();
        StepReport report{RepairStep::drop_bad_numbers};
    };

    template <class Step>
    void take(RepairStep name, Step step) {
        take(name, step, known_[static_cast<std::size_t>(name)]);
    }
    template <class Step>
    void take(RepairStep name, Step step, Known& known) {
        if (!asked(name) || is_stopped(options_.interrupted)) return;
        if (known.revision != revision_) {
            Stepped stepped = step(mesh_);
            // Joining equal positions may worsen the verdict: before_ already describes the
            // joined mesh.
            const bool may = name <= RepairStep::weld && stepped.report.moved == 0;
            known.report = std::move(stepped.report);
            const bool taken =
                known.report.changed() && accept(std::move(stepped.mesh), may, known.report);
            if (!taken) known.revision = revision_;
        }
        if (known.report.changed() || !known.report.refused.empty()) {
            reports_.push_back(known.report);
        }
    }

    /// Adopts the mesh; or marks the step as undone and returns false.
    bool accept(RepairMesh mesh, bool may_be_worse, StepReport& report) {
        std::optional<StoredVerdict> found;
        if (!may_be_worse) {
            found = verdict_of(mesh);
            if (is_worse(*found, verdict())) {
                report.undone = "the verdict would be worse";
                return false;
            }
        }
        mesh_ = std::move(mesh);
        verdict_ = found;
        ++revision_;
        return true;
    }

    [[nodiscard]] const StoredVerdict& verdict() {
        if (!verdict_) {
            const bool is_joined =
                mesh_.positions == joined_.positions && mesh_.triangles == joined_.triangles;
            verdict_ = is_joined ? before_ : verdict_of(mesh_);
        }
        return *verdict_;
    }

    const RepairOptions& options_;
    const StopCheck& stop_;
    const std::vector<OutOfRange>& bad_;
    RepairMesh mesh_;
    std::uint64_t revision_ = 0;
    /// By step; the last is for weld() within a distance.
    std::array<Known, kRepairStepCount + 1> known_;
    RepairMesh joined_;                     ///< the input, finite, with equal positions joined
    StoredVerdict before_;                  ///< the verdict on joined_
    std::optional<StoredVerdict> verdict_;  ///< the verdict on mesh_
    std::vector<StepReport> reports_;
};

/// Drops all triangles of a soup without vertices. No import returns such a soup.
Repaired without_vertices(const TriangleSoup& soup) {
    Repaired empty;
    StepReport step(RepairStep::drop_bad_numbers);
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
        step.dropped.push_back({t, DropReason::out_of_range});
    }
    empty.mesh.single_precision = soup.single_precision;
    empty.report.counts.source_triangles = empty.report.counts.dropped = step.dropped.size();
    empty.report.steps.push_back(std::move(step));
    empty.report.before = empty.report.after = verdict_of(empty.mesh);
    empty.report.settled = true;
    return empty;
}

/// Returns for each source vertex whether a step joined it to another.
std::vector<bool> find_merged(const TriangleSoup& soup, const std::vector<StepReport>& steps) {
    std::vector<bool> merged(soup.positions.size(), false);
    for (const StepReport& step : steps) {
        if (!step.undone.empty()) continue;
        for (const MergedVertex& vertex : step.merged) {
            if (vertex.source != kNone) merged[vertex.source] = true;
        }
    }
    return merged;
}

RepairCounts count(const TriangleSoup& soup, const RepairMesh& mesh,
                   const std::vector<StepReport>& steps) {
    RepairCounts counts;
    counts.source_triangles = soup.triangles.size();
    counts.source_vertices = soup.positions.size();
    std::vector<std::uint32_t> fragments(soup.triangles.size(), 0);
    std::vector<bool> whole(soup.triangles.size(), false), reversed(soup.triangles.size(), false);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::uint32_t source = mesh.triangle_origin[t].source;
        if (source == kNone) {
            ++counts.made;
            continue;
        }
        ++fragments[source];
        if (mesh.triangle_origin[t].step) continue;
        whole[source] = true;
        reversed[source] = mesh.triangle_origin[t].turned;
    }
    for (std::size_t source = 0; source < fragments.size(); ++source) {
        if (fragments[source] == 0) {
            ++counts.dropped;
        } else if (!whole[source]) {
            ++counts.cut;
        } else if (reversed[source]) {
            ++counts.reversed;
        } else {
            ++counts.kept;
        }
    }
    const std::vector<bool> merged = find_merged(soup, steps);
    std::vector<bool> stands(soup.positions.size(), false);
    for (const Origin& origin : mesh.vertex_origin) {
        if (origin.source == kNone) {
            ++counts.made_vertices;
        } else if (stands[origin.source]) {
            ++counts.parted_vertices;
        } else {
            stands[origin.source] = true;
        }
    }
    for (std::size_t i = 0; i < stands.size(); ++i) {
        if (stands[i]) continue;
        ++(merged[i] ? counts.merged_vertices : counts.unused_vertices);
    }
    return counts;
}

Repaired repair_once(const TriangleSoup& soup, const RepairOptions& options,
                     const StopCheck& stop) {
    Repair work(soup, options, stop);
    RepairReport report;
    report.before = work.before();
    for (int round = 0; round < kMostRounds && !report.settled; ++round) {
        const auto positions = work.mesh().positions;
        const auto triangles = work.mesh().triangles;
        const std::uint64_t revision = work.revision();
        work.run_round();
        report.settled = revision == work.revision() ||
                         (positions == work.mesh().positions && triangles == work.mesh().triangles);
        for (const StepReport& step : work.reports()) {
            // A round without changes still reports its refusals; the rounds before it already
            // did.
            if (report.settled && round > 0) continue;
            report.steps.push_back(step);
        }
    }
    if (is_stopped(options.interrupted)) return {work.mesh(), std::move(report)};
    report.after = work.after();
    report.counts = count(soup, work.mesh(), report.steps);
    const MovedDistances moved = find_moved_distances(soup, work.mesh());
    report.input_to_output = moved.input_to_output;
    report.output_to_input = moved.output_to_input;
    return {work.mesh(), std::move(report)};
}

}  // namespace

std::optional<RepairSteps> find_repair_preset(std::string_view name) noexcept {
    RepairSteps steps =
        steps_of({RepairStep::drop_bad_numbers, RepairStep::weld, RepairStep::drop_repeated_corners,
                  RepairStep::drop_duplicates, RepairStep::drop_zero_area, RepairStep::orient,
                  RepairStep::split_non_manifold, RepairStep::orient_outward});
    if (name == kSafePreset) return steps;
    steps |= steps_of(
        {RepairStep::stitch_seams, RepairStep::resolve_t_junctions, RepairStep::fill_holes});
    if (name == kClosedPreset) return steps;
    steps |= steps_of({RepairStep::resolve_self_intersections});
    if (name == kSolidPreset) return steps;
    return std::nullopt;
}

Repaired repair(const TriangleSoup& bare, const RepairOptions& asked) {
    if (bare.positions.empty() && !bare.triangles.empty()) return without_vertices(bare);
    const std::optional<TriangleSoup> other = marked(bare);
    const TriangleSoup& soup = other ? *other : bare;
    const RepairOptions options = with_finite_steps(soup, asked);
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    const StopCheck stop = [&] {
        return is_stopped(options.interrupted) ||
               std::chrono::duration<double>(Clock::now() - begin).count() >= options.seconds;
    };
    Repaired mended = repair_once(soup, options, stop);
    constexpr auto kResolve = static_cast<std::size_t>(RepairStep::resolve_self_intersections);
    if (!options.steps.test(kResolve) || is_stopped(options.interrupted)) return mended;
    // Patches could cross because that was to be resolved. If resolving was refused, none may
    // cross.
    const SearchOptions search = search_of(options, options.interrupted);
    if (!has_meetings(mended.mesh, search)) return mended;
    const RepairMesh finite = drop_bad_numbers(as_repair_mesh(soup), soup.out_of_range).mesh;
    if (has_meetings(finite, search)) return mended;
    RepairOptions without = options;
    without.steps.reset(kResolve);
    Repaired again = repair_once(soup, without, stop);
    for (StepReport& step : mended.report.steps) {
        if (step.step != RepairStep::resolve_self_intersections) continue;
        step.undone = "it could not remove the crossings of patches, so their holes stay open";
        again.report.steps.push_back(std::move(step));
    }
    return again;
}

}  // namespace cdprep::mesh
