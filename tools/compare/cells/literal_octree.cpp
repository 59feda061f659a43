// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/cells/literal_octree.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cdprep/cells/octree_search.h"
#include "cdprep/exact/triangles.h"
#include "cdprep/format/float_environment.h"
#include "mesh/vectors.h"

namespace cdprep::study {
namespace {

using format::kBvhWidth;
using mesh::dot;
using mesh::largest_of;
using mesh::minus;

/// The box that contains a model's triangles.
struct OrientedBox {
    std::array<Double3, 3> axis;
    Double3 centre;
    std::array<double, 3> half;
};

OrientedBox box_of(const Model& model) {
    if (const format::Bounds* bounds = model.record().bounds) {
        const Double3& half = bounds->half_extent;
        return {bounds->axis, bounds->oriented_centre, {half.x, half.y, half.z}};
    }
    const format::FileHeader& header = model.header();
    const double half = std::ldexp(1.0, -header.frame_exponent);
    return {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, header.frame_origin, {half, half, half}};
}

/// Returns an upper bound of the |coordinates| of a model.
double reach_of(const Model& model) {
    return largest_of(model.header().frame_origin) +
           std::ldexp(1.0, -model.header().frame_exponent);
}

Pose a_from_b_of(const Placement& placement) {
    return placement.a_is_moved() ? relative_pose(placement.pose_a(), placement.pose_b())
                                  : placement.pose_b();
}

Corners stored_corners(const MeshView& mesh, std::uint32_t triangle) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t vertex = mesh.triangles[triangle].vertex[i];
        if (mesh.positions_f32.empty()) {
            corners[i] = mesh.positions_f64[vertex];
        } else {
            const Float3& p = mesh.positions_f32[vertex];
            corners[i] = {p.x, p.y, p.z};
        }
    }
    return corners;
}

std::uint32_t source_number(const Model& model, std::uint32_t triangle) {
    const auto source = model.source().triangle;
    return source.empty() ? triangle : source[triangle];
}

Corners moved(const Corners& t, const Pose& pose) {
    return {transform_point(pose, t[0]), transform_point(pose, t[1]), transform_point(pose, t[2])};
}

bool boxes_meet(const Corners& s, const Corners& t) {
    for (double Double3::*x : {&Double3::x, &Double3::y, &Double3::z}) {
        const auto [s_low, s_high] = std::minmax({s[0].*x, s[1].*x, s[2].*x});
        const auto [t_low, t_high] = std::minmax({t[0].*x, t[1].*x, t[2].*x});
        if (s_high < t_low || t_high < s_low) return false;
    }
    return true;
}

bool overlap_as(const Corners& s, const Corners& t, Overlap overlap) {
    if (!boxes_meet(s, t)) return false;
    if (overlap == Overlap::closed) return exact::triangles_touch(s, t);
    const TriangleContact contact = exact::classify_contact(s, t);
    return contact == TriangleContact::cross || contact == TriangleContact::coplanar_overlap;
}

/// The triangles of A that its cells list at the corners of B's triangles.
class CornerCells {
public:
    CornerCells(const Model& a, CellSearch search)
        : index_(octree_index(a)),
          search_(search),
          grid_(*a.octree().grid),
          references_(a.octree().references) {}

    /// Returns the triangles of A, ascending, in the leaf cells of three points of its frame.
    [[nodiscard]] const std::vector<std::uint32_t>& listed(const Corners& points,
                                                           QueryCounts& counts) {
        listed_.clear();
        for (const Double3& p : points) {
            ++counts.cells_sought;
            if (!is_inside(p)) continue;
            const std::uint32_t leaf = find_leaf(index_, search_, code_of_point(grid_, p));
            if (leaf == kNoNode) continue;
            const format::OctreeNode& node = index_.nodes[leaf];
            counts.references += node.count;
            for (const std::uint32_t reference : references_.subspan(node.first, node.count)) {
                listed_.push_back(reference & ~format::kSharedReference);
            }
        }
        std::ranges::sort(listed_);
        listed_.erase(std::unique(listed_.begin(), listed_.end()), listed_.end());
        return listed_;
    }

private:
    /// Returns true if the half-open cube of the octree contains p.
    [[nodiscard]] bool is_inside(const Double3& p) const {
        constexpr double kSteps = 1U << format::kOctreeBits;
        const auto is_between = [&](double origin, double x) {
            return x >= origin && x < origin + kSteps * grid_.step;
        };
        return is_between(grid_.origin.x, p.x) && is_between(grid_.origin.y, p.y) &&
               is_between(grid_.origin.z, p.z);
    }

    OctreeIndex index_;
    CellSearch search_;
    const format::OctreeGrid& grid_;
    std::span<const std::uint32_t> references_;
    std::vector<std::uint32_t> listed_;
};

}  // namespace

