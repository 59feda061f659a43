// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "cdprep/overlapping_triangles.h"
#include "cdprep/parallel_for.h"

namespace cdprep {

/// overlapping_triangles() on as many threads as there are workspaces (at least one):
/// the same pairs in the same order and the same number, whatever the threads do.
///
/// For one question that takes a millisecond or more, such as two large models that
/// overlap deeply; below, handing it out costs more than it saves, and batch.h shares
/// out whole questions. Calls `parallel_for` at most twice, each time for one task a
/// workspace; a task that starts late finds less to do or nothing.
///
/// When `pairs` is too short for all but not empty, the question is asked once more on
/// one thread, which keeps the smallest. Never allocates.
[[nodiscard]] std::size_t split_overlapping_triangles(const Model& a, const Model& b,
                                                      const Placement& placement,
                                                      std::span<Workspace> workspaces,
                                                      ParallelFor parallel_for,
                                                      std::span<TrianglePair> pairs,
                                                      const OverlapOptions& options = {}) noexcept;

}  // namespace cdprep
