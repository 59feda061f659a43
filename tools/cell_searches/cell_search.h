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
    std::size_t points = std::size_t{1} << 17;  ///< of a set: at most 2^17, at least 2^11
    std::size_t rounds = 3;
    std::function<bool()> stop{};
};

/// Returns the time to find the cell of a point, hashed and hierarchical. There is a row per
/// mesh, depth, set of points and state of the caches.
[[nodiscard]] Table cell_search_table(std::span<const StudyMesh> meshes,
                                      const CellSearchOptions& options);

/// Checks whether hashing reduces the time of a search "by up to 80 %", for each baseline.
[[nodiscard]] std::vector<Check> cell_search_checks(const Table& table);

}  // namespace cdprep::study
