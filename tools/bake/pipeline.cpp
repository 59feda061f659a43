// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/pipeline.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "bake/baked_arrays.h"
#include "bake/baked_findings.h"
#include "cdprep/advanced/build_bvh.h"
#include "mesh/find_bounds.h"
#include "mesh/mass_properties.h"
#include "decompose/surface/piece_arrays.h"
#include "decompose/enclose/enclose.h"
#include "cli/signals.h"
#include "cli/load_mesh.h"
#include "mesh/degenerate.h"
#include "mesh/normalize.h"
#include "repair/repair.h"
#include "repair/repair_goal.h"
#include "repair/repaired_soup.h"
#include "mesh/topology.h"
#include "mesh/tree_order.h"
#include "mesh/weld.h"
#include "decompose/enclose/mesh_nodes.h"
#include "text/bounds_name.h"
#include "hull/hull_report.h"
#include "bake/provenance.h"
#include "text/verdict_words.h"
#include "write/write_file.h"

namespace cdprep::cli {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Names stages, times them, and stops between two when asked to.
class Stages {
public:
    explicit Stages(const std::function<void(const char*)>& begins) : begins_(begins) {}

    template <class Work>
    auto run(const char* name, Work work) {
        begins_(name);
        double& seconds = add(name);
        const Clock::time_point begin = Clock::now();
        auto result = work();
        seconds = seconds_since(begin);
        return result;
    }

    /// Adds a stage; the caller fills in its time.
    double& add(const char* name) {
        return times_.emplace_back(report::StageTime{name, 0}).seconds;
    }

