// SPDX-License-Identifier: MIT
#include "hull/exact_nearest.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/numbers.h"
#include "exact/wide_vector.h"

// The search of Gilbert, Johnson and Keerthi without rounding. It keeps the corners of the face
// that holds the nearest point x so far. It adds the corner of A - B that is lowest along x. Among
// all subsets of the at most four corners it keeps the one whose nearest point is nearest to all of
// them. Such a subset exists: no other corner is lower along its nearest point. When no corner is
// lower than x, x is nearest. Each step brings x strictly nearer, and there are finitely many
// faces. So the search ends for any start.
//
// Every sign is that of a polynomial of coordinates, taken as integers: multiples of the lowest bit
// of the points involved. x is computed only up to its length. It is p itself for one corner,
// p (e.e) - e (p.e) for an edge e, the normal n for a face.

namespace cdprep {
namespace {

constexpr std::size_t kSquare = 2 * kWideCoordinate;
constexpr std::size_t kVolume = 3 * kWideCoordinate;
using Length = WideInteger<kWideCoordinate>;
using Square = WideInteger<kSquare>;
using ExactDirection = WideVector<kVolume>;

/// Differences of up to four corners, all with the same unit.
struct Places {
    std::array<WidePlace, 4> at;
    int lowest;  ///< the exponent of the unit
};

Places places_of(const Difference* corner, std::size_t count, int at_most) {
    assert(count > 0 && count <= 4);
    Places places;
    places.lowest = at_most;
    for (std::size_t i = 0; i < count; ++i) {
        const std::array<Double3, 2> ends = {corner[i].at_a, corner[i].at_b};
        places.lowest = std::min(places.lowest, lowest_bit_of(ends));
    }
    for (std::size_t i = 0; i < count; ++i) {
        places.at[i] =
            wide_place(corner[i].at_a, places.lowest) - wide_place(corner[i].at_b, places.lowest);
    }
    return places;
}

/// An integer as value * 2^exponent, within 2.1 u of it.
struct Approximate {
    double value;
    int exponent;
};

Approximate approximate(const WideView& wide) {
    constexpr std::size_t kLeading = 3;  // limbs: 65 bits or more, and double has 53
    const std::size_t used = std::min(wide.size, kLeading);
    double value = 0;
    for (std::size_t i = 0; i < used; ++i) value = value * 0x1p32 + wide.limb[wide.size - 1 - i];
    return {wide.negative ? -value : value, static_cast<int>(32 * (wide.size - used))};
}

/// Returns the sizes of numbers, divided by their sum, which is not 0.
std::array<double, 4> parts_of_one(const std::array<Approximate, 4>& numbers) {
    int most = std::numeric_limits<int>::min();
    for (const Approximate& x : numbers) {
        if (x.value != 0) most = std::max(most, x.exponent + std::ilogb(x.value));
    }
    std::array<double, 4> parts{};
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const Approximate& x = numbers[i];
        if (x.value == 0) continue;
        parts[i] = std::fabs(std::ldexp(x.value, std::max(x.exponent - most, -2000)));
        sum += parts[i];
    }
    assert(sum > 0);
    for (double& part : parts) part /= sum;
    return parts;
}

/// The corners of a face of a simplex, and whether their hull holds the origin.
struct Face {
    std::array<std::uint8_t, 4> corner{};
    std::size_t count = 0;
    bool holds_origin = false;
};

class ExactSimplex {
public:
    ExactSimplex(const Difference* corner, std::size_t count)
        : places_(places_of(corner, count, lowest_bit(0))), count_(count) {}

    /// Returns the face nearest to the origin. Sets direction() unless the origin lies in that
    /// face.
    Face nearest() {
        const auto count = static_cast<std::uint8_t>(count_);
        for (std::uint8_t i = 0; i < count; ++i) {
            if (const Face face = corner(i); face.count > 0) return face;
        }
        for (std::uint8_t i = 0; i < count; ++i) {
            for (std::uint8_t j = 0; j < i; ++j) {
                if (const Face face = edge(i, j); face.count > 0) return face;
            }
        }
        for (std::uint8_t i = 0; i < count; ++i) {
            for (std::uint8_t j = 0; j < i; ++j) {
                for (std::uint8_t k = 0; k < j; ++k) {
                    if (const Face face = triangle(i, j, k); face.count > 0) return face;
                }
            }
        }
        // No face is nearest: the origin lies inside.
        assert(count_ == 4);
        return {{0, 1, 2, 3}, count_, true};
    }
    [[nodiscard]] const ExactDirection& direction() const {
        return direction_;
    }

