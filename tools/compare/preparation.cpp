// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/preparation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "decompose/surface/piece_arrays.h"
#include "decompose/surface/piece_tree.h"
#include "decompose/surface/surface_edges.h"
#include "decompose/surface/surface_pieces.h"
#include "hull/convex_hull.h"
#include "hull/enclosing_hull.h"
#include "study/cells.h"

namespace cdprep::study {
namespace {

using format::SectionId;

constexpr std::uint32_t kEnclosingVertices = 64;
/// The rounding of published sizes: four decimals are printed. The sizes of PQP follow from the
/// number of triangles.
constexpr double kPrinted = 5.1e-5;

HullFigures measure_hull(const mesh::Mesh& mesh, const TimingOptions& timing) {
    const std::array<Question, 1> question = {question_of(
        [&](std::size_t) { return convex::convex_hull(mesh.positions).points.size(); })};
    HullFigures figures;
    figures.one = timing_of(time_questions(1, question, timing)[0]);
    const convex::ConvexHull hull = convex::convex_hull(mesh.positions);
    figures.dimension = hull.dimension;
    figures.vertices = hull.points.size();
    figures.facets = hull.facets.size();
    figures.groups = hull.groups.size() - 1;
    if (const auto enclosing = convex::enclosing_hull(hull, kEnclosingVertices)) {
        figures.enclosing_vertices = enclosing->hull.points.size();
        figures.enclosing_distance = enclosing->distance;
    }
    return figures;
}

Question builds(const mesh::Mesh& mesh, ParallelFor run, build::BvhBounds bounds) {
    return question_of([&mesh, run, bounds](std::size_t) {
        return build::build_bvh(mesh.positions, mesh.triangles,
                                {.parallel_for = run, .bounds = bounds})
            .nodes.size();
    });
}

constexpr format::SectionSet kHierarchy = {SectionId::bvh_nodes, SectionId::bvh_leaves,
                                           SectionId::oriented_nodes, SectionId::swept_nodes};
constexpr format::SectionSet kPieces = {
    SectionId::pieces,         SectionId::piece_triangles,  SectionId::piece_vertices,
    SectionId::piece_facets,   SectionId::piece_nodes,      SectionId::piece_swept,
    SectionId::piece_leaves,   SectionId::piece_node_hulls, SectionId::piece_adjacency,
    SectionId::edge_convexity, SectionId::triangle_piece};

HierarchyFigures measure_hierarchy(const mesh::Mesh& mesh, const ModelForms& forms,
                                   const PreparationOptions& options, TimingOptions timing) {
    const build::BvhBounds as_baked = build::BvhOptions{}.bounds;
    std::vector<Question> alone;
    alone.reserve(2);
    alone.push_back(builds(mesh, serial_for, as_baked));
    alone.push_back(builds(mesh, serial_for, build::BvhBounds::oriented_and_swept));
    const std::vector<Timings> one = time_questions(1, alone, timing);
    timing.by = TimedBy::wall;
    const Question shared = builds(mesh, options.parallel_for, as_baked);
    HierarchyFigures figures;
    figures.one = timing_of(one[0]);
    figures.swept = timing_of(one[1]);
    figures.all = timing_of(time_questions(1, {&shared, 1}, timing)[0]);
    figures.bytes = bytes_of(forms.plain, kHierarchy);
    figures.swept_bytes = bytes_of(forms.swept, kHierarchy);
    return figures;
}

PieceFigures measure_pieces(const ModelForms& forms, const PreparationOptions& options) {
    const MemoryModel& form = forms.plain;
    PieceFigures figures;
    figures.seconds_all = form.seconds.pieces + form.seconds.piece_tree;
    figures.pieces = form.model.pieces().pieces.size();
    for (const format::Piece& piece : form.model.pieces().pieces) {
        if ((piece.flags & format::piece_contained) != 0) ++figures.contained;
    }
    for (const format::PieceFacet& facet : form.model.pieces().facets) {
        if ((facet.flags & format::facet_virtual) != 0) ++figures.virtual_faces;
    }
    figures.bytes = bytes_of(form, kPieces);
    const auto edges = convex::find_surface_edges(form.ordered, options.parallel_for).count;
    const auto of = [&](convex::EdgeKind kind) { return edges[static_cast<std::size_t>(kind)]; };
    figures.border_edges = of(convex::EdgeKind::border);
    figures.non_manifold_edges = of(convex::EdgeKind::non_manifold);
    figures.inconsistent_edges = of(convex::EdgeKind::inconsistent);
    figures.flat_edges = of(convex::EdgeKind::fold) + of(convex::EdgeKind::no_area);
    if (!options.pieces_alone || mesh::is_stopped(options.stop)) return figures;
    // Once only: it takes the longest time of all.
    const double begun = thread_seconds();
    const auto pieces = convex::make_piece_arrays(
        form.ordered, convex::find_surface_pieces(form.ordered, {.stop = options.stop}),
        serial_for);
    if (mesh::is_stopped(options.stop)) return figures;
    const build::Frame frame = {form.model.header().frame_origin,
                                form.model.header().frame_exponent};
    static_cast<void>(convex::make_piece_tree(form.ordered, pieces, frame, serial_for));
    figures.seconds_one = thread_seconds() - begun;
    return figures;
}

void set_beside(const Likeness& likeness, const PublishedBuild& build, Cell& seconds, Cell& size) {
    seconds.published = beside(likeness, build.seconds);
    size.published = beside(likeness, build.mebibytes, build.erratum);
}

std::string guarantee_of(const StudyMesh& mesh, const PieceFigures& pieces) {
    if (pieces.pieces == 0) return "no pieces: the mesh is empty";
    std::string text = std::to_string(pieces.contained) + " of " + std::to_string(pieces.pieces) +
                       " pieces inside the solid; ";
    const std::size_t defects =
        pieces.border_edges + pieces.non_manifold_edges + pieces.inconsistent_edges;
    text += defects == 0 ? "closed 2-manifold" : "pieces end at each defect";
    return text + ", answers exact" + (mesh.mesh.triangles.empty() ? " (no triangles)" : "");
}

}  // namespace

Preparation measure_preparation(const StudyMesh& mesh, const ModelForms& forms,
                                const PreparationOptions& options) {
    const TimingOptions timing = {
        .rounds = options.rounds, .least_sample_s = 0, .stop = options.stop};
    return {measure_hull(mesh.mesh, timing), measure_hierarchy(mesh.mesh, forms, options, timing),
            measure_pieces(forms, options)};
}

Table preparation_table(const std::vector<StudyMesh>& meshes,
                        const std::vector<Preparation>& prepared) {
    Table table = {"3",
                   "Pre-processing time and size of hull, hierarchy and convex pieces",
                   "model",
                   {{"hull_s", "hull", Unit::seconds},
                    {"hull_mib", "hull, MiB", Unit::mebibytes},
                    {"bvh_s", "PQP-style BVH", Unit::seconds},
                    {"pqp_mib", "PQP's size, MiB", Unit::mebibytes},
                    {"pieces_s", "pieces", Unit::seconds},
                    {"pieces_mib", "pieces, MiB", Unit::mebibytes}},
                   {},
                   {"One thread. Hull: 24 bytes per vertex and 12 per facet; the comparative study "
                    "gives no formula.",
                    "PQP's size is that of its formula for n triangles as read: 2n - 1 nodes of "
                    "172 bytes, n triangles of 76 bytes, and 36 bytes. Doubles are aligned to 4 "
                    "bytes, as in the comparative study.",
                    "SWIFT++ refuses models with defects; here, pieces end at the defects."}};
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const StudyMesh& mesh = meshes[i];
        const auto& [hull, bvh, pieces] = prepared[i];
        Cell hull_s = seconds_cell(hull.one);
        Cell hull_mib = size_cell(24.0 * static_cast<double>(hull.vertices) +
                                  12.0 * static_cast<double>(hull.facets));
        Cell bvh_s = seconds_cell(bvh.swept);
        Cell pqp_mib = size_cell(pqp_bytes_32(static_cast<double>(mesh.read_triangles)));
        Cell pieces_s = pieces.seconds_one ? seconds_cell(*pieces.seconds_one)
                                           : without("--quick leaves out the time on one thread");
        Cell pieces_mib = size_cell(static_cast<double>(pieces.bytes));
        if (mesh.likeness.model) {
            const PublishedModel& model = kPublished[*mesh.likeness.model];
            set_beside(mesh.likeness, model.hull, hull_s, hull_mib);
            set_beside(mesh.likeness, model.pqp, bvh_s, pqp_mib);
            if (model.swift) {
                set_beside(mesh.likeness, *model.swift, pieces_s, pieces_mib);
            } else {
                Published refused;
                refused.text = "Not 2-manifold";
                refused.mark = mesh.likeness.mark;
                if (mesh.likeness.mark != Mark::none) refused.remark = mesh.likeness.sentence;
                pieces_s.published = refused;
                pieces_mib.published = refused;
            }
        } else {
            for (Cell* const cell :
                 {&hull_s, &hull_mib, &bvh_s, &pqp_mib, &pieces_s, &pieces_mib}) {
                cell->published = beside(mesh.likeness, 0);
            }
        }
        table.rows.push_back({mesh.name, {hull_s, hull_mib, bvh_s, pqp_mib, pieces_s, pieces_mib}});
        if (!mesh.likeness.version_of) {
            table.notes.push_back(mesh.name +
                                  " has no published figures: " + mesh.likeness.sentence + ".");
        }
    }
    return table;
}

