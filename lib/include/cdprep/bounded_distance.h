// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "cdprep/format/api.h"
#include "cdprep/pairs.h"

namespace cdprep {

// Distances for loops that must answer in time. Work is counted, not measured by a clock. So the
// same machine gives the same answer each time.

// The units of work. A pair of nodes, which have up to 64 pairs of boxes, counts 1.
inline constexpr std::uint64_t kWorkOfLeaves = 2;     ///< a pair of leaves: up to 64 triangle pairs
inline constexpr std::uint64_t kWorkOfTriangles = 4;  ///< a pair of triangles, tested in double
inline constexpr std::uint64_t kWorkOfExact = 16;     ///< a pair of triangles, beyond double

/// The distance of two surfaces, or bounds of it if the search ended early.
struct BoundedDistance {
    /// True: the search was completed, and `nearest` is what distance() returns. False: the answer
    /// is late, because the work did not suffice. Its bounds hold, but they may be wide.
    bool is_complete = false;
    /// The exact distance is in [lower, upper], model units. These bounds are 0 and infinity if
    /// nothing is known.
    double lower = 0;
    double upper = std::numeric_limits<double>::infinity();
    /// The nearest pair of triangles found, with the same bounds. Nothing if none was found, or
    /// none is within max_distance.
    std::optional<Distance> nearest;
    std::uint64_t work = 0;  ///< counted as in DistanceBudget::work
};

/// The last complete answer about a pair. The caller keeps it while later answers are late.
struct LastDistance {
    bool is_known = false;  ///< there was a complete answer
    Placement placement = Placement::b_moves(Pose());
    BoundedDistance distance;  ///< in that placement
    std::uint64_t late = 0;    ///< late answers since then

    /// Stores a complete answer, or counts a late one. bounded_distance() calls this for
    /// DistanceBudget::last.
    CDPREP_API void note(const Placement& at, const BoundedDistance& found) noexcept;
};

/// The limits of the work of one query.
struct DistanceBudget {
    /// The maximum work, 0 for no limit. The search ends as soon as its work is at least this.
    /// After that, up to 64 pairs of triangles may still add to the work. These pairs are in the
    /// last pair of leaves of a search for contact, or are about equally near. Equally near pairs
    /// are measured again at the end.
    ///
    /// For a limit of time, first measure the time per unit of work. It is the time of many
    /// answers, divided by the sum of their BoundedDistance::work. The limit of time divided by
    /// this quotient is the work.
    std::uint64_t work = 0;
    /// The object that stores complete answers and counts late ones, or null.
    LastDistance* last = nullptr;
};

/// Returns the distance of two surfaces, or bounds of it if the work does not suffice.
///
/// A complete answer is that of distance(), bit for bit. If errors are permitted, it may be another
/// answer within them. A late answer has the bounds of the search so far. `upper` is that of the
/// nearest pair found. `lower` is the least lower bound of the pairs found and of the pairs of
/// boxes not yet visited. If rounding hides whether triangles touch, a search in exact arithmetic
/// decides. `lower` is 0 if the work does not suffice for this search.
///
/// With a cache, `lower` is at least the last proven gap minus the motion since then. The pair that
/// was nearest before is measured first. So late bounds are tight if the models moved little. If no
/// gap is left and the cache holds a pair of triangles, contact is searched for first. This search
/// gets about half of the work.
///
/// Reads no pair options: the query is about surfaces, and uses the BVHs. `options` are read as in
/// distance(). If max_distance is NaN or negative, no pair is found. Needs Ask::distance of both
/// models. Takes as long as distance(), or less if nothing touches. A late answer takes time in
/// proportion to budget.work; measure the factor (tests/bench/haptic_bench). A late answer depends
/// on the instruction set, because the counted work does. Never allocates, locks or calls the
/// system.
///
///     cdprep::LastDistance last;
///     const auto found = bounded_distance(pair, workspace, {}, {.work = 3000, .last = &last});
///     if (found.lower > safe) return;  // proven, also if it is late
[[nodiscard]] CDPREP_API BoundedDistance
bounded_distance(const Pair& pair, Workspace& workspace, const DistanceOptions& options = {},
                 const DistanceBudget& budget = {}) noexcept;

}  // namespace cdprep
