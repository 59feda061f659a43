// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "support/c_models.h"
#include "support/every_structure.h"
#include "support/tiny_pieces.h"

#include "cdprep/pose.h"

namespace cdprep::test {

inline constexpr std::array kAllBounds = {
    build::BvhBounds::aligned,          build::BvhBounds::oriented,
    build::BvhBounds::swept_points,     build::BvhBounds::swept_lines,
    build::BvhBounds::swept_rectangles, build::BvhBounds::oriented_and_swept};
inline constexpr std::array kBoundsNames = {"aligned",     "oriented",         "swept points",
                                            "swept lines", "swept rectangles", "both"};

/// What a question may go through.
enum class Holding : std::uint8_t {
    every_structure,
    pieces,  ///< and the hierarchy of boxes: all that tells distances
};

/// A mesh baked with what a question goes through. What is baked in several ways
/// alternates with `turn`: bounds, how far structures divide, how coordinates are stored, how
/// well the hierarchy is built.
class AskedModel {
public:
    AskedModel(const TestMesh& mesh, std::size_t turn, Holding holding = Holding::every_structure)
        : open_(open_tiny(baked(mesh, turn, holding))),
          bounds_(kBoundsNames[turn % kAllBounds.size()]) {}

    [[nodiscard]] const Model& model() const {
        return open_.model;
    }
    [[nodiscard]] const char* bounds() const {
        return bounds_;
    }
    [[nodiscard]] std::span<const std::byte> bytes() const {
        return open_.bytes.span();
    }

private:
    static bool is_in_floats(const TestMesh& mesh) {
        return in_floats(mesh).positions == mesh.positions;
    }
    static AlignedBytes baked(const TestMesh& mesh, std::size_t turn, Holding holding) {
        const bool is_fine = turn % 2 == 1;
        const TinyOptions options = {
            .double_precision = turn % 3 != 0 || !is_in_floats(mesh),
            .bounds = kAllBounds[turn % kAllBounds.size()],
            .quality = turn % 4 == 3 ? build::Quality::fast : build::Quality::best};
        const AlignedBytes file = bake_tiny(mesh.positions, mesh.triangles, options);
        if (holding == Holding::pieces) return with_piece_tree(file);
        const Division division = {
            .level = is_fine ? 4U : 2U, .threshold = is_fine ? 4U : 1U, .boxes = is_fine};
        return with_piece_tree(with_every_structure(file, division));
    }

    OpenModel open_;
    const char* bounds_;
};

inline cdprep_pose in_c(const Pose& pose) {
    cdprep_pose result{};
    for (std::size_t i = 0; i < 9; ++i) result.rows[i] = pose.rotation()[i];
    result.rows[9] = pose.translation().x;
    result.rows[10] = pose.translation().y;
    result.rows[11] = pose.translation().z;
    return result;
}

/// Writes who moves, and both poses, which are the identity of who does not.
template <class Pair>
void place(const Placement& placement, Pair& pair) {
    pair.moving = !placement.a_is_moved()   ? CDPREP_MOVE_B
                  : !placement.b_is_moved() ? CDPREP_MOVE_A
                                            : CDPREP_MOVE_BOTH;
    pair.pose_a = in_c(placement.pose_a());
    pair.pose_b = in_c(placement.pose_b());
}

inline cdprep_pair in_c(const CModel& a, const CModel& b, const Placement& placement) {
    cdprep_pair pair;
    cdprep_pair_init(&pair, sizeof pair);
    pair.a = a.get();
    pair.b = b.get();
    place(placement, pair);
    return pair;
}

}  // namespace cdprep::test
