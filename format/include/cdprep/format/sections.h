// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/api.h"
#include "cdprep/format/elements.h"
#include "cdprep/format/file_header.h"

namespace cdprep::format {

/// A row of the section table.
struct SectionKind {
    SectionId id;
    const char* name;  ///< as in FORMAT.md and the HDF5 datasets
    Element element;
    const char* count;        ///< the number of elements in a file
    const char* when;         ///< the condition for its presence in a file
    const char* serves;       ///< its use
    const char* units;        ///< HDF5 attribute
    const char* description;  ///< HDF5 attribute
};

/// Returns the section table, in ascending order of ids.
[[nodiscard]] CDPREP_API std::span<const SectionKind> section_kinds() noexcept;

/// Returns the row of `id`, or null for an id that this version does not know.
[[nodiscard]] CDPREP_API const SectionKind* find_section_kind(SectionId id) noexcept;

/// Returns the header. `file` must hold at least kUserBlockSize bytes.
[[nodiscard]] CDPREP_API FileHeader read_header(std::span<const std::byte> file) noexcept;

/// Returns the entry of `id`, or nothing if the file has none. `file` must have passed
/// find_header_damage().
[[nodiscard]] CDPREP_API std::optional<SectionEntry> find_section(std::span<const std::byte> file,
                                                                  SectionId id) noexcept;

/// Returns the size of one element of `id` in bytes, or 0 if this version does not know `id`.
[[nodiscard]] CDPREP_API std::uint32_t element_size(SectionId id) noexcept;

/// Returns the name of `id` in FORMAT.md and the HDF5 datasets, or "unknown" if this version does
/// not know it.
[[nodiscard]] CDPREP_API const char* section_name(SectionId id) noexcept;

}  // namespace cdprep::format