    /// Returns the weights of the nearest point, as nearest() found it: fractions that are not
    /// negative.
    [[nodiscard]] std::array<double, 4> weights(const Face& face) const {
        const auto& [i, j, k, l] = face.corner;
        if (face.count == 1) return {1};
        if (face.count == 2) {
            const WidePlace e = at(j) - at(i);
            const Square along = -dot(at(i), e);
            return parts_of_one(
                {approximate((dot(e, e) - along).view()), approximate(along.view())});
        }
        if (face.count == 3) {
            const WideVector<kSquare> n = cross(at(j) - at(i), at(k) - at(i));
            return parts_of_one({approximate(dot(n, cross(at(j), at(k))).view()),
                                 approximate(dot(n, cross(at(k), at(i))).view()),
                                 approximate(dot(n, cross(at(i), at(j))).view())});
        }
        return parts_of_one({volume(j, k, l), volume(i, k, l), volume(i, j, l), volume(i, j, k)});
    }

private:
    [[nodiscard]] Approximate volume(std::uint8_t p, std::uint8_t q, std::uint8_t r) const {
        return approximate(dot(at(p), cross(at(q), at(r))).view());
    }
    [[nodiscard]] const WidePlace& at(std::uint8_t i) const {
        return places_.at[i];
    }
    /// Returns whether no corner is lower along the direction than p.
    [[nodiscard]] bool none_is_lower(std::uint8_t p) const {
        for (std::size_t i = 0; i < count_; ++i) {
            if (i != p && dot(direction_, places_.at[i] - at(p)).sign() < 0) return false;
        }
        return true;
    }
    Face corner(std::uint8_t p) {
        direction_ = Square::from_double(1, 0) * at(p);
        if (dot(direction_, at(p)).sign() == 0) return {{p}, 1, true};
        return none_is_lower(p) ? Face{{p}, 1, false} : Face{};
    }
    Face edge(std::uint8_t p, std::uint8_t q) {
        const WidePlace e = at(q) - at(p);
        const Square along = -dot(at(p), e);
        const Square whole = dot(e, e);
        if (along.sign() <= 0 || (whole - along).sign() <= 0) return {};
        direction_ = whole * at(p) + along * e;
        if (is_zero()) return {{p, q}, 2, true};
        return none_is_lower(p) ? Face{{p, q}, 2, false} : Face{};
    }
    Face triangle(std::uint8_t p, std::uint8_t q, std::uint8_t r) {
        const WideVector<kSquare> n = cross(at(q) - at(p), at(r) - at(p));
        // The foot of the origin is parallel to n and adds nothing to these.
        const std::array<int, 3> weight = {dot(n, cross(at(q), at(r))).sign(),
                                           dot(n, cross(at(r), at(p))).sign(),
                                           dot(n, cross(at(p), at(q))).sign()};
        if (weight[0] < 0 || weight[1] < 0 || weight[2] < 0) return {};
        if (weight[0] == 0 && weight[1] == 0 && weight[2] == 0) return {};  // has no area
        const int side = dot(n, at(p)).sign();
        if (side == 0) return {{p, q, r}, 3, true};
        direction_ = Length::from_double(side, 0) * n;
        return none_is_lower(p) ? Face{{p, q, r}, 3, false} : Face{};
    }
    [[nodiscard]] bool is_zero() const {
        return direction_[0].sign() == 0 && direction_[1].sign() == 0 && direction_[2].sign() == 0;
    }

    Places places_;
    std::size_t count_;
    ExactDirection direction_;
};

/// An exact direction, and its rounded form for comparisons that double can decide.
class Compared {
public:
    explicit Compared(const ExactDirection& exact) : exact_(&exact) {
        std::array<Approximate, 3> parts{};
        int most = std::numeric_limits<int>::min();
        for (std::size_t i = 0; i < 3; ++i) {
            parts[i] = approximate(exact[i].view());
            if (parts[i].value != 0) {
                most = std::max(most, parts[i].exponent + std::ilogb(parts[i].value));
            }
        }
        std::array<double, 3> rounded{};
        for (std::size_t i = 0; i < 3; ++i) {
            if (parts[i].value == 0) continue;
            rounded[i] = std::ldexp(parts[i].value, std::max(parts[i].exponent - most, -2000));
            // Products of smaller numbers with large coordinates may lose too much.
            constexpr double kLeast = 0x1p-900;
            certain_ = certain_ && std::fabs(rounded[i]) >= kLeast;
        }
        rounded_ = {rounded[0], rounded[1], rounded[2]};
    }
    [[nodiscard]] const Double3& rounded() const {
        return rounded_;
    }