    [[nodiscard]] std::vector<report::StageTime> times() const {
        return {times_.begin(), times_.end()};
    }

private:
    const std::function<void(const char*)>& begins_;
    std::deque<report::StageTime> times_;  ///< a deque: references to its elements stay
};

/// What the stages after welding find, each on its own.
struct Findings {
    build::Bvh bvh;
    mesh::Topology topology;
    format::Bounds bounds{};
    std::optional<format::MassProperties> mass;
    report::ValidationReport defects;
};

/// Runs the stages that need nothing of each other side by side. Their times go
/// to `stages` in a fixed order, whoever ends first.
Findings examine(const mesh::TriangleSoup& soup, const mesh::Mesh& mesh,
                 const std::filesystem::path& input, const BakeOptions& options,
                 const Threads& threads, Stages& stages) {
    Findings found;
    const bool wants_mass = options.effects.sections.contains(format::SectionId::mass_properties);
    double& tree_s = stages.add("  tree");
    double& topology_s = stages.add("  topology");
    double& bounds_s = stages.add("  bounds");
    double& defects_s = stages.add("  defects");
    const auto timed = [](double& seconds, auto work) {
        return [&seconds, work] {
            const Clock::time_point begin = Clock::now();
            work();
            seconds = seconds_since(begin);
        };
    };
    threads.run_all({
        timed(tree_s,
              [&] {
                  found.bvh = build::build_bvh(
                      mesh.positions, mesh.triangles,
                      {.parallel_for = threads.parallel_for(), .bounds = options.bounds});
              }),
        timed(topology_s,
              [&] {
                  found.topology = mesh::find_topology(mesh);
                  if (wants_mass && found.topology.closed) {
                      found.mass = convex::find_mass_properties(mesh);
                  }
              }),
        timed(bounds_s, [&] { found.bounds = convex::find_bounds(mesh); }),
        timed(defects_s,
              [&] {
                  found.defects = find_for_bake(input.string(), soup, mesh, options.max_pairs,
                                                threads.parallel_for());
              }),
    });
    return found;
}

/// The header's facts about the model.
format::FileHeader facts_of(const mesh::TriangleSoup& soup, const mesh::Mesh& mesh,
                            const Findings& found, const mesh::Normalization& normalization,
                            const BakeOptions& options) {
    format::FileHeader facts{};
    facts.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
    facts.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
    if (found.topology.closed) facts.flags |= format::model_balanced;
    if (found.bvh.exact_leaves) facts.flags |= format::model_exact_leaves;
    if (options.normalize) facts.flags |= format::model_normalized;
    facts.flags |= format::swept_flags(found.bvh.swept_kind);
    facts.up_axis = soup.up_axis;
    facts.metres_per_unit = soup.metres_per_unit;
    facts.frame_origin = found.bvh.frame.origin;
    facts.frame_exponent = found.bvh.frame.exponent;
    facts.normalize_offset = normalization.offset;
    facts.normalize_factor = normalization.factor;
    return facts;
}

/// What mending gave, and what the file then keeps of it.
struct Mended {
    std::vector<std::uint32_t> triangle_from;
    std::vector<std::uint32_t> vertex_from;
    std::optional<mesh::RepairReport> report;  ///< nothing: nobody asked
    std::string worse;                         ///< how many more triangles cross; empty: none
};

/// Mends the soup by a preset, unless that is empty. Source numbers are then those of
/// what is left.
Mended mend(mesh::TriangleSoup& soup, const BakeOptions& options, const Threads& threads) {
    const auto steps = mesh::find_repair_preset(options.repair);
    if (!steps) return {};
    mesh::Repaired repaired = mesh::repair(soup, {.steps = *steps,
                                                  .max_pairs = options.max_pairs,
                                                  .interrupted = is_interrupted,
                                                  .parallel_for = threads.parallel_for()});
    const mesh::SearchOptions search = {
        {options.max_pairs, mesh::default_steps(repaired.mesh.triangles.size())},
        is_interrupted,
        threads.parallel_for()};
    const std::string worse =
        mesh::worse_crossing(mesh::find_self_crossing(soup, search),
                             mesh::find_output_crossing(soup, repaired.mesh, search));
    mesh::RepairedSoup as_imported = mesh::as_soup(soup, std::move(repaired.mesh));
    soup = std::move(as_imported.soup);
    return {std::move(as_imported.triangle_from), std::move(as_imported.vertex_from),
            std::move(repaired.report), worse};
}

std::string provenance_of(const BakeOptions& options, const mesh::TriangleSoup& soup) {
    return report::provenance_json(
        {CDPREP_VERSION, options.effects.names, options.normalize, options.weld_distance,
         options.repair, options.piece_tolerance, report::bounds_name(options.bounds),
         settings_of(options.structures), options.structures.has_hulls(),
         options.structures.hulls.max_vertices, options.structures.hulls.parts,
         options.structures.hulls.max_error, options.import.metres_per_unit, options.import.up_axis,
         options.max_pairs, soup.source_hash, soup.other_files});
}

/// Builds what was chosen over a mesh in tree order, whose numbers the structures then
/// speak of. One after the other: each shares its work out, and only one holds scratch.
Structures build_structures(const mesh::Mesh& ordered, const build::Frame& frame,
                            StructureChoice choice, const Threads& threads, Stages& stages) {
    Structures built;
    if (choice.has_octree()) {
        choice.octree.parallel_for = threads.parallel_for();
        if (choice.octree_boxes()) choice.octree.boxes_in = frame;
        built.octree = stages.run("  octree", [&] {
            return build::build_octree(ordered.positions, ordered.triangles, choice.octree);
        });
    }
    if (choice.has_adaptive_octree()) {
        choice.adaptive_octree.parallel_for = threads.parallel_for();
        if (choice.adaptive_octree_boxes()) choice.adaptive_octree.boxes_in = frame;
        built.adaptive_octree = stages.run("  octree-adaptive", [&] {
            return build::build_adaptive_octree(ordered.positions, ordered.triangles,
                                                choice.adaptive_octree);
        });
    }
    if (choice.has_tetra_tree()) {
        choice.tetra_tree.parallel_for = threads.parallel_for();
        choice.tetra_tree.frame_exponent = frame.exponent;
        choice.tetra_tree.frame_origin = frame.origin;
        built.tetra_tree = stages.run("  tetra-tree", [&] {
            return build::build_tetra_tree(ordered.positions, ordered.triangles, choice.tetra_tree);
        });
    }
    return built;
}

/// Hulls, and the parts that enclose the mesh where they were asked for, which are reported.
/// Of the mesh in source order, in which components and instances are numbered.
Result<convex::HullSections> build_hulls(const std::filesystem::path& input,
                                         const mesh::TriangleSoup& soup, const mesh::Mesh& mesh,
                                         const HullChoice& choice, const Threads& threads,
                                         std::optional<report::BakedParts>& parts) {
    auto sections = convex::make_hull_sections(mesh, soup.instances, choice.max_vertices,
                                               threads.parallel_for());
    if (!sections) return report::hull_beyond_range(input.string(), "--hull-vertices");
    if (!choice.has_parts()) return std::move(*sections);
    const MeshNodes nodes = find_nodes(soup, mesh);
    convex::ApproximateOptions how;
    how.max_error = choice.max_error;
    how.parts = choice.parts;
    how.max_vertices = choice.max_vertices;
    how.node_of = nodes.node_of;
    how.convex_node = nodes.is_convex;
    const auto found = search_pieces(mesh, how, threads);
    if (!found) return interrupted(input);
    convex::add_parts(*sections, found->pieces);
    parts = {found->pieces.size(), found->outer_error, found->is_as_asked, found->proof.fragments,
             found->proof.outside};
    return std::move(*sections);
}

/// Of the mesh in tree order, as the structures.
convex::PieceArrays build_pieces(const BakedArrays& arrays, const BakeOptions& options,
                                 const Threads& threads) {
    return convex::make_piece_arrays(
        arrays.mesh(),
        convex::find_surface_pieces(arrays.mesh(), {.tolerance = options.piece_tolerance,
                                                    .parallel_for = threads.parallel_for(),
                                                    .stop = is_interrupted}),
        threads.parallel_for());
}

std::vector<report::StructureReport> reports_of(const StructureChoice& choice,
                                                const Structures& built, const mesh::Mesh& mesh) {
    std::vector<report::StructureReport> reports;
    const std::size_t triangles = mesh.triangles.size();
    if (choice.has_octree()) {
        const OctreeFigures figures = octree_figures(built.octree, triangles);
        reports.push_back(report::report_of(Structure::octree, built.octree.grid, figures,
                                            choice.octree_boxes()));
        if (choice.octree.hashed) {
            reports.push_back(report::report_of(Structure::hashed_octree, built.octree.grid,
                                                figures, choice.octree_boxes()));
        }
    }
    if (choice.has_adaptive_octree()) {
        reports.push_back(report::report_of(
            built.adaptive_octree.tree, adaptive_octree_figures(built.adaptive_octree, triangles),
            choice.adaptive_octree_boxes()));
    }
    if (choice.has_tetra_tree()) {
        reports.push_back(
            report::report_of(built.tetra_tree.tree,
                              tetra_figures(built.tetra_tree, mesh.positions, mesh.triangles)));
    }
    return reports;
}

}  // namespace

