// SPDX-License-Identifier: MIT
#include "cells/tetra_cones.h"

#include <cassert>
#include <optional>

#include "cells/cone_faces.h"
#include "cells/cone_place.h"
#include "exact/wide_integer.h"

// Let a triangle have the corners p_i. It touches the closed cone exactly when a point sum(w_i
// p_i), with weights w >= 0, sum 1, has f_k >= 0 for the three faces k. So the nine numbers
// f_k(p_i) decide it, whether the triangle has area, lies in a plane with the centre, or holds it.
// The triangle touches the cone when
//
// - a corner lies in the cone; or
// - an edge meets it: three intervals of the edge have a common point. They do when each two have
//   one. The order of two ends f_k = 0 and f_m = 0 is the sign of a 2 x 2 minor f_k(i) f_m(j) -
//   f_m(i) f_k(j); or
// - no edge meets it. Then the common part, being convex, lies inside the triangle. If the centre
//   is not in the triangle's plane, each ray of the cone pierces the triangle, the generators too.
//   If it is, the common part is the centre, and generators that are not in the plane pierce it
//   there. A generator, the line f_k = f_m = 0, pierces the triangle when the minors of its three
//   edges have one sign. They are the weights of the point, up to a factor. The third f there is
//   the determinant of all nine, with that sign.
//
// All signs are taken from rounded numbers where those leave no doubt. Otherwise they are taken
// from integers: p - C is a multiple of the lowest bit of any coordinate.

namespace cdprep {
namespace {

/// Coordinates and their differences, times whole numbers, in units of the lowest bit.
using Length = WideInteger<kWideCoordinate>;
using Value = WideInteger<2 * kWideCoordinate>;
using Minor = WideInteger<4 * kWideCoordinate>;

Length whole(std::int32_t number) noexcept {
    return Length::from_double(number, 0);
}

int lowest_of(const Double3& p) noexcept {
    return std::min({lowest_bit(p.x), lowest_bit(p.y), lowest_bit(p.z)});
}

/// Returns p - C.
std::array<Length, 3> exact_difference(const Double3& p, const Double3& c, int lowest) noexcept {
    const auto along = [&](double x, double origin) {
        return Length::from_double(x, lowest) - Length::from_double(origin, lowest);
    };
    return {along(p.x, c.x), along(p.y, c.y), along(p.z, c.z)};
}

/// Returns the sign of `value`, which is off by less than `slack`; 2 where that may change the
/// sign.
int certain_sign(double value, double slack) noexcept {
    if (value > slack) return 1;
    return value < -slack ? -1 : 2;
}

/// The exact values of f for each face and corner, times 2^level.
class ExactValues {
public:
    ExactValues(const Corners& t, const Double3& centre, const ConeFaces& faces) noexcept {
        const int lowest =
            std::min({lowest_of(t[0]), lowest_of(t[1]), lowest_of(t[2]), lowest_of(centre)});
        for (std::size_t i = 0; i < 3; ++i) {
            std::array<Length, 3> at = exact_difference(t[i], centre, lowest);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (faces.sign[axis] < 0) at[axis] = -at[axis];
            }
            const Length sum = at[0] + at[1] + at[2];
            for (std::size_t k = 0; k < 3; ++k) {
                const ConeFace& face = faces.face[k];
                const Value value = at[face.axis] * whole(faces.steps) - sum * whole(face.steps);
                at_[k][i] = face.side < 0 ? -value : value;
            }
        }
    }

    [[nodiscard]] int sign(std::size_t face, std::size_t corner) const noexcept {
        return at_[face][corner].sign();
    }
    [[nodiscard]] Minor minor_of(std::size_t k, std::size_t m, std::size_t i,
                                 std::size_t j) const noexcept {
        return at_[k][i] * at_[m][j] - at_[m][i] * at_[k][j];
    }
    /// Returns the sign of the determinant of rows k, m and then `last`.
    [[nodiscard]] int determinant_sign(std::size_t k, std::size_t m,
                                       std::size_t last) const noexcept {
        return (minor_of(k, m, 1, 2) * at_[last][0] + minor_of(k, m, 2, 0) * at_[last][1] +
                minor_of(k, m, 0, 1) * at_[last][2])
            .sign();
    }

private:
    std::array<std::array<Value, 3>, 3> at_;
};

/// The contact of a triangle and a cone, decided by exact signs.
class ConeContact {
public:
    ConeContact(const Corners& t, const Double3& centre, const ConeFaces& faces,
                const FaceValues& f) noexcept
        : t_(t), centre_(centre), faces_(faces), f_(f) {}

    [[nodiscard]] bool touch() noexcept {
        for (std::size_t k = 0; k < 3; ++k) {
            if (is_outside(k)) return false;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            if (sign_[0][i] >= 0 && sign_[1][i] >= 0 && sign_[2][i] >= 0) return true;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            if (edge_touches(i, (i + 1) % 3)) return true;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            if (generator_pierces((k + 1) % 3, (k + 2) % 3, k)) return true;
        }
        return false;
    }

private:
    const ExactValues& exact() noexcept {
        if (!exact_) exact_.emplace(t_, centre_, faces_);
        return *exact_;
    }