    /// Returns the sign of direction . (p - q). In double, the direction is off by 2.1 u; the
    /// difference, the products and the sums by 4 u.
    [[nodiscard]] int sign(const Double3& p, const Double3& q) const {
        constexpr double kError = 12 * 0x1p-53;
        constexpr double kUnderflow = 0x1p-1060;
        const Double3 step = p - q;
        const double value = dot(rounded_, step);
        const double error = kError * dot_size(rounded_, step) + kUnderflow;
        if (certain_ && std::fabs(value) > error) return value > 0 ? 1 : -1;
        const std::array<Double3, 2> ends = {p, q};
        const int lowest = lowest_bit_of(ends);
        return dot(*exact_, wide_place(p, lowest) - wide_place(q, lowest)).sign();
    }

private:
    const ExactDirection* exact_;
    Double3 rounded_{};
    bool certain_ = true;
};

struct PlacedPoint {
    std::uint32_t number;
    Double3 at;
};

/// Returns the point that is highest (kSide > 0) or lowest along a direction.
template <int kSide>
PlacedPoint extreme(const MovedHull& hull, const Compared& direction) {
    const Double3 along = kSide > 0 ? direction.rounded() : -direction.rounded();
    const std::uint32_t first = hull.proven_by_all(along, hull.point(0)).number;
    PlacedPoint best = {first, hull.point(first)};
    hull.each_point([&](std::uint32_t number, const Double3& p) {
        if (number != best.number && direction.sign(p, best.at) == kSide) best = {number, p};
    });
    return best;
}

/// Returns the sign of direction . (p - q) for corners, or of direction . p if q is null.
int sign_along(const ExactDirection& direction, const Difference& p, const Difference* q) {
    const std::array<Difference, 2> both = {p, q == nullptr ? p : *q};
    const Places places = places_of(both.data(), 2, lowest_bit(0));
    if (q == nullptr) return dot(direction, places.at[0]).sign();
    return dot(direction, places.at[0] - places.at[1]).sign();
}

/// The square of the distance as numerator and denominator, in units of places.lowest.
struct SquaredDistance {
    WideInteger<2 * kVolume> numerator;
    WideInteger<2 * kSquare> denominator;
};

SquaredDistance squared_distance(const Places& places, std::size_t count) {
    assert(count >= 1 && count <= 3);
    const WidePlace& p = places.at[0];
    const WideInteger<2 * kSquare> one = WideInteger<2 * kSquare>::from_double(1, 0);
    if (count == 1) return {one * dot(p, p), one};
    const WidePlace e = places.at[1] - p;
    if (count == 2) {
        const Square along = dot(p, e);
        const Square whole = dot(e, e);
        const Square unit = Square::from_double(1, 0);
        return {unit * (dot(p, p) * whole - along * along), unit * whole};
    }
    const WideVector<kSquare> n = cross(e, places.at[2] - p);
    const WideInteger<kVolume> height = dot(n, p);
    return {height * height, dot(n, n)};
}

}  // namespace

ExactNearest exact_nearest(const MovedHull& a, const MovedHull& b, const NearestSimplex& from,
                           ExactGoal goal, QueryCounts* counts) noexcept {
    if (counts != nullptr) ++counts->hulls_by_exact;
    ExactNearest result{};
    result.corner = from.corner;
    result.count = from.count;
    for (;;) {
        ExactSimplex simplex(result.corner.data(), result.count);
        const Face face = simplex.nearest();
        const std::array<Difference, 4> all = result.corner;
        for (std::size_t i = 0; i < face.count; ++i) result.corner[i] = all[face.corner[i]];
        result.count = face.count;
        result.meet = face.holds_origin;
        if (result.meet) return result;
        const Compared direction(simplex.direction());
        const PlacedPoint low = extreme<-1>(a, direction);
        const PlacedPoint high = extreme<1>(b, direction);
        const Difference added = {low.number, high.number, low.at, high.at, low.at - high.at};
        if (sign_along(simplex.direction(), added, result.corner.data()) >= 0) return result;
        if (goal == ExactGoal::verdict && sign_along(simplex.direction(), added, nullptr) > 0) {
            return result;
        }
        assert(result.count < result.corner.size());
        result.corner[result.count++] = added;
        if (counts != nullptr) ++counts->exact_steps;
    }
}

DistanceBounds bounds_of(const ExactNearest& nearest) noexcept {
    const Places places = places_of(nearest.corner.data(), nearest.count, lowest_bit(0));
    const SquaredDistance squared = squared_distance(places, nearest.count);
    const Approximate above = approximate(squared.numerator.view());
    const Approximate below = approximate(squared.denominator.view());
    const int exponent = above.exponent - below.exponent;
    const bool odd = exponent % 2 != 0;
    const double root = std::sqrt(above.value / below.value * (odd ? 2 : 1));
    const int shift = (odd ? exponent - 1 : exponent) / 2 + places.lowest;
    // Two approximations, a quotient and a root: less than 4 u.
    constexpr double kError = 8 * 0x1p-53;
    const double lower = std::ldexp(root * (1 - kError), shift);
    const double upper = std::ldexp(root * (1 + kError), shift);
    return {std::max(0.0, std::nextafter(lower, -kInfinity)), std::nextafter(upper, kInfinity)};
}

bool is_within(const ExactNearest& nearest, double tolerance) noexcept {
    const Places places = places_of(nearest.corner.data(), nearest.count, lowest_bit(tolerance));
    const SquaredDistance squared = squared_distance(places, nearest.count);
    const Length limit = Length::from_double(tolerance, places.lowest);
    return (squared.numerator - (limit * limit) * squared.denominator).sign() <= 0;
}

NearestSimplex exactly_weighted(const Difference* corner, std::size_t count) noexcept {
    ExactSimplex exact(corner, count);
    const Face face = exact.nearest();
    NearestSimplex simplex;
    simplex.count = face.count;
    simplex.weight = exact.weights(face);
    for (std::size_t i = 0; i < face.count; ++i) simplex.corner[i] = corner[face.corner[i]];
    return simplex;
}

}  // namespace cdprep
