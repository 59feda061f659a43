// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cdprep/format/file_header.h"
#include "write/sparse_memory.h"

namespace cdprep::write {

/// A dataset to create: its id and number of elements.
struct Plan {
    format::SectionId id;
    std::uint64_t count;
};

/// The position of a dataset in a file.
struct Place {
    format::SectionId id;
    std::uint64_t offset;  ///< from the start of the file, user block included
    std::uint64_t count;
};

/// An HDF5 file without the contents of its datasets.
struct Layout {
    std::vector<Place> places;  ///< in the order of the plans
    SparseMemory rest;          ///< all but the datasets; its size is that of the file
};

/// Returns an HDF5 file with a user block of zeros and one allocated, unwritten dataset per plan,
/// named and described. Attributes of the group repeat the header facts that a reader of the
/// datasets needs: version, unit, frame. Counts must be at least 1. Returns nothing if HDF5
/// fails, which means that memory is short.
[[nodiscard]] std::optional<Layout> make_layout(std::span<const Plan> plans,
                                                const format::FileHeader& facts);

/// The datasets of a file that any tool may have written. `damage` names the first dataset that
/// is not contiguous or not of our type.
struct FoundLayout {
    std::vector<Place> places;  ///< by rising id; empty if `damage` is not
    std::string damage;         ///< a clause for a message, or empty
};
[[nodiscard]] FoundLayout find_layout(const std::filesystem::path& path);

}  // namespace cdprep::write
