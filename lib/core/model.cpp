// SPDX-License-Identifier: MIT
#include "cdprep/model.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "cdprep/format/find_damage.h"
#include "cdprep/format/sections.h"
#ifndef __wasi__
#include "core/mapped_file.h"
#endif
#include "core/refusal_sentence.h"

namespace cdprep {

namespace {

/// Few files have cells, so these views are allocated separately.
struct CellViews {
    OctreeView octree;
    AdaptiveOctreeView adaptive_octree;
    TetraTreeView tetra_tree;
};

const CellViews kNoCells;

}  // namespace

struct Model::State {
#ifndef __wasi__
    MappedFile mapping;  ///< or a copy; empty when the caller keeps the bytes
#endif
    std::string name;  ///< of the file, for messages
    std::span<const std::byte> file;
    const format::FileHeader* header = nullptr;
    SectionSet sections;
    SectionSet in_file;  ///< also sections that were not requested
    MeshView mesh;
    SourceView source;
    BvhView bvh;
    std::unique_ptr<const CellViews> cells;  ///< null: none
    HullView hulls;
    PieceView pieces;
    RecordView record;
    std::uint32_t number_bound = 0;  ///< of a model that can tear; otherwise 0
    bool is_torn = false;
    /// The end of the sentence of a refusal that no bake would help; null: a bake helps.
    const char* serves_only = nullptr;

    void find_sections(SectionSet wanted);

    /// Returns whether the leaves are exact; a model without triangles has no leaves. Reads the
    /// header, which a LiveModel changes.
    [[nodiscard]] bool is_exact() const noexcept {
        return (header->flags & format::model_exact_leaves) != 0 && header->triangle_count > 0;
    }
    [[nodiscard]] bool has_exact_leaves() const noexcept {
        return is_exact() && !bvh.leaves.empty();
    }

private:
    /// Points `span` at the section if it is wanted and present.
    template <class T>
    void view(SectionId id, SectionSet wanted, std::span<const T>& span) {
        const std::optional<format::SectionEntry> entry = format::find_section(file, id);
        if (!entry) return;
        in_file.insert(id);
        if (!wanted.contains(id)) return;
        sections.insert(id);
        // find_header_damage() has checked offset, alignment and element size.
        span = {reinterpret_cast<const T*>(file.data() + entry->offset),
                static_cast<std::size_t>(entry->count)};
    }
    /// The same for a section of at most one element.
    template <class T>
    void view(SectionId id, SectionSet wanted, const T*& element) {
        std::span<const T> span;
        view(id, wanted, span);
        if (!span.empty()) element = span.data();
    }
    /// The same for text.
    void view(SectionId id, SectionSet wanted, std::string_view& text) {
        std::span<const char> span;
        view(id, wanted, span);
        text = {span.data(), span.size()};
    }
};

void Model::State::find_sections(SectionSet wanted) {
    header = reinterpret_cast<const format::FileHeader*>(file.data());
    CellViews of_cells;
    bvh.shape = format::bvh_shape(header->triangle_count);
#define CDPREP_MESH_SECTION(member, name, ...) view(SectionId::name, wanted, mesh.member);
#define CDPREP_SOURCE_SECTION(member, name, ...) view(SectionId::name, wanted, source.member);
#define CDPREP_BVH_SECTION(member, name, ...) view(SectionId::name, wanted, bvh.member);
#define CDPREP_OCTREE_SECTION(member, name, ...) \
    view(SectionId::name, wanted, of_cells.octree.member);
#define CDPREP_ADAPTIVE_OCTREE_SECTION(member, name, ...) \
    view(SectionId::name, wanted, of_cells.adaptive_octree.member);
#define CDPREP_TETRA_TREE_SECTION(member, name, ...) \
    view(SectionId::name, wanted, of_cells.tetra_tree.member);
#define CDPREP_HULL_SECTION(member, name, ...) view(SectionId::name, wanted, hulls.member);
#define CDPREP_PIECE_SECTION(member, name, ...) view(SectionId::name, wanted, pieces.member);
#define CDPREP_RECORD_SECTION(member, name, ...) view(SectionId::name, wanted, record.member);
#include "cdprep/format/section_table.inc"
    bool has_cells = false;
#define CDPREP_OCTREE_SECTION(member, name, ...) has_cells |= sections.contains(SectionId::name);
#define CDPREP_ADAPTIVE_OCTREE_SECTION CDPREP_OCTREE_SECTION
#define CDPREP_TETRA_TREE_SECTION CDPREP_OCTREE_SECTION
#include "cdprep/format/section_table.inc"
    if (has_cells) cells = std::make_unique<const CellViews>(of_cells);
}

namespace {

Error damaged(std::string_view name, const format::Damage& damage) {
    return {ErrorCode::unreadable, format::damage_sentence(name, damage)};
}

}  // namespace

Model::Model(std::unique_ptr<State> state) noexcept
    : state_(std::move(state)), served_(served_by(state_->sections, state_->is_exact())) {}
Model::Model(Model&& other) noexcept
    : state_(std::move(other.state_)), served_(std::exchange(other.served_, Ask::nothing)) {}
Model& Model::operator=(Model&& other) noexcept {
    std::swap(state_, other.state_);
    std::swap(served_, other.served_);
    return *this;
}
Model::~Model() = default;

#ifndef __wasi__
Result<Model> Model::open(const std::filesystem::path& path, const OpenOptions& options) {
    const bool is_copied = options.mode == OpenMode::copy;
    Result<MappedFile> mapped = is_copied ? MappedFile::copy(path) : MappedFile::map(path);
    if (!mapped) return mapped.error();
    OpenOptions named = options;
    const std::string name = path_text(path);
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
#endif

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
                         " bytes past a multiple of " + std::to_string(format::kSectionAlignment) +
                         "; they must start at such a multiple."};
    }
    const SectionSet unless_said = options.asks == Ask::nothing ? SectionSet::all() : SectionSet{};
    SectionSet wanted = options.sections.value_or(unless_said);
    wanted.insert(sections_for(options.asks));
    // Without it, queries would not skip degenerate triangles. It is small, and absent if empty.
    if (wanted.contains(SectionId::bvh_nodes) || wanted.contains(SectionId::triangles)) {
        wanted.insert(SectionId::degenerate_bits);
    }
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