PotentialSet::PotentialSet(const Model& a, const Model& b, const Placement& placement) : b_(b) {
    const Pose a_from_b = a_from_b_of(placement);
    const std::array<double, 9>& r = a_from_b.rotation();
    // Rounding moves a vertex by less than 2^-47 of the numbers that are added. Planes and products
    // add as much again.
    const double slack =
        0x1p-43 * (reach_of(a) + reach_of(b) + largest_of(a_from_b.translation())) + 0x1p-1060;
    const OrientedBox box = box_of(a);
    for (std::size_t k = 0; k < 3; ++k) {
        const Double3& axis = box.axis[k];
        slab_[k].normal = {dot(axis, {r[0], r[3], r[6]}), dot(axis, {r[1], r[4], r[7]}),
                           dot(axis, {r[2], r[5], r[8]})};
        slab_[k].offset = dot(axis, minus(a_from_b.translation(), box.centre));
        slab_[k].limit = box.half[k] + slack;
    }
}

bool PotentialSet::holds(const Corners& t) const {
    return std::ranges::none_of(slab_, [&](const Slab& slab) {
        const auto [low, high] =
            std::minmax({dot(slab.normal, t[0]) + slab.offset, dot(slab.normal, t[1]) + slab.offset,
                         dot(slab.normal, t[2]) + slab.offset});
        return low > slab.limit || high < -slab.limit;
    });
}

bool PotentialSet::clips(const format::BvhNode& node, std::uint32_t lane) const {
    const Double3& o = b_.header().frame_origin;
    const double unit = std::ldexp(1.0, -b_.header().frame_exponent);
    const auto middle = [&](std::size_t axis) {
        return unit * (0.5 * (double{node.lower[axis][lane]} + node.upper[axis][lane]));
    };
    const auto half = [&](std::size_t axis) {
        return unit * (0.5 * (double{node.upper[axis][lane]} - node.lower[axis][lane]));
    };
    const Double3 centre = {o.x + middle(0), o.y + middle(1), o.z + middle(2)};
    return std::ranges::any_of(slab_, [&](const Slab& slab) {
        const Double3& n = slab.normal;
        const double reach =
            std::fabs(n.x) * half(0) + std::fabs(n.y) * half(1) + std::fabs(n.z) * half(2);
        return std::fabs(dot(n, centre) + slab.offset) > slab.limit + reach;
    });
}

std::uint32_t PotentialSet::leaves_below(std::uint32_t height, std::uint32_t index) const {
    const BvhView& bvh = b_.bvh();
    if (height == 0) return std::min(kBvhWidth, b_.triangle_count() - index * kBvhWidth);
    const std::uint32_t level = height - 1;
    const format::BvhNode& node = bvh.nodes[bvh.shape.first[level] + index];
    std::uint32_t triangles = 0;
    for (std::uint32_t lane = 0; lane < bvh.shape.used_boxes(level, index); ++lane) {
        if (!clips(node, lane)) triangles += leaves_below(level, index * kBvhWidth + lane);
    }
    return triangles;
}

std::size_t PotentialSet::triangles_in_leaves() const {
    return b_.triangle_count() == 0 ? 0 : leaves_below(b_.bvh().shape.levels, 0);
}

bool visit_literal_overlaps(const Model& a, const Model& b, const Placement& placement,
                            const LiteralOptions& options, PairVisitor visit) {
    const format::FloatEnvironment environment;
    if (a.triangle_count() == 0 || b.triangle_count() == 0) return true;
    QueryCounts ignored;
    QueryCounts& counts = options.counts != nullptr ? *options.counts : ignored;
    const PotentialSet potential(a, b, placement);
    const Pose a_from_b = a_from_b_of(placement);
    CornerCells cells(a, options.search);
    const auto is_left_out = [&](const Corners& t) {
        return options.degenerate == Degenerate::skip && exact::is_degenerate(t);
    };
    for (std::uint32_t at_b = 0; at_b < b.triangle_count(); ++at_b) {
        const Corners stored = stored_corners(b.mesh(), at_b);
        if (!potential.holds(stored) || is_left_out(stored)) continue;
        ++counts.potential;
        const Corners in_b = placement.b_is_moved() ? moved(stored, placement.pose_b()) : stored;
        for (const std::uint32_t at_a : cells.listed(moved(stored, a_from_b), counts)) {
            const Corners of_a = stored_corners(a.mesh(), at_a);
            const Corners in_a = placement.a_is_moved() ? moved(of_a, placement.pose_a()) : of_a;
            ++counts.triangle_pairs;
            if (is_left_out(of_a) || !overlap_as(in_a, in_b, options.overlap)) continue;
            if (!visit({source_number(a, at_a), source_number(b, at_b)})) return false;
        }
    }
    return true;
}

}  // namespace cdprep::study
