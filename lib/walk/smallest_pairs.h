// SPDX-License-Identifier: MIT
#pragma once

#include "core/smallest.h"
#include "core/sort_pairs.h"
#include "core/triangle_facts.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// Keeps the smallest of all pairs, sorted, in source numbers; returns the number of all pairs.
/// `for_each(found)` must call found(a, b), tree order, once for each pair.
template <class ForEach>
std::size_t keep_smallest_pairs(const Model& a, const Model& b, Workspace& workspace,
                                std::span<TrianglePair> pairs, ForEach&& for_each) noexcept {
    Smallest<TrianglePair> smallest(pairs);
    for_each([&](std::uint32_t at_a, std::uint32_t at_b) {
        smallest.add({source_number(a, at_a), source_number(b, at_b)});
        return true;
    });
    sort_pairs(smallest.kept(), workspace.storage().sort_scratch);
    return smallest.count();
}

}  // namespace cdprep
