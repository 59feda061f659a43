// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "decompose/surface/face_planes.h"
#include "hull/growing_hull.h"
#include "decompose/surface/solid_parts.h"
#include "decompose/surface/surface_edges.h"

namespace cdprep::convex {

/// What patches are judged by. All must outlive the patches.
struct PatchRules {
    const mesh::Mesh& mesh;  ///< tree order
    const SurfaceEdges& edges;
    const FacePlanes& planes;
    const SolidParts& solids;
    /// Hulls over closed components must stay inside. Not with a tolerance: what a hull
    /// then takes in besides is within it of the surface, or the piece says nothing.
    bool keeps_inside;
};

/// The part of a mesh that a task may join patches of, and what it uses for it.
struct PatchScope {
    std::uint32_t first;  ///< triangles [first, last)
    std::uint32_t last;
    std::uint64_t work;  ///< tests that are left, so that nothing runs for ever
    GrowingHull hull = {};
    FacePlanes::Points points = {};
};

/// A partition of a mesh's triangles, each alone at first. Tasks may join patches at the
/// same time while their scopes have no triangle in common.
class PatchSet {
public:
    explicit PatchSet(const PatchRules& rules);

    /// The patch of a triangle, by the number of one of its triangles.
    [[nodiscard]] std::uint32_t patch_of(std::uint32_t triangle);

    /// The same; for triangles that other tasks may look at too.
    [[nodiscard]] std::uint32_t owner_of(std::uint32_t triangle) const {
        while (parent_[triangle] != triangle) triangle = parent_[triangle];
        return triangle;
    }

    /// True when the two patches of the scope may be one: all vertices of either are
    /// admitted by all faces of the other, and in closed components the hull of both stays
    /// inside. What is refused once is refused for all that grows out of the two.
    [[nodiscard]] bool can_join(std::uint32_t a, std::uint32_t b, PatchScope& scope) const;

    /// Makes one patch of two, which can_join() allowed just before; returns its number.
    std::uint32_t join(std::uint32_t a, std::uint32_t b, PatchScope& scope);

    /// Makes triangles that fill a convex polygon one patch, of which `corners` are the
    /// vertices that matter. No other triangle beside one of them lies in their plane.
    void join_polygon(std::span<const std::uint32_t> triangles,
                      std::span<const std::uint32_t> corners);

    /// Makes triangles one patch that nothing will be joined to.
    void close(std::span<const std::uint32_t> triangles);

    /// True when the hull of a patch of a closed component stays inside, which needs all its
    /// triangles on the hull.
    [[nodiscard]] bool is_contained(std::uint32_t patch, PatchScope& scope) const;

    /// Vertices that matter: extreme ones of the patch are among them.
    [[nodiscard]] std::span<const std::uint32_t> vertices(std::uint32_t patch) const;
    /// Faces whose planes are all of the patch.
    [[nodiscard]] std::span<const std::uint32_t> faces(std::uint32_t patch) const;

private:
    struct Patch {
        std::vector<std::uint32_t> faces;     ///< empty: itself
        std::vector<std::uint32_t> vertices;  ///< empty: its corners
        std::unique_ptr<GrowingHull> hull;    ///< of large ones that have an inside
        bool is_flat = true;
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
