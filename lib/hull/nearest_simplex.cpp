// SPDX-License-Identifier: MIT
#include "hull/nearest_simplex.h"

#include <cassert>
#include <limits>

#include "exact/double_double.h"
#include "exact/predicates.h"

namespace cdprep {
namespace {

/// The chosen corners, their weights, and the squared distance of the nearest point.
struct Nearest {
    std::array<std::uint8_t, 3> corner{};
    std::array<double, 3> weight{};
    std::size_t count = 0;
    double squared = std::numeric_limits<double>::infinity();
};

class SimplexSearch {
public:
    explicit SimplexSearch(const NearestSimplex& simplex) : simplex_(simplex) {}

    [[nodiscard]] Nearest corner(std::uint8_t i) const {
        return {{i}, {1}, 1, dot(at(i), at(i))};
    }
    [[nodiscard]] Nearest segment(std::uint8_t i, std::uint8_t j) const {
        const Double3 edge = at(j) - at(i);
        const double along = -dot(at(i), edge);
        const double whole = dot(edge, edge);
        if (!(along > 0)) return corner(i);
        if (!(along < whole)) return corner(j);
        const double t = along / whole;
        return measured({{i, j}, {1 - t, t}, 2, 0});
    }
    [[nodiscard]] Nearest triangle(std::uint8_t i, std::uint8_t j, std::uint8_t k) const;

private:
    [[nodiscard]] const Double3& at(std::uint8_t i) const {
        assert(i < simplex_.count);
        return simplex_.corner[i].at;
    }
    [[nodiscard]] Nearest measured(Nearest nearest) const {
        Double3 sum{};
        for (std::size_t i = 0; i < nearest.count; ++i) {
            sum = sum + nearest.weight[i] * at(nearest.corner[i]);
        }
        nearest.squared = dot(sum, sum);
        return nearest;
    }

