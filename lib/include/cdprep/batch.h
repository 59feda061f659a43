// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/collide.h"
#include "cdprep/distance.h"
#include "cdprep/parallel_for.h"

namespace cdprep {

/// One question of a batch: two models, which outlive it, and how they stand. Jobs may
/// share models, in any mixture: many poses of one pair, or many pairs.
struct PairJob {
    const Model* a;
    const Model* b;
    Placement placement;
    PairCache* cache = nullptr;  ///< or null; no two jobs of a batch share one
};

/// These ask every job's question and store its answer at the same place: the same
/// answers as one by one, whatever the threads do. What is asked stands in the header
/// of the single question.
///
/// One thread works for each workspace, of which there is at least one; `parallel_for`
/// is called once. Of jobs and answers as many count as there are of both. Nothing is
/// allocated. A few microseconds to hand a batch out are worth it from some ten jobs.
///
///     std::vector<cdprep::Workspace> workspaces(4);
///     std::vector<cdprep::Collision> answers(jobs.size());
///     cdprep::collide_all(jobs, workspaces, run, answers);  // run: see parallel_for.h
void collide_all(std::span<const PairJob> jobs, std::span<Workspace> workspaces,
                 ParallelFor parallel_for, std::span<Collision> answers,
                 const CollideOptions& options = {}) noexcept;

void distance_all(std::span<const PairJob> jobs, std::span<Workspace> workspaces,
                  ParallelFor parallel_for, std::span<std::optional<Distance>> answers,
                  const DistanceOptions& options = {}) noexcept;

void is_within_all(std::span<const PairJob> jobs, double tolerance, std::span<Workspace> workspaces,
                   ParallelFor parallel_for, std::span<bool> answers) noexcept;

/// `counts` takes how many pairs of triangles overlap.
void count_overlaps_all(std::span<const PairJob> jobs, std::span<Workspace> workspaces,
                        ParallelFor parallel_for, std::span<std::size_t> counts,
                        const OverlapOptions& options = {}) noexcept;

/// Where one job's overlapping triangles go, and how many there are.
struct OverlapAnswer {
    std::span<TrianglePair> room;  ///< given; takes the smallest pairs, sorted
    std::size_t count = 0;         ///< found, also where the room is too short
};

void overlapping_triangles_all(std::span<const PairJob> jobs, std::span<Workspace> workspaces,
                               ParallelFor parallel_for, std::span<OverlapAnswer> answers,
                               const OverlapOptions& options = {}) noexcept;

/// The triangles of either model that overlap any of the other: as
/// mark_overlapping_triangles().
struct MarkedTriangles {
    std::span<std::uint64_t> bits_a;  ///< given; too short: nothing is marked
    std::span<std::uint64_t> bits_b;  ///< likewise
    std::size_t count = 0;            ///< pairs found
};

void mark_overlapping_triangles_all(std::span<const PairJob> jobs, std::span<Workspace> workspaces,
                                    ParallelFor parallel_for, std::span<MarkedTriangles> answers,
                                    const OverlapOptions& options = {}) noexcept;

}  // namespace cdprep
