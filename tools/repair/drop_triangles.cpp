// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/vectors.h"
#include "mesh/weld.h"
#include "repair/repair_steps.h"
#include "repair/stored_verdict.h"

namespace cdprep::mesh {
namespace {

/// Drops the triangles for which `reason_for` returns a reason.
template <class ReasonFor>
void drop(RepairMesh& mesh, StepReport& report, ReasonFor reason_for) {
    std::vector<bool> kept(mesh.triangles.size(), true);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::optional<DroppedTriangle> dropped = reason_for(t);
        if (!dropped) continue;
        kept[t] = false;
        report.dropped.push_back(*dropped);
        report.dropped.back().source = mesh.triangle_origin[t].source;
    }
    if (report.dropped.empty()) return;
    keep_triangles(mesh, kept);
    drop_unused_vertices(mesh, report.unused);
}

}  // namespace

Stepped drop_bad_numbers(RepairMesh mesh, std::span<const OutOfRange> out_of_range) {
    StepReport report(RepairStep::drop_bad_numbers);
    drop(mesh, report, [&](std::uint32_t t) -> std::optional<DroppedTriangle> {
        if (std::ranges::binary_search(out_of_range, mesh.triangle_origin[t].source, {},
                                       &OutOfRange::triangle)) {
            return DroppedTriangle{t, DropReason::out_of_range};
        }
        for (const std::uint32_t vertex : mesh.triangles[t].vertex) {
            if (!is_finite(mesh.positions[vertex])) {
                return DroppedTriangle{t, DropReason::not_finite};
            }
        }
        return std::nullopt;
    });
    // Vertices that are not finite cannot be welded, and no triangle uses them any more.
    const bool all_finite = std::all_of(mesh.positions.begin(), mesh.positions.end(), is_finite);
    if (!all_finite) drop_unused_vertices(mesh, report.unused);
    return {std::move(mesh), std::move(report)};
}

Stepped weld_vertices(RepairMesh mesh, double distance) {
    StepReport report(RepairStep::weld);
    TriangleSoup soup;
    soup.positions = std::move(mesh.positions);
    soup.triangles = std::move(mesh.triangles);
    Mesh welded = weld(soup, {.distance = distance}).mesh;

    std::vector<std::uint32_t> became(soup.positions.size(), kNone);
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            became[soup.triangles[t].vertex[k]] = welded.triangles[t].vertex[k];
        }
    }
    for (std::uint32_t i = 0; i < became.size(); ++i) {
        const std::uint32_t source = mesh.vertex_origin[i].source;
        if (became[i] == kNone) {
            if (source != kNone) report.unused.push_back(source);
            continue;
        }
        const std::uint32_t into = welded.source_vertex[became[i]];
        if (into == i) continue;
        const Double3& p = soup.positions[i];
        const Double3& q = soup.positions[into];
        const double moved = std::hypot(p.x - q.x, p.y - q.y, p.z - q.z);
        report.merged.push_back({source, mesh.vertex_origin[into].source, moved});
        report.moved = std::max(report.moved, moved);
    }
    std::vector<Origin> origins;
    for (const std::uint32_t vertex : welded.source_vertex) {
        origins.push_back(mesh.vertex_origin[vertex]);
    }
    mesh.positions = std::move(welded.positions);
    mesh.triangles = std::move(welded.triangles);
    mesh.vertex_origin = std::move(origins);
    return {std::move(mesh), std::move(report)};
}

Stepped drop_unused(RepairMesh mesh) {
    StepReport report(RepairStep::weld);
    drop_unused_vertices(mesh, report.unused);
    return {std::move(mesh), std::move(report)};
}

Stepped drop_repeated_corners(RepairMesh mesh) {
    StepReport report(RepairStep::drop_repeated_corners);
    drop(mesh, report, [&](std::uint32_t t) -> std::optional<DroppedTriangle> {
        if (!repeats_corner(mesh.triangles[t])) return std::nullopt;
        return DroppedTriangle{t, DropReason::repeated_corner};
    });
    return {std::move(mesh), std::move(report)};
}

Stepped drop_duplicates(RepairMesh mesh) {
    StepReport report(RepairStep::drop_duplicates);
    struct Key {
        std::array<std::uint32_t, 3> corners;  ///< from the lowest, in winding order
        std::uint32_t triangle;
        auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys(mesh.triangles.size());
    for (std::uint32_t t = 0; t < keys.size(); ++t) {
        const auto& v = mesh.triangles[t].vertex;
        keys[t] = {{v[0], v[1], v[2]}, t};
        auto& corners = keys[t].corners;
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> stays(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const bool again = i > 0 && keys[i].corners == keys[i - 1].corners;
        stays[keys[i].triangle] = again ? stays[keys[i - 1].triangle] : keys[i].triangle;
    }
    drop(mesh, report, [&](std::uint32_t t) -> std::optional<DroppedTriangle> {
        if (stays[t] == t) return std::nullopt;
        return DroppedTriangle{t, DropReason::duplicate, mesh.triangle_origin[stays[t]].source};
    });
    return {std::move(mesh), std::move(report)};
}

Stepped drop_components(RepairMesh mesh, std::uint64_t least) {
    StepReport report(RepairStep::drop_components);
    std::vector<bool> small(mesh.triangles.size(), false);
    for (const StoredComponent& component :
         find_stored_components(mesh.positions, mesh.triangles)) {
        if (component.triangles.size() >= least) continue;
        for (const std::uint32_t t : component.triangles) small[t] = true;
    }
    drop(mesh, report, [&](std::uint32_t t) -> std::optional<DroppedTriangle> {
        if (!small[t]) return std::nullopt;
        return DroppedTriangle{t, DropReason::small_component};
    });
    return {std::move(mesh), std::move(report)};
}

}  // namespace cdprep::mesh
