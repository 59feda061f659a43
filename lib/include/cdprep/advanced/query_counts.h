// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/format/api.h"

namespace cdprep {

/// Returns the name of the instruction set that queries use on this machine: "scalar", "avx2",
/// "avx512", "neon" or "simd128". To choose another, set the environment variable CDPREP_KERNELS to
/// its name before the first call into the library. Sets that the machine or the build lacks are
/// ignored.
[[nodiscard]] CDPREP_API const char* kernel_name() noexcept;

/// Counts of the work of queries about two models, of self_overlaps() and of points_inside(). The
/// counts serve tuning and comparisons on machines that are too noisy for a clock.
/// Workspace::count_into() turns them on. They are not part of an answer: they depend on the
/// instruction set and on the version of the library.
struct QueryCounts {
    std::uint64_t box_pairs = 0;       ///< boxes of A's hierarchy against boxes of B's
    std::uint64_t node_pairs = 0;      ///< pairs of nodes read for these, up to 8 boxes each
    std::uint64_t leaf_pairs = 0;      ///< pairs of leaves whose triangles were tested
    std::uint64_t triangle_pairs = 0;  ///< pairs of triangles in these: at most 64 per leaf pair

    // Pairs of triangles that boxes and planes in float did not separate, by the stage that decided
    // about them. The sum of these four counts is the number of pairs that were decided. A search
    // that ends at a hit leaves others undecided.
    std::uint64_t by_kernel = 0;  ///< float: they certainly cross
    std::uint64_t by_corner = 0;  ///< a common corner: they touch
    std::uint64_t by_filter = 0;  ///< double: they are certainly apart or crossing
    std::uint64_t by_exact = 0;   ///< exact arithmetic; also distances against a tolerance

    std::uint64_t cell_pairs = 0;  ///< leaf cells of octrees or tetra-trees, A's against B's

    // The hashed octree.
    std::uint64_t potential = 0;     ///< triangles of one model that may touch the other
    std::uint64_t cells_sought = 0;  ///< cells looked up by key
    std::uint64_t references = 0;    ///< triangles in the lists of leaf cells; repeats count

    std::uint64_t measured = 0;        ///< distances of two triangles, in double
    std::uint64_t measured_again = 0;  ///< distances computed again for the last digits

    // Convex hulls.
    std::uint64_t hull_pairs = 0;      ///< pairs of hulls
    std::uint64_t hull_steps = 0;      ///< searches for a farthest point, one in each hull
    std::uint64_t hulls_by_exact = 0;  ///< pairs that double could not decide
    std::uint64_t exact_steps = 0;     ///< searches for a farthest point without rounding

    /// Triangles tested against the ray of points_inside(), or of the containment of solids.
    std::uint64_t ray_triangles = 0;
};

}  // namespace cdprep
