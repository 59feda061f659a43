// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/page_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cdprep::report {
namespace {

using Float3 = std::array<float, 3>;
using mesh::Rule;

constexpr std::size_t kNormalTriangles = 64;  // examined for the normal of a place

/// Collects the marks of places, one place at a time.
class MarkMaker {
public:
    MarkMaker(std::span<const mesh::Double3> positions, std::span<const mesh::Triangle> triangles,
              const PageFrame& frame, std::size_t max_parts)
        : positions_(positions), triangles_(triangles), frame_(frame), parts_left_(max_parts) {}

    void add(const mesh::Place& place, MarkShape shape) {
        reached_.clear();
        if (shape == MarkShape::path) add_path(place);
        if (shape == MarkShape::triangle) add_triangles(place);
        add_place(place);
        marks_.segment_ends.push_back(static_cast<std::uint32_t>(marks_.segments.size() / 6));
        marks_.triangle_ends.push_back(static_cast<std::uint32_t>(marks_.triangles.size() / 9));
    }

    [[nodiscard]] Marks take() {
        return std::move(marks_);
    }

private:
    void append(std::vector<float>& list, const Float3& point) {
        list.insert(list.end(), point.begin(), point.end());
        reached_.push_back(point);
    }

    void add_path(const mesh::Place& place) {
        std::vector<Float3> path;
        for (const std::uint32_t vertex : place.vertices) {
            if (vertex >= positions_.size()) return;
            const mesh::Double3& at = positions_[vertex];
            if (!std::isfinite(at.x) || !std::isfinite(at.y) || !std::isfinite(at.z)) return;
            path.push_back(frame_.from_model(at));
        }
        if (path.size() < 2) return;
        const std::size_t count = path.size() == 2 ? 1 : path.size();
        for (std::size_t i = 0; i < count && parts_left_ > 0; ++i, --parts_left_) {
            append(marks_.segments, path[i]);
            append(marks_.segments, path[(i + 1) % path.size()]);
        }
    }

    void add_triangles(const mesh::Place& place) {
        for (const std::uint32_t triangle : place.triangles) {
            if (parts_left_ == 0) return;
            if (!has(triangle)) continue;
            --parts_left_;
            for (const std::uint32_t vertex : triangles_[triangle].vertex) {
                append(marks_.triangles, frame_.from_model(positions_[vertex]));
            }
        }
    }

    void add_place(const mesh::Place& place) {
        const mesh::Double3& at = place.position;
        const bool finite = std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z);
        constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
        const Float3 position = finite ? frame_.from_model(at) : Float3{kNone, kNone, kNone};
        float radius = 0;
        for (const Float3& point : reached_) {
            if (!finite) break;
            radius = std::max(radius, std::hypot(point[0] - position[0], point[1] - position[1],
                                                 point[2] - position[2]));
        }
        const Float3 normal = normal_of(place);
        for (const Float3& three : {position, normal}) {
            marks_.places.insert(marks_.places.end(), three.begin(), three.end());
        }
        marks_.places.push_back(radius);
    }

    /// Returns the common direction of the triangles of the place, or zero.
    [[nodiscard]] Float3 normal_of(const mesh::Place& place) const {
        std::array<double, 3> sum{};
        const std::size_t count = std::min(place.triangles.size(), kNormalTriangles);
        for (const std::uint32_t triangle : std::span(place.triangles).first(count)) {
            if (!has(triangle)) continue;
            const std::array<double, 3> normal = triangle_normal(triangles_[triangle]);
            for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += normal[axis];
        }
        const double length = std::hypot(sum[0], sum[1], sum[2]);
        if (!(length > 0)) return {};
        return {static_cast<float>(sum[0] / length), static_cast<float>(sum[1] / length),
                static_cast<float>(sum[2] / length)};
    }

