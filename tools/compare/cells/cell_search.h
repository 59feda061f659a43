// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "study/study_mesh.h"
#include "study/table.h"

namespace cdprep::study {
struct CellSearchOptions {
    std::vector<std::uint32_t> depths = {6, 8, 10};
    std::size_t points = std::size_t{1} << 17;  ///< of a set: 2^17 at most, 2^11 at least
    std::size_t rounds = 3;
    std::function<bool()> stop{};
};

/// What the search for the cell of a point takes, hashed and hierarchical: a row a mesh, depth,
/// set of points and state of the caches.
[[nodiscard]] Table cell_search_table(std::span<const StudyMesh> meshes,
                                      const CellSearchOptions& options);

/// Whether hashing reduces a search "by up to 80 %", by what it is held against.
[[nodiscard]] std::vector<Check> cell_search_checks(const Table& table);

}  // namespace cdprep::study
