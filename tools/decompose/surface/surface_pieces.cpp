// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/surface/surface_pieces.h"
#include "cdprep/advanced/parallel_for.h"

#include <algorithm>
#include <numeric>

#include "cdprep/advanced/build_bvh.h"
#include "decompose/surface/patch_set.h"
#include "decompose/surface/patch_steps.h"
#include "mesh/tree_order.h"

namespace cdprep::convex {
namespace {

/// The limit of tests of a point against a plane, per triangle; a test takes some nanoseconds. It
/// bounds the running time.
constexpr std::uint64_t kMostWork = 5000;

/// Returns the triangles in an order that keeps neighbours near each other.
std::vector<std::uint32_t> tree_order(const mesh::Mesh& mesh, ParallelFor parallel_for) {
    return build::build_bvh(mesh.positions, mesh.triangles,
                            {.parallel_for = parallel_for,
                             .bounds = build::BvhBounds::aligned,
                             .quality = build::Quality::fast})
        .order;
}

/// Returns the patches as pieces, with the mesh's own triangle numbers.
SurfacePieces listed(PatchSet& patches, std::span<const std::uint32_t> place) {
    const std::size_t count = place.size();
    std::vector<std::uint32_t> piece_of_patch(count, mesh::kNone);
    SurfacePieces result;
    std::vector<std::uint32_t> piece_of(count);
    std::vector<std::uint32_t> size;
    for (std::uint32_t t = 0; t < count; ++t) {
        std::uint32_t& piece = piece_of_patch[patches.patch_of(place[t])];
        if (piece == mesh::kNone) {
            piece = static_cast<std::uint32_t>(size.size());
            size.push_back(0);
        }
        ++size[piece];
        piece_of[t] = piece;
    }
    result.first.assign(size.size() + 1, 0);
    std::partial_sum(size.begin(), size.end(), result.first.begin() + 1);
    result.pieces.resize(size.size());
    result.triangles.resize(count);
    std::vector<std::uint32_t> next(result.first.begin(), result.first.end() - 1);
    for (std::uint32_t t = 0; t < count; ++t) result.triangles[next[piece_of[t]]++] = t;
    return result;
}

/// Returns an upper bound of the height of a patch's vertices above its planes.
double error_of(const PatchRules& rules, const PatchSet& patches, std::uint32_t patch,
                double tolerance, FacePlanes::Points& points) {
    // Of a point against a plane, some nanoseconds each. Beyond this, the tolerance is the bound.
    constexpr std::uint64_t kMostTests = 1U << 24U;
    const std::uint64_t tests = patches.faces(patch).size() * patches.vertices(patch).size();
    if (tests > kMostTests) return tolerance;
    rules.planes.gather(patches.vertices(patch), points);
    double most = 0;
    for (const std::uint32_t face : patches.faces(patch)) {
        most = std::max(most, rules.planes.height_bound(face, points));
    }
    return most;
}

/// Sets the promises of each piece. Without a tolerance the pieces were built to keep them.
void describe(const PatchRules& rules, PatchSet& patches, std::span<const std::uint32_t> place,
              SurfacePieces& result, const SurfacePieceOptions& options) {
    constexpr std::size_t kAtATime = 256;  // pieces per task, with one limit of tests
    const auto run = [&](std::size_t first, std::size_t last) {
        PatchScope scope{0, static_cast<std::uint32_t>(place.size()), kMostWork * kAtATime};
        for (std::size_t i = first; i < last; ++i) {
            const std::uint32_t patch = patches.patch_of(place[result.of(i)[0]]);
            SurfacePiece& piece = result.pieces[i];
            piece.contained = rules.solids.is_solid(patch);
            if (rules.keeps_inside) continue;
            piece.outer_error = error_of(rules, patches, patch, options.tolerance, scope.points);
            piece.contained =
                piece.contained && piece.outer_error == 0 && patches.is_contained(patch, scope);
        }
    };
    for_chunks(result.pieces.size(), kAtATime, options.parallel_for, run);
}

/// Returns the inverse permutation: places[order[i]] is i.
std::vector<std::uint32_t> places_of(std::span<const std::uint32_t> order) {
    std::vector<std::uint32_t> places(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) places[order[i]] = i;
    return places;
}

}  // namespace

SurfacePieces find_surface_pieces(const mesh::Mesh& mesh, const SurfacePieceOptions& options) {
    const ParallelFor parallel_for = options.parallel_for;
    const std::vector<std::uint32_t> order = tree_order(mesh, parallel_for);
    const mesh::Mesh ordered = mesh::in_tree_order(mesh, order).mesh;
    const SurfaceEdges edges = find_surface_edges(ordered, parallel_for);
    const FacePlanes planes(ordered, options.tolerance, parallel_for);
    const SolidParts solids(ordered);
    const PatchRules rules{ordered, edges, planes, solids, options.tolerance == 0};
    PatchSet patches(rules);
    const std::vector<std::uint32_t> places = places_of(order);
    close_convex_regions(rules, patches, parallel_for);
    if (options.order == PieceOrder::greedy) {
        fill_polygons(rules, patches, parallel_for);
        merge_patches(rules, patches, kMostWork, options.stop, parallel_for);
    } else {
        grow_patches(rules, patches, options.order, places, kMostWork, options.stop);
    }
    SurfacePieces result = listed(patches, places);
    result.edges = edges.count;
    describe(rules, patches, places, result, options);
    return result;
}

}  // namespace cdprep::convex