#ifndef __wasi__
Result<Model> Model::open_trusted(const std::filesystem::path& path) {
    Result<MappedFile> mapped = MappedFile::map(path);
    if (!mapped) return mapped.error();
    auto state = std::make_unique<State>();
    state->mapping = std::move(mapped).value();
    state->file = state->mapping.bytes();
    state->name = path_text(path);
    if (const auto damage = format::find_header_damage(state->file)) {
        return damaged(path_text(path), *damage);
    }
    state->find_sections(SectionSet::all());
    return Model(std::move(state));
}
#endif

std::optional<Refusal> Model::refusal(Ask asks) const {
    if (serves(asks)) return std::nullopt;
    using Reason = Refusal::Reason;
    if (state_ == nullptr) {
        return Refusal{Reason::not_opened, "The model was moved from: it answers no query."};
    }
    if (state_->serves_only != nullptr) {
        return Refusal{Reason::not_baked, state_->name + ": " + state_->serves_only};
    }
    const bool exact_leaves = state_->is_exact();
    const Ask refused = without(asks, served_);
    const Ask missing = without(refused, served_by(state_->in_file, exact_leaves));
    if (missing == Ask::nothing) {
        return Refusal{
            Reason::not_opened,
            refusal_sentence(state_->name, refused, {state_->sections, exact_leaves, is_balanced()},
                             Reason::not_opened)};
    }
    return Refusal{
        Reason::not_baked,
        refusal_sentence(state_->name, missing, {state_->in_file, exact_leaves, is_balanced()},
                         Reason::not_baked)};
}