    [[nodiscard]] std::array<double, 3> triangle_normal(const mesh::Triangle& triangle) const {
        std::array<Float3, 3> corner{};
        for (std::size_t k = 0; k < 3; ++k) {
            corner[k] = frame_.from_model(positions_[triangle.vertex[k]]);
        }
        std::array<double, 3> a{};
        std::array<double, 3> b{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            a[axis] = static_cast<double>(corner[1][axis]) - static_cast<double>(corner[0][axis]);
            b[axis] = static_cast<double>(corner[2][axis]) - static_cast<double>(corner[0][axis]);
        }
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }

    [[nodiscard]] bool has(std::uint32_t triangle) const {
        return triangle < triangles_.size() && is_drawable(positions_, triangles_[triangle]);
    }

    std::span<const mesh::Double3> positions_;
    std::span<const mesh::Triangle> triangles_;
    const PageFrame& frame_;
    std::size_t parts_left_;
    std::vector<Float3> reached_;  ///< points drawn for the current place
    Marks marks_;
};

struct RuleStyle {
    mesh::Rule rule;
    MarkStyle style;
};

constexpr MarkShape kPoint = MarkShape::point;
constexpr MarkShape kPath = MarkShape::path;
constexpr MarkShape kTriangle = MarkShape::triangle;

/// Rules that are often found together have hues far apart.
constexpr std::array<RuleStyle, 27> kStyles = {{
    {Rule::non_finite_coordinate, {kPoint, true, false, "red"}},
    {Rule::index_out_of_range, {kPoint, true, false, "pink"}},
    {Rule::extent_beyond_float, {kPoint, true, false, "purple"}},
    {Rule::unreferenced_vertex, {kPoint, true, false, "slate"}},
    {Rule::duplicate_vertex, {kPoint, true, false, "teal"}},
    {Rule::near_vertex, {kPath, true, false, "blue"}},
    {Rule::empty_mesh, {kPoint, true, false, "slate"}},
    {Rule::repeated_corner, {kTriangle, true, false, "magenta"}},
    {Rule::zero_area, {kTriangle, true, false, "purple"}},
    {Rule::sliver, {kTriangle, true, false, "olive"}},
    {Rule::duplicate_triangle, {kTriangle, true, false, "teal"}},
    {Rule::opposite_triangle, {kTriangle, true, false, "brown"}},
    {Rule::boundary_edge, {kPath, false, false, "orange"}},
    {Rule::boundary_loop, {kPath, false, true, "blue"}},
    {Rule::non_manifold_edge, {kPath, false, false, "magenta"}},
    {Rule::non_manifold_vertex, {kPoint, true, false, "indigo"}},
    {Rule::inconsistent_winding, {kPath, false, false, "green"}},
    {Rule::non_orientable, {kTriangle, true, false, "brown"}},
    {Rule::t_junction, {kPath, true, false, "teal"}},
    {Rule::near_seam, {kPath, true, false, "olive"}},
    {Rule::inverted_component, {kTriangle, true, false, "brown"}},
    {Rule::nested_component, {kTriangle, true, false, "slate"}},
    {Rule::overlapping_components, {kTriangle, true, false, "purple"}},
    {Rule::several_components, {kTriangle, true, false, "teal"}},
    {Rule::crossing_triangles, {kTriangle, true, false, "red"}},
    {Rule::touching_triangles, {kTriangle, true, false, "olive"}},
    {Rule::coplanar_overlap, {kTriangle, true, false, "pink"}},
}};

}  // namespace

MarkStyle mark_style(mesh::Rule rule) noexcept {
    const auto* const row = std::ranges::find(kStyles, rule, &RuleStyle::rule);
    return row == kStyles.end() ? kStyles.back().style : row->style;
}

Marks make_marks(std::span<const mesh::Double3> positions,
                 std::span<const mesh::Triangle> triangles, const PageFrame& frame, mesh::Rule rule,
                 std::span<const mesh::Place> places, std::size_t max_parts) {
    MarkMaker maker(positions, triangles, frame, max_parts);
    const MarkShape shape = mark_style(rule).shape;
    for (const mesh::Place& place : places) maker.add(place, shape);
    return maker.take();
}

}  // namespace cdprep::report
