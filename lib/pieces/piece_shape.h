// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/format/hull.h"
#include "cdprep/format/pieces.h"
#include "exact/box3.h"
#include "exact/vectors.h"

namespace cdprep {

class ContactSide;

/// The corners, faces and edges of a piece's hull as moved, relative to a point. Set once for each
/// piece; then tested against those of many others.
class PieceShape {
public:
    /// Limits of memory and time. The depth of larger hulls is searched (expanding_polytope.h).
    static constexpr std::size_t kMostCorners = 64;
    static constexpr std::size_t kMostFaces = 64;
    static constexpr std::size_t kMostEdges = 128;  // places fit into 8 bits
    /// Limits of size. Within them, the squares of lengths and areas stay in the range of double,
    /// and so do their products with a length.
    static constexpr double kLongest = 0x1p254, kShortest = 0x1p-240, kLeastArea = 0x1p-480;

    struct Face {
        Double3 normal;        ///< outwards, of length 1 up to rounding
        double error;          ///< of the normal, relative
        std::uint32_t corner;  ///< one of the face
        bool is_covered;       ///< by triangles
    };
    /// Numbers of corners: the ends of an edge, and another corner of the face on either side.
    struct Edge {
        std::uint8_t from;
        std::uint8_t to;
        std::uint8_t left;
        std::uint8_t right;
    };

    /// Reads a piece. Returns false for a hull that is too large, one without faces, or one with a
    /// face beyond those limits as moved, such as one without area.
    [[nodiscard]] bool set(const ContactSide& side, const Double3& origin) noexcept;

    [[nodiscard]] std::span<const Double3> corners() const noexcept {
        return std::span(corner_).first(corners_);
    }
    [[nodiscard]] std::span<const Face> faces() const noexcept {
        return std::span(face_).first(faces_);
    }
    [[nodiscard]] std::span<const Edge> edges() const noexcept {
        return std::span(edge_).first(edges_);
    }
    /// The normals of all faces, reversed. The rest of the last block is 0.
    [[nodiscard]] std::span<const format::HullBlock> inward() const noexcept {
        return std::span(inward_).first((faces_ + format::kHullLanes - 1) / format::kHullLanes);
    }
    /// The box around the corners.
    [[nodiscard]] const Box3& box() const noexcept {
        return box_;
    }
    /// The largest distance of a corner from where exact arithmetic would move it.
    [[nodiscard]] double position_error() const noexcept {
        return position_error_;
    }
    /// The largest distance of a corner from the origin.
    [[nodiscard]] double reach() const noexcept {
        return reach_;
    }

private:
    void set_corners(const ContactSide& side, const Double3& origin) noexcept;
    [[nodiscard]] bool add_face(std::span<const format::PieceFacet> facets) noexcept;
    void add_edges(const ContactSide& side) noexcept;
    void set_inward() noexcept;

    std::size_t corners_ = 0;
    std::size_t faces_ = 0;
    std::size_t edges_ = 0;
    double position_error_ = 0;
    double reach_ = 0;
    Box3 box_{};
    std::array<Double3, kMostCorners> corner_;
    std::array<Face, kMostFaces> face_;
    std::array<Edge, kMostEdges> edge_;
    std::array<format::HullBlock, kMostFaces / format::kHullLanes> inward_;
};

}  // namespace cdprep
