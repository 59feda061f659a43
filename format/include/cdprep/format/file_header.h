// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "cdprep/format/geometry.h"
#include "cdprep/format/limits.h"

namespace cdprep::format {

/// The first bytes of a finished baked file. The writer stores them last. Byte 0x93 and the line
/// ends reveal a transfer in text mode.
inline constexpr std::array<char, 8> kMagic = {'\x93', 'C', 'D', 'P', '\r', '\n', '\x1a', '\n'};

/// The format version. It increases whenever an older reader would misread a newer file.
inline constexpr std::uint32_t kVersion = 1;

inline constexpr std::uint32_t kEndianMark = 0x01020304;    ///< in the writer's byte order
inline constexpr double kIeeeCheck = 0x1.5bf0a8b145769p+1;  ///< Euler's e: proves IEEE 754 doubles

inline constexpr std::uint64_t kUserBlockSize = 4096;   ///< bytes; the HDF5 part follows
inline constexpr std::uint64_t kSectionAlignment = 64;  ///< one cache line
inline constexpr std::uint64_t kPageAlignment = 4096;   ///< for sections of kPageThreshold or more
inline constexpr std::uint64_t kPageThreshold = 65536;  ///< bytes

/// The id of a section. Each id has a row in section_table.inc, which describes the section.
/// Numbers are never reused, not even those of retired ids.
enum class SectionId : std::uint32_t {
#define CDPREP_SECTION(member, name, id, Element, count, when, serves, units, description) \
    name = (id),
#include "cdprep/format/section_table.inc"
};

/// The value in sections repaired_from and source_vertex for triangles and vertices that a repair
/// added. They have no number in the imported file.
inline constexpr std::uint32_t kMadeByRepair = 0xffffffffU;

/// An entry of the section table: the place and size of a section.
struct SectionEntry {
    SectionId id;
    std::uint32_t element_size;  ///< bytes; redundant, to catch a mismatch early
    std::uint64_t offset;        ///< in the file, a multiple of kSectionAlignment; 0 if empty
    std::uint64_t count;         ///< elements, not bytes
    std::uint64_t checksum;      ///< checksum() of the section's bytes
};

/// Bits of FileHeader::flags.
enum ModelFlags : std::uint32_t {
    model_balanced = 1,           ///< the directed uses of every edge cancel: winding numbers exist
    model_normalized = 2,         ///< baked with --normalize
    model_exact_leaves = 4,       ///< bvh_leaves hold model coordinates without loss
    model_swept_lines = 8,        ///< swept_nodes hold lines; see swept_kind()
    model_swept_rectangles = 16,  ///< swept_nodes hold rectangles
};

/// Returns the kind of swept_nodes in a model with these flags: SweptKind::point if neither
/// model_swept_lines nor model_swept_rectangles is set.
[[nodiscard]] constexpr SweptKind swept_kind(std::uint32_t flags) noexcept {
    if ((flags & model_swept_rectangles) != 0) return SweptKind::rectangle;
    return (flags & model_swept_lines) != 0 ? SweptKind::line : SweptKind::point;
}

/// Returns the bits of FileHeader::flags for this kind of swept_nodes.
[[nodiscard]] constexpr std::uint32_t swept_flags(SweptKind kind) noexcept {
    if (kind == SweptKind::rectangle) return model_swept_rectangles;
    return kind == SweptKind::line ? model_swept_lines : 0U;
}

/// The up direction of the imported file. It is only recorded: nothing is rotated.
enum class UpAxis : std::uint32_t { unknown = 0, x = 1, y = 2, z = 3 };

/// The start of the file. The section table follows at byte 256.
///
/// The frame maps model coordinates x to (x - frame_origin) * 2^frame_exponent. These are the
/// coordinates of the BVH's boxes, which lie in [-1, 1].
struct FileHeader {
    std::array<char, 8> magic;  ///< kMagic
    std::uint32_t version;      ///< kVersion
    std::uint32_t endian_mark;  ///< kEndianMark
    double ieee_check;          ///< kIeeeCheck
    std::uint64_t file_size;    ///< bytes, HDF5 part included
    /// checksum() of the user block with this field zero.
    std::uint64_t header_checksum;
    /// The result of content_hash() over the sections' ids, sizes, counts and checksums, and the
    /// header's facts about the model. The same input, options and tool version give the same hash.
    std::uint64_t content_hash;
    /// Bytes 8 to 47 of the HDF5 superblock. Other HDF5 tools that rewrite the file copy the user
    /// block, but may move the sections. This field then no longer matches the superblock. Images
    /// that build_image() makes have no HDF5 part: this field and those bytes are zero.
    std::array<std::uint8_t, 40> superblock;
    std::uint32_t section_count;
    std::uint32_t required_features;  ///< a reader refuses unknown bits; 0 in this version
    std::uint32_t vertex_count;
    std::uint32_t triangle_count;
    std::uint32_t flags;  ///< ModelFlags
    UpAxis up_axis;
    double metres_per_unit;       ///< length of one model unit; 0 if unknown or normalised
    Double3 frame_origin;         ///< model units
    std::int32_t frame_exponent;  ///< exponent of two
    std::uint32_t reserved0;      ///< zero
    /// With model_normalized: model = (source - offset) * factor, up to rounding to float. The
    /// offset is the middle of the source's bounding box, and the factor is 1 / its diagonal. The
    /// factor is 1 if 1 / diagonal is not finite. Without model_normalized, or without triangles,
    /// both are 0.
    Double3 normalize_offset;
    double normalize_factor;
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
