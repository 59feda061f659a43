// SPDX-License-Identifier: GPL-3.0-or-later
#include "hull/mesh_hulls.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>

#include "hull/enclosing_hull.h"
#include "mesh/component_numbers.h"

namespace cdprep::convex {
namespace {

using Vertices = std::vector<std::uint32_t>;

std::vector<Vertices> component_vertices(const mesh::Mesh& mesh) {
    const mesh::ComponentNumbers components = mesh::number_components(mesh);
    std::vector<Vertices> sets(components.count);
    for (std::uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        sets[components.of_vertex[vertex]].push_back(vertex);
    }
    return sets;
}

Vertices instance_vertices(const mesh::Mesh& mesh, const format::Instance& instance) {
    Vertices vertices;
    for (std::uint32_t i = 0; i < instance.triangle_count; ++i) {
        const mesh::Triangle& triangle = mesh.triangles[instance.first_triangle + i];
        vertices.insert(vertices.end(), triangle.vertex.begin(), triangle.vertex.end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

std::vector<Vertices> vertex_sets(const mesh::Mesh& mesh,
                                  std::span<const format::Instance> instances, HullScope scope) {
    if (scope == HullScope::component) return component_vertices(mesh);
    std::vector<Vertices> sets;
    if (scope == HullScope::node && !instances.empty()) {
        for (const format::Instance& instance : instances) {
            sets.push_back(instance_vertices(mesh, instance));
        }
    } else {
        sets.emplace_back(mesh.positions.size());
        std::iota(sets[0].begin(), sets[0].end(), 0U);
    }
    return sets;
}

ConvexHull hull_of(const mesh::Mesh& mesh, const Vertices& vertices, ParallelFor run) {
    if (vertices.size() == mesh.positions.size()) return convex_hull(mesh.positions, run);
    std::vector<Double3> points;
    points.reserve(vertices.size());
    for (const std::uint32_t vertex : vertices) points.push_back(mesh.positions[vertex]);
    ConvexHull hull = convex_hull(points, run);
    for (std::uint32_t& number : hull.numbers) number = vertices[number];
    return hull;
}

}  // namespace

std::optional<std::vector<MeshHull>> find_mesh_hulls(const mesh::Mesh& mesh,
                                                     std::span<const format::Instance> instances,
                                                     const MeshHullOptions& options) {
    const std::vector<Vertices> sets = vertex_sets(mesh, instances, options.scope);
    // Threads work on many hulls in parallel, or on the points of a single one.
    const bool many = sets.size() > 1;
    std::vector<MeshHull> hulls(sets.size());
    std::atomic<bool> failed = false;
    const auto find = [&](std::size_t i) {
        ConvexHull exact =
            hull_of(mesh, sets[i], many ? ParallelFor(serial_for) : options.parallel_for);
        if (options.max_vertices == 0) {
            hulls[i].hull = std::move(exact);
            return;
        }
        std::optional<EnclosingHull> enclosing = enclosing_hull(exact, options.max_vertices);
        if (!enclosing) failed = true;
        if (enclosing) hulls[i] = {std::move(enclosing->hull), enclosing->distance};
    };
    if (many) {
        options.parallel_for(sets.size(), find);
    } else {
        serial_for(sets.size(), find);
    }
    if (failed) return std::nullopt;
    return hulls;
}

}  // namespace cdprep::convex
