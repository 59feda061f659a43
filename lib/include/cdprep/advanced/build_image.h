// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/format/api.h"
#include "cdprep/format/file_header.h"
#include "cdprep/format/limits.h"
#include "cdprep/result.h"

namespace cdprep::build {

/// One section of a model: its elements, laid out as in a file or in memory.
struct Section {
    format::SectionId id;
    std::span<const std::byte> bytes;  ///< a whole number of elements; may be empty
};

/// The sections of a model and their table, sorted by id.
struct SectionTable {
    std::uint32_t count = 0;
    std::array<Section, format::kMaxSections> sections{};
    /// One entry for each section. Offsets and checksums are zero until they are set.
    std::array<format::SectionEntry, format::kMaxSections> entries{};

    [[nodiscard]] std::span<const format::SectionEntry> used_entries() const noexcept {
        return {entries.data(), count};
    }
};

/// Returns the table of `sections`, which may have any order. Fails with `bad_argument` if an id is
/// unknown or occurs twice. Also fails if the bytes of a section are not a whole number of
/// elements. Does not read the bytes of the sections. Takes O(n log n) time in the number of
/// sections. Allocates only on failure.
[[nodiscard]] CDPREP_API Result<SectionTable> make_section_table(std::span<const Section> sections);

/// Sets the checksums in a table. Reads every byte of the sections once.
CDPREP_API void add_checksums(SectionTable& table) noexcept;

inline constexpr std::uint64_t kLargestAlignment = std::uint64_t{1} << 30;

struct ImageOptions {
    /// Sections start at multiples of this power of two, from format::kSectionAlignment to
    /// kLargestAlignment. Sections of format::kPageThreshold bytes and more always start at page
    /// boundaries.
    std::uint64_t section_alignment = format::kSectionAlignment;
};

/// Returns the number of bytes that build_image() fills, a multiple of format::kSectionAlignment.
/// Fails if build_image() would fail on these sections or options. Does not read the bytes of the
/// sections. Allocates only on failure.
[[nodiscard]] CDPREP_API Result<std::size_t> image_size(std::span<const Section> sections,
                                                        const ImageOptions& options = {});

/// Writes a model into memory: header, section table with checksums, sections, and zeros between
/// them. The result is like the file of `cdprep bake`, but without HDF5: the superblock is zero.
/// Facts, content hash, sections and section table are the same, except for the offsets in the
/// table. Model::open() accepts these bytes like those of a file.
///
/// Returns the first image_size() bytes of `memory`. The bytes after them are not changed.
///
/// `facts` supplies the header fields that describe the model: counts, flags, units, frame and
/// normalisation. The function copies FileHeader::required_features and the reserved bytes too;
/// leave them zero. It fills in the other fields. Model::open() checks that facts and sections
/// agree. The sections must not overlap `memory`.
///
/// Fails with `bad_argument`, and then writes nothing, if make_section_table() fails or
/// options.section_alignment is not allowed. Also fails if `memory` is too small or does not start
/// at a multiple of format::kSectionAlignment. Allocates only on failure. Takes O(bytes) time: each
/// byte is read once for its checksum and copied once.
///
///     const auto size = build::image_size(sections);
///     if (!size) return size.error();
///     std::span<std::byte> room = arena.allocate(size.value(), format::kSectionAlignment);
///     const auto image = build::build_image(facts, sections, room);
///     if (!image) return image.error();
///     const auto model = Model::open(image.value());
[[nodiscard]] CDPREP_API Result<std::span<std::byte>> build_image(const format::FileHeader& facts,
                                                                  std::span<const Section> sections,
                                                                  std::span<std::byte> memory,
                                                                  const ImageOptions& options = {});

}  // namespace cdprep::build
