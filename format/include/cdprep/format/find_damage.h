// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "cdprep/format/section_set.h"

namespace cdprep::format {

/// What is wrong with a file. Numbers are never reused.
enum class DamageKind : std::uint32_t {
    too_short = 1,         ///< found bytes, limit needed
    bad_magic = 2,         ///< not a bake, or one that was not finished
    bad_version = 3,       ///< found version, limit kVersion
    bad_byte_order = 4,    ///< written on a machine of other endianness or float format
    bad_file_size = 5,     ///< found bytes, limit the size that the header states
    bad_header = 6,        ///< header checksum does not match, or a field outside its range
    rewritten = 7,         ///< the HDF5 superblock is not the one that the table belongs to
    unknown_feature = 8,   ///< found required feature bits that this version does not know
    bad_section = 9,       ///< entry overlaps, misaligned, past the end, or of wrong element size
    missing_section = 10,  ///< a section that the header's counts demand is not there
    bad_checksum = 11,     ///< found checksum, limit the one in the table
    bad_count = 12,        ///< found elements, limit the number that the header's counts demand
    bad_index = 13,        ///< found index, limit the largest allowed
    bad_number = 14,       ///< a coordinate is not finite or beyond kMaxCoordinate
    bad_order = 15,        ///< runs or nodes that do not follow each other, names not ended
    bad_box = 16,          ///< a box does not contain what lies below it: of stored boxes a deep
                           ///< check, of those that follow from split points an ordinary one
    bad_fact = 17,         ///< deep check: a recorded fact (flag, component, bounds) is not true
};

/// One piece of damage: where, what was found, what was allowed.
struct Damage {
    DamageKind kind;
    SectionId section;    ///< 0 when it concerns the user block
    std::uint64_t at;     ///< byte of the file
    std::uint64_t found;  ///< see DamageKind
    std::uint64_t limit;  ///< see DamageKind, inclusive
};

/// Returns the damage of an element that does not agree with the geometry: DamageKind::bad_fact at
/// element `index` of a section.
[[nodiscard]] Damage wrong_fact(std::span<const std::byte> file, SectionId section,
                                std::uint64_t index, std::uint64_t found,
                                std::uint64_t expected) noexcept;

/// Returns a sentence for people: the file, what is wrong, the number found, the number allowed,
/// and what to do next.
[[nodiscard]] std::string damage_sentence(std::string_view file, const Damage& damage);

/// Checks the user block alone: magic, version, sizes, header checksum, the
/// superblock stamp, and that every section entry lies inside the file without
/// overlapping another. Reads 4,144 bytes. Enough for bytes that are trusted.
/// Returns nothing when all is well. Never allocates, never throws.
[[nodiscard]] std::optional<Damage> find_header_damage(std::span<const std::byte> file) noexcept;

/// Proves that a file is safe to query: find_header_damage(), and, for each
/// section in `wanted` that is present, checksum, element count, every index in
/// range, every coordinate finite and at most kMaxCoordinate. Sections outside
/// `wanted` are not read. Reads each byte once, in O(bytes); never allocates.
///
/// Sections that only make sense together are proved together: an octree's tables with
/// its nodes, those with its grid and its references. What is wanted without the ones it
/// leans on has its checksum checked alone.
///
/// Safe means: no query reads outside the file or fails to end. That the
/// content is *right* is proved by find_deep_damage().
[[nodiscard]] std::optional<Damage> find_damage(std::span<const std::byte> file,
                                                SectionSet wanted = SectionSet::all()) noexcept;

/// Proves, beyond find_damage(), that boxes contain what lies below them in
/// exact arithmetic, that the tree order is a permutation of the source
/// triangles, and that degenerate bits match the geometry's repeated corners.
/// Copies the sections that it compares. O(bytes).
[[nodiscard]] std::optional<Damage> find_deep_damage(std::span<const std::byte> file);

}  // namespace cdprep::format
