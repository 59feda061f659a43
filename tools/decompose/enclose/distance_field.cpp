// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

using mesh::middle_of;

// A number without a reason was chosen by trial: a finer field or more samples take more time.
constexpr double kSampling = 0.4;    ///< of a spacing: sides of the last triangles
constexpr double kCentreWay = 0.67;  ///< of the longest side: bound from centre to corner
/// Of the longest side: the most that the sides at a cut may have. An exact middle needs 0.867. Far
/// from 0, doubles along some axes may be coarser than the samples, and a middle is rounded to a
/// corner there. The longest side might then never become shorter. Up to this share, it does after
/// two cuts.
constexpr double kMostAfterCut = 0.9;
constexpr double kRounded = 1e-5;    ///< of a spacing: exceeds the rounding to float
constexpr double kCoarser = 0.25;    ///< of a spacing: the step to a larger; halves the nodes
constexpr double kTooLow = 0.35;     ///< of a spacing: a field is rarely lower than this
constexpr std::size_t kFiner = 3;    ///< fine nodes per coarse spacing
constexpr double kMostFine = 6.4e7;  ///< most nodes of the fine field: 256 megabytes
constexpr float kUnknown = std::numeric_limits<float>::infinity();
constexpr std::size_t kGroup = 4;  ///< nodes along each axis of a group of kept-out nodes
constexpr double kShell = 1.5;     ///< thickness of the layer of kept-out nodes, in spacings
constexpr std::size_t kBlock = 8;  ///< nodes along each axis of a block
constexpr std::size_t kFacetsAtOnce = 32;  ///< per task: changes no result
constexpr std::size_t kProbes = 64;        ///< nodes whose mean cost is the weight of a node
constexpr double kLeastNodes = 4096;       ///< least, whatever a node costs

/// The place of a point in a grid: the cube's first node, and the share of the way along each axis.
struct GridPlace {
    std::array<std::size_t, 3> low;
    std::array<double, 3> share;
};

GridPlace place_on_grid(const Double3& p, const Double3& origin, double spacing,
                        const std::array<std::size_t, 3>& count) {
    const std::array<double, 3> place = {(p.x - origin.x) / spacing, (p.y - origin.y) / spacing,
                                         (p.z - origin.z) / spacing};
    GridPlace found{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double last = static_cast<double>(count[k] - 2);
        const double floor = std::clamp(std::floor(place[k]), 0.0, last);
        found.low[k] = static_cast<std::size_t>(floor);
        found.share[k] = place[k] - floor;
    }
    return found;
}

template <class Node>
double interpolated(const GridPlace& place, const Node& node) {
    const auto& low = place.low;
    const auto& share = place.share;
    const auto along_x = [&](std::size_t y, std::size_t z) {
        const double first = node(low[0], low[1] + y, low[2] + z);
        return first + share[0] * (node(low[0] + 1, low[1] + y, low[2] + z) - first);
    };
    const double front = along_x(0, 0) + share[1] * (along_x(1, 0) - along_x(0, 0));
    const double back = along_x(0, 1) + share[1] * (along_x(1, 1) - along_x(0, 1));
    return front + share[2] * (back - front);
}

/// Returns the longest way from a point to a corner.
double longest_way(const Double3& from, const std::array<Double3, 3>& corners) {
    double longest = 0;
    for (const Double3& corner : corners) {
        longest = std::max(longest, mesh::euclidean_distance(from, corner));
    }
    return longest;
}

}  // namespace

