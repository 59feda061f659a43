// SPDX-License-Identifier: MIT
#include "support/small_hull.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "exact/predicates.h"

namespace cdprep::test {
namespace {

using Face = std::array<std::uint32_t, 3>;

bool collinear(const Double3& a, const Double3& b, const Double3& c) {
    return orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 &&
           orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
           orient2d({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

/// Four points that span space, or fewer.
std::vector<std::uint32_t> first_simplex(const std::vector<Double3>& p) {
    std::vector<std::uint32_t> chosen = {0};
    for (std::uint32_t i = 1; i < p.size() && chosen.size() < 4; ++i) {
        const Double3& a = p[chosen[0]];
        const bool apart = chosen.size() == 1 ? p[i] != a
                           : chosen.size() == 2
                               ? !collinear(a, p[chosen[1]], p[i])
                               : orient3d(a, p[chosen[1]], p[chosen[2]], p[i]) != 0;
        if (apart) chosen.push_back(i);
    }
    return chosen;
}

/// The polytope after p[added] joined it: what it sees gives way to a cone.
void join(std::vector<Face>& faces, const std::vector<Double3>& p, std::uint32_t added) {
    std::vector<Face> kept;
    std::set<std::array<std::uint32_t, 2>> rim;
    for (const Face& f : faces) {
        if (orient3d(p[f[0]], p[f[1]], p[f[2]], p[added]) >= 0) {
            kept.push_back(f);
            continue;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const std::array<std::uint32_t, 2> back = {f[(i + 1) % 3], f[i]};
            if (rim.erase(back) == 0) rim.insert({f[i], f[(i + 1) % 3]});
        }
    }
    for (const auto& edge : rim) kept.push_back({edge[0], edge[1], added});
    faces = std::move(kept);
}

}  // namespace

SmallHull::SmallHull(std::span<const Double3> points, Edges edges)
    : points_(points.begin(), points.end()) {
    std::vector<std::uint32_t> s = first_simplex(points_);
    if (s.size() == 4) {
        const auto& p = points_;
        if (orient3d(p[s[0]], p[s[1]], p[s[2]], p[s[3]]) < 0) std::swap(s[0], s[1]);
        triangles_ = {
            {s[0], s[1], s[2]}, {s[1], s[0], s[3]}, {s[2], s[1], s[3]}, {s[0], s[2], s[3]}};
        for (std::uint32_t i = 0; i < p.size(); ++i) join(triangles_, p, i);
        drop_inner_points();
    }
    blocks_.resize((points_.size() + format::kHullLanes - 1) / format::kHullLanes);
    for (std::size_t i = 0; i < blocks_.size() * format::kHullLanes; ++i) {
        const Double3& p = points_[std::min(i, points_.size() - 1)];
        auto& at = blocks_[i / format::kHullLanes].at;
        const std::size_t lane = i % format::kHullLanes;
        at[0][lane] = p.x;
        at[1][lane] = p.y;
        at[2][lane] = p.z;
        reach_ = {std::max(reach_.x, std::fabs(p.x)), std::max(reach_.y, std::fabs(p.y)),
                  std::max(reach_.z, std::fabs(p.z))};
    }
    if (edges == Edges::none || triangles_.empty()) return;
    list_neighbours();
    list_starts();
}

void SmallHull::drop_inner_points() {
    std::map<std::uint32_t, std::uint32_t> number;
    std::vector<Double3> used;
    for (Face& face : triangles_) {
        for (std::uint32_t& corner : face) {
            const auto [at, added] =
                number.try_emplace(corner, static_cast<std::uint32_t>(used.size()));
            if (added) used.push_back(points_[corner]);
            corner = at->second;
        }
    }
    points_ = std::move(used);
}

void SmallHull::list_neighbours() {
    std::vector<std::vector<std::uint32_t>> of(points_.size());
    for (const Face& face : triangles_) {
        for (std::size_t i = 0; i < 3; ++i) of[face[i]].push_back(face[(i + 1) % 3]);
    }
    begins_ = {0};
    for (auto& list : of) {
        neighbours_.insert(neighbours_.end(), list.begin(), list.end());
        begins_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
    }
}

void SmallHull::list_starts() {
    starts_.resize(kDirectionStarts);
    const double cells = kDirectionCells;
    for (std::uint32_t face = 0; face < 6; ++face) {
        for (std::uint32_t cell = 0; cell < kDirectionCells * kDirectionCells; ++cell) {
            std::array<double, 3> d{};
            const std::size_t axis = face / 2;
            d[axis] = face % 2 == 0 ? 1 : -1;
            d[(axis + 1) % 3] = (2 * (cell % kDirectionCells) + 1) / cells - 1;
            d[(axis + 2) % 3] = (2 * (cell / kDirectionCells) + 1) / cells - 1;
            const auto height = [&](const Double3& p) {
                return d[0] * p.x + d[1] * p.y + d[2] * p.z;
            };
            const auto best = std::max_element(
                points_.begin(), points_.end(),
                [&](const Double3& p, const Double3& q) { return height(p) < height(q); });
            starts_[face * kDirectionCells * kDirectionCells + cell] =
                static_cast<std::uint32_t>(best - points_.begin());
        }
    }
}

ConvexPoints SmallHull::view() const {
    return {blocks_, static_cast<std::uint32_t>(points_.size()), reach_, begins_, neighbours_,
            starts_};
}

std::vector<Double3> box_corners(double x, double y, double z) {
    std::vector<Double3> corners;
    for (unsigned i = 0; i < 8; ++i) {
        corners.push_back({(i & 1) != 0 ? x : -x, (i & 2) != 0 ? y : -y, (i & 4) != 0 ? z : -z});
    }
    return corners;
}

}  // namespace cdprep::test