    /// Returns whether all corners lie strictly beyond a face. Sets the signs.
    bool is_outside(std::size_t k) noexcept {
        int greatest = -1;
        for (std::size_t i = 0; i < 3; ++i) {
            sign_[k][i] = certain_sign(f_.at[k][i], f_.slack[i]);
            if (sign_[k][i] == 2) sign_[k][i] = exact().sign(k, i);
            greatest = std::max(greatest, sign_[k][i]);
        }
        return greatest < 0;
    }

    /// A minor in double. Let f be off by less than e. A product a b is off by less than |a| e_b +
    /// |b| e_a + e_a e_b and u |a b|. Their difference is off by u of itself.
    struct Rounded {
        double value;
        double slack;
    };
    [[nodiscard]] Rounded rounded_minor(std::size_t k, std::size_t m, std::size_t i,
                                        std::size_t j) const noexcept {
        constexpr double kUnderflow = 0x1p-1000;
        const double ki = f_.at[k][i], mi = f_.at[m][i], kj = f_.at[k][j], mj = f_.at[m][j];
        const double left = ki * mj, right = mi * kj;
        const double slack = f_.slack[j] * (std::fabs(ki) + std::fabs(mi)) +
                             f_.slack[i] * (std::fabs(kj) + std::fabs(mj)) +
                             2 * f_.slack[i] * f_.slack[j] +
                             0x1p-51 * (std::fabs(left) + std::fabs(right));
        return {left - right, slack * (1 + 0x1p-40) + kUnderflow};
    }
    [[nodiscard]] int minor_sign(std::size_t k, std::size_t m, std::size_t i,
                                 std::size_t j) noexcept {
        const Rounded rounded = rounded_minor(k, m, i, j);
        const int sign = certain_sign(rounded.value, rounded.slack);
        return sign != 2 ? sign : exact().minor_of(k, m, i, j).sign();
    }

    bool edge_touches(std::size_t i, std::size_t j) noexcept {
        for (std::size_t k = 0; k < 3; ++k) {
            if (sign_[k][i] < 0 && sign_[k][j] < 0) return false;
        }
        // From i to j: face `in` is entered on the way, face `out` is left.
        for (std::size_t in = 0; in < 3; ++in) {
            if (sign_[in][i] >= 0) continue;
            for (std::size_t out = 0; out < 3; ++out) {
                if (sign_[out][j] < 0 && minor_sign(in, out, i, j) > 0) return false;
            }
        }
        return true;
    }

    /// Returns whether the line f_k = f_m = 0 pierces the triangle where f_last >= 0.
    bool generator_pierces(std::size_t k, std::size_t m, std::size_t last) noexcept {
        const int side = minor_sign(k, m, 0, 1);
        if (side == 0 || minor_sign(k, m, 1, 2) != side || minor_sign(k, m, 2, 0) != side) {
            return false;
        }
        return determinant_sign(k, m, last) * side >= 0;
    }
    [[nodiscard]] int determinant_sign(std::size_t k, std::size_t m, std::size_t last) noexcept {
        double value = 0;
        double size = 0;
        double slack = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const Rounded minor = rounded_minor(k, m, (i + 1) % 3, (i + 2) % 3);
            const double f = f_.at[last][i];
            value += minor.value * f;
            size += std::fabs(minor.value * f);
            slack +=
                minor.slack * (std::fabs(f) + f_.slack[i]) + std::fabs(minor.value) * f_.slack[i];
        }
        const int sign = certain_sign(value, (slack + 0x1p-50 * size) * (1 + 0x1p-40));
        return sign != 2 ? sign : exact().determinant_sign(k, m, last);
    }

    const Corners& t_;
    const Double3& centre_;
    const ConeFaces& faces_;
    const FaceValues& f_;
    std::array<std::array<int, 3>, 3> sign_{};  ///< [face][corner]
    std::optional<ExactValues> exact_;
};

/// Returns the power of two that brings the farthest corner near 1, where the filters work; 1 where
/// they work anyway.
double scale_for(const Double3& centre, const Corners& t) noexcept {
    double most = 0;
    for (const Double3& p : t) most = std::max(most, seen_point(centre, p, 1).size);
    if (most == 0 || (most > 0x1p-300 && most < 0x1p300)) return 1;
    return std::ldexp(1.0, std::clamp(-std::ilogb(most), -1010, 1010));
}

/// Returns the number of the child that holds the place with barycentric coordinates `l` of the
/// given sum. Sets `l` to the coordinates within the child. Ties go to the lowest child.
std::uint32_t split_place(std::array<Length, 3>& l, const Length& sum) noexcept {
    for (std::uint32_t child = 0; child < 3; ++child) {
        if ((l[child] + l[child] - sum).sign() < 0) continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            l[k] = k == child ? l[k] + l[k] - sum : l[k] + l[k];
        }
        return child;
    }
    l = {sum - (l[2] + l[2]), sum - (l[0] + l[0]), sum - (l[1] + l[1])};
    return 3;
}