std::uint32_t Model::triangle_count() const noexcept {
    return state_->header->triangle_count;
}
std::uint32_t Model::triangle_number_bound() const noexcept {
    return state_->bvh.lanes.empty() ? triangle_count() : state_->number_bound;
}
std::uint32_t Model::vertex_count() const noexcept {
    return state_->header->vertex_count;
}
const format::FileHeader& Model::header() const noexcept {
    return *state_->header;
}
std::span<const std::byte> Model::bytes() const noexcept {
    return state_->file;
}
SectionSet Model::sections() const noexcept {
    return state_->sections;
}
std::size_t Model::touch(SectionSet wanted) const noexcept {
    std::size_t touched = 0;
    const auto read = [](const std::byte& byte) {
        static_cast<void>(*static_cast<const volatile std::byte*>(&byte));
    };
    for (std::uint32_t number = 0; number < 64; ++number) {
        const SectionId id{number};
        if (!wanted.contains(id) || !state_->sections.contains(id)) continue;
        const std::optional<format::SectionEntry> entry = format::find_section(state_->file, id);
        if (!entry || entry->count == 0) continue;
        const auto bytes =
            state_->file.subspan(static_cast<std::size_t>(entry->offset),
                                 static_cast<std::size_t>(entry->count * entry->element_size));
        for (std::size_t i = 0; i < bytes.size(); i += format::kPageAlignment) read(bytes[i]);
        read(bytes.back());
        touched += bytes.size();
    }
    return touched;
}
std::size_t Model::touch(Ask asks) const noexcept {
    return touch(sections_for(asks));
}
const MeshView& Model::mesh() const noexcept {
    return state_->mesh;
}
const SourceView& Model::source() const noexcept {
    return state_->source;
}
const BvhView& Model::bvh() const noexcept {
    return state_->bvh;
}
const OctreeView& Model::octree() const noexcept {
    return state_->cells ? state_->cells->octree : kNoCells.octree;
}
const AdaptiveOctreeView& Model::adaptive_octree() const noexcept {
    return state_->cells ? state_->cells->adaptive_octree : kNoCells.adaptive_octree;
}
const TetraTreeView& Model::tetra_tree() const noexcept {
    return state_->cells ? state_->cells->tetra_tree : kNoCells.tetra_tree;
}
const HullView& Model::hulls() const noexcept {
    return state_->hulls;
}
const PieceView& Model::pieces() const noexcept {
    return state_->pieces;
}
const RecordView& Model::record() const noexcept {
    return state_->record;
}
bool Model::has_exact_leaves() const noexcept {
    return state_->has_exact_leaves();
}
bool Model::is_torn() const noexcept {
    return state_->is_torn;
}
void Model::set_lanes(std::span<const std::uint8_t> lanes,
                      std::uint32_t triangle_number_bound) noexcept {
    state_->bvh.lanes = lanes;
    state_->number_bound = triangle_number_bound;
}
void Model::set_torn(std::uint32_t triangle_number_bound) noexcept {
    state_->is_torn = true;
    state_->number_bound = triangle_number_bound;
}
void Model::set_part(Ask asks) noexcept {
    state_->serves_only =
        "a window holds a part of a surface, and serves only collide, overlap, distance, within, "
        "ray, closest and touch.";
    served_ = served_ & asks;
}
void Model::set_live() noexcept {
    state_->serves_only =
        "a live model serves no query that needs pieces, hulls, octrees or tetra-trees.";
}
void Model::set_leaves(std::uint32_t count, std::span<const format::Double3> positions,
                       std::span<const format::Triangle> triangles,
                       std::span<const format::OrientedNode> oriented) noexcept {
    state_->bvh.shape = format::bvh_shape(count * format::kBvhWidth);
    state_->mesh.positions_f64 = positions;
    state_->mesh.triangles = triangles;
    state_->bvh.oriented = oriented;
}
bool Model::is_balanced() const noexcept {
    return (state_->header->flags & format::model_balanced) != 0 && !is_torn();
}

std::string_view Model::name(SectionId names, std::uint32_t index) const noexcept {
    std::string_view rest;
    if (names == SectionId::instance_names) rest = state_->source.instance_names;
    if (names == SectionId::group_names) rest = state_->source.group_names;
    if (names == SectionId::material_names) rest = state_->source.material_names;
    for (std::uint32_t i = 0; !rest.empty(); ++i) {
        const std::size_t end = rest.find('\0');
        if (i == index) return rest.substr(0, end);
        if (end == std::string_view::npos) break;
        rest.remove_prefix(end + 1);
    }
    return {};
}

}  // namespace cdprep