Result<report::BakeReport> bake(const std::filesystem::path& input,
                                const std::filesystem::path& output, const BakeOptions& options,
                                const Threads& threads,
                                const std::function<void(const char*)>& begins) {
    const Clock::time_point begin = Clock::now();
    report::BakeReport report;
    report.input = input.string();
    report.output = output.string();
    Stages stages(begins);

    auto imported = stages.run("import", [&] {
        import::ImportOptions limits = options.import;
        limits.parallel_for = threads.parallel_for();
        return import::import_file(input, limits);
    });
    if (is_interrupted()) return interrupted(input);
    if (!imported) return imported.error();
    mesh::TriangleSoup soup = std::move(imported).value();
    const Mended mended = stages.run("repair", [&] { return mend(soup, options, threads); });
    if (is_interrupted()) return interrupted(input);
    if (const auto error = find_refusal(input, soup)) return *error;

    const mesh::Normalization normalization = stages.run("normalize", [&] {
        return options.normalize ? mesh::normalize(soup) : mesh::Normalization{};
    });
    if (const auto error = find_wide_weld(input, soup, options.weld_distance)) return *error;
    mesh::Welded welded =
        stages.run("weld", [&] { return mesh::weld(soup, {options.weld_distance}); });
    if (is_interrupted()) return interrupted(input);

    Findings found = stages.run(
        "build", [&] { return examine(soup, welded.mesh, input, options, threads, stages); });
    if (is_interrupted()) return interrupted(input);
    const bool is_unknown = !found.defects.defects.crossings_complete;
    if (options.strict && (found.defects.exit != 0 || is_unknown)) {
        report.exit = found.defects.exit;
        report.error = strict_refusal(found.defects);
        return report;
    }

    BakedArrays arrays = stages.run("arrange", [&] {
        if (mended.report) {
            for (std::uint32_t& vertex : welded.mesh.source_vertex) {
                vertex = mended.vertex_from[vertex];
            }
        }
        mesh::TreeOrdered ordered = mesh::in_tree_order(welded.mesh, found.bvh.order);
        for (format::Component& component : found.topology.components) {
            component.vertex = ordered.new_vertex[component.vertex];
        }
        std::vector<std::uint64_t> degenerate =
            mesh::find_degenerate(ordered.mesh, threads.parallel_for());
        return BakedArrays{
            soup,
            std::move(ordered.mesh),
            std::move(found.bvh),
            std::move(degenerate),
            std::move(found.topology.components),
            found.bounds,
            found.mass,
            {found.defects.defects.verdicts, kept_findings(found.defects, mended.report),
             provenance_of(options, soup), mended.triangle_from}};
    });
    if (!options.structures.names.empty()) {
        Structures built = stages.run("structures", [&] {
            return build_structures(arrays.mesh(), found.bvh.frame, options.structures, threads,
                                    stages);
        });
        if (options.structures.has_hulls()) {
            Result<convex::HullSections> hulls = stages.run("hull", [&] {
                return build_hulls(input, soup, welded.mesh, options.structures.hulls, threads,
                                   report.parts);
            });
            if (!hulls) return hulls.error();
            built.hulls = std::move(hulls).value();
        }
        arrays.keep(std::move(built));
    }
    if (options.effects.sections.contains(format::SectionId::pieces)) {
        convex::PieceArrays pieces =
            stages.run("pieces", [&] { return build_pieces(arrays, options, threads); });
        convex::PieceTree tree = stages.run("piece tree", [&] {
            return convex::make_piece_tree(arrays.mesh(), pieces, arrays.frame(),
                                           threads.parallel_for());
        });
        arrays.keep(std::move(pieces), std::move(tree));
    }
    if (options.effects.sections.contains(format::SectionId::piece_adjacency)) {
        arrays.keep(stages.run("contacts", [&] {
            return convex::make_contact_arrays(arrays.mesh(), arrays.pieces(),
                                               threads.parallel_for());
        }));
    }
    if (is_interrupted()) return interrupted(input);

    const format::FileHeader facts = facts_of(soup, arrays.mesh(), found, normalization, options);
    format::SectionSet wanted = options.effects.sections;
    wanted.insert(options.structures.sections);
    const Result<Done> written = stages.run("write", [&] {
        return write::write_file(output, facts, arrays.sections(wanted).sections());
    });
    if (!written) return written.error();

    report.triangles = facts.triangle_count;
    report.vertices = facts.vertex_count;
    report.components = arrays.component_count();
    report.merged_vertices = welded.report.merged_vertices;
    report.degenerate_triangles = arrays.degenerate_count();
    report.closed = (facts.flags & format::model_balanced) != 0;
    report.repaired = options.repair;
    report.promises = report::promise_words(found.defects.defects.verdicts[0]);
    report.warnings = count_warnings(found.defects);
    report.crossings_complete = found.defects.defects.crossings_complete;
    report.remarks = found.defects.remarks;
    if (!mended.worse.empty()) {
        report.remarks.push_back("The repair made crossings: " + mended.worse + ".");
    }
    report.single_precision = soup.single_precision;
    if (!options.structures.names.empty()) {
        report.structures = stages.run("describe", [&] {
            return reports_of(options.structures, arrays.structures(), arrays.mesh());
        });
    }
    if (report.parts && !report.parts->is_as_asked) {
        report.exit = static_cast<int>(Exit::findings);
    }
    report.bytes = std::filesystem::file_size(output);
    report.stages = stages.times();
    report.seconds = seconds_since(begin);
    return report;
}

}  // namespace cdprep::cli
