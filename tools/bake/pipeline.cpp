// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/pipeline.h"

#include <optional>
#include <string>
#include <utility>

#include "bake/baked_arrays.h"
#include "bake/baked_findings.h"
#include "bake/build_structures.h"
#include "bake/provenance.h"
#include "bake/stages.h"
#include "cdprep/advanced/build_image.h"
#include "cli/load_mesh.h"
#include "cli/signals.h"
#include "mesh/degenerate.h"
#include "mesh/find_bounds.h"
#include "mesh/mass_properties.h"
#include "mesh/normalize.h"
#include "mesh/topology.h"
#include "mesh/tree_order.h"
#include "mesh/weld.h"
#include "repair/repair.h"
#include "repair/repair_goal.h"
#include "repair/repaired_soup.h"
#include "text/verdict_words.h"
#include "write/write_file.h"

namespace cdprep::cli {
namespace {

/// The outcome of a repair, and what the file keeps of it.
struct RepairOutcome {
    std::vector<std::uint32_t> triangle_from;
    std::vector<std::uint32_t> vertex_from;
    std::optional<mesh::RepairReport> report;  ///< none without --repair
    std::string worse;                         ///< new crossing triangles, in words; empty: none
};

/// The results of the stages that examine the mesh.
struct Findings {
    build::Bvh bvh;
    mesh::Topology topology;
    format::Bounds bounds{};
    std::optional<format::MassProperties> mass;
    report::ValidationReport defects;
};

/// One bake. Each stage leaves its result in a member for the stages after it.
class Baking {
public:
    Baking(const std::filesystem::path& input, const std::filesystem::path& output,
           const BakeOptions& options, const Threads& threads,
           const std::function<void(const char*)>& begins)
        : input_(input), output_(output), options_(options), threads_(threads), stages_(begins) {}

    Result<report::BakeReport> run() {
        if (const auto error = find_arrays()) return *error;
        if (!arrays_) return refusal();
        if (const auto error = write()) return *error;
        return describe();
    }

    Result<BakedImage> run_in_memory() {
        if (const auto error = find_arrays()) return *error;
        if (!arrays_) return Error{ErrorCode::unreadable, *refusal().error};
        return stages_.run("image", [&] { return make_image(); });
    }

private:
    /// Runs all stages before the output. With --strict, there are no arrays if the mesh is
    /// refused.
    std::optional<Error> find_arrays() {
        if (const auto error = prepare()) return *error;
        stages_.run("build", [&] { return examine(), Done{}; });
        if (is_interrupted()) return interrupted(input_);
        if (is_refused()) return std::nullopt;
        stages_.run("arrange", [&] { return arrange(), Done{}; });
        if (const auto error = add_structures()) return *error;
        add_pieces();
        if (is_interrupted()) return interrupted(input_);
        return std::nullopt;
    }

    // --- The mesh ------------------------------------------------------------------

    std::optional<Error> prepare() {
        auto imported = stages_.run("import", [&] {
            import::ImportOptions options = options_.import;
            options.parallel_for = threads_.parallel_for();
            return options_.read(input_, options);
        });
        if (is_interrupted()) return interrupted(input_);
        if (!imported) return imported.error();
        soup_ = std::move(imported).value();
        stages_.run("repair", [&] { return repair(), Done{}; });
        if (is_interrupted()) return interrupted(input_);
        if (const auto error = find_refusal(input_, soup_)) return *error;

        normalization_ = stages_.run("normalize", [&] {
            return options_.normalize ? mesh::normalize(soup_) : mesh::Normalization{};
        });
        if (const auto error = find_wide_weld(input_, soup_, options_.weld_distance)) return *error;
        welded_ = stages_.run("weld", [&] { return mesh::weld(soup_, {options_.weld_distance}); });
        if (is_interrupted()) return interrupted(input_);
        return std::nullopt;
    }

    /// Repairs the soup by the preset, if the options name one. Source numbers are then those of
    /// the repaired soup.
    void repair() {
        const auto steps = mesh::find_repair_preset(options_.repair);
        if (!steps) return;
        mesh::Repaired repaired = mesh::repair(soup_, {.steps = *steps,
                                                       .max_pairs = options_.max_pairs,
                                                       .interrupted = is_interrupted,
                                                       .parallel_for = threads_.parallel_for()});
        const mesh::SearchOptions search = {
            {options_.max_pairs, mesh::default_steps(repaired.mesh.triangles.size())},
            is_interrupted,
            threads_.parallel_for()};
        repair_.worse =
            mesh::worse_crossing(mesh::find_self_crossing(soup_, search),
                                 mesh::find_output_crossing(soup_, repaired.mesh, search));
        mesh::RepairedSoup as_imported = mesh::as_soup(soup_, std::move(repaired.mesh));
        soup_ = std::move(as_imported.soup);
        repair_.triangle_from = std::move(as_imported.triangle_from);
        repair_.vertex_from = std::move(as_imported.vertex_from);
        repair_.report = std::move(repaired.report);
    }

