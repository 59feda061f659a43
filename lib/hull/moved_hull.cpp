// SPDX-License-Identifier: MIT
#include "hull/moved_hull.h"
#include "core/numbers.h"

#include <algorithm>
#include <cassert>
#include <cmath>

// Hill climbing walks the stored hull, whose edges are exact, along d': the direction d turned back
// to the hull's frame. Its result is then proved for the points as they are moved. Let u = 2^-53, X
// the largest coordinates of stored points, and S = sum_i |d_i| (sum_j |R_ij| X_j + |T_i|). For
// stored points p and v
//
//   G = d' . (p - v) in double  is off by 4u of the products' sizes:       8.1 u S
//   d' is off by 3u in each component, times |p - v| <= 2 X:               6.1 u S
//   transform_point(p) and transform_point(v) are off by 4u of
//   their products' sizes and T:                                           8.1 u S
//
// so d . (transform_point(p) - transform_point(v)) differs from G by less than s = 24 u S.
//
// In a convex polytope, the corners higher than a given height are connected by its edges. So let M
// be a connected set of corners that contains v, such that G < -2 s for every neighbour of M. Then
// all corners outside M are lower than v by more than s before moving, and still lower than v
// afterwards. So the highest corner is in M.

namespace cdprep {
namespace {

constexpr double kSlack = 24 * 0x1p-53;      ///< s / S: derived above
constexpr double kValueError = 6 * 0x1p-53;  ///< as in the kernel
constexpr double kUnderflow = 0x1p-1060;     ///< what products of numbers near 0 may lose
constexpr std::size_t kMostAlike = 24;       ///< of about one height; more: all are scanned

double at(const Double3& p, std::size_t axis) {
    return axis == 0 ? p.x : (axis == 1 ? p.y : p.z);
}

/// Numbers of corners, in the order they were found.
class Alike {
public:
    explicit Alike(std::uint32_t first) : number_{first} {}

    [[nodiscard]] std::size_t size() const {
        return size_;
    }
    [[nodiscard]] std::uint32_t operator[](std::size_t i) const {
        return number_[i];
    }
    [[nodiscard]] bool has(std::uint32_t number) const {
        const auto* end = number_.data() + size_;
        return std::find(number_.data(), end, number) != end;
    }
    /// Adds a number. Returns false when there is no room.
    bool add(std::uint32_t number) {
        if (size_ == kMostAlike) return false;
        number_[size_++] = number;
        return true;
    }

private:
    std::array<std::uint32_t, kMostAlike> number_;
    std::size_t size_ = 1;
};

}  // namespace

MovedHull::MovedHull(const ConvexPoints& points, const Pose* pose) noexcept
    : points_(&points), pose_(pose) {}

std::uint32_t MovedHull::scan_corners(const Double3& local) const noexcept {
    std::uint32_t best = 0;
    double most = dot(local, hull_point(*points_, 0));
    for (std::uint32_t i = 1; i < count(); ++i) {
        const double height = dot(local, hull_point(*points_, i));
        if (height > most) most = height, best = i;
    }
    return best;
}

std::uint32_t MovedHull::scan(const Double3& local) const noexcept {
    if (!points_->corners.empty()) return scan_corners(local);
    const std::array<double, 3> d = {local.x, local.y, local.z};
    const std::uint32_t number = kernels::active().farthest(points_->blocks[0].at[0].data(),
                                                            points_->blocks.size(), d.data());
    return std::min(number, count() - 1);
}

std::uint32_t MovedHull::climb(const Double3& local, std::uint32_t from) const noexcept {
    double height = dot(local, hull_point(*points_, from));
    for (std::uint32_t last = count(); last != from;) {
        last = from;
        for (const std::uint32_t number : neighbours(last)) {
            const double other = dot(local, hull_point(*points_, number));
            if (!(other > height)) continue;
            height = other;
            from = number;
        }
    }
    return from;
}

std::uint32_t MovedHull::farthest(const Double3& direction, std::uint32_t near) const noexcept {
    const Double3 local = turned_back(pose_, direction);
    return can_climb() ? climb(local, near) : scan(local);
}

std::uint32_t MovedHull::farthest_anew(const Double3& direction,
                                       std::uint32_t near) const noexcept {
    const Double3 local = turned_back(pose_, direction);
    if (!can_climb()) return scan(local);
    if (points_->starts.empty()) return climb(local, near);
    const std::uint32_t start = points_->starts[cell_of_direction(local)];
    const bool is_better =
        dot(local, hull_point(*points_, start)) > dot(local, hull_point(*points_, near));
    return climb(local, is_better ? start : near);
}

double MovedHull::slack(const Double3& direction) const noexcept {
    const Double3& x = points_->reach;
    if (pose_ == nullptr) return kSlack * dot_size(direction, x) + kUnderflow;
    const std::array<double, 9>& r = pose_->rotation();
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double most = std::fabs(r[3 * i]) * x.x + std::fabs(r[3 * i + 1]) * x.y +
                            std::fabs(r[3 * i + 2]) * x.z;
        sum += std::fabs(at(direction, i)) * (most + std::fabs(at(pose_->translation(), i)));
    }
    return kSlack * sum + kUnderflow;
}

