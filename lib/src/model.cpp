// SPDX-License-Identifier: MIT
#include "cdprep/model.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "cdprep/format/find_damage.h"
#include "cdprep/format/sections.h"
#include "core/refusal_sentence.h"
#include "damage_sentence.h"
#include "mapped_file.h"

namespace cdprep {

struct Model::State {
    MappedFile mapping;  ///< or a copy; empty when the caller keeps the bytes
    std::string name;    ///< of the file, for messages
    std::span<const std::byte> file;
    const format::FileHeader* header = nullptr;
    SectionSet sections;
    SectionSet in_file;  ///< also those that were not asked for
    format::BvhShape shape;
    std::span<const Float3> positions_f32;
    std::span<const Double3> positions_f64;
    std::span<const format::Triangle> triangles;
    std::span<const std::uint32_t> source_triangle;
    std::span<const std::uint32_t> source_vertex;
    std::span<const std::uint32_t> source_face;
    std::span<const format::BvhNode> nodes;
    std::span<const format::BvhLeaf> leaves;
    std::span<const format::OrientedNode> oriented_nodes;
    std::span<const format::SweptNode> swept_nodes;
    std::span<const std::uint64_t> degenerate_bits;
    std::span<const format::Component> components;
    std::span<const format::Bounds> bounds;
    std::span<const format::MassProperties> mass_properties;
    std::span<const format::Instance> instances;
    std::span<const format::NamedRun> group_runs;
    std::span<const format::NamedRun> material_runs;
    std::span<const char> instance_names;
    std::span<const char> group_names;
    std::span<const char> material_names;
    std::span<const char> provenance;
    std::span<const format::Verdict> verdicts;
    std::span<const char> findings;
    std::span<const std::uint32_t> repaired_from;
    std::span<const format::OctreeGrid> octree_grid;
    std::span<const format::AdaptiveOctree> adaptive_octree;
    std::span<const format::TetraTree> tetra_tree;
    std::span<const format::OctreeNode> octree_nodes;
    std::span<const std::uint32_t> octree_references;
    std::span<const std::uint64_t> octree_leaf_codes;
    std::span<const std::uint32_t> octree_leaf_nodes;
    std::span<const std::uint32_t> octree_top;
    std::span<const std::uint32_t> octree_modulus_table;
    std::span<const std::uint32_t> octree_mixed_table;
    std::span<const format::AdaptiveOctreeNode> adaptive_octree_nodes;
    std::span<const std::uint32_t> adaptive_octree_references;
    std::span<const format::CellBox> octree_boxes;
    std::span<const format::CellBox> adaptive_octree_boxes;
    std::span<const format::TetraNode> tetra_nodes;
    std::span<const std::uint32_t> tetra_references;
    std::span<const std::uint32_t> tetra_top;
    std::span<const format::BvhNode> tetra_boxes;
    std::span<const format::OrientedNode> tetra_oriented;
    std::span<const format::Hull> hulls;
    std::span<const format::HullBlock> hull_blocks;
    std::span<const std::uint32_t> hull_vertices;
    std::span<const format::HullFacet> hull_facets;
    std::span<const format::HullGroup> hull_groups;
    std::span<const std::uint32_t> hull_neighbours;
    std::span<const std::uint32_t> hull_starts;
    std::span<const format::Piece> pieces;
    std::span<const std::uint32_t> piece_triangles;
    std::span<const std::uint32_t> piece_vertices;
    std::span<const format::PieceFacet> piece_facets;
    std::span<const format::BvhNode> piece_nodes;
    std::span<const format::SweptNode> piece_swept;
    std::span<const format::PieceLeaf> piece_leaves;
    std::span<const format::PieceNodeHull> piece_node_hulls;
    std::span<const format::PieceAdjacency> piece_adjacency;
    std::span<const std::uint8_t> edge_convexity;
    std::span<const std::uint32_t> triangle_piece;

    void find_sections(SectionSet wanted);