    /// Runs independent stages side by side. Their times are listed in a fixed order.
    void examine() {
        const mesh::Mesh& mesh = welded_.mesh;
        double& tree_s = stages_.add("  tree");
        double& topology_s = stages_.add("  topology");
        double& bounds_s = stages_.add("  bounds");
        double& defects_s = stages_.add("  defects");
        threads_.run_all({
            Stages::timed(tree_s,
                          [&] {
                              found_.bvh =
                                  build::build_bvh(mesh.positions, mesh.triangles,
                                                   {.parallel_for = threads_.parallel_for(),
                                                    .bounds = options_.bounds});
                          }),
            Stages::timed(topology_s,
                          [&] {
                              found_.topology = mesh::find_topology(mesh);
                              if (wants(format::SectionId::mass_properties) &&
                                  found_.topology.balanced) {
                                  found_.mass = convex::find_mass_properties(mesh);
                              }
                          }),
            Stages::timed(bounds_s, [&] { found_.bounds = convex::find_bounds(mesh); }),
            Stages::timed(defects_s,
                          [&] {
                              found_.defects = find_for_bake(soup_, mesh, options_.max_pairs,
                                                             threads_.parallel_for());
                          }),
        });
    }

    // --- --strict ------------------------------------------------------------------

    [[nodiscard]] bool is_refused() const {
        const bool is_unknown = !found_.defects.defects.crossings_complete;
        return options_.strict && (found_.defects.exit != 0 || is_unknown);
    }

    report::BakeReport refusal() {
        report_.input = input_.string();
        report_.output = output_.string();
        // The report of the defects counts only findings: it is a success if none is a warning,
        // even where the search for them ended early.
        report_.exit = static_cast<int>(Exit::findings);
        report_.error = input_.string() + ": " + strict_refusal(found_.defects, options_.max_pairs);
        return std::move(report_);
    }

    // --- The arrays ----------------------------------------------------------------

    [[nodiscard]] bool wants(format::SectionId section) const {
        return options_.effects.sections.contains(section);
    }

    /// Brings the mesh and all facts found about it into tree order.
    void arrange() {
        if (repair_.report) {
            for (std::uint32_t& vertex : welded_.mesh.source_vertex) {
                vertex = repair_.vertex_from[vertex];
            }
        }
        mesh::TreeOrdered ordered = mesh::in_tree_order(welded_.mesh, found_.bvh.order);
        for (format::Component& component : found_.topology.components) {
            component.vertex = ordered.new_vertex[component.vertex];
        }
        std::vector<std::uint64_t> degenerate =
            mesh::find_degenerate(ordered.mesh, threads_.parallel_for());
        arrays_.emplace(soup_, std::move(ordered.mesh), std::move(found_.bvh),
                        std::move(degenerate), std::move(found_.topology.components), found_.bounds,
                        found_.mass,
                        BakedNotes{found_.defects.defects.verdicts,
                                   kept_findings(found_.defects, repair_.report),
                                   provenance_json(options_, soup_), repair_.triangle_from});
    }

    std::optional<Error> add_structures() {
        const StructureChoice& choice = options_.structures;
        if (choice.names.empty()) return std::nullopt;
        Structures built = stages_.run("structures", [&] {
            return build_structures(arrays_->mesh(), arrays_->bvh().frame, choice, threads_,
                                    stages_);
        });
        if (choice.has_hulls()) {
            // Components and instances are numbered in source order.
            Result<BuiltHulls> hulls = stages_.run("hull", [&] {
                return build_hulls(input_, soup_, welded_.mesh, choice.hulls, threads_);
            });
            if (!hulls) return hulls.error();
            built.hulls = std::move(hulls->sections);
            report_.parts = hulls->parts;
        }
        arrays_->keep(std::move(built));
        return std::nullopt;
    }

    void add_pieces() {
        const mesh::Mesh& ordered = arrays_->mesh();
        if (wants(format::SectionId::pieces)) {
            convex::PieceArrays pieces = stages_.run("pieces", [&] {
                return build_pieces(ordered, options_.piece_tolerance, threads_);
            });
            convex::PieceTree tree = stages_.run("piece tree", [&] {
                return convex::make_piece_tree(ordered, pieces, arrays_->bvh().frame,
                                               threads_.parallel_for());
            });
            arrays_->keep(std::move(pieces), std::move(tree));
        }
        if (wants(format::SectionId::piece_adjacency)) {
            arrays_->keep(stages_.run("contacts", [&] {
                return convex::make_contact_arrays(ordered, arrays_->pieces(),
                                                   threads_.parallel_for());
            }));
        }
    }

