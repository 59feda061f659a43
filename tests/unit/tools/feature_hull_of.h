// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <numeric>
#include <span>
#include <vector>

#include "cdprep/advanced/closest_features.h"
#include "hull/convex_hull.h"
#include "support/small_hull.h"

namespace cdprep::test {

/// The exact hull of some points in memory, with its surface.
class SurfaceHull {
public:
    explicit SurfaceHull(std::span<const Double3> points) : hull_(convex::convex_hull(points)) {
        std::map<std::array<std::uint32_t, 2>, std::uint32_t> left_of;
        for (std::uint32_t group = 0; group + 1 < hull_.groups.size(); ++group) {
            for (std::uint32_t f = hull_.groups[group]; f < hull_.groups[group + 1]; ++f) {
                const auto& c = hull_.facets[f];
                const bool first = f == hull_.groups[group];
                facets_.push_back({c, first ? +format::facet_first_of_face : 0U});
                for (std::size_t k = 0; k < 3; ++k) left_of[{c[k], c[(k + 1) % 3]}] = f;
            }
        }
        for (const auto& c : hull_.facets) {
            adjacency_.push_back(
                {{left_of.at({c[1], c[0]}), left_of.at({c[2], c[1]}), left_of.at({c[0], c[2]})}});
        }
        // Of the same points in the same order, with neighbours where it can have some.
        if (hull_.dimension == 3) small_.emplace(hull_.points, Edges::exact);
        numbers_.resize(hull_.points.size());
        std::iota(numbers_.begin(), numbers_.end(), 0U);
    }

    /// Climbing along edges where `climbs`; else all points are looked at.
    [[nodiscard]] FeatureHull view(bool climbs = false) const {
        ConvexPoints points;
        points.count = static_cast<std::uint32_t>(numbers_.size());
        points.corners = numbers_;
        points.doubles = hull_.points;
        if (climbs && small_ && has_same_order()) points = small_->view();
        return {points, facets_, adjacency_};
    }
    [[nodiscard]] const std::vector<Double3>& points() const {
        return hull_.points;
    }

    /// The corners of a feature.
    [[nodiscard]] std::vector<Double3> corners(const HullFeature& feature) const {
        if (feature.kind == FeatureKind::vertex) return {hull_.points[feature.number]};
        if (facets_.empty()) return hull_.points;
        std::vector<Double3> result;
        if (feature.kind == FeatureKind::edge) {
            const auto& c = hull_.facets[feature.number / 3];
            for (const std::uint32_t k : {feature.number % 3, (feature.number + 1) % 3}) {
                result.push_back(hull_.points[c[k]]);
            }
            return result;
        }
        std::uint32_t f = feature.number;
        do {
            for (const std::uint32_t c : hull_.facets[f]) result.push_back(hull_.points[c]);
            ++f;
        } while (f < facets_.size() && facets_[f].flags == 0);
        return result;
    }

private:
    [[nodiscard]] bool has_same_order() const {
        const auto equal = [](const Double3& p, const Double3& q) {
            return p.x == q.x && p.y == q.y && p.z == q.z;
        };
        return std::equal(hull_.points.begin(), hull_.points.end(), small_->points().begin(),
                          small_->points().end(), equal);
    }

    convex::ConvexHull hull_;
    std::vector<format::PieceFacet> facets_;
    std::vector<format::PieceAdjacency> adjacency_;
    std::optional<SmallHull> small_;
    std::vector<std::uint32_t> numbers_;
};

}  // namespace cdprep::test