    /// A model without triangles has no leaves, and none that lose anything.
    [[nodiscard]] bool has_exact_leaves() const noexcept {
        return (header->flags & format::model_exact_leaves) != 0 && !leaves.empty();
    }

private:
    /// Points `span` at the section when it is wanted and there.
    template <class T>
    void view(SectionId id, SectionSet wanted, std::span<const T>& span) {
        const std::optional<format::SectionEntry> entry = format::find_section(file, id);
        if (!entry) return;
        in_file.insert(id);
        if (!wanted.contains(id)) return;
        sections.insert(id);
        // The checker has proved offset, alignment and element size.
        span = {reinterpret_cast<const T*>(file.data() + entry->offset),
                static_cast<std::size_t>(entry->count)};
    }
};

void Model::State::find_sections(SectionSet wanted) {
    header = reinterpret_cast<const format::FileHeader*>(file.data());
    shape = format::bvh_shape(header->triangle_count);
    view(SectionId::positions_f32, wanted, positions_f32);
    view(SectionId::positions_f64, wanted, positions_f64);
    view(SectionId::triangles, wanted, triangles);
    view(SectionId::source_triangle, wanted, source_triangle);
    view(SectionId::source_vertex, wanted, source_vertex);
    view(SectionId::source_face, wanted, source_face);
    view(SectionId::bvh_nodes, wanted, nodes);
    view(SectionId::bvh_leaves, wanted, leaves);
    view(SectionId::oriented_nodes, wanted, oriented_nodes);
    view(SectionId::swept_nodes, wanted, swept_nodes);
    view(SectionId::degenerate_bits, wanted, degenerate_bits);
    view(SectionId::components, wanted, components);
    view(SectionId::bounds, wanted, bounds);
    view(SectionId::mass_properties, wanted, mass_properties);
    view(SectionId::instances, wanted, instances);
    view(SectionId::instance_names, wanted, instance_names);
    view(SectionId::group_runs, wanted, group_runs);
    view(SectionId::group_names, wanted, group_names);
    view(SectionId::material_runs, wanted, material_runs);
    view(SectionId::material_names, wanted, material_names);
    view(SectionId::provenance, wanted, provenance);
    view(SectionId::verdicts, wanted, verdicts);
    view(SectionId::findings, wanted, findings);
    view(SectionId::repaired_from, wanted, repaired_from);
    view(SectionId::octree_grid, wanted, octree_grid);
    view(SectionId::adaptive_octree, wanted, adaptive_octree);
    view(SectionId::tetra_tree, wanted, tetra_tree);
    view(SectionId::octree_nodes, wanted, octree_nodes);
    view(SectionId::octree_references, wanted, octree_references);
    view(SectionId::octree_leaf_codes, wanted, octree_leaf_codes);
    view(SectionId::octree_leaf_nodes, wanted, octree_leaf_nodes);
    view(SectionId::octree_top, wanted, octree_top);
    view(SectionId::octree_modulus_table, wanted, octree_modulus_table);
    view(SectionId::octree_mixed_table, wanted, octree_mixed_table);
    view(SectionId::adaptive_octree_nodes, wanted, adaptive_octree_nodes);
    view(SectionId::adaptive_octree_references, wanted, adaptive_octree_references);
    view(SectionId::octree_boxes, wanted, octree_boxes);
    view(SectionId::adaptive_octree_boxes, wanted, adaptive_octree_boxes);
    view(SectionId::tetra_nodes, wanted, tetra_nodes);
    view(SectionId::tetra_references, wanted, tetra_references);
    view(SectionId::tetra_top, wanted, tetra_top);
    view(SectionId::tetra_boxes, wanted, tetra_boxes);
    view(SectionId::tetra_oriented, wanted, tetra_oriented);
    view(SectionId::hulls, wanted, hulls);
    view(SectionId::hull_blocks, wanted, hull_blocks);
    view(SectionId::hull_vertices, wanted, hull_vertices);
    view(SectionId::hull_facets, wanted, hull_facets);
    view(SectionId::hull_groups, wanted, hull_groups);
    view(SectionId::hull_neighbours, wanted, hull_neighbours);
    view(SectionId::hull_starts, wanted, hull_starts);
    view(SectionId::pieces, wanted, pieces);
    view(SectionId::piece_triangles, wanted, piece_triangles);
    view(SectionId::piece_vertices, wanted, piece_vertices);
    view(SectionId::piece_facets, wanted, piece_facets);
    view(SectionId::piece_nodes, wanted, piece_nodes);
    view(SectionId::piece_swept, wanted, piece_swept);
    view(SectionId::piece_leaves, wanted, piece_leaves);
    view(SectionId::piece_node_hulls, wanted, piece_node_hulls);
    view(SectionId::piece_adjacency, wanted, piece_adjacency);
    view(SectionId::edge_convexity, wanted, edge_convexity);
    view(SectionId::triangle_piece, wanted, triangle_piece);
}

namespace {

Error damaged(std::string_view name, const format::Damage& damage) {
    return {ErrorCode::unreadable, damage_sentence(name, damage)};
}

/// The element of a section that has one, or null.
template <class T>
const T* only(std::span<const T> section) {
    return section.empty() ? nullptr : section.data();
}

}  // namespace

Model::Model(std::unique_ptr<State> state) noexcept
    : state_(std::move(state)), served_(served_by(state_->sections, state_->has_exact_leaves())) {}
Model::Model(Model&& other) noexcept
    : state_(std::move(other.state_)), served_(std::exchange(other.served_, Ask::nothing)) {}
Model& Model::operator=(Model&& other) noexcept {
    std::swap(state_, other.state_);
    std::swap(served_, other.served_);
    return *this;
}
Model::~Model() = default;

Result<Model> Model::open(const std::filesystem::path& path, const OpenOptions& options) {
    const bool is_copied = options.mode == OpenMode::copy;
    Result<MappedFile> mapped = is_copied ? MappedFile::copy(path) : MappedFile::map(path);
    if (!mapped) return mapped.error();
    OpenOptions named = options;
    const std::string name = path.string();
    named.name = name;
    Result<Model> model = from_bytes(mapped.value().bytes(), named);
    if (model) model.value().state_->mapping = std::move(mapped).value();
    return model;
}

Result<Model> Model::open(const std::filesystem::path& path, Ask asks) {
    return open(path, OpenOptions{.asks = asks});
}

Result<Model> Model::open(const std::filesystem::path& path, SectionSet wanted) {
    return open(path, OpenOptions{.sections = wanted});
}

Result<Model> Model::open(std::span<const std::byte> bytes, const OpenOptions& options) {
    return from_bytes(bytes, options);
}

Result<Model> Model::open(std::span<const std::byte> bytes, SectionSet wanted) {
    return from_bytes(bytes, OpenOptions{.sections = wanted});
}

Result<Model> Model::from_bytes(std::span<const std::byte> bytes, const OpenOptions& options) {
    const std::string name(options.name);
    const auto misaligned =
        reinterpret_cast<std::uintptr_t>(bytes.data()) % format::kSectionAlignment;
    if (misaligned != 0) {
        return Error{ErrorCode::bad_argument,
                     name + ": the bytes start " + std::to_string(misaligned) +
                         " past a multiple of " + std::to_string(format::kSectionAlignment) +
                         "; they must start at one."};
    }
    const SectionSet unless_said = options.asks == Ask::nothing ? SectionSet::all() : SectionSet{};
    SectionSet wanted = options.sections.value_or(unless_said);
    wanted.insert(sections_for(options.asks));
    if (const auto damage = format::find_damage(bytes, wanted)) return damaged(name, *damage);
    auto state = std::make_unique<State>();
    state->file = bytes;
    state->name = name;
    state->find_sections(wanted);
    Model model(std::move(state));
    if (const std::optional<Refusal> refused = model.refusal(options.asks)) {
        return Error{ErrorCode::bad_argument, refused->message};
    }
    return model;
}

Result<Model> Model::open_trusted(const std::filesystem::path& path) {
    Result<MappedFile> mapped = MappedFile::map(path);
    if (!mapped) return mapped.error();
    auto state = std::make_unique<State>();
    state->mapping = std::move(mapped).value();
    state->file = state->mapping.bytes();
    state->name = path.string();
    if (const auto damage = format::find_header_damage(state->file)) {
        return damaged(path.string(), *damage);
    }
    state->find_sections(SectionSet::all());
    return Model(std::move(state));
}

std::optional<Refusal> Model::refusal(Ask asks) const {
    if (serves(asks)) return std::nullopt;
    using Reason = Refusal::Reason;
    if (state_ == nullptr) {
        return Refusal{Reason::not_opened, "The model was moved away: it can be asked nothing."};
    }
    const bool exact_leaves = (state_->header->flags & format::model_exact_leaves) != 0;
    const Ask refused = without(asks, served_);
    const Ask missing = without(refused, served_by(state_->in_file, exact_leaves));
    if (missing == Ask::nothing) {
        return Refusal{
            Reason::not_opened,
            refusal_sentence(state_->name, refused, {state_->sections, exact_leaves, is_closed()},
                             Reason::not_opened)};
    }
    return Refusal{Reason::not_baked, refusal_sentence(state_->name, missing,
                                                       {state_->in_file, exact_leaves, is_closed()},
                                                       Reason::not_baked)};
}

std::uint32_t Model::triangle_count() const noexcept {
    return state_->header->triangle_count;
}
std::uint32_t Model::vertex_count() const noexcept {
    return state_->header->vertex_count;
}
const format::FileHeader& Model::header() const noexcept {
    return *state_->header;
}
SectionSet Model::sections() const noexcept {
    return state_->sections;
}
std::span<const Float3> Model::positions_f32() const noexcept {
    return state_->positions_f32;
}
std::span<const Double3> Model::positions_f64() const noexcept {
    return state_->positions_f64;
}
std::span<const format::Triangle> Model::triangles() const noexcept {
    return state_->triangles;
}
std::span<const std::uint32_t> Model::source_triangle() const noexcept {
    return state_->source_triangle;
}
std::span<const std::uint32_t> Model::source_vertex() const noexcept {
    return state_->source_vertex;
}
std::span<const std::uint32_t> Model::source_face() const noexcept {
    return state_->source_face;
}
std::span<const format::BvhNode> Model::nodes() const noexcept {
    return state_->nodes;
}
std::span<const format::BvhLeaf> Model::leaves() const noexcept {
    return state_->leaves;
}
bool Model::has_exact_leaves() const noexcept {
    return state_->has_exact_leaves();
}
std::span<const format::OrientedNode> Model::oriented_nodes() const noexcept {
    return state_->oriented_nodes;
}
std::span<const format::SweptNode> Model::swept_nodes() const noexcept {
    return state_->swept_nodes;
}
std::span<const std::uint64_t> Model::degenerate_bits() const noexcept {
    return state_->degenerate_bits;
}
std::span<const format::Component> Model::components() const noexcept {
    return state_->components;
}
std::span<const format::Instance> Model::instances() const noexcept {
    return state_->instances;
}
std::span<const format::NamedRun> Model::group_runs() const noexcept {
    return state_->group_runs;
}
std::span<const format::NamedRun> Model::material_runs() const noexcept {
    return state_->material_runs;
}
const format::Bounds* Model::bounds() const noexcept {
    return only(state_->bounds);
}
const format::MassProperties* Model::mass_properties() const noexcept {
    return only(state_->mass_properties);
}
std::string_view Model::provenance() const noexcept {
    return {state_->provenance.data(), state_->provenance.size()};
}
std::string_view Model::findings() const noexcept {
    return {state_->findings.data(), state_->findings.size()};
}
std::span<const std::uint32_t> Model::repaired_from() const noexcept {
    return state_->repaired_from;
}
std::span<const format::Verdict> Model::verdicts() const noexcept {
    return state_->verdicts;
}
const format::BvhShape& Model::shape() const noexcept {
    return state_->shape;
}
bool Model::is_closed() const noexcept {
    return (state_->header->flags & format::model_closed) != 0;
}

const format::OctreeGrid* Model::octree_grid() const noexcept {
    return only(state_->octree_grid);
}
const format::AdaptiveOctree* Model::adaptive_octree() const noexcept {
    return only(state_->adaptive_octree);
}
const format::TetraTree* Model::tetra_tree() const noexcept {
    return only(state_->tetra_tree);
}
std::span<const format::OctreeNode> Model::octree_nodes() const noexcept {
    return state_->octree_nodes;
}
std::span<const std::uint32_t> Model::octree_references() const noexcept {
    return state_->octree_references;
}
std::span<const std::uint64_t> Model::octree_leaf_codes() const noexcept {
    return state_->octree_leaf_codes;
}
std::span<const std::uint32_t> Model::octree_leaf_nodes() const noexcept {
    return state_->octree_leaf_nodes;
}
std::span<const std::uint32_t> Model::octree_top() const noexcept {
    return state_->octree_top;
}
std::span<const std::uint32_t> Model::octree_modulus_table() const noexcept {
    return state_->octree_modulus_table;
}
std::span<const std::uint32_t> Model::octree_mixed_table() const noexcept {
    return state_->octree_mixed_table;
}
std::span<const format::AdaptiveOctreeNode> Model::adaptive_octree_nodes() const noexcept {
    return state_->adaptive_octree_nodes;
}
std::span<const std::uint32_t> Model::adaptive_octree_references() const noexcept {
    return state_->adaptive_octree_references;
}
std::span<const format::CellBox> Model::octree_boxes() const noexcept {
    return state_->octree_boxes;
}
std::span<const format::CellBox> Model::adaptive_octree_boxes() const noexcept {
    return state_->adaptive_octree_boxes;
}
std::span<const format::TetraNode> Model::tetra_nodes() const noexcept {
    return state_->tetra_nodes;
}
std::span<const std::uint32_t> Model::tetra_references() const noexcept {
    return state_->tetra_references;
}
std::span<const std::uint32_t> Model::tetra_top() const noexcept {
    return state_->tetra_top;
}
std::span<const format::BvhNode> Model::tetra_boxes() const noexcept {
    return state_->tetra_boxes;
}
std::span<const format::OrientedNode> Model::tetra_oriented() const noexcept {
    return state_->tetra_oriented;
}
std::span<const format::Hull> Model::hulls() const noexcept {
    return state_->hulls;
}
std::span<const format::HullBlock> Model::hull_blocks() const noexcept {
    return state_->hull_blocks;
}
std::span<const std::uint32_t> Model::hull_vertices() const noexcept {
    return state_->hull_vertices;
}
std::span<const format::HullFacet> Model::hull_facets() const noexcept {
    return state_->hull_facets;
}
std::span<const format::HullGroup> Model::hull_groups() const noexcept {
    return state_->hull_groups;
}
std::span<const std::uint32_t> Model::hull_neighbours() const noexcept {
    return state_->hull_neighbours;
}
std::span<const std::uint32_t> Model::hull_starts() const noexcept {
    return state_->hull_starts;
}
std::span<const format::Piece> Model::pieces() const noexcept {
    return state_->pieces;
}
std::span<const std::uint32_t> Model::piece_triangles() const noexcept {
    return state_->piece_triangles;
}
std::span<const std::uint32_t> Model::piece_vertices() const noexcept {
    return state_->piece_vertices;
}
std::span<const format::PieceFacet> Model::piece_facets() const noexcept {
    return state_->piece_facets;
}
std::span<const format::BvhNode> Model::piece_nodes() const noexcept {
    return state_->piece_nodes;
}
std::span<const format::SweptNode> Model::piece_swept() const noexcept {
    return state_->piece_swept;
}
std::span<const format::PieceLeaf> Model::piece_leaves() const noexcept {
    return state_->piece_leaves;
}
std::span<const format::PieceNodeHull> Model::piece_node_hulls() const noexcept {
    return state_->piece_node_hulls;
}
std::span<const format::PieceAdjacency> Model::piece_adjacency() const noexcept {
    return state_->piece_adjacency;
}
std::span<const std::uint8_t> Model::edge_convexity() const noexcept {
    return state_->edge_convexity;
}
std::span<const std::uint32_t> Model::triangle_piece() const noexcept {
    return state_->triangle_piece;
}

std::string_view Model::name(SectionId names, std::uint32_t index) const noexcept {
    std::span<const char> text;
    if (names == SectionId::instance_names) text = state_->instance_names;
    if (names == SectionId::group_names) text = state_->group_names;
    if (names == SectionId::material_names) text = state_->material_names;
    std::string_view rest(text.data(), text.size());
    for (std::uint32_t i = 0; !rest.empty(); ++i) {
        const std::size_t end = rest.find('\0');
        if (i == index) return rest.substr(0, end);
        if (end == std::string_view::npos) break;
        rest.remove_prefix(end + 1);
    }
    return {};
}

}  // namespace cdprep
