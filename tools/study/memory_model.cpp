// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/memory_model.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <utility>

#include "cdprep/format/checksum.h"
#include "cdprep/format/make_user_block.h"
#include "cdprep/format/sections.h"
#include "convex/contact_arrays.h"
#include "convex/find_bounds.h"
#include "convex/hull_sections.h"
#include "convex/piece_arrays.h"
#include "convex/piece_tree.h"
#include "convex/surface_pieces.h"
#include "mesh/degenerate.h"
#include "mesh/topology.h"
#include "mesh/tree_order.h"

namespace cdprep::study {
namespace {

using format::SectionId;

constexpr std::align_val_t kAlignment{format::kPageAlignment};

/// Sections that stand in an image one after the other, in the order of their ids.
class Sections {
public:
    template <class Element>
    void add(SectionId id, const std::vector<Element>& elements) {
        kept_.push_back({id, std::vector<std::byte>(elements.size() * sizeof(Element))});
        std::vector<std::byte>& bytes = kept_.back().bytes;
        if (!bytes.empty()) std::memcpy(bytes.data(), elements.data(), bytes.size());
    }

    [[nodiscard]] ImageBytes image(const format::FileHeader& facts) {
        std::ranges::sort(kept_, {}, &Kept::id);
        std::uint64_t size = aligned(format::kUserBlockSize + format::kSectionAlignment);
        std::vector<format::SectionEntry> entries;
        for (const auto& [id, bytes] : kept_) {
            const std::uint32_t element = format::element_size(id);
            entries.push_back({id, element, bytes.empty() ? 0 : size, bytes.size() / element,
                               format::checksum(bytes)});
            size = aligned(size + bytes.size());
        }
        ImageBytes image(size);
        for (std::size_t i = 0; i < kept_.size(); ++i) {
            if (kept_[i].bytes.empty()) continue;
            std::memcpy(image.span().data() + entries[i].offset, kept_[i].bytes.data(),
                        kept_[i].bytes.size());
        }
        const std::array<std::byte, 40> superblock{};
        const format::UserBlock block = format::make_user_block(facts, entries, superblock, size);
        std::memcpy(image.span().data(), block.data(), block.size());
        return image;
    }

private:
    struct Kept {
        SectionId id;
        std::vector<std::byte> bytes;
    };

    /// As in a file, where larger sections begin at pages.
    static std::uint64_t aligned(std::uint64_t size) {
        constexpr std::uint64_t kStep = format::kPageAlignment;
        return (size + kStep - 1) / kStep * kStep;
    }

