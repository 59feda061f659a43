// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/tear.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>
#include <utility>

namespace cdprep::scenes {
namespace {

/// Returns numbers with their common power of two taken out: the largest is at least 1, below 2.
/// Zeros stay.
std::array<double, 3> without_exponent(std::array<double, 3> v) {
    const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    if (largest == 0) return v;
    const int exponent = std::ilogb(largest);
    for (double& number : v) number = std::scalbn(number, -exponent);
    return v;
}

/// The exact sum of doubles, as a list of doubles that do not overlap, the least first (Shewchuk
/// 1997, grow-expansion).
class ExactSum {
public:
    void add(double x) noexcept {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            const double sum = x + terms_[i], part = sum - x;
            const double rest = (x - (sum - part)) + (terms_[i] - part);
            if (rest != 0) terms_[kept++] = rest;
            x = sum;
        }
        if (x != 0) terms_[kept++] = x;
        count_ = kept;
    }
    void add_product(double x, double y) noexcept {
        const double product = x * y;
        add(std::fma(x, y, -product));
        add(product);
    }
    [[nodiscard]] int sign() const noexcept {
        if (count_ == 0) return 0;
        return terms_[count_ - 1] > 0 ? 1 : -1;
    }

private:
    std::array<double, 12> terms_{};  ///< as many as add_product() is called for, twice
    std::size_t count_ = 0;
};

std::array<double, 3> array_of(const Double3& v) {
    return {v.x, v.y, v.z};
}

/// Cuts the triangles of one model.
class Cutter {
public:
    Cutter(std::span<const Double3> rest, const Tear& tear)
        : rest_(rest), tear_(tear), normal_(without_exponent(tear.normal)) {
        for (const Double3& point : rest) sides_.push_back(side_of(tear, point));
    }

    Cut run(std::span<const LiveTriangle> triangles) {
        if (!find_sides(triangles)) return {};
        cut_.misses = false;
        for (const int side : sides_) cut_.is_far.push_back(side > 0 ? 1 : 0);
        copy_vertices();
        for (const LiveTriangle& triangle : triangles) add(triangle);
        return std::move(cut_);
    }

private:
    /// Finds the sides that use each vertex. Returns whether vertices of triangles are on both
    /// sides.
    bool find_sides(std::span<const LiveTriangle> triangles) {
        near_.resize(rest_.size());
        far_.resize(rest_.size());
        bool has_near = false, has_far = false;
        for (const LiveTriangle& triangle : triangles) {
            const bool near = is_near(triangle), far = is_far(triangle);
            for (const std::uint32_t vertex : triangle.vertex) {
                near_[vertex] |= near ? 1 : 0;
                far_[vertex] |= far ? 1 : 0;
                has_near = has_near || sides_[vertex] < 0;
                has_far = has_far || sides_[vertex] > 0;
            }
        }
        return has_near && has_far;
    }

    /// Returns whether a triangle reaches the far side.
    [[nodiscard]] bool is_far(const LiveTriangle& triangle) const {
        return std::ranges::any_of(triangle.vertex,
                                   [&](std::uint32_t vertex) { return sides_[vertex] > 0; });
    }
    [[nodiscard]] bool is_near(const LiveTriangle& triangle) const {
        const auto is_below = [&](std::uint32_t vertex) { return sides_[vertex] < 0; };
        return !is_far(triangle) || std::ranges::any_of(triangle.vertex, is_below);
    }

    /// Gives the far side its own copies of vertices in the plane.
    void copy_vertices() {
        far_copy_.resize(rest_.size());
        for (std::uint32_t vertex = 0; vertex < rest_.size(); ++vertex) {
            far_copy_[vertex] = vertex;
            if (sides_[vertex] != 0 || far_[vertex] == 0) continue;
            if (near_[vertex] == 0) {
                cut_.is_far[vertex] = 1;
            } else {
                far_copy_[vertex] = add_vertex({vertex, vertex, 0}, true);
            }
        }
    }

    std::uint32_t add_vertex(const CutVertex& vertex, bool is_far) {
        cut_.vertices.push_back(vertex);
        cut_.is_far.push_back(is_far ? 1 : 0);
        return static_cast<std::uint32_t>(rest_.size() + cut_.vertices.size() - 1);
    }

    void add(const LiveTriangle& triangle) {
        if (is_near(triangle) && is_far(triangle)) {
            cut_.removed.push_back(triangle.number);
            return split(triangle.vertex);
        }
        if (!is_far(triangle)) return;
        const format::Triangle copied = far_side(triangle.vertex);
        if (copied.vertex == triangle.vertex) return;
        cut_.removed.push_back(triangle.number);
        cut_.appended.push_back(copied);
    }

