// SPDX-License-Identifier: MIT
#include "cdprep/cells.h"

#include <new>
#include <type_traits>

#include "cdprep/cells/level_of_detail.h"
#include "cdprep/cells/overlap_through.h"
#include "cells/cell_storage.h"
#include "cells/inclusion_by_cells.h"
#include "walk/cell_searches.h"

namespace cdprep {
namespace {

static_assert(std::is_trivially_destructible_v<CellStorage>);

void construct(void* memory) noexcept {
    new (memory) CellStorage;
}

std::size_t overlaps_by_cells(const Pair& pair, Workspace& workspace,
                              std::span<TrianglePair> room) noexcept {
    return overlaps_through(pair, {.structure = pair.options.through}, workspace, room);
}

bool any_overlap_by_cells(const Pair& pair, Workspace& workspace) noexcept {
    return any_overlap_through(pair, {.structure = pair.options.through}, workspace);
}

Answer answer_at_level(const Pair& pair, std::uint32_t level, Workspace& workspace) noexcept {
    return collide_at_level(pair, level, workspace).answer;
}

constexpr CellSearches kSearches = {
    .size = sizeof(CellStorage),
    .alignment = alignof(CellStorage),
    .construct = construct,
    .overlaps = overlaps_by_cells,
    .any_overlap = any_overlap_by_cells,
    .points_inside = inclusion_by_cells,
    .collide_at_level = answer_at_level,
};

}  // namespace

const CellSearches& cells() noexcept {
    return kSearches;
}

}  // namespace cdprep
