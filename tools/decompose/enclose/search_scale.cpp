// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/search_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "decompose/enclose/part_points.h"
#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

constexpr std::array<double Double3::*, 3> kCoordinates = {&Double3::x, &Double3::y, &Double3::z};
/// Sizes of meshes that are searched as they are. Sixth powers, and lengths of 2^-60 of them as
/// floats, are normal numbers.
constexpr double kLeastUsual = 0x1p-64;
constexpr double kMostUsual = 0x1p64;
constexpr int kLeastExponent = -1074;       ///< of a subnormal number
constexpr double kRoundings = 1 + 0x1p-50;  ///< exceeds the rounding of a sum of six numbers

double next_above(double x) {
    return std::nextafter(x, std::numeric_limits<double>::infinity());
}
double next_below(double x) {
    return std::nextafter(x, -std::numeric_limits<double>::infinity());
}

}  // namespace

SearchScale::SearchScale(std::span<const Double3> positions) {
    mesh::Box box;
    for (const Double3& p : positions) box.add(p);
    double largest = 0;        // of all coordinates
    double largest_moved = 0;  // of those along axes with an extent
    double side = 0;
    Double3 shift = {};
    for (double Double3::*axis : kCoordinates) {
        const double lower = box.lower.*axis;
        const double upper = box.upper.*axis;
        const double size = std::max(std::fabs(lower), std::fabs(upper));
        largest = std::max(largest, size);
        side = std::max(side, upper - lower);
        if (lower == upper) {
            shift.*axis = lower;
        } else {
            largest_moved = std::max(largest_moved, size);
        }
    }
    is_needed_ = !(largest <= kMostUsual && side >= kLeastUsual);
    if (!is_needed_) return;
    shift_ = shift;
    if (largest_moved > 0) exponent_ = std::ilogb(largest_moved);
    for (const Double3& p : positions) {
        const Double3 moved = mesh::minus(p, shift_);
        const Double3 mapped = inwards(p);
        for (double Double3::*axis : kCoordinates) {
            if (std::ldexp(mapped.*axis, exponent_) == moved.*axis) continue;
            // Each coordinate changes by at most half of this.
            lost_ = std::ldexp(1.0, exponent_ + kLeastExponent);
        }
    }
}

Double3 SearchScale::inwards(const Double3& p) const {
    const Double3 moved = mesh::minus(p, shift_);
    return {std::ldexp(moved.x, -exponent_), std::ldexp(moved.y, -exponent_),
            std::ldexp(moved.z, -exponent_)};
}

mesh::Mesh SearchScale::inwards(mesh::Mesh mesh) const {
    for (Double3& p : mesh.positions) p = inwards(p);
    return mesh;
}

ConvexHull SearchScale::inwards(ConvexHull hull) const {
    for (Double3& p : hull.points) p = inwards(p);
    return hull;
}

double SearchScale::inwards(double length) const {
    return std::min(std::ldexp(length, -exponent_), std::numeric_limits<double>::max());
}

/// Returns numbers around a coordinate of the search in model units; equal if it is exact.
SearchScale::Range SearchScale::outwards(double x, double shift) const {
    const double scaled = std::ldexp(x, exponent_);
    const double back = std::ldexp(scaled, -exponent_);  // exact
    const double at = scaled + shift;
    const bool is_rounded = lost_ > 0 || (x != 0 && shift != 0);
    return {is_rounded || back > x ? next_below(at - lost_) : at,
            is_rounded || back < x ? next_above(at + lost_) : at};
}

// A point lies in the box of its ranges, so the hull of all boxes contains the hull of the points.
// It is as far from it as one of its corners.
OuterHull SearchScale::outwards(const ConvexHull& hull) const {
    OuterHull outer{hull, 0};
    outer.hull.numbers.clear();
    std::vector<Double3> corners;
    for (Double3& p : outer.hull.points) {
        Place place;
        double sides = 0;
        for (double Double3::*axis : kCoordinates) {
            const auto [lower, upper] = outwards(p.*axis, shift_.*axis);
            place.lower.*axis = lower;
            place.upper.*axis = upper;
            sides += upper - lower;
        }
        add_corners(place, corners);
        outer.growth = std::max(outer.growth, sides);
        p = place.lower;
    }
    if (outer.growth == 0) return outer;
    outer.growth *= kRoundings;
    outer.hull = convex_hull(corners);
    outer.hull.numbers.clear();
    return outer;
}

HullError SearchScale::outwards(const HullError& error) const {
    HullError mapped = error;
    mapped.lower = std::max(0.0, outwards(error.lower, 0).lower);
    mapped.upper = outwards(error.upper, 0).upper;
    for (double Double3::*axis : kCoordinates) {
        mapped.worst.*axis = std::ldexp(error.worst.*axis, exponent_) + shift_.*axis;
    }
    return mapped;
}

}  // namespace cdprep::convex
