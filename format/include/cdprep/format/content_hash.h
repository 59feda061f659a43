// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/format/api.h"
#include "cdprep/format/file_header.h"

namespace cdprep::format {

/// Returns the hash of a model's content. It covers the header's facts: version, required features,
/// counts, flags, up axis, units, frame and normalisation. It also covers each section's id,
/// element size, count and checksum. It does not cover offsets, the file size or the HDF5 part.
/// `sections` must be sorted by id, with at most kMaxSections entries.
[[nodiscard]] CDPREP_API std::uint64_t content_hash(
    const FileHeader& header, std::span<const SectionEntry> sections) noexcept;

/// Returns the checksum of a user block as if its field header_checksum were zero. `user_block`
/// holds kUserBlockSize bytes.
[[nodiscard]] CDPREP_API std::uint64_t header_checksum(
    std::span<const std::byte, kUserBlockSize> user_block) noexcept;

}  // namespace cdprep::format
