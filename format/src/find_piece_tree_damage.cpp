// SPDX-License-Identifier: MIT
#include "section_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "bvh_boxes.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/pieces.h"
#include "reference_lists.h"

namespace cdprep::format {
namespace {

using Found = std::optional<Damage>;

constexpr std::array kIds = {SectionId::piece_nodes, SectionId::piece_leaves,
                             SectionId::piece_node_hulls, SectionId::piece_swept};
/// The sections that the BVH refers to.
constexpr std::array kBelow = {SectionId::pieces, SectionId::piece_triangles};

/// Finds a leaf whose run is not among its piece's triangles.
Found find_bad_leaf(const SectionView<Piece>& pieces, const SectionView<PieceLeaf>& leaves,
                    std::uint64_t triangles, std::uint64_t i) noexcept {
    const PieceLeaf leaf = leaves[i];
    if (leaf.piece >= pieces.count()) {
        return leaves.bad_index(i, leaf.piece, pieces.count());
    }
    if (leaf.count == 0 || leaf.count > kBvhWidth) {
        return leaves.damage(DamageKind::bad_count, i, leaf.count, kBvhWidth);
    }
    const std::uint64_t next = std::uint64_t{leaf.piece} + 1;
    const std::uint64_t end = next < pieces.count() ? pieces[next].first_triangle : triangles;
    const std::uint64_t last = std::uint64_t{leaf.first_triangle} + leaf.count;
    if (leaf.first_triangle < pieces[leaf.piece].first_triangle || last > end) {
        return leaves.damage(DamageKind::bad_order, i, last, end);
    }
    return std::nullopt;
}

bool is_good(const PieceNodeHull& hull) noexcept {
    bool good = std::isfinite(hull.slack) && hull.slack >= 0 && hull.count > 0 &&
                hull.count <= kPieceHullCorners &&
                std::all_of(std::begin(hull.reserved), std::end(hull.reserved),
                            [](std::uint32_t number) { return number == 0; });
    for (const HullBlock& block : hull.block) {
        for (const auto& row : block.at) {
            for (const double x : row) good = good && std::fabs(x) <= 2 * kMaxCoordinate;
        }
    }
    return good;
}

}  // namespace

std::optional<Damage> find_missing_piece_tree(std::span<const std::byte> file) noexcept {
    if (const Found damage = find_gap(file, kIds)) return damage;
    if (!find_section(file, kIds[0])) return std::nullopt;
    for (const SectionId id : kBelow) {
        if (!find_section(file, id)) return missing_section(id);
    }
    return std::nullopt;
}

std::optional<Damage> find_piece_tree_damage(std::span<const std::byte> file,
                                             SectionSet wanted) noexcept {
    const auto is_there = [&](SectionId id) {
        return wanted.contains(id) && find_section(file, id).has_value();
    };
    if (!std::all_of(kIds.begin(), kIds.end(), is_there)) return std::nullopt;
    if (!std::all_of(kBelow.begin(), kBelow.end(), is_there)) return std::nullopt;
    const SectionView<BvhNode> nodes(file, SectionId::piece_nodes, wanted);
    const SectionView<PieceLeaf> leaves(file, SectionId::piece_leaves, wanted);
    const SectionView<SweptNode> swept(file, SectionId::piece_swept, wanted);
    const SectionView<PieceNodeHull> hulls(file, SectionId::piece_node_hulls, wanted);
    const SectionView<Piece> pieces(file, SectionId::pieces, wanted);
    const std::uint64_t triangles = read_header(file).triangle_count;
    if (leaves.count() > kMaxPieceLeaves) {
        return leaves.damage(DamageKind::bad_count, 0, leaves.count(), kMaxPieceLeaves);
    }
    const BvhShape shape = piece_tree_shape(static_cast<std::uint32_t>(leaves.count()));
    if (nodes.count() != shape.node_count) {
        return nodes.damage(DamageKind::bad_count, 0, nodes.count(), shape.node_count);
    }
    if (const Found damage = find_bad_bvh_box(nodes, shape)) return damage;
    if (swept.count() != shape.node_count) {
        return swept.damage(DamageKind::bad_count, 0, swept.count(), shape.node_count);
    }
    if (hulls.count() != piece_hull_count(shape)) {
        return hulls.damage(DamageKind::bad_count, 0, hulls.count(), piece_hull_count(shape));
    }
    std::uint64_t held = 0;
    for (std::uint64_t i = 0; i < leaves.count(); ++i) {
        if (const Found damage = find_bad_leaf(pieces, leaves, triangles, i)) return damage;
        held += leaves[i].count;
    }
    if (held != triangles) return leaves.damage(DamageKind::bad_count, 0, held, triangles);
    for (std::uint64_t i = 0; i < hulls.count(); ++i) {
        if (!is_good(hulls[i])) return hulls.damage(DamageKind::bad_number, i, i, 0);
    }
    return std::nullopt;
}

}  // namespace cdprep::format
