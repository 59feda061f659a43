// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "pieces/piece_shape.h"

namespace cdprep {

/// What a way out of two hulls is across.
enum class WayKind : std::uint8_t {
    face_a,  ///< a face of A
    face_b,
    edges,  ///< an edge of either
    other,
};

/// A direction in which B may leave A, and how far.
struct WayOut {
    Double3 normal;  ///< from A to B, of length 1 up to rounding
    double length;   ///< up to rounding
    WayKind kind;
    std::uint8_t a;  ///< the face or edge of A, by its place in PieceShape
    std::uint8_t b;
};

/// The shortest ways out of two overlapping hulls, among the normals of the faces of A - B. These
/// are the normals of A's faces, those of B's reversed, and the directions across an edge of either
/// that both hulls stay behind.
///
/// The shortest of them is the penetration depth, so testing all that may be proves it. For hulls
/// of few faces this takes a fraction of the time of a search (expanding_polytope.h).
class WaysOut {
public:
    /// The most ways that are kept: few are left once snags are known.
    static constexpr std::size_t kMost = 16;

    /// Tests all ways. Returns false if that is too much work. Hulls that are known to have a
    /// common point need fewer tests.
    [[nodiscard]] bool find(const PieceShape& a, const PieceShape& b, bool they_meet) noexcept;

    /// Adds a way that is not one of those.
    void add(const Double3& normal, double length) noexcept {
        add({normal, length, WayKind::other, 0, 0});
    }
    void clear() noexcept {
        count_ = 0;
    }

    /// Returns the shortest ways in order. Of ways that are equal up to rounding, those of faces
    /// come first.
    [[nodiscard]] std::span<const WayOut> shortest() const noexcept {
        return std::span(way_).first(count_);
    }
    /// Returns a lower bound of the length of every way out. Negative: the hulls may be apart.
    [[nodiscard]] double least() const noexcept {
        return least_;
    }
    /// Returns the part of the bound's error that comes from rounding the moved corners.
    [[nodiscard]] double position_error() const noexcept {
        return position_error_;
    }

private:
    void add(const WayOut& way) noexcept;
    void add_faces(const PieceShape& of, const PieceShape& other, WayKind kind) noexcept;
    void add_edges(const PieceShape& a, const PieceShape& b, double far) noexcept;

    std::size_t count_ = 0;
    double least_ = 0;
    double position_error_ = 0;
    double reach_ = 0;
    double skipped_angle_ = 0;  ///< the largest between edges that were left out
    std::array<WayOut, kMost> way_;
    std::array<double, kMost> order_;  ///< the length; of edges, a little more
};

/// Returns a bound of the shortest way out of two hulls, or minus their distance, by the normals of
/// their faces. Takes a fraction of the time of WaysOut::find().
[[nodiscard]] double shortest_way_by_faces(const PieceShape& a, const PieceShape& b) noexcept;

}  // namespace cdprep