    const NearestSimplex& simplex_;
};

void take_nearer(Nearest& best, const Nearest& other) {
    if (other.squared < best.squared || best.count == 0) best = other;
}

/// Twice the areas that the origin's foot spans with the edges opposite each corner are n . (q x r)
/// and so on, seen along the axis on which the triangle is largest. The foot is parallel to n and
/// adds nothing.
Nearest SimplexSearch::triangle(std::uint8_t i, std::uint8_t j, std::uint8_t k) const {
    const Double3& p = at(i);
    const Double3& q = at(j);
    const Double3& r = at(k);
    const Double3 n = cross(q - p, r - p);
    const std::array<double, 3> area = {dot(n, cross(q, r)), dot(n, cross(r, p)),
                                        dot(n, cross(p, q))};
    const double whole = area[0] + area[1] + area[2];
    const bool none = !(whole > 0);
    Nearest best;
    if (none || !(area[0] > 0)) take_nearer(best, segment(j, k));
    if (none || !(area[1] > 0)) take_nearer(best, segment(k, i));
    if (none || !(area[2] > 0)) take_nearer(best, segment(i, j));
    if (best.count > 0) return best;
    return measured({{i, j, k}, {area[0] / whole, area[1] / whole, area[2] / whole}, 3, 0});
}

/// The signed volumes that the origin spans with the faces opposite each corner.
std::array<double, 4> volumes(const NearestSimplex& s) {
    const Double3& p = s.corner[0].at;
    const Double3& q = s.corner[1].at;
    const Double3& r = s.corner[2].at;
    const Double3& t = s.corner[3].at;
    const Double3 rt = cross(r, t);
    const Double3 pq = cross(p, q);
    return {dot(q, rt), -dot(p, rt), dot(t, pq), -dot(r, pq)};
}

/// The three corners opposite each of four.
constexpr std::array<std::array<std::uint8_t, 3>, 4> kOpposite = {
    {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

Nearest nearest_face(const NearestSimplex& simplex, const SimplexSearch& search) {
    const std::array<double, 4> volume = volumes(simplex);
    const double whole = (volume[0] + volume[1]) + (volume[2] + volume[3]);
    Nearest best;
    for (std::size_t i = 0; i < 4; ++i) {
        if (volume[i] * whole > 0) continue;
        const auto& [j, k, l] = kOpposite[i];
        take_nearer(best, search.triangle(j, k, l));
    }
    return best;
}

void keep(NearestSimplex& simplex, const Nearest& nearest) {
    const NearestSimplex all = simplex;
    simplex.count = nearest.count;
    for (std::size_t i = 0; i < nearest.count; ++i) {
        simplex.corner[i] = all.corner[nearest.corner[i]];
        simplex.weight[i] = nearest.weight[i];
    }
}

/// Returns p - e (p . e) / (e . e), whose terms may cancel.
Double3 across_segment(const Double3& p, const Double3& q) {
    const Double3 e = q - p;
    const double whole = dot(e, e);
    if (!(whole > 0)) return {};
    const Double3 v = p - (dot(p, e) / whole) * e;
    constexpr double kCancelled = 0x1p-20;  // of squares: 10 bits of v are lost
    if (dot(v, v) > kCancelled * dot(p, p)) return v;
    const DoubleDouble ex = e.x, ey = e.y, ez = e.z;
    const DoubleDouble along = ex * p.x + ey * p.y + ez * p.z;
    const DoubleDouble share = along / (ex * ex + ey * ey + ez * ez);
    const auto part = [&](double from, const DoubleDouble& edge) {
        return static_cast<double>(DoubleDouble(from) - share * edge);
    };
    return {part(p.x, ex), part(p.y, ey), part(p.z, ez)};
}

}  // namespace

void keep_nearest(NearestSimplex& simplex) noexcept {
    assert(simplex.count >= 1 && simplex.count <= 4);
    const SimplexSearch search(simplex);
    if (simplex.count == 1) simplex.weight[0] = 1;
    if (simplex.count == 2) keep(simplex, search.segment(0, 1));
    if (simplex.count == 3) keep(simplex, search.triangle(0, 1, 2));
    if (simplex.count < 4) return;
    const Nearest face = nearest_face(simplex, search);
    if (face.count > 0) {
        keep(simplex, face);
    } else {
        const std::array<double, 4> volume = volumes(simplex);
        const double whole = (volume[0] + volume[1]) + (volume[2] + volume[3]);
        for (std::size_t i = 0; i < 4; ++i) simplex.weight[i] = volume[i] / whole;
    }
}

bool certainly_encloses_origin(const NearestSimplex& simplex) noexcept {
    if (simplex.count < 4) return false;
    constexpr Double3 kOrigin{};
    const auto sign = [&](std::size_t i, std::size_t j, std::size_t k) {
        // The filter expects differences that were rounded once, and these are.
        return filtered_orient3d(simplex.corner[i].at, simplex.corner[j].at, simplex.corner[k].at,
                                 kOrigin);
    };
    const int first = sign(1, 2, 3);
    if (first != 1 && first != -1) return false;
    return sign(0, 2, 3) == -first && sign(0, 1, 3) == first && sign(0, 1, 2) == -first;
}

Double3 weighted_sum(const NearestSimplex& simplex, Double3 Difference::*side) noexcept {
    Double3 sum{};
    for (std::size_t i = 0; i < simplex.count; ++i) {
        sum = sum + simplex.weight[i] * (simplex.corner[i].*side);
    }
    return sum;
}

Double3 nearest_direction(const NearestSimplex& simplex) noexcept {
    assert(simplex.count >= 1 && simplex.count <= 3);
    const Double3& p = simplex.corner[0].at;
    if (simplex.count == 1) return p;
    const Double3& q = simplex.corner[1].at;
    if (simplex.count == 2) return across_segment(p, q);
    if (simplex.count > 3) return {};
    const Double3 n = cross(q - p, simplex.corner[2].at - p);
    return dot(n, p) < 0 ? -n : n;
}

}  // namespace cdprep
