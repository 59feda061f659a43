// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/memory_model.h"

#include <chrono>
#include <new>
#include <utility>

#include "bake/section_list.h"
#include "cdprep/advanced/build_image.h"
#include "cdprep/advanced/build_model.h"
#include "cdprep/cells/section_list.h"
#include "cdprep/format/sections.h"
#include "decompose/enclose/hull_sections.h"
#include "decompose/surface/contact_arrays.h"
#include "decompose/surface/piece_arrays.h"
#include "decompose/surface/piece_tree.h"
#include "decompose/surface/surface_pieces.h"
#include "mesh/find_bounds.h"
#include "mesh/mass_properties.h"

namespace cdprep::study {
namespace {

using format::SectionId;

constexpr std::align_val_t kAlignment{format::kPageAlignment};

template <class Work>
auto timed(double& seconds, Work work) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begun = Clock::now();
    auto made = work();
    seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    return made;
}

/// Returns the mesh in the model's order. Its source numbers are those of `mesh`.
mesh::Mesh ordered_mesh(const mesh::Mesh& mesh, const build::ModelArrays& arrays) {
    mesh::Mesh ordered;
    ordered.single_precision = mesh.single_precision;
    ordered.triangles = arrays.triangles;
    ordered.positions.reserve(arrays.source_vertex.size());
    ordered.source_vertex.reserve(arrays.source_vertex.size());
    for (const std::uint32_t vertex : arrays.source_vertex) {
        ordered.positions.push_back(mesh.positions[vertex]);
        ordered.source_vertex.push_back(mesh.source_vertex[vertex]);
    }
    return ordered;
}

/// The structures that are built besides the BVH.
struct BuiltParts {
    build::Octree octree;
    build::AdaptiveOctree adaptive_octree;
    build::TetraTree tetra_tree;
    convex::HullSections hulls;
    convex::PieceArrays pieces;
    convex::PieceTree piece_tree;
    convex::ContactArrays contacts;
};

constexpr SectionSet kTree = {
    SectionId::positions_f32,   SectionId::positions_f64,   SectionId::triangles,
    SectionId::source_triangle, SectionId::source_vertex,   SectionId::bvh_nodes,
    SectionId::bvh_leaves,      SectionId::degenerate_bits, SectionId::oriented_nodes,
    SectionId::swept_nodes,     SectionId::components,      SectionId::bounds};
constexpr SectionSet kOctree = {SectionId::octree_grid, SectionId::octree_nodes,
                                SectionId::octree_references};
constexpr SectionSet kHashes = {SectionId::octree_leaf_codes, SectionId::octree_leaf_nodes,
                                SectionId::octree_top, SectionId::octree_modulus_table,
                                SectionId::octree_mixed_table};
constexpr SectionSet kAdaptiveOctree = {SectionId::adaptive_octree,
                                        SectionId::adaptive_octree_nodes,
                                        SectionId::adaptive_octree_references};
constexpr SectionSet kTetraTree = {SectionId::tetra_tree, SectionId::tetra_nodes,
                                   SectionId::tetra_references, SectionId::tetra_top};
constexpr SectionSet kTetraBoxes = {SectionId::tetra_boxes, SectionId::tetra_oriented};
constexpr SectionSet kHulls = {SectionId::hulls,         SectionId::hull_blocks,
                               SectionId::hull_vertices, SectionId::hull_facets,
                               SectionId::hull_groups,   SectionId::hull_neighbours,
                               SectionId::hull_starts};
constexpr SectionSet kPieces = {
    SectionId::pieces,         SectionId::piece_triangles,  SectionId::piece_vertices,
    SectionId::piece_facets,   SectionId::piece_nodes,      SectionId::piece_swept,
    SectionId::piece_leaves,   SectionId::piece_node_hulls, SectionId::piece_adjacency,
    SectionId::edge_convexity, SectionId::triangle_piece};

SectionSet wanted_sections(const MemoryParts& parts) {
    SectionSet wanted = kTree;
    if (parts.octree) {
        wanted.insert(kOctree);
        if (parts.octree->hashed) wanted.insert(kHashes);
        if (parts.octree->boxes_in) wanted.insert(SectionId::octree_boxes);
    }
    if (parts.adaptive_octree) {
        wanted.insert(kAdaptiveOctree);
        if (parts.adaptive_octree->boxes_in) wanted.insert(SectionId::adaptive_octree_boxes);
    }
    if (parts.tetra_tree) {
        wanted.insert(kTetraTree);
        if (parts.tetra_tree->bounding == format::TetraBounding::boxes) wanted.insert(kTetraBoxes);
    }
    if (parts.hulls) wanted.insert(kHulls);
    if (parts.mass) wanted.insert(SectionId::mass_properties);
    // A stopped search has found no pieces.
    if (parts.pieces && !mesh::is_stopped(parts.stop)) wanted.insert(kPieces);
    return wanted;
}

void build_pieces(BuiltParts& built, const mesh::Mesh& mesh, const build::Frame& frame,
                  const mesh::StopCheck& stop, ParallelFor run, BuildSeconds& seconds) {
    built.pieces = timed(seconds.pieces, [&] {
        return convex::make_piece_arrays(
            mesh, convex::find_surface_pieces(mesh, {.parallel_for = run, .stop = stop}), run);
    });
    if (mesh::is_stopped(stop)) return;
    built.piece_tree = timed(seconds.piece_tree, [&] {
        return convex::make_piece_tree(mesh, built.pieces, frame, run);
    });
    built.contacts = timed(seconds.contacts,
                           [&] { return convex::make_contact_arrays(mesh, built.pieces, run); });
}

/// Builds the parts. Returns nothing if a hull would leave the range of double.
std::optional<BuiltParts> build_parts(const mesh::Mesh& mesh, const build::Frame& frame,
                                      const MemoryParts& parts, ParallelFor run,
                                      BuildSeconds& seconds) {
    BuiltParts built;
    if (parts.octree) {
        build::OctreeOptions options = *parts.octree;
        options.parallel_for = run;
        if (options.boxes_in) options.boxes_in = frame;
        built.octree = timed(seconds.octree, [&] {
            return build::build_octree(mesh.positions, mesh.triangles, options);
        });
    }
    if (parts.adaptive_octree) {
        build::AdaptiveOctreeOptions options = *parts.adaptive_octree;
        options.parallel_for = run;
        if (options.boxes_in) options.boxes_in = frame;
        built.adaptive_octree = timed(seconds.adaptive_octree, [&] {
            return build::build_adaptive_octree(mesh.positions, mesh.triangles, options);
        });
    }
    if (parts.tetra_tree) {
        build::TetraTreeOptions options = *parts.tetra_tree;
        options.parallel_for = run;
        options.frame_exponent = frame.exponent;
        options.frame_origin = frame.origin;
        built.tetra_tree = timed(seconds.tetra_tree, [&] {
            return build::build_tetra_tree(mesh.positions, mesh.triangles, options);
        });
    }
    if (parts.pieces) build_pieces(built, mesh, frame, parts.stop, run, seconds);
    if (!parts.hulls) return built;
    auto hulls = timed(seconds.hulls, [&] { return convex::make_hull_sections(mesh, {}, 0, run); });
    if (!hulls) return std::nullopt;
    built.hulls = std::move(*hulls);
    return built;
}

void add_parts(build::SectionList& list, const BuiltParts& built) {
    add_sections(list, built.octree);
    add_sections(list, built.adaptive_octree);
    add_sections(list, built.tetra_tree);
    add_sections(list, built.hulls);
    add_sections(list, built.pieces);
    add_sections(list, built.piece_tree);
    add_sections(list, built.contacts);
}

Result<ImageBytes> image_of(const format::FileHeader& facts, const build::SectionList& list) {
    const Result<std::size_t> size = build::image_size(list.sections());
    if (!size) return size.error();
    ImageBytes image(size.value());
    const auto built = build::build_image(facts, list.sections(), image.span());
    if (!built) return built.error();
    return image;
}

}  // namespace

