// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/nesting.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "cdprep/exact/winding.h"
#include "mesh/half_edges.h"
#include "mesh/point_tree.h"

namespace cdprep::mesh {
namespace {

/// Returns the origin of a ray through q in direction +x. It is as far before the box as the box
/// is wide, which keeps the numbers in range. If q.x is the lowest double, the ray runs in
/// direction -x, where it meets nothing.
Double3 behind(const Double3& q, const Box& box) {
    const double before = box.lower.x - (box.upper.x - box.lower.x);
    if (before < q.x && std::isfinite(before)) return {before, q.y, q.z};
    const double next = std::nextafter(q.x, -Box::kInfinity);
    return {std::isfinite(next) ? next : std::nextafter(q.x, 0.0), q.y, q.z};
}

/// The sum of winding terms of one component's triangles around a point.
struct Around {
    int winding = 0;
    bool on_surface = false;

    /// Adds the term of a triangle; q is the point, o the origin of its ray.
    void add(const Double3& q, const Double3& o, const Corners& t) {
        const WindingTerm term = exact::winding_term(o, q, t);
        winding += term.crossings;
        on_surface |= term.on_surface;
    }
};

class NestingFinder {
public:
    NestingFinder(const Mesh& mesh, const ComponentNumbers& components,
                  const std::vector<bool>& balanced)
        : mesh_(mesh), components_(components), balanced_(balanced) {
        box_.resize(components.count);
        lowest_.assign(components.count, kNone);
        for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
            const std::uint32_t component = components.of_vertex[i];
            box_[component].add(mesh.positions[i]);
            lowest_[component] = std::min(lowest_[component], i);
        }
    }

    std::vector<Nested> find() {
        list_points();
        sort_by_component();
        for (std::uint32_t outer = 0; outer < components_.count; ++outer) {
            if (balanced_[outer]) find_within(outer);
        }
        std::sort(nested_.begin(), nested_.end(), [](const Nested& a, const Nested& b) {
            return std::tie(a.inner, a.outer) < std::tie(b.inner, b.outer);
        });
        return std::move(nested_);
    }

private:
    [[nodiscard]] Corners corners_of(std::uint32_t triangle) const {
        const auto& v = mesh_.triangles[triangle].vertex;
        return {mesh_.positions[v[0]], mesh_.positions[v[1]], mesh_.positions[v[2]]};
    }
    [[nodiscard]] std::uint32_t component_of(std::uint32_t triangle) const {
        return components_.of_vertex[mesh_.triangles[triangle].vertex[0]];
    }

    void list_points() {
        std::vector<Double3> points;
        for (std::uint32_t i = 0; i < components_.count; ++i) {
            if (!balanced_[i]) continue;
            asking_.push_back(i);
            points.push_back(mesh_.positions[lowest_[i]]);
        }
        tree_.emplace(std::move(points));
        around_.resize(asking_.size());
    }

    /// Finds the components inside `outer`. Tests each triangle with the points whose rays it
    /// may meet, and which lie in its component's box.
    void find_within(std::uint32_t outer) {
        touched_.clear();
        for (std::uint32_t k = first_[outer]; k < first_[outer + 1]; ++k) {
            const Corners t = corners_of(triangle_[k]);
            Box region;
            for (const Double3& p : t) region.add(p);
            region.lower.x = box_[outer].lower.x;
            tree_->visit([&region](const Box& box) { return region.meets(box); },
                         [&](std::uint32_t number) {
                             const Double3& q = tree_->point(number);
                             if (asking_[number] == outer || !region.contains(q)) return;
                             around_[number].add(q, behind(q, box_[outer]), t);
                             touched_.push_back(number);
                         });
        }
        for (const std::uint32_t number : touched_) {
            Around around = std::exchange(around_[number], {});
            const std::uint32_t inner = asking_[number];
            if (around.on_surface) around = ask_other_vertices(inner, outer);
            if (around.winding == 0 || around.on_surface) continue;
            nested_.push_back({inner, outer, around.winding});
        }
    }

    /// Returns the sum around the lowest vertex off the other's surface; on_surface if there is
    /// none.
    Around ask_other_vertices(std::uint32_t inner, std::uint32_t outer) {
        Around around;
        around.on_surface = true;
        for (const std::uint32_t i : vertices_of(inner)) {
            if (i == lowest_[inner]) continue;
            around = {};
            for (std::uint32_t k = first_[outer]; k < first_[outer + 1]; ++k) {
                const Double3& q = mesh_.positions[i];
                around.add(q, behind(q, box_[outer]), corners_of(triangle_[k]));
            }
            if (!around.on_surface) break;
        }
        return around;
    }

    /// Returns the vertices in ascending order.
    [[nodiscard]] std::vector<std::uint32_t> vertices_of(std::uint32_t component) const {
        std::vector<std::uint32_t> vertices;
        for (std::uint32_t k = first_[component]; k < first_[component + 1]; ++k) {
            const auto& v = mesh_.triangles[triangle_[k]].vertex;
            vertices.insert(vertices.end(), v.begin(), v.end());
        }
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        return vertices;
    }

    void sort_by_component() {
        first_.assign(components_.count + 1, 0);
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) ++first_[component_of(i) + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        triangle_.resize(mesh_.triangles.size());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            triangle_[next[component_of(i)]++] = i;
        }
    }

    const Mesh& mesh_;
    const ComponentNumbers& components_;
    const std::vector<bool>& balanced_;
    std::vector<Box> box_;               ///< of each component
    std::vector<std::uint32_t> lowest_;  ///< vertex of each component
    std::vector<std::uint32_t> first_;
    std::vector<std::uint32_t> triangle_;  ///< by component
    std::vector<std::uint32_t> asking_;    ///< components whose point is in the tree
    std::optional<PointTree> tree_;
    std::vector<Around> around_;          ///< by asking component, for one outer component
    std::vector<std::uint32_t> touched_;  ///< the entries in use, some more than once
    std::vector<Nested> nested_;
};

}  // namespace

std::vector<Nested> find_nested(const Mesh& mesh, const ComponentNumbers& components,
                                const std::vector<bool>& balanced) {
    if (std::count(balanced.begin(), balanced.end(), true) < 2) return {};
    return NestingFinder(mesh, components, balanced).find();
}

}  // namespace cdprep::mesh
