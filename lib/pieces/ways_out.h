// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

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

    /// Tests all ways. Returns false if that is too much work, or if an edge is shorter than
    /// PieceShape::kShortest. Hulls that are known to have a common point need fewer tests.
    [[nodiscard]] bool find(const PieceShape& a, const PieceShape& b, bool they_meet) noexcept;

    /// Adds a way that is not one of those.
    void add(const Double3& normal, double length) noexcept {
        add({normal, length, WayKind::other, 0, 0});
    }
    /// Forgets all ways.
    void clear() noexcept {
        count_ = found_ = 0;
    }

    /// The number of ways that operator[] returns.
    [[nodiscard]] std::size_t count() const noexcept {
        return std::min(count_, kMost);
    }
    /// Returns a way by its number, which is less than count(). The shortest has the number 0. Of
    /// ways that are equal up to rounding, those of faces come first. No way can be added
    /// afterwards, until clear().
    [[nodiscard]] const WayOut& operator[](std::size_t i) noexcept {
        assert(i < count());
        while (found_ <= i) find_next();
        return way_[place_[i]];
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
    /// The number of ways stored before the longest are dropped. Most pairs of pieces have fewer.
    static constexpr std::size_t kRoom = 128;

    void add(const WayOut& way) noexcept;
    void add_faces(const PieceShape& of, const PieceShape& other, WayKind kind) noexcept;
    [[nodiscard]] bool add_edges(const PieceShape& a, const PieceShape& b, double far) noexcept;
    void keep_shortest() noexcept;
    void find_next() noexcept;

    std::size_t count_ = 0;
    std::size_t found_ = 0;  ///< how many of the shortest are in place_
    double least_ = 0;
    double position_error_ = 0;
    double reach_ = 0;
    double shortest_of_faces_ = 0;
    double skipped_angle_ = 0;  ///< the largest between edges that were left out
    std::array<WayOut, kRoom> way_;
    /// The length; of edges, a little more. Infinite for those in place_.
    std::array<double, kRoom> order_;
    std::array<std::uint8_t, kMost> place_;  ///< of the shortest in way_, in order
};

/// Returns a bound of the shortest way out of two hulls, or minus their distance, by the normals of
/// their faces. Takes a fraction of the time of WaysOut::find().
[[nodiscard]] double shortest_way_by_faces(const PieceShape& a, const PieceShape& b) noexcept;

}  // namespace cdprep
