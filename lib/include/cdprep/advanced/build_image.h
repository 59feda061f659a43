// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/format/file_header.h"
#include "cdprep/format/limits.h"
#include "cdprep/result.h"

namespace cdprep::build {

/// One section of a model: its elements as they are to lie in a file or in memory.
struct Section {
    format::SectionId id;
    std::span<const std::byte> bytes;  ///< a whole number of elements; may be empty
};

/// The sections of a model and their table, sorted by id.
struct SectionTable {
    std::uint32_t count = 0;
    std::array<Section, format::kMaxSections> sections{};
    /// Beside the sections. Offsets are zero until somebody sets them, and so are checksums.
    std::array<format::SectionEntry, format::kMaxSections> entries{};

    [[nodiscard]] std::span<const format::SectionEntry> used_entries() const noexcept {
        return {entries.data(), count};
    }
};

/// Returns the table of sections in any order. Fails with `bad_argument` when an id is
/// unknown or given twice, and when bytes are no whole number of elements. Looks at no byte
/// of the sections. O(n log n) in the sections; allocates nothing unless it fails.
[[nodiscard]] Result<SectionTable> make_section_table(std::span<const Section> sections);

/// Sets the checksums in a table. Reads every byte of the sections once.
void add_checksums(SectionTable& table) noexcept;

inline constexpr std::uint64_t kLargestAlignment = std::uint64_t{1} << 30;

struct ImageOptions {
    /// Sections start at multiples of it: a power of two from format::kSectionAlignment to
    /// kLargestAlignment. Those of format::kPageThreshold bytes and more start at pages in any
    /// case.
    std::uint64_t section_alignment = format::kSectionAlignment;
};

/// Returns how many bytes build_image() fills, a multiple of format::kSectionAlignment.
/// Fails as build_image() does. Looks at no byte of the sections; allocates nothing unless
/// it fails.
[[nodiscard]] Result<std::size_t> image_size(std::span<const Section> sections,
                                             const ImageOptions& options = {});

/// Writes a model into memory: header, section table with checksums, sections, and zeroes
/// between them. It is what `cdprep bake` writes, without HDF5: the superblock is zero.
/// Sections, their table without offsets, facts and content hash are the same.
/// Model::open() takes the bytes as those of a file.
///
/// `facts` gives the header fields that describe the model (counts, flags, units, frame,
/// normalisation); the rest is filled in. Whether facts and sections agree is checked by
/// Model::open(). The sections do not overlap `memory`.
///
/// Returns the first image_size() bytes of `memory`; what follows them is not touched.
/// Fails with `bad_argument`, and then writes nothing, when make_section_table() fails,
/// when `memory` is too small or does not start at a multiple of
/// format::kSectionAlignment, and when the alignment wanted is not as ImageOptions says.
/// Allocates nothing unless it fails. O(bytes): each is copied and read once.
///
///     const auto size = build::image_size(sections);
///     if (!size) return size.error();
///     std::span<std::byte> room = arena.allocate(size.value(), format::kSectionAlignment);
///     const auto image = build::build_image(facts, sections, room);
///     if (!image) return image.error();
///     const auto model = Model::open(image.value());
[[nodiscard]] Result<std::span<std::byte>> build_image(const format::FileHeader& facts,
                                                       std::span<const Section> sections,
                                                       std::span<std::byte> memory,
                                                       const ImageOptions& options = {});

}  // namespace cdprep::build
