// SPDX-License-Identifier: GPL-3.0-or-later
#include "cell_searches/potential_set.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

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

/// Returns an upper bound of the error of a plane's distance. A rotation deviates by up to 1e-12,
/// so the inverse of a pose does; rounding is far less. 2^-37 covers three such products.
double slack_of(const Model& a, const Model& b, const Pose& a_from_b) {
    return 0x1p-37 * (reach_of(a) + reach_of(b) + largest_of(a_from_b.translation())) + 0x1p-1060;
}

std::uint32_t triangles_of_group(std::uint32_t height) {
    return std::uint32_t{1} << (3 * height);
}

/// The triangles [first, last) of a group.
std::pair<std::uint32_t, std::uint32_t> range_of(const Model& model, std::uint32_t height,
                                                 std::uint32_t number) {
    const std::uint32_t size = triangles_of_group(height);
    return {number * size, std::min(model.triangle_count(), (number + 1) * size)};
}

/// An interval, at first empty.
struct Interval {
    double lower = std::numeric_limits<double>::infinity();
    double upper = -std::numeric_limits<double>::infinity();
};

// The normals of a 26-DOP: of the faces, edges and corners of a cube. Not of length 1.
constexpr std::array<Double3, 13> kDirections = {{{1, 0, 0},
                                                  {0, 1, 0},
                                                  {0, 0, 1},
                                                  {1, 1, 0},
                                                  {1, -1, 0},
                                                  {1, 0, 1},
                                                  {1, 0, -1},
                                                  {0, 1, 1},
                                                  {0, 1, -1},
                                                  {1, 1, 1},
                                                  {1, 1, -1},
                                                  {1, -1, 1},
                                                  {-1, 1, 1}}};
using Extents = std::array<Interval, kDirections.size()>;

/// Returns the extents of each group, in the frame of A.
std::vector<Extents> extents_of(const Model& model, const TriangleGroups& groups,
                                const Pose* pose) {
    std::vector<Extents> all;
    all.reserve(groups.numbers.size());
    for (const std::uint32_t number : groups.numbers) {
        Extents& extents = all.emplace_back();
        const auto [first, last] = range_of(model, groups.height, number);
        for (std::uint32_t t = first; t < last; ++t) {
            const Corners stored = stored_corners(model.mesh(), t);
            for (const Double3& p : pose != nullptr ? moved(stored, *pose) : stored) {
                for (std::size_t d = 0; d < kDirections.size(); ++d) {
                    const double at = dot(kDirections[d], p);
                    extents[d].lower = std::min(extents[d].lower, at);
                    extents[d].upper = std::max(extents[d].upper, at);
                }
            }
        }
    }
    return all;
}

/// Returns the groups whose extents each come within `slack` of an extent of the others.
TriangleGroups near_others(const TriangleGroups& groups, const std::vector<Extents>& own,
                           const std::vector<Extents>& others, double slack) {
    std::vector<bool> is_near(own.size(), true);
    for (std::size_t d = 0; d < kDirections.size(); ++d) {
        // Sorted by where they begin; `upper` is the last end so far.
        std::vector<Interval> sorted;
        sorted.reserve(others.size());
        for (const Extents& extents : others) sorted.push_back(extents[d]);
        std::ranges::sort(sorted, {}, &Interval::lower);
        double end = -std::numeric_limits<double>::infinity();
        for (Interval& interval : sorted) interval.upper = end = std::max(end, interval.upper);
        for (std::size_t i = 0; i < own.size(); ++i) {
            const auto behind =
                std::ranges::upper_bound(sorted, own[i][d].upper + slack, {}, &Interval::lower);
            if (behind == sorted.begin() || std::prev(behind)->upper < own[i][d].lower - slack) {
                is_near[i] = false;
            }
        }
    }
    TriangleGroups kept{groups.height, {}};
    for (std::size_t i = 0; i < own.size(); ++i) {
        if (is_near[i]) kept.numbers.push_back(groups.numbers[i]);
    }
    return kept;
}

}  // namespace

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

Corners moved(const Corners& t, const Pose& pose) {
    return {transform_point(pose, t[0]), transform_point(pose, t[1]), transform_point(pose, t[2])};
}

Pose a_from_b_of(const Placement& placement) {
    return placement.a_is_moved() ? relative_pose(placement.pose_a(), placement.pose_b())
                                  : placement.pose_b();
}

bool TriangleGroups::has(std::uint32_t triangle) const {
    return std::ranges::binary_search(numbers, triangle / triangles_of_group(height));
}

std::size_t TriangleGroups::triangles_of(const Model& model) const {
    std::size_t count = 0;
    for (const std::uint32_t number : numbers) {
        const auto [first, last] = range_of(model, height, number);
        count += last - first;
    }
    return count;
}

PotentialSet::PotentialSet(const Model& a, const Model& b, const Placement& placement) : b_(b) {
    const Pose a_from_b = a_from_b_of(placement);
    const std::array<double, 9>& r = a_from_b.rotation();
    const double slack = slack_of(a, b, a_from_b);
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

void PotentialSet::add_below(std::uint32_t height, std::uint32_t index,
                             TriangleGroups& groups) const {
    if (height <= groups.height) {
        groups.numbers.push_back(index);
        return;
    }
    const BvhView& bvh = b_.bvh();
    const std::uint32_t level = height - kCluster;  // a node of level 0 has the boxes of leaves
    const format::BvhNode& node = bvh.nodes[bvh.shape.first[level] + index];
    for (std::uint32_t lane = 0; lane < bvh.shape.used_boxes(level, index); ++lane) {
        if (!clips(node, lane)) add_below(height - 1, index * kBvhWidth + lane, groups);
    }
}

TriangleGroups PotentialSet::groups(std::uint32_t height) const {
    TriangleGroups groups{height, {}};
    if (b_.triangle_count() == 0) return groups;
    add_below(b_.bvh().shape.levels + kLeaf, 0, groups);
    return groups;
}

GroupsOfBoth groups_in_boxes(const Model& a, const Model& b, const Placement& placement,
                             std::uint32_t height) {
    const Placement turned = Placement::b_moves(relative_pose(a_from_b_of(placement), Pose()));
    return {PotentialSet(b, a, turned).groups(height),
            PotentialSet(a, b, placement).groups(height)};
}

GroupsOfBoth groups_in_slabs(const Model& a, const Model& b, const Placement& placement,
                             const GroupsOfBoth& groups) {
    const Pose a_from_b = a_from_b_of(placement);
    // A direction adds up to three coordinates.
    const double slack = 3 * slack_of(a, b, a_from_b);
    const std::vector<Extents> of_a = extents_of(a, groups.a, nullptr);
    const std::vector<Extents> of_b = extents_of(b, groups.b, &a_from_b);
    return {near_others(groups.a, of_a, of_b, slack), near_others(groups.b, of_b, of_a, slack)};
}

}  // namespace cdprep::study
