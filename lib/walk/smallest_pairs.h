// SPDX-License-Identifier: MIT
#pragma once

#include "core/smallest.h"
#include "core/sort_pairs.h"
#include "core/triangle_facts.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// Keeps the smallest of all pairs, sorted; returns the number of all pairs. `for_each(found)` must
/// call found(pair) once for each pair.
template <class ForEach>
std::size_t keep_smallest_pairs(Workspace& workspace, std::span<TrianglePair> pairs,
                                ForEach&& for_each) noexcept {
    Smallest<TrianglePair> smallest(pairs);
    for_each([&](const TrianglePair& pair) {
        smallest.add(pair);
        return true;
    });
    sort_pairs(smallest.kept(), workspace.storage().sort_scratch);
    return smallest.count();
}

/// As above, in source numbers. `for_each(found)` must call found(a, b), tree order.
template <class ForEach>
std::size_t keep_smallest_pairs(const Model& a, const Model& b, Workspace& workspace,
                                std::span<TrianglePair> pairs, ForEach&& for_each) noexcept {
    return keep_smallest_pairs(workspace, pairs, [&](auto&& found) {
        for_each([&](std::uint32_t at_a, std::uint32_t at_b) {
            return found(TrianglePair{source_number(a, at_a), source_number(b, at_b)});
        });
    });
}

}  // namespace cdprep
