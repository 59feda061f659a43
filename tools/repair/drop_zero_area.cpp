// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include "cdprep/exact/triangles.h"
#include "repair/repair_steps.h"

namespace cdprep::mesh {
namespace {

Corners corners_of(const RepairMesh& mesh, std::uint32_t t) {
    const auto& v = mesh.triangles[t].vertex;
    return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

/// Returns the middle one of three collinear corners; 3 if two of them coincide. Compares along
/// the first axis on which they differ, which orders the points of a line exactly.
std::size_t middle_corner(const Corners& c) {
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) return 3;
    const auto less = [](const Double3& a, const Double3& b) {
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    };
    for (std::size_t k = 0; k < 3; ++k) {
        const Double3 &p = c[k], &q = c[(k + 1) % 3], &r = c[(k + 2) % 3];
        if (less(q, p) != less(r, p)) return k;
    }
    return 3;
}

using EdgeCounts = std::unordered_map<std::uint64_t, std::vector<HalfEdge>>;

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
    return (std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
}

/// The uses of every edge of the mesh, updated with each change.
class LocalEdges {
public:
    explicit LocalEdges(const RepairMesh& mesh) {
        for (HalfEdge h = 0; h < 3 * mesh.triangles.size(); h += 3) add(mesh, h / 3);
    }
    void add(const RepairMesh& mesh, std::uint32_t t) {
        for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) uses_[key(mesh, h)].push_back(h);
    }
    void remove(const RepairMesh& mesh, std::uint32_t t) {
        for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) std::erase(uses_[key(mesh, h)], h);
    }
    [[nodiscard]] const std::vector<HalfEdge>& of(std::uint32_t a, std::uint32_t b) {
        return uses_[key_of(a, b)];
    }

    static std::uint64_t key(const RepairMesh& mesh, HalfEdge h) {
        return key_of(start_of(mesh.triangles, h), end_of(mesh.triangles, h));
    }

private:
    EdgeCounts uses_;
};

class ZeroAreaDrop {
public:
    ZeroAreaDrop(RepairMesh& mesh, StepReport& report)
        : mesh_(mesh), report_(report), edges_(mesh), kept_(mesh.triangles.size(), true) {}

    /// Makes passes in the order of the triangles. A pass tries those whose edges have changed
    /// since they were refused: a neighbour may have gained area.
    void run(const std::vector<std::uint32_t>& flat) {
        next_pass_.insert(flat.begin(), flat.end());
        while (!next_pass_.empty()) {
            pass_ = std::exchange(next_pass_, {});
            while (!pass_.empty()) {
                const std::uint32_t t = *pass_.begin();
                pass_.erase(pass_.begin());
                next_pass_.erase(t);
                refused_.erase(t);
                mend(t);
            }
        }
        for (const auto& [t, why] : refused_) report_refusal(t, why);
        keep_triangles(mesh_, kept_);
    }

private:
    /// Tries the triangle again when the uses of the edge change.
    void wait_for(std::uint32_t a, std::uint32_t b, std::uint32_t t) {
        waiting_[key_of(a, b)].push_back(t);
    }

    /// Lets those that wait for an edge of the triangle be tried again: in this pass if they come
    /// after `by`.
    void wake(std::uint32_t triangle, std::uint32_t by) {
        for (HalfEdge h = 3 * triangle; h < 3 * triangle + 3; ++h) {
            const auto at = waiting_.find(LocalEdges::key(mesh_, h));
            if (at == waiting_.end()) continue;
            for (const std::uint32_t t : at->second) {
                if (refused_.contains(t)) (t > by ? pass_ : next_pass_).insert(t);
            }
            waiting_.erase(at);
        }
    }