std::uint32_t octant_of(const Double3& centre, const Double3& p) noexcept {
    return (p.x < centre.x ? 1U : 0U) | (p.y < centre.y ? 2U : 0U) | (p.z < centre.z ? 4U : 0U);
}

std::uint32_t exact_key(const Double3& centre, const Double3& p, std::uint32_t level) noexcept {
    const int lowest = std::min(lowest_of(centre), lowest_of(p));
    std::array<Length, 3> l = exact_difference(p, centre, lowest);
    for (Length& x : l) {
        if (x.sign() < 0) x = -x;
    }
    const Length sum = l[0] + l[1] + l[2];
    std::uint32_t key = 8U | octant_of(centre, p);
    for (std::uint32_t i = 0; i < level; ++i) key = key << 2 | split_place(l, sum);
    return key;
}

Generator middle(const Generator& a, const Generator& b) noexcept {
    // Twice the middle, as generators of the next level are.
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

Generator twice(const Generator& a) noexcept {
    return middle(a, a);
}

}  // namespace

TetraCone tetra_cone(std::uint32_t key) noexcept {
    assert(key >= 8 && tetra_level(key) <= format::kMaxTetraLevel);
    const std::uint32_t level = tetra_level(key);
    const std::uint32_t octant = key >> (2 * level);
    const auto axis_sign = [&](std::uint32_t axis) { return (octant >> axis & 1U) != 0 ? -1 : 1; };
    TetraCone cone{{{{axis_sign(0), 0, 0}, {0, axis_sign(1), 0}, {0, 0, axis_sign(2)}}}, level};
    for (std::uint32_t i = level; i-- > 0;) {
        const auto [v1, v2, v3] = cone.generator;
        const Generator m12 = middle(v1, v2), m23 = middle(v2, v3), m31 = middle(v3, v1);
        switch (key >> (2 * i) & 3U) {
            case 0:
                cone.generator = {twice(v1), m12, m31};
                break;
            case 1:
                cone.generator = {m12, twice(v2), m23};
                break;
            case 2:
                cone.generator = {m31, m23, twice(v3)};
                break;
            default:
                cone.generator = {m12, m23, m31};
                break;
        }
    }
    return cone;
}

ConeFaces cone_faces(const TetraCone& cone) noexcept {
    ConeFaces faces{};
    faces.steps = 1 << cone.level;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::int32_t sum = 0;
        for (const Generator& g : cone.generator) sum += g[axis];
        faces.sign[axis] = sum < 0 ? -1 : 1;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const Generator& across = cone.generator[k];
        const Generator& b = cone.generator[(k + 1) % 3];
        const Generator& c = cone.generator[(k + 2) % 3];
        // Neighbours on the face's grid share one coordinate.
        assert(b[0] == c[0] || b[1] == c[1] || b[2] == c[2]);
        std::size_t axis = 0;
        while (b[axis] != c[axis]) ++axis;
        const std::int32_t steps = std::abs(b[axis]);
        faces.face[k] = {axis, steps, std::ldexp(steps, -static_cast<int>(cone.level)),
                         std::abs(across[axis]) > steps ? 1.0 : -1.0};
    }
    return faces;
}

std::uint32_t tetra_key(const Double3& centre, const Double3& p, std::uint32_t level) noexcept {
    assert(level <= format::kMaxTetraLevel);
    const std::uint32_t key = inner_cone(seen_point(centre, p, 1), level);
    return key != 0 && tetra_level(key) == level ? key : exact_key(centre, p, level);
}

bool touches_faces(const Corners& t, const Double3& centre, const ConeFaces& faces,
                   const FaceValues& f) noexcept {
    return ConeContact(t, centre, faces, f).touch();
}

bool triangle_touches_cone(const Corners& t, const Double3& centre,
                           const TetraCone& cone) noexcept {
    const ConeFaces faces = cone_faces(cone);
    const SeenTriangle seen = seen_triangle(centre, t, scale_for(centre, t));
    return touches_faces(t, centre, faces, face_values(faces, seen));
}

Double3 behind_centre(const Double3& centre, const TetraCone& cone) noexcept {
    // The point is as far away as the origin, so differences lose little for any model size.
    const double far =
        std::max({std::fabs(centre.x), std::fabs(centre.y), std::fabs(centre.z), kLeastSeen});
    const double unit = std::ldexp(far, -static_cast<int>(cone.level));
    const auto along = [&](std::size_t axis) {
        double sum = 0;
        for (const Generator& g : cone.generator) sum += g[axis];
        return sum * unit;
    };
    return {centre.x - along(0), centre.y - along(1), centre.z - along(2)};
}

}  // namespace cdprep
