// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/format/api.h"
#include "cdprep/format/file_header.h"

namespace cdprep::format {

/// The offset in the file of the bytes that FileHeader::superblock copies.
inline constexpr std::uint64_t kSuperblockOffset = kUserBlockSize + 8;

using UserBlock = std::array<std::byte, kUserBlockSize>;

/// Returns the first 4,096 bytes of a file.
///
/// Takes the facts about the model from `facts`: required features, counts, flags, up axis, units,
/// frame and normalisation. Fills in the other fields: magic, version, marks, file size, hashes,
/// superblock and section count. `sections` has at most kMaxSections entries, complete with
/// checksums and sorted by id. `superblock` holds the file's bytes 4,104 to 4,143.
[[nodiscard]] CDPREP_API UserBlock make_user_block(const FileHeader& facts,
                                                   std::span<const SectionEntry> sections,
                                                   std::span<const std::byte, 40> superblock,
                                                   std::uint64_t file_size) noexcept;

}  // namespace cdprep::format