kernels::FarthestPoint MovedHull::proven_by_corners(const Double3& direction,
                                                    const Double3& origin) const noexcept {
    kernels::FarthestPoint best = {0, -kInfinity, -kInfinity};
    each_point([&](std::uint32_t number, const Double3& at) {
        const Double3 p = at - origin;
        const double value = dot(p, direction);
        best.bound = std::max(best.bound, value + kValueError * dot_size(p, direction));
        if (!(value > best.value)) return;
        best.number = number;
        best.value = value;
    });
    return best;
}

kernels::FarthestPoint MovedHull::proven_by_all(const Double3& direction,
                                                const Double3& origin) const noexcept {
    if (!points_->corners.empty()) return proven_by_corners(direction, origin);
    const Pose still;
    const Pose& pose = pose_ == nullptr ? still : *pose_;
    kernels::MovedDirection from{};
    std::copy_n(pose.rotation().data(), 9, from.rotation);
    for (std::size_t i = 0; i < 3; ++i) {
        from.translation[i] = at(pose.translation(), i);
        from.origin[i] = at(origin, i);
        from.direction[i] = at(direction, i);
    }
    kernels::FarthestPoint result = kernels::active().farthest_moved(
        points_->blocks[0].at[0].data(), points_->blocks.size(), from);
    result.number = std::min(result.number, count() - 1);
    return result;
}

double MovedHull::bound_along(const Double3& direction, const Double3& origin) const noexcept {
    const Double3 p = point(farthest(direction, 0)) - origin;
    return dot(p, direction) + kValueError * dot_size(p, direction) + 2 * slack(direction);
}

kernels::FarthestPoint MovedHull::proven(const Double3& direction, const Double3& origin,
                                         std::uint32_t farthest) const noexcept {
    assert(farthest < count());
    if (!can_climb()) return proven_by_all(direction, origin);
    const Double3 local = turned_back(pose_, direction);
    const Double3 top = hull_point(*points_, farthest);
    const double least = -2 * slack(direction);
    Alike alike(farthest);
    kernels::FarthestPoint best = {farthest, -kInfinity, -kInfinity};
    for (std::size_t i = 0; i < alike.size(); ++i) {
        const Double3 p = point(alike[i]) - origin;
        const double value = dot(p, direction);
        best.bound = std::max(best.bound, value + kValueError * dot_size(p, direction));
        if (value > best.value) {
            best.number = alike[i];
            best.value = value;
        }
        for (const std::uint32_t number : neighbours(alike[i])) {
            if (dot(local, hull_point(*points_, number) - top) < least || alike.has(number))
                continue;
            if (!alike.add(number)) return proven_by_all(direction, origin);
        }
    }
    return best;
}

}  // namespace cdprep