Table preparation_details(const std::vector<StudyMesh>& meshes,
                          const std::vector<Preparation>& prepared) {
    Table table = {
        "3.details",
        "Hull, hierarchy and pieces in detail",
        "model",
        {{"hull_vertices", "hull: vertices", Unit::count},
         {"hull_facets", "facets", Unit::count},
         {"hull_groups", "faces", Unit::count},
         {"enclosing_vertices", "enclosing: vertices", Unit::count},
         {"enclosing_distance", "enclosing: distance", Unit::share},
         {"bvh_s_1", "BVH, 1 thread", Unit::seconds},
         {"bvh_s_all", "all threads", Unit::seconds},
         {"bvh_mib", "actual, MiB", Unit::mebibytes},
         {"swept_mib", "PQP-style, MiB", Unit::mebibytes},
         {"pqp_mib_64", "PQP today, MiB", Unit::mebibytes},
         {"pieces_s_all", "pieces, all threads", Unit::seconds},
         {"pieces", "pieces", Unit::count},
         {"virtual_faces", "virtual faces", Unit::count},
         {"border_edges", "border edges", Unit::count},
         {"non_manifold_edges", "non-manifold edges", Unit::count},
         {"inconsistent_edges", "inconsistent edges", Unit::count},
         {"flat_edges", "folds, zero area", Unit::count},
         {"guarantee", "guarantee", Unit::none}},
        {},
        {"Enclosing: a hull of at most 64 vertices around the exact one. Distance: the largest one "
         "between the two hulls, as a share of the mesh's diagonal.",
         "PQP today: doubles aligned to 8 bytes, nodes of 176 bytes, triangles of 80 bytes.",
         "Edges are those of the welded mesh."}};
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const auto& [hull, bvh, pieces] = prepared[i];
        const bool encloses = hull.enclosing_vertices > 0;
        const std::string why =
            "a hull of dimension " + std::to_string(hull.dimension) + " is not reduced";
        table.rows.push_back(
            {meshes[i].name,
             {count_cell(hull.vertices), count_cell(hull.facets), count_cell(hull.groups),
              encloses ? count_cell(hull.enclosing_vertices) : without(why),
              encloses ? number(hull.enclosing_distance) : without(why), seconds_cell(bvh.one),
              seconds_cell(bvh.all), size_cell(static_cast<double>(bvh.bytes)),
              size_cell(static_cast<double>(bvh.swept_bytes)),
              size_cell(pqp_bytes_64(static_cast<double>(meshes[i].read_triangles))),
              seconds_cell(pieces.seconds_all), count_cell(pieces.pieces),
              count_cell(pieces.virtual_faces), count_cell(pieces.border_edges),
              count_cell(pieces.non_manifold_edges), count_cell(pieces.inconsistent_edges),
              count_cell(pieces.flat_edges), word(guarantee_of(meshes[i], pieces))}});
    }
    return table;
}

