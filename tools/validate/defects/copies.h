// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "crossings/self_intersections.h"
#include "mesh/mesh.h"
#include "validate/defects/edge_flaws.h"

namespace cdprep::mesh {

/// A triangle and its copies by ascending number. Copies have the same three corners in either
/// winding. Valid while the Copies object exists.
class CopyList {
public:
    CopyList(std::uint32_t lowest, std::span<const RepeatedTriangle> others)
        : lowest_(lowest), others_(others) {}

    [[nodiscard]] std::uint64_t size() const {
        return 1 + others_.size();
    }
    [[nodiscard]] std::uint32_t operator[](std::size_t i) const {
        return i == 0 ? lowest_ : others_[i - 1].triangle;
    }

private:
    std::uint32_t lowest_;
    std::span<const RepeatedTriangle> others_;
};

/// The triangles of a mesh that are copies of a lower one. A triangle with k copies in all makes
/// k (k - 1) / 2 meetings, and multiplies the meetings with others. Kept apart, they cost O(k).
class Copies {
public:
    Copies() = default;
    /// Takes EdgeFlaws::repeated, in any order. O(c log c) for c copies.
    explicit Copies(std::vector<RepeatedTriangle> repeated);

    /// Returns whether there are no copies.
    [[nodiscard]] bool empty() const {
        return repeated_.empty();
    }

    /// Returns the copies of a triangle that is no copy itself. O(log c).
    [[nodiscard]] CopyList of(std::uint32_t lowest) const;

    /// Calls visit(CopyList) for each triangle that has copies.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (std::size_t i = 0; i < repeated_.size();) {
            const CopyList list = of(repeated_[i].first);
            visit(list);
            i += list.size() - 1;
        }
    }

    /// Returns those of the numbers below `triangles` that are not copies, ascending.
    [[nodiscard]] std::vector<std::uint32_t> left_of(std::size_t triangles) const;

private:
    std::vector<RepeatedTriangle> repeated_;  ///< by `first`, then `triangle`
};

/// Runs search_self_intersections() on the triangles that are no copies. Each meeting represents
/// one meeting of every copy of `a` with every copy of `b`. Copies of one triangle never form a
/// meeting with each other. Copies cost only the time to leave them out.
bool search_distinct_meetings(const Mesh& mesh, const Copies& copies, const SearchOptions& options,
                              const TakeMeetings& take);

/// Returns the first `most` pairs that the meetings of distinct triangles represent, by (a, b).
/// The meetings must be sorted by (a, b). O((most + meetings) log most).
[[nodiscard]] std::vector<TriangleMeeting> first_pairs(std::span<const TriangleMeeting> distinct,
                                                       const Copies& copies, std::size_t most);

}  // namespace cdprep::mesh