DistanceField::DistanceField(const Solid& solid, double spacing, double beyond,
                             ParallelFor parallel_for, std::size_t most_nodes)
    : solid_(&solid), spacing_(spacing) {
    weight_ = find_weight();
    const auto of_work = static_cast<double>(most_nodes);
    const double most =
        std::max(of_work / static_cast<double>(weight_), std::min(of_work, kLeastNodes));
    const mesh::Box& box = solid.tree().box();
    const Double3 size = mesh::minus(box.upper, box.lower);
    const auto nodes_along = [&](double length) { return std::floor(length / spacing_) + 2; };
    while (nodes_along(size.x) * nodes_along(size.y) * nodes_along(size.z) > most) {
        spacing_ *= 1 + kCoarser;
    }
    count_ = {static_cast<std::size_t>(nodes_along(size.x)),
              static_cast<std::size_t>(nodes_along(size.y)),
              static_cast<std::size_t>(nodes_along(size.z))};
    // The grid exceeds the box by up to half a spacing on each side, so that no node lies on a
    // face.
    const auto begin = [&](double lower, double length, std::size_t count) {
        return lower + (length - static_cast<double>(count - 1) * spacing_) / 2;
    };
    origin_ = {begin(box.lower.x, size.x, count_[0]), begin(box.lower.y, size.y, count_[1]),
               begin(box.lower.z, size.z, count_[2])};
    distance_.resize(count_[0] * count_[1] * count_[2]);
    nearest_.resize(distance_.size());
    std::array<std::size_t, 3> blocks{};
    for (std::size_t k = 0; k < 3; ++k) blocks[k] = (count_[k] + kBlock - 1) / kBlock;
    std::vector<std::size_t> measured(blocks[0] * blocks[1] * blocks[2]);
    const auto fill_block = [&](std::size_t i) {
        measured[i] = fill({{i % blocks[0] * kBlock, i / blocks[0] % blocks[1] * kBlock,
                             i / blocks[0] / blocks[1] * kBlock}},
                           beyond);
    };
    parallel_for(measured.size(), fill_block);
    measured_ = std::accumulate(measured.begin(), measured.end(), std::size_t{0});
    double fine = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        fine_count_[k] = kFiner * (count_[k] - 1) + 1;
        fine *= static_cast<double>(fine_count_[k]);
    }
    if (fine > kMostFine) return;
    fine_ = std::make_unique<std::atomic<float>[]>(static_cast<std::size_t>(fine));
    for (std::size_t i = 0; i < static_cast<std::size_t>(fine); ++i) {
        fine_[i].store(kUnknown, std::memory_order_relaxed);
    }
}

Double3 DistanceField::node(std::size_t x, std::size_t y, std::size_t z) const {
    return {origin_.x + static_cast<double>(x) * spacing_,
            origin_.y + static_cast<double>(y) * spacing_,
            origin_.z + static_cast<double>(z) * spacing_};
}

/// Returns the cost of a node measured after its neighbour, as a mean over a few evenly spread
/// places.
std::size_t DistanceField::find_weight() const {
    const mesh::Box& box = solid_->tree().box();
    const Double3 size = mesh::minus(box.upper, box.lower);
    // Multiples of the powers of the root of x^4 = x + 1 fill a cube evenly.
    constexpr Double3 kStep = {0.8191725134, 0.6710436067, 0.5497004779};
    const auto along = [](double lower, double length, double step, std::size_t i) {
        const double at = step * static_cast<double>(i + 1);
        return lower + (at - std::floor(at)) * length;
    };
    std::size_t weight = 0;
    for (std::size_t i = 0; i < kProbes; ++i) {
        Double3 p = {along(box.lower.x, size.x, kStep.x, i), along(box.lower.y, size.y, kStep.y, i),
                     along(box.lower.z, size.z, kStep.z, i)};
        const std::uint32_t near = solid_->tree().nearest(p).triangle;
        p.x += spacing_;
        weight += solid_->tree().nearest(p, near).weight();
    }
    return weight / kProbes;
}

