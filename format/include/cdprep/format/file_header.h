// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "cdprep/format/geometry.h"
#include "cdprep/format/limits.h"

namespace cdprep::format {

/// First bytes of a finished bake. The writer stores them last. 0x93 and the
/// line ends catch transfers in text mode.
inline constexpr std::array<char, 8> kMagic = {'\x93', 'C', 'D', 'P', '\r', '\n', '\x1a', '\n'};

/// Raised whenever an older reader would misread a newer file.
inline constexpr std::uint32_t kVersion = 1;

inline constexpr std::uint32_t kEndianMark = 0x01020304;    ///< as the writer's processor stores it
inline constexpr double kIeeeCheck = 0x1.5bf0a8b145769p+1;  ///< e: proves IEEE 754 doubles

inline constexpr std::uint64_t kUserBlockSize = 4096;   ///< HDF5 starts here
inline constexpr std::uint64_t kSectionAlignment = 64;  ///< one cache line
inline constexpr std::uint64_t kPageAlignment = 4096;   ///< of sections of kPageThreshold and more
inline constexpr std::uint64_t kPageThreshold = 65536;  ///< bytes

/// What a section holds. Numbers are never reused, not even for retired ids.
/// Element types are in geometry.h; names in brackets are those of the HDF5
/// datasets.
enum class SectionId : std::uint32_t {
    positions_f32 = 1,     ///< Float3 per vertex, in order of first use by the tree order
    positions_f64 = 2,     ///< Double3 per vertex, instead of positions_f32
    triangles = 3,         ///< Triangle per triangle, in tree order
    source_triangle = 4,   ///< uint32 per triangle: its number in the imported file
    source_vertex = 5,     ///< uint32 per vertex: lowest number of those welded into it
    source_face = 6,       ///< uint32 per source triangle: face within its instance; absent when
                           ///< every face is a triangle
    bvh_nodes = 7,         ///< BvhNode, root first
    degenerate_bits = 8,   ///< uint64: bit i of the array is set when triangle i of the tree order
                           ///< has collinear corners; absent when none has
    components = 9,        ///< Component per connected component
    bounds = 10,           ///< Bounds, one
    mass_properties = 11,  ///< MassProperties, one; absent unless the model is closed
    instances = 12,        ///< Instance per node and mesh
    instance_names = 13,   ///< uint8: UTF-8, each name ended by a zero byte
    group_runs = 14,       ///< NamedRun
    group_names = 15,      ///< uint8, as instance_names
    material_runs = 16,    ///< NamedRun
    material_names = 17,   ///< uint8, as instance_names
    provenance = 18,       ///< uint8: canonical JSON, UTF-8: versions, options, source hash
    bvh_leaves = 19,       ///< BvhLeaf per leaf
    oriented_nodes = 20,   ///< OrientedNode per BvhNode
    swept_nodes = 21,      ///< SweptNode per BvhNode
    verdicts = 22,         ///< Verdict of the whole mesh, then one per component
    findings = 23,         ///< uint8: JSON, UTF-8: what was found wrong, and what was mended
    repaired_from = 24,    ///< uint32 per source triangle: its number in the imported file before
                           ///< it was repaired, or kMadeByRepair; absent when it was not
    octree_grid = 25,      ///< OctreeGrid, one; sections 25 to 32 are in octree.h
    octree_nodes = 26,     ///< OctreeNode, sorted by key
    octree_references = 27,      ///< uint32: a triangle, tree order, and kSharedReference; a leaf's
                                 ///< rise
    octree_leaf_codes = 28,      ///< uint64 per leaf, rising: its key without the leading one,
                                 ///< shifted up to 21 levels
    octree_leaf_nodes = 29,      ///< uint32 per leaf: number of its OctreeNode
    octree_top = 30,             ///< uint32: for each cell of level top_level, along the z curve,
                                 ///< the number of leaves before it; then of all
    octree_modulus_table = 31,   ///< uint32: 2^slot_bits first nodes, then a next node per node,
                                 ///< each plus one, 0 ends a chain; slot: key modulo 2^slot_bits
    octree_mixed_table = 32,     ///< the same; slot: the upper bits of the key times kKeyMixer
    adaptive_octree = 33,        ///< AdaptiveOctree, one
    adaptive_octree_nodes = 34,  ///< AdaptiveOctreeNode, root first
    adaptive_octree_references = 35,  ///< as octree_references
    tetra_tree = 36,                  ///< TetraTree, one
    tetra_nodes = 37,                 ///< TetraNode, sorted by key
    tetra_references = 38,            ///< as octree_references
    tetra_top = 39,     ///< uint32 per cone of level top_level, by key: the node in which the
                        ///< search for a direction in it goes on, plus one; 0 where none is
    tetra_boxes = 40,   ///< BvhNode: boxes of tetra_nodes, each twice (tetra_tree.h); with
                        ///< TetraBounding::boxes alone
    octree_boxes = 41,  ///< CellBox per OctreeNode; some files have none
    adaptive_octree_boxes = 42,  ///< CellBox per AdaptiveOctreeNode; some files have none
    tetra_oriented = 43,         ///< OrientedNode: beside tetra_boxes
    hulls = 44,  ///< Hull, sorted by scope, then number; sections 44 to 49 and 60 are in hulls.h
    hull_blocks = 45,      ///< HullBlock: points of hulls
    hull_vertices = 46,    ///< uint32 per lane of hull_blocks: the point's number in the imported
                           ///< file, as in source_vertex, or kNoVertex
    hull_facets = 47,      ///< HullFacet
    hull_groups = 48,      ///< HullGroup
    hull_neighbours = 49,  ///< uint32: of each larger hull where the neighbours of each point
                           ///< begin, and where the last end; then those
    hull_starts = 60,  ///< uint32: of each larger hull, per cell of directions, a point far in it
    pieces = 50,       ///< Piece, in the order of their lowest triangle; sections 50 to 53
                       ///< are in pieces.h
    piece_triangles = 51,   ///< uint32 per triangle: a triangle, tree order; by piece, rising
    piece_vertices = 52,    ///< uint32: vertices that are corners of hulls; by piece, rising
    piece_facets = 53,      ///< PieceFacet, by piece
    piece_nodes = 54,       ///< BvhNode: boxes of the hierarchy over pieces, root first
    piece_leaves = 55,      ///< PieceLeaf
    piece_swept = 61,       ///< SweptNode per BvhNode of piece_nodes: rectangles
    piece_node_hulls = 56,  ///< PieceNodeHull per node above the lowest level, and of the root
    piece_adjacency = 57,   ///< PieceAdjacency per PieceFacet
    edge_convexity = 58,    ///< uint8 per triangle, tree order: edge_convexity() of pieces.h
    triangle_piece = 59,    ///< uint32 per triangle, tree order: the Piece it is in
};

/// In repaired_from and source_vertex: made by a repair, from nothing in the file.
inline constexpr std::uint32_t kMadeByRepair = 0xffffffffU;

/// Where a section lies.
struct SectionEntry {
    SectionId id;
    std::uint32_t element_size;  ///< bytes; redundant, so that a mismatch is caught early
    std::uint64_t offset;        ///< from the start of the file; kSectionAlignment; 0 when empty
    std::uint64_t count;         ///< elements, not bytes
    std::uint64_t checksum;      ///< checksum() of the section's bytes
};

/// Bits of FileHeader::flags.
enum ModelFlags : std::uint32_t {
    model_closed = 1,        ///< the oriented uses of every edge cancel: winding numbers are exact
    model_normalized = 2,    ///< baked with --normalize
    model_exact_leaves = 4,  ///< bvh_leaves hold model coordinates without loss
    model_swept_lines = 8,   ///< swept_nodes hold lines; without this and the next: points
    model_swept_rectangles = 16,  ///< swept_nodes hold rectangles
};

/// What the swept_nodes of a model with these flags hold.
[[nodiscard]] constexpr SweptKind swept_kind(std::uint32_t flags) noexcept {
    if ((flags & model_swept_rectangles) != 0) return SweptKind::rectangle;
    return (flags & model_swept_lines) != 0 ? SweptKind::line : SweptKind::point;
}

/// The flags that say so.
[[nodiscard]] constexpr std::uint32_t swept_flags(SweptKind kind) noexcept {
    if (kind == SweptKind::rectangle) return model_swept_rectangles;
    return kind == SweptKind::line ? model_swept_lines : 0U;
}

/// Direction that the imported file calls up. Data only: nothing is turned.
enum class UpAxis : std::uint32_t { unknown = 0, x = 1, y = 2, z = 3 };

/// The start of the file. The section table follows at byte 256.
///
/// The frame maps model coordinates to those of the hierarchy's boxes:
/// (x - frame_origin) * 2^frame_exponent, which lie in [-1, 1].
struct FileHeader {
    std::array<char, 8> magic;  ///< kMagic
    std::uint32_t version;      ///< kVersion
    std::uint32_t endian_mark;  ///< kEndianMark
    double ieee_check;          ///< kIeeeCheck
    std::uint64_t file_size;    ///< bytes, HDF5 part included
    /// checksum() of the user block with this field zero.
    std::uint64_t header_checksum;
    /// Of the sections' ids, sizes, counts and checksums and of the header's
    /// facts about the model: same input, options and tool version, same hash.
    std::uint64_t content_hash;
    /// Bytes 8 to 47 of the HDF5 superblock. A tool that rewrites the file moves
    /// the sections but copies this block; then these no longer match.
    std::array<std::uint8_t, 40> superblock;
    std::uint32_t section_count;
    std::uint32_t required_features;  ///< a reader refuses bits that it does not know; now 0
    std::uint32_t vertex_count;
    std::uint32_t triangle_count;
    std::uint32_t flags;  ///< ModelFlags
    UpAxis up_axis;
    double metres_per_unit;       ///< length of one model unit; 0 when the file does not say
    Double3 frame_origin;         ///< model units
    std::int32_t frame_exponent;  ///< of two
    std::uint32_t reserved0;      ///< zero
    /// With model_normalized: model = (source - offset) * factor.
    Double3 normalize_offset;
    double normalize_factor;                ///< 1 / diagonal
    std::array<std::uint8_t, 72> reserved;  ///< zero; readers ignore it
};

inline constexpr std::uint64_t kSectionTableOffset = 256;

static_assert(sizeof(SectionEntry) == 32 && alignof(SectionEntry) == 8);
static_assert(offsetof(SectionEntry, offset) == 8);
static_assert(offsetof(SectionEntry, checksum) == 24);

static_assert(sizeof(FileHeader) == 256 && alignof(FileHeader) == 8);
static_assert(offsetof(FileHeader, ieee_check) == 16);
static_assert(offsetof(FileHeader, superblock) == 48);
static_assert(offsetof(FileHeader, section_count) == 88);
static_assert(offsetof(FileHeader, metres_per_unit) == 112);
static_assert(offsetof(FileHeader, frame_exponent) == 144);
static_assert(offsetof(FileHeader, normalize_offset) == 152);
static_assert(offsetof(FileHeader, reserved) == 184);
static_assert(kSectionTableOffset + kMaxSections * sizeof(SectionEntry) <= kUserBlockSize);
static_assert(std::is_trivially_copyable_v<FileHeader> && std::is_standard_layout_v<FileHeader>);

}  // namespace cdprep::format