std::vector<Check> preparation_checks(const std::vector<StudyMesh>& meshes,
                                      const std::vector<Preparation>& prepared) {
    std::vector<Check> checks;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const StudyMesh& mesh = meshes[i];
        if (mesh.likeness.model &&
            mesh.read_triangles == kPublished[*mesh.likeness.model].triangles) {
            const PublishedModel& model = kPublished[*mesh.likeness.model];
            const double formula =
                pqp_bytes_32(static_cast<double>(mesh.read_triangles)) / (1 << 20);
            const bool has_erratum = *model.pqp.erratum != '\0';
            Check check;
            check.claim = mesh.name +
                          ": PQP's published size follows from the number of triangles, to the "
                          "last printed digit";
            check.evidence = formatted("%.4f MiB by the formula, ", formula) +
                             formatted("%.4f printed", model.pqp.mebibytes) +
                             (has_erratum ? std::string(": ") + model.pqp.erratum : "");
            const bool is_equal = std::fabs(formula - model.pqp.mebibytes) < kPrinted;
            check.verdict = has_erratum && !is_equal ? Verdict::not_asked : verdict_of(is_equal);
            checks.push_back(std::move(check));
        }
        const auto& [hull, bvh, pieces] = prepared[i];
        if (!pieces.seconds_one) continue;
        Check check;
        check.claim =
            mesh.name + ": the hierarchy takes less pre-processing time than the pieces (Table 3)";
        check.evidence = seconds_text(bvh.swept.median_s) + " against " +
                         seconds_text(*pieces.seconds_one) + " on one thread";
        check.verdict = verdict_of(bvh.swept.median_s < *pieces.seconds_one);
        checks.push_back(std::move(check));
    }
    return checks;
}

}  // namespace cdprep::study