/// Far from the surface, the distance of the middle serves all nodes of a block. Elsewhere a node
/// is on the side of the previous one unless the surface may pass between them.
std::size_t DistanceField::fill(const Block& block, double beyond) {
    const auto [x0, y0, z0] = block.first;
    const std::size_t x1 = std::min(x0 + kBlock, count_[0]);
    const std::size_t y1 = std::min(y0 + kBlock, count_[1]);
    const std::size_t z1 = std::min(z0 + kBlock, count_[2]);
    const Double3 centre = middle_of(node(x0, y0, z0), node(x1 - 1, y1 - 1, z1 - 1));
    const double radius = mesh::euclidean_distance(centre, node(x0, y0, z0)) + spacing_;
    TriangleTree::Nearest near = solid_->tree().nearest(centre);
    const bool one_sided = near.distance > radius;
    const bool inside = solid_->includes(centre);
    const bool is_far = one_sided && (inside || near.distance > radius + beyond);
    std::size_t measured = 0;
    double before = one_sided ? 2 * spacing_ : 0;
    bool is_inside = inside;
    for (std::size_t z = z0; z < z1; ++z) {
        for (std::size_t y = y0; y < y1; ++y) {
            for (std::size_t x = x0; x < x1; ++x) {
                float& value = distance_[index(x, y, z)];
                if (is_far) {
                    nearest_[index(x, y, z)] = near.triangle;
                    value = static_cast<float>(inside ? radius - near.distance
                                                      : near.distance - radius);
                    continue;
                }
                const Double3 p = node(x, y, z);
                near = solid_->tree().nearest(p, near.triangle);
                measured += near.weight();
                nearest_[index(x, y, z)] = near.triangle;
                const bool is_new_row = x == x0;
                if (!one_sided && (is_new_row || std::max(before, near.distance) <= spacing_)) {
                    is_inside = solid_->includes(p);
                }
                before = near.distance;
                value = static_cast<float>(is_inside ? -near.distance : near.distance);
            }
        }
    }
    return is_far ? 1 : measured;
}

double DistanceField::at(const Double3& p) const {
    return interpolated(place_on_grid(p, origin_, spacing_, count_),
                        [this](std::size_t x, std::size_t y, std::size_t z) {
                            return static_cast<double>(distance_[index(x, y, z)]);
                        });
}

PointGroups DistanceField::nodes_beyond(double distance) const {
    PointGroups groups;
    const auto least = static_cast<float>(distance);
    const auto most = static_cast<float>(distance + kShell * spacing_);
    std::vector<Double3> group;
    for (std::size_t z0 = 0; z0 < count_[2]; z0 += kGroup) {
        for (std::size_t y0 = 0; y0 < count_[1]; y0 += kGroup) {
            for (std::size_t x0 = 0; x0 < count_[0]; x0 += kGroup) {
                group.clear();
                for (std::size_t z = z0; z < std::min(z0 + kGroup, count_[2]); ++z) {
                    for (std::size_t y = y0; y < std::min(y0 + kGroup, count_[1]); ++y) {
                        for (std::size_t x = x0; x < std::min(x0 + kGroup, count_[0]); ++x) {
                            const float value = distance_[index(x, y, z)];
                            if (value > least && value <= most) group.push_back(node(x, y, z));
                        }
                    }
                }
                groups.add(group);
            }
        }
    }
    return groups;
}

double DistanceField::fine_node(std::size_t x, std::size_t y, std::size_t z) const {
    std::atomic<float>& value = fine_[(z * fine_count_[1] + y) * fine_count_[0] + x];
    const float known = value.load(std::memory_order_relaxed);
    if (known != kUnknown) return static_cast<double>(known);
    const double step = spacing_ / static_cast<double>(kFiner);
    const Double3 p = {origin_.x + static_cast<double>(x) * step,
                       origin_.y + static_cast<double>(y) * step,
                       origin_.z + static_cast<double>(z) * step};
    // The nearest node of the grid: at most half a spacing away along each axis.
    const auto beside = [](std::size_t at) { return (at + kFiner / 2) / kFiner; };
    const std::size_t known_node = index(beside(x), beside(y), beside(z));
    const double distance = solid_->tree().nearest(p, nearest_[known_node]).distance;
    // If no surface lies between the two, both are on one side.
    const double to_node =
        mesh::euclidean_distance(p, node(beside(x), beside(y), beside(z))) + kRounded * spacing_;
    const auto of_node = static_cast<double>(distance_[known_node]);
    const bool is_inside =
        std::max(distance, std::fabs(of_node)) > to_node ? of_node < 0 : solid_->includes(p);
    const auto found = static_cast<float>(is_inside ? -distance : distance);
    value.store(found, std::memory_order_relaxed);
    return static_cast<double>(found);
}