    [[nodiscard]] format::Triangle far_side(std::array<std::uint32_t, 3> vertices) const {
        for (std::uint32_t& vertex : vertices) {
            if (vertex < rest_.size()) vertex = far_copy_[vertex];
        }
        return {vertices};
    }

    void append(bool is_far, const std::array<std::uint32_t, 3>& vertices) {
        cut_.appended.push_back(is_far ? far_side(vertices) : format::Triangle{vertices});
    }

    /// Appends the fragments of a triangle with vertices on both sides. They keep its winding.
    void split(const std::array<std::uint32_t, 3>& vertex) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = vertex[i], b = vertex[(i + 1) % 3], c = vertex[(i + 2) % 3];
            if (sides_[a] == 0) return split_at(a, b, c);
            if (sides_[b] == 0 || sides_[c] == 0 || sides_[b] != sides_[c]) continue;
            const std::size_t own = sides_[a] > 0 ? 1 : 0, other = 1 - own;
            const std::array<std::uint32_t, 2> ab = on_plane(a, b), ac = on_plane(a, c);
            append(own == 1, {a, ab[own], ac[own]});
            append(other == 1, {ab[other], b, c});
            append(other == 1, {ab[other], c, ac[other]});
            return;
        }
    }

    /// Splits a triangle whose vertex a is in the plane.
    void split_at(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const std::array<std::uint32_t, 2> bc = on_plane(b, c);
        const std::size_t side_of_b = sides_[b] > 0 ? 1 : 0, side_of_c = 1 - side_of_b;
        append(side_of_b == 1, {a, b, bc[side_of_b]});
        append(side_of_c == 1, {a, bc[side_of_c], c});
    }

    /// Returns the vertices where an edge crosses the plane: near, far.
    std::array<std::uint32_t, 2> on_plane(std::uint32_t a, std::uint32_t b) {
        if (a > b) std::swap(a, b);
        const auto first = static_cast<std::uint32_t>(rest_.size() + cut_.vertices.size());
        const auto [at, is_new] = edges_.try_emplace(std::uint64_t{a} << 32 | b, first);
        if (is_new) {
            const double to_a = distance(rest_[a]), to_b = distance(rest_[b]);
            // Tiny distances may be rounded to 0.
            const double share = to_a + to_b > 0 ? to_a / (to_a + to_b) : 0.5;
            add_vertex({a, b, share}, false);
            add_vertex({a, b, share}, true);
        }
        return {at->second, at->second + 1};
    }

    /// Returns a multiple of the distance from the plane, rounded.
    [[nodiscard]] double distance(const Double3& p) const {
        const std::array<double, 3> at = array_of(p);
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) sum += normal_[i] * (at[i] - tear_.point[i]);
        return std::abs(sum);
    }

    std::span<const Double3> rest_;
    const Tear& tear_;
    std::array<double, 3> normal_;
    std::vector<int> sides_;                ///< by vertex
    std::vector<std::uint8_t> near_, far_;  ///< whether that side uses a vertex
    std::vector<std::uint32_t> far_copy_;   ///< the vertex that the far side uses instead
    std::unordered_map<std::uint64_t, std::uint32_t> edges_;  ///< the first of two new vertices
    Cut cut_;
};

}  // namespace

int side_of(const Tear& tear, const Double3& point) noexcept {
    const std::array<double, 3> normal = without_exponent(tear.normal);
    const std::array<double, 3> p = array_of(point);
    // Products of numbers near 2^1000 would overflow, those near 2^-1000 would lose bits.
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        if (normal[i] == 0) continue;
        largest = std::max({largest, std::abs(p[i]), std::abs(tear.point[i])});
    }
    if (largest == 0) return 0;
    const int exponent = std::ilogb(largest);
    ExactSum sum;
    for (std::size_t i = 0; i < 3; ++i) {
        if (normal[i] == 0) continue;
        sum.add_product(normal[i], std::scalbn(p[i], -exponent));
        sum.add_product(-normal[i], std::scalbn(tear.point[i], -exponent));
    }
    return sum.sign();
}

Double3 half_opening(const Tear& tear) noexcept {
    const std::array<double, 3> normal = without_exponent(tear.normal);
    const double scale = tear.opening / 2 / std::hypot(normal[0], normal[1], normal[2]);
    return {scale * normal[0], scale * normal[1], scale * normal[2]};
}

Cut cut_by_plane(std::span<const Double3> rest, std::span<const LiveTriangle> triangles,
                 const Tear& tear) {
    return Cutter(rest, tear).run(triangles);
}

}  // namespace cdprep::scenes
