// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/around_edge.h"

#include <algorithm>

#include "cdprep/exact/predicates.h"

namespace cdprep::mesh {
namespace {

constexpr int kNoPlane = 3;

int turn_in(int plane, const Double3& a, const Double3& b, const Double3& c) {
    const auto flat = [plane](const Double3& p) {
        return plane == 0 ? Double2{p.y, p.z} : plane == 1 ? Double2{p.z, p.x} : Double2{p.x, p.y};
    };
    return exact::orient2d(flat(a), flat(b), flat(c));
}

}  // namespace

AroundEdge::AroundEdge(std::span<const Double3> positions, std::span<const Triangle> triangles,
                       std::span<const HalfEdge> uses)
    : positions_(positions), triangles_(triangles) {
    const std::uint32_t start = start_of(triangles, uses[0]), end = end_of(triangles, uses[0]);
    lower_ = std::min(start, end);
    upper_ = std::max(start, end);
    for (const HalfEdge h : uses) {
        if (refer_to(apex(h))) break;
    }
}

AroundEdge::AroundEdge(std::span<const Double3> positions, std::span<const Triangle> triangles,
                       HalfEdge use, const Double3& reference)
    : positions_(positions), triangles_(triangles) {
    const std::uint32_t start = start_of(triangles, use), end = end_of(triangles, use);
    lower_ = std::min(start, end);
    upper_ = std::max(start, end);
    refer_to(reference);
}

bool AroundEdge::refer_to(const Double3& p) {
    for (int plane = 0; plane < kNoPlane; ++plane) {
        turn_ = turn_in(plane, positions_[lower_], positions_[upper_], p);
        if (turn_ == 0) continue;
        plane_ = plane;
        reference_ = p;
        return true;
    }
    return false;
}

const Double3& AroundEdge::apex(HalfEdge h) const {
    return positions_[apex_of(triangles_, h)];
}

bool AroundEdge::opens(HalfEdge h) const {
    return start_of(triangles_, h) == upper_;
}

int AroundEdge::sector(HalfEdge h) const {
    if (plane_ == kNoPlane) return 0;
    const Double3 &low = positions_[lower_], &up = positions_[upper_];
    const int side = exact::orient3d(low, up, reference_, apex(h));
    if (side != 0) return side < 0 ? 1 : 3;
    return turn_in(plane_, low, up, apex(h)) == -turn_ ? 2 : 0;
}

std::vector<HalfEdge> AroundEdge::sorted(std::span<const HalfEdge> uses) const {
    std::vector<HalfEdge> order(uses.begin(), uses.end());
    std::sort(order.begin(), order.end(), [&](HalfEdge a, HalfEdge b) {
        const int sector_a = sector(a), sector_b = sector(b);
        if (sector_a != sector_b) return sector_a < sector_b;
        if (sector_a % 2 == 1) {
            const int side =
                exact::orient3d(positions_[lower_], positions_[upper_], apex(a), apex(b));
            if (side != 0) return side < 0;
        }
        if (opens(a) != opens(b)) return opens(b);
        return a < b;
    });
    return order;
}

}  // namespace cdprep::mesh
