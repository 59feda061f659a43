// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "cdprep/ask.h"
#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/hulls.h"
#include "cdprep/format/octree.h"
#include "cdprep/format/pieces.h"
#include "cdprep/format/section_set.h"
#include "cdprep/format/tetra_tree.h"
#include "cdprep/format/verdict.h"
#include "cdprep/result.h"

namespace cdprep {

using format::Double3;
using format::Float3;
using format::SectionId;
using format::SectionSet;

/// Where the bytes of an opened file are.
enum class OpenMode : std::uint8_t {
    /// In the file, mapped: nothing is copied, and processes share the memory. Needs a file that
    /// nobody truncates or rewrites while the Model lives; see Model.
    map,
    /// In memory that the Model owns, aligned to pages. Costs reading the whole file at opening,
    /// and its size in memory. Whatever happens to the file then, the answers stay the same. For
    /// network shares, removable media, and files that others truncate.
    copy,
};

/// How a model is opened. Only the sections that are opened are checked and read.
struct OpenOptions {
    /// What will be asked. Opening fails when the file was baked without something that this
    /// needs. Nothing: whatever the file has can be asked.
    Ask asks = Ask::nothing;
    /// The sections to open where the file has them, beside those of `asks`. Unset: those of
    /// `asks` alone, or every section when `asks` is nothing.
    std::optional<SectionSet> sections = std::nullopt;
    /// Stands for the file in messages about bytes in memory.
    std::string_view name = "memory";
    /// Of a path; bytes in memory are used where they are.
    OpenMode mode = OpenMode::map;
};

/// Why a model does not serve a question.
struct Refusal {
    enum class Reason : std::uint8_t {
        not_baked,   ///< the file lacks sections: bake it again
        not_opened,  ///< the file has them, but they were not asked for at opening
    };
    Reason reason;
    std::string message;  ///< a sentence: file, question, missing sections, what to do
};

/// A baked model, open for queries.
///
/// Opening maps the file and checks it once; nothing is decoded, and nothing copied unless
/// OpenMode::copy asks for it. Every span and every answer that refers to geometry is valid as long
/// as the Model is alive. Move-only. All const members and all queries may run on any number of
/// threads at once.
///
/// A mapped file must stay as it is while the Model lives:
/// - Replacing it by rename is safe: the Model keeps the old file, also when that has no name any
///   more. `cdprep bake` writes in this way.
/// - When it is truncated, or a network share or disk fails, touching a page that is not there
///   stops the program with SIGBUS on POSIX. Nothing can be checked beforehand.
/// - When it is rewritten in place, queries may see the new bytes, which nobody has checked:
///   answers may be wrong, and a query may read outside the file or not end.
/// Open with OpenMode::copy where others may do so.
///
/// No answer depends on the caller's floating-point environment: rounding mode, flushing of
/// subnormal numbers, unmasked exceptions. Each call computes in the default one and restores the
/// caller's (cdprep/format/float_environment.h).
///
///     auto opened = cdprep::Model::open("bracket.cdp.h5");
///     if (!opened) {
///         std::cerr << opened.error().message << '\n';
///         return 1;
///     }
///     const cdprep::Model& model = opened.value();
///     std::cout << model.triangle_count() << " triangles\n";
class Model {
public:
    /// Maps or copies `path` and checks completely the sections that `options` names; the others
    /// are not touched and give empty spans. Fails with `unreadable` when the file cannot be read,
    /// is not a finished bake, was written by an incompatible version, was rewritten by another
    /// tool, or is damaged; with `bad_argument` when it lacks sections that options.asks needs.
    /// O(bytes of the sections), at memory speed.
    [[nodiscard]] static Result<Model> open(const std::filesystem::path& path,
                                            const OpenOptions& options = {});

    /// The same with options.asks: opens the sections that `asks` needs or uses, and no others.
    ///
    ///     auto arm = cdprep::Model::open("arm.cdp.h5", cdprep::Ask::collide);
    [[nodiscard]] static Result<Model> open(const std::filesystem::path& path, Ask asks);

    /// The same with those of `wanted` that are present; whatever they serve can be asked.
    [[nodiscard]] static Result<Model> open(const std::filesystem::path& path, SectionSet wanted);

