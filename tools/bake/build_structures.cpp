// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/build_structures.h"

#include <utility>

#include "cli/signals.h"
#include "decompose/enclose/enclose.h"
#include "decompose/enclose/mesh_nodes.h"
#include "hull/hull_report.h"

namespace cdprep::cli {

Structures build_structures(const mesh::Mesh& ordered, const build::Frame& frame,
                            StructureChoice choice, const Threads& threads, Stages& stages) {
    // One after the other: each uses all threads, and only one at a time holds scratch memory.
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

Result<BuiltHulls> build_hulls(const std::filesystem::path& input, const mesh::TriangleSoup& soup,
                               const mesh::Mesh& mesh, const HullChoice& choice,
                               const Threads& threads) {
    auto sections = convex::make_hull_sections(mesh, soup.instances, choice.max_vertices,
                                               threads.parallel_for());
    if (!sections) return report::hull_beyond_range(input.string(), "--hull-vertices");
    BuiltHulls built = {std::move(*sections), {}};
    if (!choice.has_parts()) return built;
    const MeshNodes nodes = find_nodes(soup, mesh);
    convex::ApproximateOptions how;
    how.max_error = choice.max_error;
    how.max_parts = choice.parts;
    how.max_vertices = choice.max_vertices;
    how.node_of = nodes.node_of;
    how.convex_node = nodes.is_convex;
    const auto found = search_parts(mesh, how, threads);
    if (!found) return interrupted(input);
    convex::add_parts(built.sections, found->parts);
    built.parts = {found->parts.size(), found->outer_error, found->is_as_asked,
                   found->proof.fragments, found->proof.outside};
    return built;
}

convex::PieceArrays build_pieces(const mesh::Mesh& ordered, double tolerance,
                                 const Threads& threads) {
    return convex::make_piece_arrays(
        ordered,
        convex::find_surface_pieces(ordered, {.tolerance = tolerance,
                                              .parallel_for = threads.parallel_for(),
                                              .stop = is_interrupted}),
        threads.parallel_for());
}

std::vector<report::StructureReport> structure_reports(const StructureChoice& choice,
                                                       const Structures& built,
                                                       const mesh::Mesh& mesh) {
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

}  // namespace cdprep::cli