    // --- The file ------------------------------------------------------------------

    [[nodiscard]] build::SectionList sections() const {
        format::SectionSet wanted = options_.effects.sections;
        wanted.insert(options_.structures.sections);
        return arrays_->sections(wanted);
    }

    [[nodiscard]] Result<BakedImage> make_image() const {
        const build::SectionList list = sections();
        const Result<std::size_t> size = build::image_size(list.sections());
        if (!size) return size.error();
        BakedImage image(*size);
        const auto built = build::build_image(facts(), list.sections(), image.bytes());
        if (!built) return built.error();
        return image;
    }

    std::optional<Error> write() {
        const Result<Done> written = stages_.run(
            "write", [&] { return write::write_file(output_, facts(), sections().sections()); });
        if (!written) return written.error();
        return std::nullopt;
    }

    /// The facts about the model in the file's header.
    [[nodiscard]] format::FileHeader facts() const {
        const build::Bvh& bvh = arrays_->bvh();
        format::FileHeader facts{};
        facts.vertex_count = static_cast<std::uint32_t>(arrays_->mesh().positions.size());
        facts.triangle_count = static_cast<std::uint32_t>(arrays_->mesh().triangles.size());
        if (found_.topology.balanced) facts.flags |= format::model_balanced;
        if (bvh.exact_leaves) facts.flags |= format::model_exact_leaves;
        if (options_.normalize) facts.flags |= format::model_normalized;
        facts.flags |= format::swept_flags(bvh.swept_kind);
        facts.up_axis = soup_.up_axis;
        facts.metres_per_unit = soup_.metres_per_unit;
        facts.frame_origin = bvh.frame.origin;
        facts.frame_exponent = bvh.frame.exponent;
        facts.normalize_offset = normalization_.offset;
        facts.normalize_factor = normalization_.factor;
        return facts;
    }

    report::BakeReport describe() {
        report_.input = input_.string();
        report_.output = output_.string();
        report_.triangles = arrays_->mesh().triangles.size();
        report_.vertices = arrays_->mesh().positions.size();
        report_.components = arrays_->component_count();
        report_.merged_vertices = welded_.report.merged_vertices;
        report_.degenerate_triangles = arrays_->degenerate_count();
        report_.balanced = found_.topology.balanced;
        report_.repaired = options_.repair;
        report_.promises = report::promise_words(found_.defects.defects.verdicts[0]);
        report_.warnings = count_warnings(found_.defects);
        report_.crossings_complete = found_.defects.defects.crossings_complete;
        report_.remarks = soup_.remarks;
        const std::vector<std::string>& found = found_.defects.remarks;
        report_.remarks.insert(report_.remarks.end(), found.begin(), found.end());
        if (!repair_.worse.empty()) {
            report_.remarks.push_back("The repair made crossings: " + repair_.worse + ".");
        }
        report_.single_precision = soup_.single_precision;
        if (!options_.structures.names.empty()) {
            report_.structures = stages_.run("describe", [&] {
                return structure_reports(options_.structures, arrays_->structures(),
                                         arrays_->mesh());
            });
        }
        if (report_.parts && !report_.parts->is_as_asked) {
            report_.exit = static_cast<int>(Exit::findings);
        }
        report_.bytes = std::filesystem::file_size(output_);
        report_.stages = stages_.times();
        report_.seconds = stages_.total();
        return std::move(report_);
    }

    const std::filesystem::path& input_;
    const std::filesystem::path& output_;
    const BakeOptions& options_;
    const Threads& threads_;
    Stages stages_;
    mesh::TriangleSoup soup_;
    RepairOutcome repair_;
    mesh::Normalization normalization_;
    mesh::Welded welded_;
    Findings found_;
    std::optional<BakedArrays> arrays_;
    report::BakeReport report_;
};

}  // namespace

Result<report::BakeReport> bake(const std::filesystem::path& input,
                                const std::filesystem::path& output, const BakeOptions& options,
                                const Threads& threads,
                                const std::function<void(const char*)>& begins) {
    return Baking(input, output, options, threads, begins).run();
}

Result<BakedImage> bake_image(const std::filesystem::path& input, const BakeOptions& options,
                              const Threads& threads,
                              const std::function<void(const char*)>& begins) {
    const std::filesystem::path none;
    return Baking(input, none, options, threads, begins).run_in_memory();
}

}  // namespace cdprep::cli
