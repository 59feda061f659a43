// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "validate/defects/edge_flaws.h"
#include "mesh/mesh.h"
#include "crossings/self_intersections.h"

namespace cdprep::mesh {

/// A triangle and its copies, the triangles with the same three corners in either winding,
/// by ascending number. Valid as long as what it is of.
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

/// Which triangles of a mesh are copies of a lower one. k copies of one triangle make
/// k (k - 1) / 2 meetings, and multiply those with others: kept apart, they cost O(k).
class Copies {
public:
    Copies() = default;
    /// From EdgeFlaws::repeated, in any order. O(c log c) for c copies.
    explicit Copies(std::vector<RepeatedTriangle> repeated);

    /// There are none.
    [[nodiscard]] bool empty() const {
        return repeated_.empty();
    }

    /// Of a triangle that is no copy itself. O(log c).
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

    /// The numbers of the triangles that are no copies, of so many; ascending.
    [[nodiscard]] std::vector<std::uint32_t> left_of(std::size_t triangles) const;

private:
    std::vector<RepeatedTriangle> repeated_;  ///< by `first`, then `triangle`
};

/// search_self_intersections() among the triangles that are no copies: each meeting stands
/// for one of every copy of `a` with every copy of `b`. Copies of one triangle are in
/// none with each other. Takes no longer for any number of copies than they take to leave
/// out.
bool search_distinct_meetings(const Mesh& mesh, const Copies& copies, const SearchOptions& options,
                              const TakeMeetings& take);

/// The first `most` of all pairs that meetings of distinct triangles stand for, by (a, b);
/// the meetings are sorted so. O((most + meetings) log most).
[[nodiscard]] std::vector<TriangleMeeting> first_pairs(std::span<const TriangleMeeting> distinct,
                                                       const Copies& copies, std::size_t most);

}  // namespace cdprep::mesh
