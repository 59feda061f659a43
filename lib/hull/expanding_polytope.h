// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cdprep/advanced/convex_penetration.h"
#include "hull/moved_hull.h"
#include "hull/nearest_simplex.h"

namespace cdprep {

/// A polytope within A - B that holds the origin and grows where its border is nearest to
/// it, until the border of A - B is known to be as near.
///
/// Its corners are corners of A - B, what a new one sees is decided without rounding, and
/// what lies in a plane with it is not seen: so the faces always close, and none is flat.
class ExpandingPolytope {
public:
    ExpandingPolytope(const MovedHull& a, const MovedHull& b) noexcept : a_(a), b_(b) {}

    /// Starts from up to four corners, affinely independent, whose hull holds the origin.
    [[nodiscard]] Penetration expand(const Difference* corner, std::size_t count,
                                     const DistanceOptions& options) noexcept;
    /// Farthest points that were sought, one of each hull.
    [[nodiscard]] std::uint64_t steps() const noexcept {
        return steps_;
    }

private:
    static constexpr std::size_t kMostCorners = 128;
    static constexpr std::size_t kMostFaces = 2 * kMostCorners;

    struct Face {
        std::array<std::uint8_t, 3> corner;  ///< counter-clockwise from outside
        double lower;                        ///< it is at least so far from the origin
        Double3 direction;                   ///< outwards, the largest coordinate 1
        bool looked_at;                      ///< closely
    };
    struct Edge {
        std::uint8_t from, to;
    };

    [[nodiscard]] Difference difference(std::uint32_t i, std::uint32_t j) const noexcept;
    /// The corner of A - B that is highest along a direction, sought from one near it.
    [[nodiscard]] Difference highest(const Double3& direction, const Difference& near) noexcept;
    /// Takes note of how far A - B reaches at most along a direction, seen from one of its
    /// corners, that highest() answered.
    void bound_along(const Double3& direction, const Difference& top,
                     const NearestSimplex& corners) noexcept;
    /// Adds the witnesses.
    [[nodiscard]] Penetration answer() noexcept;
    /// Adds corners until there are four that span space; false where A - B is flat, as
    /// far as double can tell.
    [[nodiscard]] bool span_space() noexcept;
    /// The bounds where it is false: nothing is deep.
    void bound_flat() noexcept;
    [[nodiscard]] bool add_off_point() noexcept;
    [[nodiscard]] bool add_off_line() noexcept;
    [[nodiscard]] bool add_off_plane() noexcept;
    void first_faces() noexcept;
    void add_face(std::uint8_t p, std::uint8_t q, std::uint8_t r) noexcept;
    /// How far along a direction a face is, at least: 4 u for the rounded corners and the dot
    /// products, 8 u for the length and the quotient.
    [[nodiscard]] double lower_along(const Double3& d, const Face& face) const noexcept;
    /// Takes note of what the nearest point of a face says besides its normal.
    void look_closely(Face& face) const noexcept;
    [[nodiscard]] bool sees(const Difference& from, const Face& face) const noexcept;
    [[nodiscard]] bool has(const Difference& corner) const noexcept;
    /// Replaces what a new corner sees by the cone to it; false when there is no room.
    [[nodiscard]] bool grow(const Difference& corner) noexcept;
    [[nodiscard]] const Face& nearest_face() noexcept;
    [[nodiscard]] NearestSimplex simplex_of(const Face& face) const noexcept;

    const MovedHull& a_;
    const MovedHull& b_;
    std::uint64_t steps_ = 0;
    std::size_t corners_ = 0;
    std::size_t faces_ = 0;
    Penetration best_{};
    NearestSimplex all_;      ///< the corners that best_ was proved with
    NearestSimplex nearest_;  ///< those of them that their nearest point needs
    double foot_ = 0;         ///< how far its nearest point is from the origin
    std::array<Difference, kMostCorners> corner_;
    std::array<Face, kMostFaces> face_;
    std::array<Edge, 3 * kMostFaces> edge_;
};

}  // namespace cdprep