double DistanceField::fine_at(const Double3& p) const {
    const GridPlace place =
        place_on_grid(p, origin_, spacing_ / static_cast<double>(kFiner), fine_count_);
    return interpolated(
        place, [this](std::size_t x, std::size_t y, std::size_t z) { return fine_node(x, y, z); });
}

void DistanceField::sample(std::array<Double3, 3> corners, Detail detail, Estimate& most) const {
    const double ab = mesh::euclidean_distance(corners[0], corners[1]);
    const double bc = mesh::euclidean_distance(corners[1], corners[2]);
    const double ca = mesh::euclidean_distance(corners[2], corners[0]);
    const double longest = std::max({ab, bc, ca});
    ++most.samples;
    const Double3 centre = {(corners[0].x + corners[1].x + corners[2].x) / 3,
                            (corners[0].y + corners[1].y + corners[2].y) / 3,
                            (corners[0].z + corners[1].z + corners[2].z) / 3};
    // Between two points, the distance changes by no more than the way between them.
    const double way = kCentreWay * longest;
    double here = at(centre);
    const bool is_fine = detail == Detail::fine && fine_;
    const double too_low = is_fine ? kTooLow * spacing_ : 0;
    if (here + too_low + way <= most.distance) return;
    // A fine value is only needed if it can decide this triangle.
    const bool matters = here + too_low > most.distance ||
                         here + too_low / static_cast<double>(kFiner) + way <= most.distance;
    if (is_fine && matters) {
        most.samples += weight_ - 1;
        here = fine_at(centre);
        if (here + too_low / static_cast<double>(kFiner) + way <= most.distance) return;
    }
    if (here > most.distance) most = {here, centre, most.samples};
    if (longest <= kSampling * spacing_) return;
    if (longest > ab)
        std::rotate(corners.begin(), corners.begin() + (longest == bc ? 1 : 2), corners.end());
    const Double3 cut = middle_of(corners[0], corners[1]);
    if (longest_way(cut, corners) > kMostAfterCut * longest) return;
    sample({corners[0], cut, corners[2]}, detail, most);
    sample({cut, corners[1], corners[2]}, detail, most);
}

Estimate DistanceField::estimate(const ConvexHull& hull, double least, Detail detail,
                                 ParallelFor run) const {
    Estimate most{least};
    if (hull.dimension == 1) sample({hull.points[0], hull.points[1], hull.points[1]}, detail, most);
    const std::size_t count = (hull.facets.size() + kFacetsAtOnce - 1) / kFacetsAtOnce;
    std::vector<Estimate> found(count, Estimate{least});
    const auto look = [&](std::size_t i) {
        const std::size_t end = std::min((i + 1) * kFacetsAtOnce, hull.facets.size());
        for (std::size_t k = i * kFacetsAtOnce; k < end; ++k) {
            const auto& f = hull.facets[k];
            sample({hull.points[f[0]], hull.points[f[1]], hull.points[f[2]]}, detail, found[i]);
        }
    };
    run(count, look);
    for (const Estimate& one : found) {
        const std::size_t samples = most.samples + one.samples;
        if (one.distance > most.distance) most = one;
        most.samples = samples;
    }
    return most;
}

}  // namespace cdprep::convex
