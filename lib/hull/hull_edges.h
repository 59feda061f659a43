// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "cdprep/format/pieces.h"

namespace cdprep {

/// An edge of a facet, given by the corner at which it begins.
struct FacetPlace {
    std::uint32_t facet;
    std::uint32_t corner;
    friend bool operator==(const FacetPlace&, const FacetPlace&) = default;
};

/// The edges of a hull's surface, for walks along them. The surface is closed and its edges are
/// paired.
class HullEdges {
public:
    HullEdges(std::span<const format::PieceFacet> facets,
              std::span<const format::PieceAdjacency> adjacency) noexcept
        : facets_(facets), adjacency_(adjacency) {}

    [[nodiscard]] std::span<const format::PieceFacet> facets() const noexcept {
        return facets_;
    }
    [[nodiscard]] std::uint32_t start(const FacetPlace& p) const noexcept {
        return facets_[p.facet].corner[p.corner];
    }
    [[nodiscard]] std::uint32_t end(const FacetPlace& p) const noexcept {
        return facets_[p.facet].corner[(p.corner + 1) % 3];
    }
    [[nodiscard]] static FacetPlace next(const FacetPlace& p) noexcept {
        return {p.facet, (p.corner + 1) % 3};
    }
    [[nodiscard]] static FacetPlace previous(const FacetPlace& p) noexcept {
        return {p.facet, (p.corner + 2) % 3};
    }
    /// Returns the same edge as seen from the adjacent facet.
    [[nodiscard]] FacetPlace twin(const FacetPlace& p) const noexcept {
        const std::uint32_t facet = adjacency_[p.facet].across[p.corner];
        const std::uint32_t first = end(p);
        const auto& corner = facets_[facet].corner;
        return {facet, corner[0] == first ? 0U : corner[1] == first ? 1U : 2U};
    }
    [[nodiscard]] std::uint32_t first_of_face(std::uint32_t facet) const noexcept {
        while ((facets_[facet].flags & format::facet_first_of_face) == 0) --facet;
        return facet;
    }
    /// Returns the number after the last facet of the face that begins at `first`.
    [[nodiscard]] std::uint32_t end_of_face(std::uint32_t first) const noexcept {
        std::uint32_t end = first + 1;
        while (end < facets_.size() && (facets_[end].flags & format::facet_first_of_face) == 0) {
            ++end;
        }
        return end;
    }
    /// Returns whether the edge lies between two faces, rather than being a diagonal of one.
    [[nodiscard]] bool is_edge(const FacetPlace& p) const noexcept {
        const std::uint32_t other = adjacency_[p.facet].across[p.corner];
        const std::uint32_t low = p.facet < other ? p.facet : other;
        const std::uint32_t high = p.facet < other ? other : p.facet;
        for (std::uint32_t f = low + 1; f <= high; ++f) {
            if ((facets_[f].flags & format::facet_first_of_face) != 0) return true;
        }
        return false;
    }

    /// Calls visit(place) for the edges around the face that begins at `first`, in order.
    template <class Visit>
    void each_around_face(std::uint32_t first, Visit&& visit) const noexcept {
        const std::uint32_t end_facet = end_of_face(first);
        FacetPlace begin{first, 0};
        while (!is_edge(begin)) {
            begin = begin.corner == 2 ? FacetPlace{begin.facet + 1, 0} : next(begin);
            if (begin.facet == end_facet) return;
        }
        FacetPlace at = begin;
        do {
            visit(at);
            at = next(at);
            while (!is_edge(at)) at = next(twin(at));
        } while (!(at == begin));
    }

    /// Calls visit(place) for the edges that begin where `p` begins.
    template <class Visit>
    void each_from(const FacetPlace& p, Visit&& visit) const noexcept {
        FacetPlace at = p;
        do {
            if (is_edge(at)) visit(at);
            at = twin(previous(at));
        } while (!(at == p));
    }

private:
    std::span<const format::PieceFacet> facets_;
    std::span<const format::PieceAdjacency> adjacency_;
};

}  // namespace cdprep
