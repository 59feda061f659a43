// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "decompose/surface/face_planes.h"
#include "decompose/surface/solid_parts.h"
#include "decompose/surface/surface_edges.h"
#include "hull/growing_hull.h"

namespace cdprep::convex {

/// The data by which patches are judged. All of it must outlive the patches.
struct PatchRules {
    const mesh::Mesh& mesh;  ///< tree order
    const SurfaceEdges& edges;
    const FacePlanes& planes;
    const SolidParts& solids;
    /// True if hulls over balanced components must stay inside. False with a tolerance. A hull may
    /// then add volume: it is within the tolerance of the surface, or the piece makes no promise.
    bool keeps_inside;
};

/// The part of a mesh in which a task may join patches, and the task's scratch memory.
struct PatchScope {
    std::uint32_t first;  ///< triangles [first, last)
    std::uint32_t last;
    std::uint64_t work;  ///< tests left, so that every run ends
    GrowingHull hull = {};
    FacePlanes::Points points = {};
};

/// The place of a patch's hull. `outside`: a part of it may be outside the solid.
enum class Containment : std::uint8_t { inside, outside };

/// A partition of a mesh's triangles, each alone at first. Tasks may join patches in parallel if
/// their scopes share no triangle.
class PatchSet {
public:
    explicit PatchSet(const PatchRules& rules);

    /// Returns the patch of a triangle, as the number of one of its triangles.
    [[nodiscard]] std::uint32_t patch_of(std::uint32_t triangle);

    /// Returns the same, for triangles that other tasks may read too.
    [[nodiscard]] std::uint32_t owner_of(std::uint32_t triangle) const {
        while (parent_[triangle] != triangle) triangle = parent_[triangle];
        return triangle;
    }

    /// Returns true if two patches of the scope may become one. All faces of each must admit all
    /// vertices of the other. In balanced components the hull of both must stay inside. A refused
    /// pair stays refused for all patches that grow from the two.
    [[nodiscard]] bool can_join(std::uint32_t a, std::uint32_t b, PatchScope& scope) const;

    /// Joins two patches that can_join() allowed just before. Returns the number of the result.
    std::uint32_t join(std::uint32_t a, std::uint32_t b, PatchScope& scope);

    /// Makes one patch of triangles that fill a convex polygon. `corners` are the only vertices
    /// that matter. No other triangle next to one of them may lie in their plane.
    void join_polygon(std::span<const std::uint32_t> triangles,
                      std::span<const std::uint32_t> corners);

    /// Makes one patch of triangles that lie on their hull; nothing will be joined to it.
    void close(std::span<const std::uint32_t> triangles, Containment containment);

    /// Returns true if the hull of a patch of a balanced component stays inside. All its triangles
    /// must lie on the hull.
    [[nodiscard]] bool is_contained(std::uint32_t patch, PatchScope& scope) const;

    /// Returns the vertices that matter; the patch's extreme vertices are among them.
    [[nodiscard]] std::span<const std::uint32_t> vertices(std::uint32_t patch) const;
    /// Returns faces whose planes are all planes of the patch.
    [[nodiscard]] std::span<const std::uint32_t> faces(std::uint32_t patch) const;

private:
    struct Patch {
        std::vector<std::uint32_t> faces;     ///< empty: itself
        std::vector<std::uint32_t> vertices;  ///< empty: its corners
        std::unique_ptr<GrowingHull> hull;    ///< of large patches that are not flat
        bool is_flat = true;
        Containment closed = Containment::inside;  ///< as close() was told
    };

    [[nodiscard]] bool fit(std::uint32_t a, std::uint32_t b, PatchScope& scope) const;
    [[nodiscard]] bool lie_in_one_plane(std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] bool is_outline_convex(std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] bool stays_inside(std::uint32_t a, std::uint32_t b, PatchScope& scope) const;
    [[nodiscard]] bool hull_stays_inside(std::uint32_t a, std::uint32_t b, PatchScope& scope) const;
    void make_hull(std::uint32_t a, std::uint32_t b, PatchScope& scope) const;

    PatchRules rules_;
    std::vector<std::uint32_t> parent_;
    std::vector<Patch> patches_;
    std::vector<std::uint32_t> own_number_;
};

}  // namespace cdprep::convex
