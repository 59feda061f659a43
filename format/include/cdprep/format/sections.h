// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/elements.h"
#include "cdprep/format/file_header.h"

namespace cdprep::format {

/// A row of the section table.
struct SectionKind {
    SectionId id;
    const char* name;  ///< as FORMAT.md and the HDF5 datasets spell it
    Element element;
    const char* count;        ///< how many elements a file holds
    const char* when;         ///< a bake holds it
    const char* serves;       ///< what reads it
    const char* units;        ///< HDF5 attribute
    const char* description;  ///< HDF5 attribute
};

/// Returns the section table, by rising id.
[[nodiscard]] std::span<const SectionKind> section_kinds() noexcept;

/// Returns the row of `id`, or null for an id that this version does not know.
[[nodiscard]] const SectionKind* find_section_kind(SectionId id) noexcept;

/// Reads the header. `file` must hold at least kUserBlockSize bytes.
[[nodiscard]] FileHeader read_header(std::span<const std::byte> file) noexcept;

/// Returns the entry of `id`, or nothing when the file has none. `file` must
/// have passed find_header_damage().
[[nodiscard]] std::optional<SectionEntry> find_section(std::span<const std::byte> file,
                                                       SectionId id) noexcept;

/// Returns the size of one element of `id` in bytes; 0 for an id that this
/// version does not know.
[[nodiscard]] std::uint32_t element_size(SectionId id) noexcept;

/// Returns the name of `id` as FORMAT.md and the HDF5 datasets spell it,
/// "unknown" for an id that this version does not know.
[[nodiscard]] const char* section_name(SectionId id) noexcept;

}  // namespace cdprep::format
