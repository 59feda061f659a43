// SPDX-License-Identifier: MIT
#include "cdprep/advanced/find_falsehood.h"

#include <algorithm>
#include <vector>

#include "cdprep/advanced/convex_distance.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/format/sections.h"
#include "core/moved_model.h"
#include "pieces/piece_contact.h"

namespace cdprep {
namespace {

using format::HullBlock;
using format::PieceNodeHull;

ConvexPoints points_in(std::span<const HullBlock> blocks, std::size_t count) {
    ConvexPoints points;
    points.blocks = blocks;
    points.count = static_cast<std::uint32_t>(count);
    return points;
}

/// Returns the corners of the triangles below a node.
std::vector<Double3> corners_below(const Model& model, std::uint32_t level, std::uint32_t node) {
    const std::uint64_t wide = std::uint64_t{1} << (3 * (level + 1));
    const std::uint64_t last =
        std::min<std::uint64_t>((node + 1) * wide, model.pieces().leaves.size());
    const MovedModel still(model, nullptr);
    std::vector<Double3> corners;
    for (std::uint64_t i = node * wide; i < last; ++i) {
        const format::PieceLeaf& leaf = model.pieces().leaves[i];
        for (std::uint32_t k = 0; k < leaf.count; ++k) {
            const Corners c = still.corners(model.pieces().triangles[leaf.first_triangle + k]);
            corners.insert(corners.end(), c.begin(), c.end());
        }
    }
    return corners;
}

bool is_true(const PieceNodeHull& hull, const std::vector<Double3>& corners) {
    const Placement still = Placement::b_moves(Pose());
    const ConvexPoints around = hull_points(hull);
    for (const Double3& p : corners) {
        const auto block = hull_blocks({&p, 1});
        if (!convex_collide(around, points_in(block, 1), still)) return false;
    }
    const std::vector<HullBlock> blocks = hull_blocks(corners);
    const ConvexPoints below = points_in(blocks, corners.size());
    constexpr double kRounded = 1 + 0x1p-40;  // more than the roundings of both distances
    for (std::uint32_t i = 0; i < hull.count; ++i) {
        const Double3 corner = around.point(i);
        const auto block = hull_blocks({&corner, 1});
        const auto apart = convex_distance(below, points_in(block, 1), still);
        if (!apart || apart->lower > hull.slack * kRounded) return false;
    }
    return true;
}

}  // namespace

std::optional<format::Damage> find_piece_falsehood(std::span<const std::byte> file,
                                                   const Model& model) {
    const format::FloatEnvironment environment;
    constexpr auto kHulls = format::SectionId::piece_node_hulls;
    const auto hulls = model.pieces().node_hulls;
    const auto shape =
        format::piece_tree_shape(static_cast<std::uint32_t>(model.pieces().leaves.size()));
    for (std::uint32_t level = 0; level < shape.levels; ++level) {
        for (std::uint32_t node = 0; node < shape.count[level]; ++node) {
            const std::uint32_t number = shape.first[level] + node;
            if (number >= hulls.size()) break;
            if (is_true(hulls[number], corners_below(model, level, node))) continue;
            const auto entry = format::find_section(file, kHulls);
            return format::Damage{format::DamageKind::bad_fact, kHulls,
                                  entry->offset + number * sizeof(PieceNodeHull), number, 0};
        }
    }
    return std::nullopt;
}

}  // namespace cdprep
