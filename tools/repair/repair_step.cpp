// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/repair_step.h"

#include <algorithm>
#include <array>
#include <utility>

namespace cdprep::mesh {
namespace {

constexpr std::array<std::string_view, kRepairStepCount> kNames = {"drop-bad-numbers",
                                                                   "weld",
                                                                   "stitch-seams",
                                                                   "drop-repeated-corners",
                                                                   "resolve-t-junctions",
                                                                   "drop-duplicates",
                                                                   "orient",
                                                                   "split-non-manifold",
                                                                   "drop-zero-area",
                                                                   "fill-holes",
                                                                   "orient-outward",
                                                                   "resolve-self-intersections",
                                                                   "drop-components"};

}  // namespace

std::string_view name_of(RepairStep step) noexcept {
    return kNames[static_cast<std::size_t>(step)];
}

std::optional<RepairStep> find_repair_step(std::string_view name) noexcept {
    const auto* at = std::find(kNames.begin(), kNames.end(), name);
    if (at == kNames.end()) return std::nullopt;
    return static_cast<RepairStep>(at - kNames.begin());
}

void turn(RepairMesh& mesh, std::uint32_t triangle) {
    std::swap(mesh.triangles[triangle].vertex[1], mesh.triangles[triangle].vertex[2]);
    bool& turned = mesh.triangle_origin[triangle].turned;
    turned = !turned;
}

void keep_triangles(RepairMesh& mesh, const std::vector<bool>& kept) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (!kept[i]) continue;
        mesh.triangles[next] = mesh.triangles[i];
        mesh.triangle_origin[next] = mesh.triangle_origin[i];
        ++next;
    }
    mesh.triangles.resize(next);
    mesh.triangle_origin.resize(next);
}

void drop_unused_vertices(RepairMesh& mesh, std::vector<std::uint32_t>& unused) {
    std::vector<std::uint32_t> renamed(mesh.positions.size(), kNone);
    for (const Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t vertex : triangle.vertex) renamed[vertex] = 0;
    }
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < renamed.size(); ++i) {
        if (renamed[i] == kNone) {
            if (mesh.vertex_origin[i].source != kNone) {
                unused.push_back(mesh.vertex_origin[i].source);
            }
            continue;
        }
        mesh.positions[next] = mesh.positions[i];
        mesh.vertex_origin[next] = mesh.vertex_origin[i];
        renamed[i] = next++;
    }
    mesh.positions.resize(next);
    mesh.vertex_origin.resize(next);
    for (Triangle& triangle : mesh.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) vertex = renamed[vertex];
    }
}

std::uint32_t add_vertex(RepairMesh& mesh, const Double3& p, RepairStep step) {
    const auto rounded = [&](double x) {
        return mesh.single_precision ? static_cast<double>(static_cast<float>(x)) : x;
    };
    mesh.positions.push_back({rounded(p.x), rounded(p.y), rounded(p.z)});
    mesh.vertex_origin.push_back({kNone, step});
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

void part_fans(RepairMesh& mesh, std::span<const HalfEdge> twins,
               std::vector<std::uint32_t>& parted, RepairStep step) {
    const std::vector<std::uint32_t> fans = find_fans(twins);
    std::vector<bool> taken(mesh.positions.size(), false);
    std::vector<std::uint32_t> vertex_of(fans.size(), kNone);  // by the lowest corner
    for (HalfEdge h = 0; h < fans.size(); ++h) {
        std::uint32_t& vertex = mesh.triangles[h / 3].vertex[h % 3];
        if (fans[h] == h) {  // the lowest corner of a fan comes first
            if (taken[vertex]) {
                mesh.positions.push_back(Double3(mesh.positions[vertex]));
                mesh.vertex_origin.push_back({mesh.vertex_origin[vertex].source, step});
                parted.push_back(mesh.vertex_origin[vertex].source);
                vertex_of[h] = static_cast<std::uint32_t>(mesh.positions.size() - 1);
            } else {
                taken[vertex] = true;
                vertex_of[h] = vertex;
            }
        }
        vertex = vertex_of[fans[h]];
    }
}

}  // namespace cdprep::mesh