    /// Repairs one triangle, or refuses to.
    void mend(std::uint32_t t) {
        const std::size_t middle = middle_corner(corners_of(mesh_, t));
        if (middle == 3)
            return refuse(t, "two of its corners have equal positions; weld joins them");
        const HalfEdge longest = next_in_triangle(3 * t + static_cast<HalfEdge>(middle));
        const std::uint32_t a = start_of(mesh_.triangles, longest);
        const std::uint32_t b = end_of(mesh_.triangles, longest);
        const std::uint32_t v = mesh_.triangles[t].vertex[middle];
        wait_for(a, b, t);
        const std::vector<HalfEdge>& uses = edges_.of(a, b);
        if (uses.size() == 1) return drop(t);
        if (uses.size() > 2) {
            return refuse(t, "several other triangles share its longest edge");
        }
        const HalfEdge other = uses[0] / 3 == t ? uses[1] : uses[0];
        if (exact::is_degenerate(corners_of(mesh_, other / 3))) {
            return refuse(t, "its neighbour across the longest edge has no area either");
        }
        return flip(t, v, a, b, other);
    }

    void drop(std::uint32_t t) {
        kept_[t] = false;
        wake(t, t);
        edges_.remove(mesh_, t);
        report_.dropped.push_back({mesh_.triangle_origin[t].source, DropReason::zero_area});
    }

    /// Replaces the neighbour (b, a, d) by (b, v, d), and t by (v, a, d).
    void flip(std::uint32_t t, std::uint32_t v, std::uint32_t a, std::uint32_t b, HalfEdge other) {
        const std::uint32_t d = apex_of(mesh_.triangles, other);
        if (d == v || !edges_.of(v, d).empty()) {
            wait_for(v, d, t);
            return refuse(t, "an edge already joins its middle corner and its neighbour's apex");
        }
        const std::uint32_t u = other / 3;
        const bool from_b = start_of(mesh_.triangles, other) == b;
        const Origin origin{mesh_.triangle_origin[u].source, report_.step};
        wake(t, t);
        wake(u, t);
        edges_.remove(mesh_, t);
        edges_.remove(mesh_, u);
        mesh_.triangles[u] = from_b ? Triangle{{b, v, d}} : Triangle{{v, b, d}};
        mesh_.triangles[t] = from_b ? Triangle{{v, a, d}} : Triangle{{a, v, d}};
        edges_.add(mesh_, t);
        edges_.add(mesh_, u);
        report_.dropped.push_back(
            {mesh_.triangle_origin[t].source, DropReason::zero_area, origin.source});
        report_.cut.push_back(origin.source);
        mesh_.triangle_origin[t] = mesh_.triangle_origin[u] = origin;
    }

    void refuse(std::uint32_t t, const char* why) {
        refused_[t] = why;
    }

    void report_refusal(std::uint32_t t, const char* why) {
        const std::uint32_t source = mesh_.triangle_origin[t].source;
        Refusal refusal;
        refusal.sentence =
            "triangle " +
            (source == kNone ? std::string("made by a step") : std::to_string(source)) +
            " has no area, and " + why + ".";
        refusal.triangles = {source};
        refusal.position = mesh_.positions[mesh_.triangles[t].vertex[0]];
        report_.refused.push_back(std::move(refusal));
    }

    RepairMesh& mesh_;
    StepReport& report_;
    LocalEdges edges_;
    std::vector<bool> kept_;
    std::set<std::uint32_t> pass_, next_pass_;                               ///< triangles to try
    std::map<std::uint32_t, const char*> refused_;                           ///< with the reason
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> waiting_;  ///< by edge
};

}  // namespace

Stepped drop_zero_area(RepairMesh mesh) {
    StepReport report(RepairStep::drop_zero_area);
    std::vector<std::uint32_t> flat;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (exact::is_degenerate(corners_of(mesh, t))) flat.push_back(t);
    }
    if (!flat.empty()) ZeroAreaDrop(mesh, report).run(flat);
    if (!report.dropped.empty()) drop_unused_vertices(mesh, report.unused);
    return {std::move(mesh), std::move(report)};
}

}  // namespace cdprep::mesh
