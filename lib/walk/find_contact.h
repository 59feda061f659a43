// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/advanced/pair_cache.h"
#include "cdprep/pairs.h"

namespace cdprep {

/// A pair of triangles, tree order.
struct TreePair {
    std::uint32_t a;
    std::uint32_t b;
};

/// No pair: no model has triangles of these numbers.
inline constexpr TreePair kNoPair = {0xffffffff, 0xffffffff};

/// Returns whether the cache holds a pair of triangles that both models have.
[[nodiscard]] bool has_pair(const PairCache& cache, const Model& a, const Model& b) noexcept;

void remember_pair(PairCache& cache, const TreePair& pair) noexcept;

/// Returns the first pair of triangles in contact that a walk of both hierarchies meets.
[[nodiscard]] std::optional<TreePair> find_contact(const Model& a, const Model& b,
                                                   const Placement& placement, Workspace& workspace,
                                                   const PairOptions& options) noexcept;

/// Returns whether any triangles are in contact. Uses the cache, which may be null.
[[nodiscard]] bool any_contact(const Model& a, const Model& b, const Placement& placement,
                               Workspace& workspace, const PairOptions& options,
                               PairCache* cache) noexcept;

/// Returns whether any triangles are in contact. Searches around `touched` first, a pair that was
/// in contact before, or kNoPair. Sets it to the pair found, or to kNoPair. It changes speed, never
/// the result.
[[nodiscard]] bool any_contact_near(TreePair& touched, const Pair& pair,
                                    Workspace& workspace) noexcept;

/// Prefetches what any_contact_near() reads first. `touched` may be any pair.
void prefetch_contact(const TreePair& touched, const Model& a, const Model& b) noexcept;

}  // namespace cdprep
