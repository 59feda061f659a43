// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "cdprep/format/api.h"
#include "cdprep/format/section_set.h"

namespace cdprep::format {

/// The kind of damage in a file. "found" and "limit" are the fields of Damage. Numbers are never
/// reused.
enum class DamageKind : std::uint32_t {
    too_short = 1,         ///< found: bytes of the file; limit: bytes needed
    bad_magic = 2,         ///< not a baked file, or an unfinished one
    bad_version = 3,       ///< found: the version; limit: kVersion
    bad_byte_order = 4,    ///< written on a machine with another byte order or float format
    bad_file_size = 5,     ///< found: bytes of the file; limit: the size that the header states
    bad_header = 6,        ///< the header's checksum does not match, or a field is out of range
    rewritten = 7,         ///< the HDF5 superblock does not match the header
    unknown_feature = 8,   ///< found: feature bits; limit: those that this version knows
    bad_section = 9,       ///< a section is present but must not be, is misaligned or out of
                           ///< order, or has a wrong element size. Or it ends past the file's end,
                           ///< overlaps another one or the user block, or is empty with an offset.
    missing_section = 10,  ///< a section that another one requires is missing
    bad_checksum = 11,     ///< found: checksum of the bytes; limit: the one in the table
    bad_count = 12,        ///< found: elements; limit: the number that the other facts require
    bad_index = 13,        ///< found: index, level, enumerator or flags; limit: the largest allowed
    bad_number = 14,       ///< a number is not finite, or is out of range
    bad_order = 15,        ///< runs, nodes or lists out of sequence, links that contradict each
                           ///< other, or names that do not end with a zero
    bad_box = 16,          ///< deep check: a box does not contain what lies below it. Safety check:
                           ///< a box of a BVH or an octree has lower > upper or leaves the frame.
                           ///< Or a split point lies outside its node's box, divides no axis, or is
                           ///< not zero in a leaf.
    bad_fact = 17,         ///< deep check: a recorded fact is false (corner, bounds, hash, number)
};

/// One case of damage: its place, the number found and the number allowed.
struct Damage {
    DamageKind kind;
    SectionId section;    ///< 0 if the damage concerns no section
    std::uint64_t at;     ///< offset in the file, in bytes
    std::uint64_t found;  ///< see DamageKind
    std::uint64_t limit;  ///< see DamageKind, inclusive
};

/// Returns the damage for an element that contradicts the geometry: DamageKind::bad_fact at element
/// `index` of a section. Damage::at is 0 if the file lacks the section. `file` must have passed
/// find_header_damage().
[[nodiscard]] CDPREP_API Damage wrong_fact(std::span<const std::byte> file, SectionId section,
                                           std::uint64_t index, std::uint64_t found,
                                           std::uint64_t expected) noexcept;

/// Returns a message for people: the file, the damage and the next step. For most kinds of damage,
/// it also states the number found and the number allowed.
[[nodiscard]] CDPREP_API std::string damage_sentence(std::string_view file, const Damage& damage);

/// Checks only the header, the section table and the 40 superblock bytes that the header repeats.
/// Every section must lie inside the file and overlap no other. Returns nothing if no damage is
/// found. Reads 4,144 bytes. This check is sufficient if the file is trusted. Never allocates,
/// never throws.
[[nodiscard]] CDPREP_API std::optional<Damage> find_header_damage(
    std::span<const std::byte> file) noexcept;

/// Proves that a file is safe to query. Runs find_header_damage(). Then checks each present section
/// in `wanted`: its checksum, its element count, every coordinate, and every index that queries
/// follow. Numbers in the imported file, such as source_vertex, are not checked. Vertex coordinates
/// must be finite and at most kMaxCoordinate in absolute value. Aligned boxes must lie in the
/// frame. A section that a present one requires must be present too, wanted or not. The one
/// exception: missing boxes of a tetra-tree are found only if the tetra-tree is wanted. Returns
/// nothing if no damage is found.
///
/// Sections outside `wanted` are not read. Sections that depend on each other are checked together,
/// such as an octree's tables, nodes, grid and references. A section is not proven safe if `wanted`
/// lacks one on which it depends. Usually, only its checksum is then checked.
///
/// Safe means that no query reads outside the file or runs forever. To check that the content is
/// also *right*, call find_deep_damage(). find_damage() takes O(bytes) time and never allocates.
[[nodiscard]] CDPREP_API std::optional<Damage> find_damage(
    std::span<const std::byte> file, SectionSet wanted = SectionSet::all()) noexcept;

/// Runs find_damage(), then checks the facts below. Returns nothing if no damage is found.
///
/// The bounds in the BVHs contain what lies below them. Aligned boxes are checked in exact
/// arithmetic, oriented boxes and swept spheres in double precision. The tree order is a
/// permutation of the source triangles. If there are pieces, each triangle belongs to one piece,
/// and to one leaf of their BVH. Every triangle with a repeated corner is marked in
/// degenerate_bits. The model's aligned bounds contain every vertex. The content of bvh_leaves and
/// the content hash are right.
///
/// Other facts, such as octrees and hulls, are checked by `cdprep info --deep`. Copies the sections
/// that it compares. Takes O(bytes * levels of the BVH) time.
[[nodiscard]] CDPREP_API std::optional<Damage> find_deep_damage(std::span<const std::byte> file);

}  // namespace cdprep::format
