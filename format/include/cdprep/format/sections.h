// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/file_header.h"

namespace cdprep::format {

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