    /// The same for bytes that the caller keeps: an archive, a network buffer. They must start at
    /// a multiple of format::kSectionAlignment and stay as they are while the Model lives.
    [[nodiscard]] static Result<Model> open(std::span<const std::byte> bytes,
                                            const OpenOptions& options = {});
    [[nodiscard]] static Result<Model> open(std::span<const std::byte> bytes, SectionSet wanted);

    /// Maps `path` and checks its first 4,144 bytes alone, whatever its size. For files whose hash
    /// the caller has verified by other means: a damaged one may crash a query.
    [[nodiscard]] static Result<Model> open_trusted(const std::filesystem::path& path);

    Model(Model&&) noexcept;
    Model& operator=(Model&&) noexcept;
    ~Model();

    [[nodiscard]] std::uint32_t triangle_count() const noexcept;  ///< from the header
    [[nodiscard]] std::uint32_t vertex_count() const noexcept;    ///< from the header

    [[nodiscard]] const format::FileHeader& header() const noexcept;

    /// Sections that were asked for and are present.
    [[nodiscard]] SectionSet sections() const noexcept;

    /// What can be asked of this model, computed once at opening. A question that is not served
    /// stops the program with a sentence (precondition.h).
    [[nodiscard]] Ask asks() const noexcept {
        return served_;
    }
    /// True when all of `asks` can be asked.
    [[nodiscard]] bool serves(Ask asks) const noexcept {
        return contains(served_, asks);
    }
    /// Returns why not all of `asks` can be asked, or nothing when serves() is true. Allocates.
    [[nodiscard]] std::optional<Refusal> refusal(Ask asks) const;

    /// Raw spans, tree order where FORMAT.md says so; empty when the section is
    /// absent or was not asked for. Exactly one of the two positions is present.
    [[nodiscard]] std::span<const Float3> positions_f32() const noexcept;        ///< model units
    [[nodiscard]] std::span<const Double3> positions_f64() const noexcept;       ///< model units
    [[nodiscard]] std::span<const format::Triangle> triangles() const noexcept;  ///< tree order
    [[nodiscard]] std::span<const std::uint32_t> source_triangle() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> source_vertex() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> source_face() const noexcept;
    /// By source triangle, what it was in the file before `bake --repair` mended it, or
    /// format::kMadeByRepair; empty when nothing was repaired, and numbers are the file's.
    [[nodiscard]] std::span<const std::uint32_t> repaired_from() const noexcept;
    [[nodiscard]] std::span<const format::BvhNode> nodes() const noexcept;  ///< root first
    [[nodiscard]] std::span<const format::BvhLeaf> leaves() const noexcept;
    /// True when leaves() are there and hold model coordinates without loss.
    [[nodiscard]] bool has_exact_leaves() const noexcept;
    /// Same numbers as nodes(); empty when the model was baked without.
    [[nodiscard]] std::span<const format::OrientedNode> oriented_nodes() const noexcept;
    /// Likewise; format::swept_kind(header().flags) says what they are.
    [[nodiscard]] std::span<const format::SweptNode> swept_nodes() const noexcept;
    [[nodiscard]] std::span<const std::uint64_t> degenerate_bits() const noexcept;
    [[nodiscard]] std::span<const format::Component> components() const noexcept;
    /// What was found of the whole mesh when it was baked, then of each component, in the
    /// order of their lowest source triangle, and so what answers mean on it.
    [[nodiscard]] std::span<const format::Verdict> verdicts() const noexcept;
    [[nodiscard]] std::span<const format::Instance> instances() const noexcept;
    [[nodiscard]] std::span<const format::NamedRun> group_runs() const noexcept;
    [[nodiscard]] std::span<const format::NamedRun> material_runs() const noexcept;
    [[nodiscard]] const format::Bounds* bounds() const noexcept;                   ///< or null
    [[nodiscard]] const format::MassProperties* mass_properties() const noexcept;  ///< or null
    [[nodiscard]] std::string_view provenance() const noexcept;  ///< canonical JSON
    /// JSON: what was found wrong with the mesh, and what was mended; or empty.
    [[nodiscard]] std::string_view findings() const noexcept;

