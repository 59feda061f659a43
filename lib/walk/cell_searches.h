// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/format/api.h"
#include "cdprep/pairs.h"
#include "cdprep/points.h"

namespace cdprep {

/// The additions of cdprep::cells to a workspace: scratch memory, and the searches through octrees
/// and tetra-trees. The models must serve the query and the structure.
struct CellSearches {
    std::size_t size;       ///< of the scratch memory, bytes
    std::size_t alignment;  ///< of the scratch memory, bytes
    /// Creates the scratch memory, which needs no destructor.
    void (*construct)(void* memory) noexcept;
    /// As overlaps(), by pair.options.through.
    std::size_t (*overlaps)(const Pair& pair, Workspace& workspace,
                            std::span<TrianglePair> room) noexcept;
    /// Returns whether any two triangles overlap, by pair.options.through.
    bool (*any_overlap)(const Pair& pair, Workspace& workspace) noexcept;
    /// As points_inside(), for a balanced model with triangles.
    Inclusion (*points_inside)(const Model& model, const Double3& p, Workspace& workspace,
                               Structure through) noexcept;
    /// Returns the answer of collide_at_level().
    Answer (*collide_at_level)(const Pair& pair, std::uint32_t level,
                               Workspace& workspace) noexcept;
};

/// Returns the searches that the workspace was created with; stops the program if it has none.
[[nodiscard]] CDPREP_API const CellSearches& require_cells(Workspace& workspace) noexcept;

}  // namespace cdprep
