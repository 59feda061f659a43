// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/pipeline.h"

#include <optional>
#include <string>
#include <utility>

#include "bake/baked_arrays.h"
#include "bake/baked_findings.h"
#include "bake/build_structures.h"
#include "bake/stages.h"
#include "mesh/find_bounds.h"
#include "mesh/mass_properties.h"
#include "decompose/surface/piece_arrays.h"
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
#include "bake/provenance.h"
#include "text/verdict_words.h"
#include "write/write_file.h"

namespace cdprep::cli {
namespace {

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
                 const BakeOptions& options, const Threads& threads, Stages& stages) {
    Findings found;
    const bool wants_mass = options.effects.sections.contains(format::SectionId::mass_properties);
    double& tree_s = stages.add("  tree");
    double& topology_s = stages.add("  topology");
    double& bounds_s = stages.add("  bounds");
    double& defects_s = stages.add("  defects");
    threads.run_all({
        Stages::timed(tree_s,
              [&] {
                  found.bvh = build::build_bvh(
                      mesh.positions, mesh.triangles,
                      {.parallel_for = threads.parallel_for(), .bounds = options.bounds});
              }),
        Stages::timed(topology_s,
              [&] {
                  found.topology = mesh::find_topology(mesh);
                  if (wants_mass && found.topology.closed) {
                      found.mass = convex::find_mass_properties(mesh);
                  }
              }),
        Stages::timed(bounds_s, [&] { found.bounds = convex::find_bounds(mesh); }),
        Stages::timed(defects_s,
              [&] {
                  found.defects = find_for_bake(soup, mesh, options.max_pairs,
                                                threads.parallel_for());
              }),
    });
    return found;
}

/// The outcome of a repair, and what the file keeps of it.
struct RepairOutcome {
    std::vector<std::uint32_t> triangle_from;
    std::vector<std::uint32_t> vertex_from;
    std::optional<mesh::RepairReport> report;  ///< none without --repair
    std::string worse;                         ///< how many more triangles cross; empty: none
};

/// Repairs the soup by the preset, if the options name one. Source numbers are then those of the
/// repaired soup.
RepairOutcome repair_soup(mesh::TriangleSoup& soup, const BakeOptions& options, const Threads& threads) {
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

/// The mesh as it is examined, and what was done to it before.
struct Prepared {
    mesh::TriangleSoup soup;
    RepairOutcome repair;
    mesh::Normalization normalization;
    mesh::Welded welded;
};

Result<Prepared> prepare(const std::filesystem::path& input, const BakeOptions& options,
                         const Threads& threads, Stages& stages) {
    auto imported = stages.run("import", [&] {
        import::ImportOptions limits = options.import;
        limits.parallel_for = threads.parallel_for();
        return import::import_file(input, limits);
    });
    if (is_interrupted()) return interrupted(input);
    if (!imported) return imported.error();
    Prepared prepared = {std::move(imported).value(), {}, {}, {}};
    mesh::TriangleSoup& soup = prepared.soup;
    prepared.repair = stages.run("repair", [&] { return repair_soup(soup, options, threads); });
    if (is_interrupted()) return interrupted(input);
    if (const auto error = find_refusal(input, soup)) return *error;

    prepared.normalization = stages.run("normalize", [&] {
        return options.normalize ? mesh::normalize(soup) : mesh::Normalization{};
    });
    if (const auto error = find_wide_weld(input, soup, options.weld_distance)) return *error;
    prepared.welded = stages.run("weld", [&] { return mesh::weld(soup, {options.weld_distance}); });
    if (is_interrupted()) return interrupted(input);
    return prepared;
}

/// Brings the mesh and all that was found of it into tree order.
BakedArrays arrange(Prepared& prepared, Findings& found, const BakeOptions& options,
                    const Threads& threads) {
    mesh::Mesh& mesh = prepared.welded.mesh;
    const RepairOutcome& repair = prepared.repair;
    if (repair.report) {
        for (std::uint32_t& vertex : mesh.source_vertex) vertex = repair.vertex_from[vertex];
    }
    mesh::TreeOrdered ordered = mesh::in_tree_order(mesh, found.bvh.order);
    for (format::Component& component : found.topology.components) {
        component.vertex = ordered.new_vertex[component.vertex];
    }
    std::vector<std::uint64_t> degenerate =
        mesh::find_degenerate(ordered.mesh, threads.parallel_for());
    return {prepared.soup,
            std::move(ordered.mesh),
            std::move(found.bvh),
            std::move(degenerate),
            std::move(found.topology.components),
            found.bounds,
            found.mass,
            {found.defects.defects.verdicts, kept_findings(found.defects, repair.report),
             provenance_json(options, prepared.soup), repair.triangle_from}};
}

/// Adds the structures and pieces that the options choose.
Result<Done> add_structures(const std::filesystem::path& input, const Prepared& prepared,
                            const BakeOptions& options, const Threads& threads, Stages& stages,
                            BakedArrays& arrays, std::optional<report::BakedParts>& parts) {
    const StructureChoice& choice = options.structures;
    if (!choice.names.empty()) {
        Structures built = stages.run("structures", [&] {
            return build_structures(arrays.mesh(), arrays.bvh().frame, choice, threads, stages);
        });
        if (choice.has_hulls()) {
            Result<convex::HullSections> hulls = stages.run("hull", [&] {
                return build_hulls(input, prepared.soup, prepared.welded.mesh, choice.hulls,
                                   threads, parts);
            });
            if (!hulls) return hulls.error();
            built.hulls = std::move(hulls).value();
        }
        arrays.keep(std::move(built));
    }
    if (options.effects.sections.contains(format::SectionId::pieces)) {
        convex::PieceArrays pieces = stages.run("pieces", [&] {
            return build_pieces(arrays.mesh(), options.piece_tolerance, threads);
        });
        convex::PieceTree tree = stages.run("piece tree", [&] {
            return convex::make_piece_tree(arrays.mesh(), pieces, arrays.bvh().frame,
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
    return Done{};
}

/// The facts about the model in the file's header.
format::FileHeader facts_of(const Prepared& prepared, const Findings& found,
                            const BakedArrays& arrays, const BakeOptions& options) {
    const build::Bvh& bvh = arrays.bvh();
    format::FileHeader facts{};
    facts.vertex_count = static_cast<std::uint32_t>(arrays.mesh().positions.size());
    facts.triangle_count = static_cast<std::uint32_t>(arrays.mesh().triangles.size());
    if (found.topology.closed) facts.flags |= format::model_balanced;
    if (bvh.exact_leaves) facts.flags |= format::model_exact_leaves;
    if (options.normalize) facts.flags |= format::model_normalized;
    facts.flags |= format::swept_flags(bvh.swept_kind);
    facts.up_axis = prepared.soup.up_axis;
    facts.metres_per_unit = prepared.soup.metres_per_unit;
    facts.frame_origin = bvh.frame.origin;
    facts.frame_exponent = bvh.frame.exponent;
    facts.normalize_offset = prepared.normalization.offset;
    facts.normalize_factor = prepared.normalization.factor;
    return facts;
}

void report_mesh(const Prepared& prepared, const Findings& found, const BakedArrays& arrays,
                 report::BakeReport& report) {
    report.triangles = arrays.mesh().triangles.size();
    report.vertices = arrays.mesh().positions.size();
    report.components = arrays.component_count();
    report.merged_vertices = prepared.welded.report.merged_vertices;
    report.degenerate_triangles = arrays.degenerate_count();
    report.closed = found.topology.closed;
    report.promises = report::promise_words(found.defects.defects.verdicts[0]);
    report.warnings = count_warnings(found.defects);
    report.crossings_complete = found.defects.defects.crossings_complete;
    report.remarks = found.defects.remarks;
    if (!prepared.repair.worse.empty()) {
        report.remarks.push_back("The repair made crossings: " + prepared.repair.worse + ".");
    }
    report.single_precision = prepared.soup.single_precision;
}

}  // namespace

Result<report::BakeReport> bake(const std::filesystem::path& input,
                                const std::filesystem::path& output, const BakeOptions& options,
                                const Threads& threads,
                                const std::function<void(const char*)>& begins) {
    report::BakeReport report;
    report.input = input.string();
    report.output = output.string();
    Stages stages(begins);
    Result<Prepared> prepared = prepare(input, options, threads, stages);
    if (!prepared) return prepared.error();

    Findings found = stages.run("build", [&] {
        return examine(prepared->soup, prepared->welded.mesh, options, threads, stages);
    });
    if (is_interrupted()) return interrupted(input);
    const bool is_unknown = !found.defects.defects.crossings_complete;
    if (options.strict && (found.defects.exit != 0 || is_unknown)) {
        report.exit = found.defects.exit;
        report.error = input.string() + ": " + strict_refusal(found.defects);
        return report;
    }

    BakedArrays arrays =
        stages.run("arrange", [&] { return arrange(*prepared, found, options, threads); });
    const Result<Done> added =
        add_structures(input, *prepared, options, threads, stages, arrays, report.parts);
    if (!added) return added.error();
    if (is_interrupted()) return interrupted(input);

    format::SectionSet wanted = options.effects.sections;
    wanted.insert(options.structures.sections);
    const Result<Done> written = stages.run("write", [&] {
        return write::write_file(output, facts_of(*prepared, found, arrays, options),
                                 arrays.sections(wanted).sections());
    });
    if (!written) return written.error();

    report_mesh(*prepared, found, arrays, report);
    report.repaired = options.repair;
    if (!options.structures.names.empty()) {
        report.structures = stages.run("describe", [&] {
            return structure_reports(options.structures, arrays.structures(), arrays.mesh());
        });
    }
    if (report.parts && !report.parts->is_as_asked) {
        report.exit = static_cast<int>(Exit::findings);
    }
    report.bytes = std::filesystem::file_size(output);
    report.stages = stages.times();
    report.seconds = stages.total();
    return report;
}

}  // namespace cdprep::cli
