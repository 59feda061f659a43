// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "support/exact_contact.h"
#include "support/exact_rational.h"

namespace cdprep::test {

// The distance between two convex hulls, and their penetration depth, from the definitions
// and for any exact number type: Integer128 for small integers, ExactNumber for doubles.
//
// A - B, the set of all differences, is a polytope. Each of its faces is the sum of a face of
// A and a face of -B. Any direction d proves a distance of min d.(a - b) / |d|. The best proof
// comes from the point x of A - B nearest to the origin. The vector x is perpendicular to a
// face of A - B. That face is a corner (d = a - b), an edge, or flat. An edge belongs to one
// hull and meets a corner of the other. The normal of a flat face is that of a face or of two
// edges. Any direction also separates A from B by a translation of max d.(a - b) / |d|. The
// shortest such translation is along the normal of a face of A - B. All triples and pairs of
// points count as faces and edges: more directions only add proofs.

__extension__ typedef __int128 Integer128;  // NOLINT(modernize-use-using)

/// The square of a length as a quotient.
template <class Number>
struct SquaredLength {
    Number numerator;
    Number denominator;  ///< > 0
};

template <class Number>
bool less(const SquaredLength<Number>& a, const SquaredLength<Number>& b) {
    return a.numerator * b.denominator < b.numerator * a.denominator;
}

inline ExactNumber exact_number(Integer128 value) {
    constexpr int kDigit = 32;
    const auto low = static_cast<double>(value & 0xffffffff);
    if (value >= -1 && value <= 0) return static_cast<double>(value);
    return exact_number(value >> kDigit) * ExactNumber(0x1p32) + ExactNumber(low);
}
inline const ExactNumber& exact_number(const ExactNumber& value) {
    return value;
}

template <class Number>
class ExactHullPair {
public:
    using Point = ExactPoint<Number>;
    using Squared = SquaredLength<Number>;

    ExactHullPair(std::span<const Double3> a, std::span<const Double3> b)
        : a_(converted(a)), b_(converted(b)) {}

    /// Returns the square of the distance; nothing if the hulls have a common point.
    [[nodiscard]] std::optional<Squared> squared_distance() const {
        std::optional<Squared> best;
        const auto prove = [&](const Point& d) {
            const Number gap = lowest(d, a_) - highest(d, b_);
            if (sign_of(gap) <= 0) return;
            const Squared squared = {gap * gap, dot(d, d)};
            if (!best || less(*best, squared)) best = squared;
        };
        for (const Point& p : a_) {
            for (const Point& q : b_) prove(minus(p, q));
        }
        each_edge(a_, [&](const Point& p, const Point& e) {
            for (const Point& q : b_) prove(across(minus(p, q), e));
        });
        each_edge(b_, [&](const Point& q, const Point& e) {
            for (const Point& p : a_) prove(across(minus(p, q), e));
        });
        each_normal([&](const Point& n) {
            prove(n);
            prove(minus(Point{Number(0), Number(0), Number(0)}, n));
        });
        return best;
    }

    /// Returns the square of the shortest translation that separates the hulls. They must have a
    /// common point.
    [[nodiscard]] Squared squared_depth() const {
        std::optional<Squared> best;
        const auto draw_out = [&](const Point& d) {
            const Number way = highest(d, a_) - lowest(d, b_);
            const Squared squared = {way * way, dot(d, d)};
            if (!best || less(squared, *best)) best = squared;
        };
        each_normal([&](const Point& n) {
            draw_out(n);
            draw_out(minus(Point{Number(0), Number(0), Number(0)}, n));
        });
        return best ? *best : Squared{Number(0), Number(1)};  // all points lie on a line
    }

private:
    static std::vector<Point> converted(std::span<const Double3> points) {
        std::vector<Point> result;
        for (const Double3& p : points) result.push_back({Number(p.x), Number(p.y), Number(p.z)});
        return result;
    }
    static Number lowest(const Point& d, const std::vector<Point>& points) {
        Number least = dot(d, points[0]);
        for (const Point& p : points) least = std::min(least, dot(d, p));
        return least;
    }
    static Number highest(const Point& d, const std::vector<Point>& points) {
        Number most = dot(d, points[0]);
        for (const Point& p : points) most = std::max(most, dot(d, p));
        return most;
    }
    static Point scaled(const Point& p, const Number& s) {
        return {p[0] * s, p[1] * s, p[2] * s};
    }
    static Point across(const Point& w, const Point& e) {
        return minus(scaled(w, dot(e, e)), scaled(e, dot(w, e)));
    }
    template <class Visit>
    static void each_edge(const std::vector<Point>& points, Visit&& visit) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                const Point e = minus(points[i], points[j]);
                if (!is_zero(e)) visit(points[j], e);
            }
        }
    }
    template <class Visit>
    static void each_face_normal(const std::vector<Point>& points, Visit&& visit) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                for (std::size_t k = 0; k < j; ++k) {
                    const Point n = cross(minus(points[i], points[k]), minus(points[j], points[k]));
                    if (!is_zero(n)) visit(n);
                }
            }
        }
    }
    template <class Visit>
    void each_normal(Visit&& visit) const {
        each_face_normal(a_, visit);
        each_face_normal(b_, visit);
        each_edge(a_, [&](const Point&, const Point& e) {
            each_edge(b_, [&](const Point&, const Point& f) {
                const Point n = cross(e, f);
                if (!is_zero(n)) visit(n);
            });
        });
    }

    std::vector<Point> a_;
    std::vector<Point> b_;
};

/// Returns the sign of length - sqrt(squared), for length >= 0.
template <class Number>
int compare_length(double length, const SquaredLength<Number>& squared) {
    return (ExactNumber(length) * ExactNumber(length) * exact_number(squared.denominator) -
            exact_number(squared.numerator))
        .sign();
}

}  // namespace cdprep::test
