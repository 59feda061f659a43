// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace cdprep {

/// What queries about two models, and whether a point is inside one, did to find their
/// answers: for tuning, and for judging a change on a machine too noisy for a clock. Ask
/// for it with Workspace::count_into(). No part of any answer: instruction sets round
/// differently and leave different near misses to the next stage, and another version of
/// the library may need more or less of anything.
struct QueryCounts {
    std::uint64_t box_pairs = 0;       ///< boxes of A's hierarchy against boxes of B's
    std::uint64_t node_pairs = 0;      ///< nodes of those, up to 8 boxes each, read for them
    std::uint64_t leaf_pairs = 0;      ///< pairs of leaves whose triangles were looked at
    std::uint64_t triangle_pairs = 0;  ///< of triangles in those: at most 64 each

    // Which stage decided about pairs of triangles that boxes and planes in float did
    // not part. The sum is the number of those pairs.
    std::uint64_t by_kernel = 0;  ///< float: they cross for certain
    std::uint64_t by_corner = 0;  ///< a common corner: they touch
    std::uint64_t by_filter = 0;  ///< double: apart or crossing for certain
    std::uint64_t by_exact = 0;   ///< exact arithmetic

    std::uint64_t cell_pairs = 0;  ///< leaf cells of octrees or tetra-trees, A's against B's

    // Of the hashed octree.
    std::uint64_t potential = 0;     ///< triangles of the one model that may touch the other
    std::uint64_t cells_sought = 0;  ///< cells looked up by their key
    std::uint64_t references = 0;    ///< triangles that the leaf cells list, each time they do

    std::uint64_t measured = 0;        ///< distances of two triangles taken in double
    std::uint64_t measured_again = 0;  ///< again, for the last digits

    // Of convex hulls.
    std::uint64_t hull_pairs = 0;      ///< pairs asked about
    std::uint64_t hull_steps = 0;      ///< farthest points sought, one of each hull
    std::uint64_t hulls_by_exact = 0;  ///< pairs that double could not decide about
    std::uint64_t exact_steps = 0;     ///< farthest points sought without rounding

    /// Triangles held against a ray to learn whether a point is inside a model.
    std::uint64_t ray_triangles = 0;
};

}  // namespace cdprep
