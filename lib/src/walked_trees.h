// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cdprep/format/pieces.h"
#include "cdprep/model.h"
#include "node_lists.h"
#include "walk_pairs.h"

namespace cdprep {

// What two models are walked through: hierarchies of one shape, and which triangles their
// leaves hold, as lanes of the leaves of boxes around triangles. Calls of each_pair() bring
// every pair of triangles of two leaves once.

/// Both models' boxes around triangles.
struct TriangleTrees {
    Tree a;
    Tree b;

    TriangleTrees(const Model& of_a, const Model& of_b) noexcept : a(of_a), b(of_b) {}

    /// Calls test(lanes of a, lanes of b) until it returns false; returns false when it did.
    template <class Test>
    static bool each_pair(std::uint32_t leaf_a, std::uint32_t leaf_b, Test&& test) noexcept {
        return test(LeafLanes{leaf_a, 0xff}, LeafLanes{leaf_b, 0xff});
    }
};

/// A model's boxes around parts of its pieces.
class PieceTreeOf {
public:
    explicit PieceTreeOf(const Model& model) noexcept
        : leaves_(model.piece_leaves().data()),
          triangles_(model.piece_triangles().data()),
          count_(static_cast<std::uint32_t>(model.piece_leaves().size())) {}

    [[nodiscard]] Tree tree(const Model& model) const noexcept {
        Tree tree(model);
        tree.nodes = model.piece_nodes().data();
        tree.oriented = nullptr;
        tree.swept = model.piece_swept().data();
        tree.swept_kind = format::SweptKind::rectangle;
        tree.shape = format::piece_tree_shape(count_);
        if (count_ == 0) tree.triangles = 0;
        return tree;
    }

    /// A leaf's triangles by the BVH leaves that hold them.
    struct Lanes {
        std::array<LeafLanes, format::kBvhWidth> of;
        std::size_t count = 0;
    };
    [[nodiscard]] Lanes lanes(std::uint32_t number) const noexcept {
        const format::PieceLeaf& leaf = leaves_[number];
        Lanes lanes;
        for (std::uint32_t i = 0; i < leaf.count; ++i) {
            const std::uint32_t triangle = triangles_[leaf.first_triangle + i];
            const std::uint32_t holder = triangle / format::kBvhWidth;
            const auto lane = static_cast<std::uint8_t>(1U << (triangle % format::kBvhWidth));
            if (lanes.count > 0 && lanes.of[lanes.count - 1].leaf == holder) {
                lanes.of[lanes.count - 1].lanes |= lane;
            } else {
                lanes.of[lanes.count++] = {holder, lane};
            }
        }
        return lanes;
    }

private:
    const format::PieceLeaf* leaves_;
    const std::uint32_t* triangles_;
    std::uint32_t count_;
};

/// Both models' hierarchies over pieces.
struct PieceTrees {
    PieceTreeOf of_a;
    PieceTreeOf of_b;
    Tree a;
    Tree b;

    PieceTrees(const Model& model_a, const Model& model_b) noexcept
        : of_a(model_a), of_b(model_b), a(of_a.tree(model_a)), b(of_b.tree(model_b)) {}

    /// As TriangleTrees::each_pair().
    template <class Test>
    bool each_pair(std::uint32_t leaf_a, std::uint32_t leaf_b, Test&& test) const noexcept {
        const PieceTreeOf::Lanes in_a = of_a.lanes(leaf_a);
        const PieceTreeOf::Lanes in_b = of_b.lanes(leaf_b);
        for (std::size_t i = 0; i < in_a.count; ++i) {
            for (std::size_t j = 0; j < in_b.count; ++j) {
                if (!test(in_a.of[i], in_b.of[j])) return false;
            }
        }
        return true;
    }
};

}  // namespace cdprep