    /// The octree, its hash tables and its sorted leaves (format/octree.h); empty when baked
    /// without.
    [[nodiscard]] const format::OctreeGrid* octree_grid() const noexcept;  ///< or null
    [[nodiscard]] std::span<const format::OctreeNode> octree_nodes() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> octree_references() const noexcept;
    [[nodiscard]] std::span<const std::uint64_t> octree_leaf_codes() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> octree_leaf_nodes() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> octree_top() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> octree_modulus_table() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> octree_mixed_table() const noexcept;
    /// The octree with split points of its own (format/octree.h).
    [[nodiscard]] const format::AdaptiveOctree* adaptive_octree() const noexcept;  ///< or null
    [[nodiscard]] std::span<const format::AdaptiveOctreeNode> adaptive_octree_nodes()
        const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> adaptive_octree_references() const noexcept;
    /// Per node of either tree; empty where the file has none.
    [[nodiscard]] std::span<const format::CellBox> octree_boxes() const noexcept;
    [[nodiscard]] std::span<const format::CellBox> adaptive_octree_boxes() const noexcept;
    /// The tetra-tree (format/tetra_tree.h).
    [[nodiscard]] const format::TetraTree* tetra_tree() const noexcept;  ///< or null
    [[nodiscard]] std::span<const format::TetraNode> tetra_nodes() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> tetra_references() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> tetra_top() const noexcept;
    [[nodiscard]] std::span<const format::BvhNode> tetra_boxes() const noexcept;
    [[nodiscard]] std::span<const format::OrientedNode> tetra_oriented() const noexcept;
    /// Convex hulls (format/hulls.h; model_hulls.h finds their way about).
    [[nodiscard]] std::span<const format::Hull> hulls() const noexcept;
    [[nodiscard]] std::span<const format::HullBlock> hull_blocks() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> hull_vertices() const noexcept;
    [[nodiscard]] std::span<const format::HullFacet> hull_facets() const noexcept;
    [[nodiscard]] std::span<const format::HullGroup> hull_groups() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> hull_neighbours() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> hull_starts() const noexcept;
    /// Convex pieces of the surface and their hulls (format/pieces.h); empty when baked without.
    [[nodiscard]] std::span<const format::Piece> pieces() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> piece_triangles() const noexcept;
    [[nodiscard]] std::span<const std::uint32_t> piece_vertices() const noexcept;
    [[nodiscard]] std::span<const format::PieceFacet> piece_facets() const noexcept;
    /// The hierarchy over pieces, root first (format/pieces.h); empty when baked without.
    [[nodiscard]] std::span<const format::BvhNode> piece_nodes() const noexcept;
    [[nodiscard]] std::span<const format::SweptNode> piece_swept() const noexcept;
    [[nodiscard]] std::span<const format::PieceLeaf> piece_leaves() const noexcept;
    [[nodiscard]] std::span<const format::PieceNodeHull> piece_node_hulls() const noexcept;
    [[nodiscard]] std::span<const format::PieceAdjacency> piece_adjacency() const noexcept;
    /// Per triangle, tree order: format::edge_convexity() reads it; empty when baked without.
    [[nodiscard]] std::span<const std::uint8_t> edge_convexity() const noexcept;
    /// The piece of each triangle, tree order; empty when baked without.
    [[nodiscard]] std::span<const std::uint32_t> triangle_piece() const noexcept;

    /// Name number `index` of instance_names, group_names or material_names;
    /// empty when there is none. O(index).
    [[nodiscard]] std::string_view name(SectionId names, std::uint32_t index) const noexcept;

    /// Shape of the hierarchy, computed once at opening.
    [[nodiscard]] const format::BvhShape& shape() const noexcept;

    /// True when the oriented uses of every edge cancel: solid questions have
    /// exact answers.
    [[nodiscard]] bool is_closed() const noexcept;

private:
    struct State;
    explicit Model(std::unique_ptr<State> state) noexcept;
    [[nodiscard]] static Result<Model> from_bytes(std::span<const std::byte> bytes,
                                                  const OpenOptions& options);
    std::unique_ptr<State> state_;
    Ask served_ = Ask::nothing;
};

}  // namespace cdprep
