// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "walk/leaf_batch.h"
#include "walk/piece_leaves.h"
#include "walk/walk_pairs.h"

namespace cdprep {

// The structures through which two models are walked: hierarchies of one shape, and the triangles
// of their leaves. each_pair() passes every pair of triangles of two leaves once, in the form that
// the kernels take. triangle_a() and triangle_b() return the tree-order numbers of the triangles
// that a LeafBatch then reports.

/// Both models' BVHs.
struct TriangleTrees {
    static constexpr bool kHasHulls = false;
    Tree a;
    Tree b;

    TriangleTrees(const Model& of_a, const Model& of_b, Workspace::Storage& /*scratch*/) noexcept
        : a(of_a), b(of_b) {}

    /// Calls test(view of a, view of b). Stops and returns false when `test` returns false.
    template <class Test>
    static bool each_pair(const LeafBatch& batch, std::uint32_t leaf_a, std::uint32_t leaf_b,
                          Test&& test) noexcept {
        batch.prefetch_pair(leaf_a, leaf_b);
        return test(batch.view_a({leaf_a, 0xff}), batch.view_b({leaf_b, 0xff}));
    }
    static std::uint32_t triangle_a(std::uint32_t named) noexcept {
        return named;
    }
    static std::uint32_t triangle_b(std::uint32_t named) noexcept {
        return named;
    }
};

/// Both models' hierarchies over pieces. A workspace serves those of one query at a time.
struct PieceTrees {
    static constexpr bool kHasHulls = true;
    PieceLeaves of_a;
    PieceLeaves of_b;
    Tree a;
    Tree b;
    Workspace::Storage& scratch;

    PieceTrees(const Model& model_a, const Model& model_b, Workspace::Storage& of) noexcept
        : of_a(model_a), of_b(model_b), a(of_a.tree(model_a)), b(of_b.tree(model_b)), scratch(of) {
        ++scratch.piece_walks;
    }

    /// As TriangleTrees::each_pair().
    template <class Test>
    bool each_pair(const LeafBatch& batch, std::uint32_t leaf_a, std::uint32_t leaf_b,
                   Test&& test) const noexcept {
        const auto with_a = [&](const LeafView& in_a) {
            return of_b.each_view(
                leaf_b, scratch.gathered_b, scratch,
                [&](const LeafLanes& lanes) { return batch.view_b(lanes); },
                [&](const LeafView& in_b) {
                    PieceLeaves::keep(in_a, scratch.gathered_a, scratch);
                    return test(in_a, in_b);
                });
        };
        return of_a.each_view(
            leaf_a, scratch.gathered_a, scratch,
            [&](const LeafLanes& lanes) { return batch.view_a(lanes); }, with_a);
    }
    /// Calls test(view) for views that together hold a leaf's triangles.
    template <class Test>
    void each_view_a(const LeafBatch& batch, std::uint32_t leaf, Test&& test) const noexcept {
        of_a.each_view(
            leaf, scratch.gathered_a, scratch,
            [&](const LeafLanes& lanes) { return batch.view_a(lanes); }, test);
    }
    template <class Test>
    void each_view_b(const LeafBatch& batch, std::uint32_t leaf, Test&& test) const noexcept {
        of_b.each_view(
            leaf, scratch.gathered_b, scratch,
            [&](const LeafLanes& lanes) { return batch.view_b(lanes); }, test);
    }
    [[nodiscard]] std::uint32_t triangle_a(std::uint32_t named) const noexcept {
        return of_a.triangle(named);
    }
    [[nodiscard]] std::uint32_t triangle_b(std::uint32_t named) const noexcept {
        return of_b.triangle(named);
    }
};

}  // namespace cdprep