    std::vector<Kept> kept_;
};

template <class Work>
auto timed(double& seconds, Work work) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begun = Clock::now();
    auto made = work();
    seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    return made;
}

std::vector<format::Float3> as_floats(const mesh::Mesh& mesh) {
    std::vector<format::Float3> floats;
    floats.reserve(mesh.positions.size());
    for (const format::Double3& p : mesh.positions) {
        floats.push_back(
            {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    return floats;
}

void add_tree(Sections& sections, const mesh::Mesh& mesh, const build::Bvh& bvh) {
    if (mesh.single_precision) {
        sections.add(SectionId::positions_f32, as_floats(mesh));
    } else {
        sections.add(SectionId::positions_f64, mesh.positions);
    }
    sections.add(SectionId::triangles, mesh.triangles);
    sections.add(SectionId::source_triangle, bvh.order);
    sections.add(SectionId::source_vertex, mesh.source_vertex);
    sections.add(SectionId::bvh_nodes, bvh.nodes);
    sections.add(SectionId::bvh_leaves, bvh.leaves);
    if (!bvh.oriented_nodes.empty()) sections.add(SectionId::oriented_nodes, bvh.oriented_nodes);
    if (!bvh.swept_nodes.empty()) sections.add(SectionId::swept_nodes, bvh.swept_nodes);
}

void add_octree(Sections& sections, const build::Octree& octree) {
    sections.add(SectionId::octree_grid, std::vector{octree.grid});
    sections.add(SectionId::octree_nodes, octree.nodes);
    sections.add(SectionId::octree_references, octree.references);
    if (!octree.boxes.empty()) sections.add(SectionId::octree_boxes, octree.boxes);
    if (octree.modulus_table.empty()) return;
    sections.add(SectionId::octree_leaf_codes, octree.leaf_codes);
    sections.add(SectionId::octree_leaf_nodes, octree.leaf_nodes);
    sections.add(SectionId::octree_top, octree.top);
    sections.add(SectionId::octree_modulus_table, octree.modulus_table);
    sections.add(SectionId::octree_mixed_table, octree.mixed_table);
}

void add_adaptive_octree(Sections& sections, const build::AdaptiveOctree& octree) {
    sections.add(SectionId::adaptive_octree, std::vector{octree.tree});
    sections.add(SectionId::adaptive_octree_nodes, octree.nodes);
    sections.add(SectionId::adaptive_octree_references, octree.references);
    if (!octree.boxes.empty()) sections.add(SectionId::adaptive_octree_boxes, octree.boxes);
}

void add_tetra_tree(Sections& sections, const build::TetraTree& tetra) {
    sections.add(SectionId::tetra_tree, std::vector{tetra.tree});
    sections.add(SectionId::tetra_nodes, tetra.nodes);
    sections.add(SectionId::tetra_references, tetra.references);
    sections.add(SectionId::tetra_top, tetra.top);
    // There even when the triangles that hold the centre are all, and no cone has any.
    if (tetra.tree.bounding != format::TetraBounding::boxes) return;
    sections.add(SectionId::tetra_boxes, tetra.boxes);
    sections.add(SectionId::tetra_oriented, tetra.oriented);
}

void add_hulls(Sections& sections, const convex::HullSections& hulls) {
    sections.add(SectionId::hulls, hulls.hulls);
    sections.add(SectionId::hull_blocks, hulls.blocks);
    sections.add(SectionId::hull_vertices, hulls.vertices);
    sections.add(SectionId::hull_facets, hulls.facets);
    sections.add(SectionId::hull_groups, hulls.groups);
    sections.add(SectionId::hull_neighbours, hulls.neighbours);
    sections.add(SectionId::hull_starts, hulls.starts);
}

void add_pieces(Sections& sections, const mesh::Mesh& mesh, const build::Frame& frame,
                const mesh::StopCheck& stop, ParallelFor run, BuildSeconds& seconds) {
    const auto pieces = timed(seconds.pieces, [&] {
        return convex::make_piece_arrays(
            mesh, convex::find_surface_pieces(mesh, {.parallel_for = run, .stop = stop}), run);
    });
    if (stop && stop()) return;
    sections.add(SectionId::pieces, pieces.pieces);
    sections.add(SectionId::piece_triangles, pieces.triangles);
    sections.add(SectionId::piece_vertices, pieces.vertices);
    sections.add(SectionId::piece_facets, pieces.facets);
    const auto tree = timed(seconds.piece_tree,
                            [&] { return convex::make_piece_tree(mesh, pieces, frame, run); });
    sections.add(SectionId::piece_nodes, tree.nodes);
    sections.add(SectionId::piece_swept, tree.swept);
    sections.add(SectionId::piece_leaves, tree.leaves);
    sections.add(SectionId::piece_node_hulls, tree.hulls);
    const auto contacts =
        timed(seconds.contacts, [&] { return convex::make_contact_arrays(mesh, pieces, run); });
    sections.add(SectionId::piece_adjacency, contacts.adjacency);
    sections.add(SectionId::edge_convexity, contacts.convexity);
    sections.add(SectionId::triangle_piece, contacts.piece_of);
}

format::FileHeader facts_of(const mesh::Mesh& mesh, const build::Bvh& bvh, bool is_closed) {
    format::FileHeader facts{};
    facts.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
    facts.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
    if (is_closed) facts.flags |= format::model_closed;
    if (bvh.exact_leaves) facts.flags |= format::model_exact_leaves;
    facts.flags |= format::swept_flags(bvh.swept_kind);
    facts.frame_origin = bvh.frame.origin;
    facts.frame_exponent = bvh.frame.exponent;
    return facts;
}

/// Builds the parts and adds them; false where a hull would leave the range of double.
bool add_parts(Sections& sections, const mesh::Mesh& mesh, const build::Frame& frame,
               const MemoryParts& parts, ParallelFor run, BuildSeconds& seconds) {
    if (parts.octree) {
        build::OctreeOptions options = *parts.octree;
        options.parallel_for = run;
        if (options.boxes_in) options.boxes_in = frame;
        add_octree(sections, timed(seconds.octree, [&] {
                       return build::build_octree(mesh.positions, mesh.triangles, options);
                   }));
    }
    if (parts.adaptive_octree) {
        build::AdaptiveOctreeOptions options = *parts.adaptive_octree;
        options.parallel_for = run;
        if (options.boxes_in) options.boxes_in = frame;
        add_adaptive_octree(sections, timed(seconds.adaptive_octree, [&] {
                                return build::build_adaptive_octree(mesh.positions, mesh.triangles,
                                                                    options);
                            }));
    }
    if (parts.tetra_tree) {
        build::TetraTreeOptions options = *parts.tetra_tree;
        options.parallel_for = run;
        options.frame_exponent = frame.exponent;
        options.frame_origin = frame.origin;
        add_tetra_tree(sections, timed(seconds.tetra_tree, [&] {
                           return build::build_tetra_tree(mesh.positions, mesh.triangles, options);
                       }));
    }
    if (parts.pieces) add_pieces(sections, mesh, frame, parts.stop, run, seconds);
    if (!parts.hulls) return true;
    const auto hulls =
        timed(seconds.hulls, [&] { return convex::make_hull_sections(mesh, {}, 0, run); });
    if (hulls) add_hulls(sections, *hulls);
    return hulls.has_value();
}

}  // namespace

ImageBytes::ImageBytes(std::size_t size)
    : data_(static_cast<std::byte*>(::operator new[](size, kAlignment))), size_(size) {
    std::memset(data_.get(), 0, size);
}

void ImageBytes::Free::operator()(std::byte* bytes) const noexcept {
    ::operator delete[](bytes, kAlignment);
}

Result<MemoryModel> make_memory_model(const mesh::Mesh& mesh, const MemoryParts& parts,
                                      ParallelFor parallel_for) {
    BuildSeconds seconds;
    const build::Bvh bvh = timed(seconds.tree, [&] {
        return build::build_bvh(mesh.positions, mesh.triangles,
                                {.parallel_for = parallel_for, .bounds = parts.bounds});
    });
    mesh::TreeOrdered ordered = mesh::in_tree_order(mesh, bvh.order);
    mesh::Topology topology = mesh::find_topology(mesh);
    for (format::Component& component : topology.components) {
        component.vertex = ordered.new_vertex[component.vertex];
    }
    Sections sections;
    add_tree(sections, ordered.mesh, bvh);
    const auto degenerate = mesh::find_degenerate(ordered.mesh, parallel_for);
    if (!degenerate.empty()) sections.add(SectionId::degenerate_bits, degenerate);
    sections.add(SectionId::components, topology.components);
    sections.add(SectionId::bounds, std::vector{convex::find_bounds(mesh)});
    if (!add_parts(sections, ordered.mesh, bvh.frame, parts, parallel_for, seconds)) {
        return Error{ErrorCode::over_budget,
                     "A hull of the model would have coordinates beyond the range of double."};
    }
    ImageBytes image = sections.image(facts_of(ordered.mesh, bvh, topology.closed));
    Result<Model> opened = Model::open(std::as_const(image).span());
    if (!opened) return opened.error();
    return MemoryModel{std::move(image), std::move(opened).value(), std::move(ordered.mesh),
                       seconds};
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
    mesh.single_precision = model.positions_f64().empty();
    mesh.positions.assign(model.positions_f64().begin(), model.positions_f64().end());
    for (const format::Float3& p : model.positions_f32()) mesh.positions.push_back({p.x, p.y, p.z});
    mesh.source_vertex.assign(model.source_vertex().begin(), model.source_vertex().end());
    if (mesh.source_vertex.empty()) {
        for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) mesh.source_vertex.push_back(i);
    }
    mesh.triangles.resize(model.triangles().size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::size_t source = model.source_triangle().empty() ? i : model.source_triangle()[i];
        mesh.triangles[source] = model.triangles()[i];
    }
    return mesh;
}

}  // namespace cdprep::study
