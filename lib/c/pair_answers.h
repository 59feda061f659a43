// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "c/c_pairs.h"
#include "cdprep/bounded_distance.h"
#include "cdprep/c/motion.h"
#include "cdprep/time_of_impact.h"

// Queries about two models that exist both singly and in batches. Each takes a checked pair and a
// workspace.

namespace cdprep::c {

[[nodiscard]] cdprep_collision in_c(bool hit, const Containment& containment) noexcept;
[[nodiscard]] cdprep_nearest in_c(const std::optional<Distance>& found) noexcept;
[[nodiscard]] cdprep_bounded in_c(const BoundedDistance& found) noexcept;
[[nodiscard]] cdprep_impact in_c(const Impact& impact) noexcept;
[[nodiscard]] DistanceOptions in_cpp(const cdprep_distance_options& options) noexcept;

[[nodiscard]] cdprep_collision collision_of(const AskedPair& asked, Workspace& workspace) noexcept;
[[nodiscard]] std::size_t list_overlaps(const AskedPair& asked, Workspace& workspace,
                                        std::span<TrianglePair> room) noexcept;
[[nodiscard]] std::size_t mark_overlaps(const AskedPair& asked, Workspace& workspace,
                                        const cdprep_marks& marks) noexcept;
[[nodiscard]] cdprep_nearest nearest_of(const AskedPair& asked,
                                        const cdprep_distance_options& options,
                                        Workspace& workspace) noexcept;
[[nodiscard]] bool is_pair_within(const AskedPair& asked, double tolerance,
                                  Workspace& workspace) noexcept;
[[nodiscard]] std::size_t list_pairs_within(const AskedPair& asked, double tolerance,
                                            Workspace& workspace,
                                            std::span<TrianglePair> room) noexcept;

/// Refuses null bit arrays, and arrays with too few words.
int check_marks(Call& call, const Name& name, const cdprep_marks& marks,
                const AskedPair& asked) noexcept;

}  // namespace cdprep::c