ImageBytes::ImageBytes(std::size_t size)
    : data_(static_cast<std::byte*>(::operator new[](size, kAlignment))), size_(size) {}

void ImageBytes::Free::operator()(std::byte* bytes) const noexcept {
    ::operator delete[](bytes, kAlignment);
}

Result<MemoryModel> make_memory_model(const mesh::Mesh& mesh, const MemoryParts& parts,
                                      ParallelFor parallel_for) {
    BuildSeconds seconds;
    build::Bvh bvh = timed(seconds.tree, [&] {
        return build::build_bvh(mesh.positions, mesh.triangles,
                                {.parallel_for = parallel_for, .bounds = parts.bounds});
    });
    build::ModelArrays arrays =
        build::arrange_model(mesh.positions, mesh.triangles, std::move(bvh),
                             mesh.single_precision ? build::Precision::single_precision
                                                   : build::Precision::double_precision,
                             parallel_for);
    mesh::Mesh ordered = ordered_mesh(mesh, arrays);
    arrays.source_vertex = ordered.source_vertex;
    const format::Bounds bounds = convex::find_bounds(mesh);
    const auto built = build_parts(ordered, arrays.bvh.frame, parts, parallel_for, seconds);
    if (!built) {
        return Error{ErrorCode::over_budget,
                     "A hull of the model would have coordinates beyond the range of double."};
    }
    build::SectionList list = arrays.sections(wanted_sections(parts));
    list.add_one(SectionId::bounds, bounds);
    const auto mass = parts.mass ? convex::find_mass_properties(mesh) : std::nullopt;
    if (mass) list.add_one(SectionId::mass_properties, *mass);
    add_parts(list, *built);
    Result<ImageBytes> filled = image_of(arrays.facts, list);
    if (!filled) return filled.error();
    ImageBytes image = std::move(filled).value();
    Result<Model> opened = Model::open(std::as_const(image).span());
    if (!opened) return opened.error();
    return MemoryModel{std::move(image), std::move(opened).value(), std::move(ordered), seconds};
}

std::uint64_t bytes_of(const MemoryModel& model, format::SectionSet sections) noexcept {
    std::uint64_t bytes = 0;
    for (std::uint32_t number = 1; number < 64; ++number) {
        const auto id = static_cast<SectionId>(number);
        if (!sections.contains(id)) continue;
        const auto entry = format::find_section(model.image.span(), id);
        if (entry) bytes += entry->count * entry->element_size;
    }
    return bytes;
}

mesh::Mesh mesh_of(const Model& model) {
    mesh::Mesh mesh;
    mesh.single_precision = model.mesh().positions_f64.empty();
    mesh.positions.assign(model.mesh().positions_f64.begin(), model.mesh().positions_f64.end());
    for (const format::Float3& p : model.mesh().positions_f32)
        mesh.positions.push_back({p.x, p.y, p.z});
    mesh.source_vertex.assign(model.source().vertex.begin(), model.source().vertex.end());
    if (mesh.source_vertex.empty()) {
        for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) mesh.source_vertex.push_back(i);
    }
    mesh.triangles.resize(model.mesh().triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::size_t source = model.source().triangle.empty() ? i : model.source().triangle[i];
        mesh.triangles[source] = model.mesh().triangles[i];
    }
    return mesh;
}

}  // namespace cdprep::study
