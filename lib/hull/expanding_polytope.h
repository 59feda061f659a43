// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cdprep/advanced/convex_penetration.h"
#include "hull/moved_hull.h"
#include "hull/nearest_simplex.h"

namespace cdprep {

/// A polytope within A - B that holds the origin. It grows where its border is nearest to the
/// origin, until the border of A - B is proved to be as near.
///
/// Its corners are corners of A - B. Exact signs decide which faces a new corner sees. A corner
/// does not see the faces that lie in a plane with it. So the faces always close, and none is flat.
class ExpandingPolytope {
public:
    ExpandingPolytope(const MovedHull& a, const MovedHull& b) noexcept : a_(a), b_(b) {}

    /// Starts from up to four corners, affinely independent, whose hull holds the origin.
    [[nodiscard]] Penetration expand(const Difference* corner, std::size_t count,
                                     const DistanceOptions& options) noexcept;
    /// Returns the number of searches for farthest points, one in each hull.
    [[nodiscard]] std::uint64_t steps() const noexcept {
        return steps_;
    }

private:
    /// Limits memory and time. Without room for another corner, the bounds so far are the answer.
    static constexpr std::size_t kMostCorners = 128;
    static constexpr std::size_t kMostFaces = 2 * kMostCorners;  ///< at most 2 n - 4, by Euler

    struct Face {
        std::array<std::uint8_t, 3> corner;  ///< counter-clockwise from outside
        double lower;                        ///< a lower bound of its distance from the origin
        Double3 direction;                   ///< outwards, the largest coordinate 1
        bool looked_at;                      ///< look_closely() was called
    };
    struct Edge {
        std::uint8_t from, to;
    };

    [[nodiscard]] Difference difference(std::uint32_t i, std::uint32_t j) const noexcept;
    /// Returns the corner of A - B that is highest along a direction. The search begins at `near`.
    [[nodiscard]] Difference highest(const Double3& direction, const Difference& near) noexcept;
    /// Records an upper bound of the reach of A - B along a direction. `top` is the corner of A - B
    /// that highest() returned.
    void bound_along(const Double3& direction, const Difference& top,
                     const NearestSimplex& corners) noexcept;
    /// Adds the witnesses and returns the result.
    [[nodiscard]] Penetration answer() noexcept;
    /// Adds corners until four of them span space. Returns false where A - B is flat, up to
    /// rounding.
    [[nodiscard]] bool span_space() noexcept;
    /// Sets the bounds where span_space() returned false: the depth is 0 up to rounding.
    void bound_flat() noexcept;
    [[nodiscard]] bool add_off_point() noexcept;
    [[nodiscard]] bool add_off_line() noexcept;
    [[nodiscard]] bool add_off_plane() noexcept;
    void first_faces() noexcept;
    void add_face(std::uint8_t p, std::uint8_t q, std::uint8_t r) noexcept;
    /// Returns a lower bound of the reach of a face along a direction. The error: 4 u for the
    /// rounded corners and the dot products, 8 u for the length and the quotient.
    [[nodiscard]] double lower_along(const Double3& d, const Face& face) const noexcept;
    /// Improves the lower bound of a face by the direction of its nearest point.
    void look_closely(Face& face) const noexcept;
    [[nodiscard]] bool sees(const Difference& from, const Face& face) const noexcept;
    [[nodiscard]] bool has(const Difference& corner) const noexcept;
    /// Replaces the faces that a new corner sees by the cone to it. Returns false when there is no
    /// room.
    [[nodiscard]] bool grow(const Difference& corner) noexcept;
    [[nodiscard]] const Face& nearest_face() noexcept;
    [[nodiscard]] NearestSimplex simplex_of(const Face& face) const noexcept;

    const MovedHull& a_;
    const MovedHull& b_;
    std::uint64_t steps_ = 0;
    std::size_t corners_ = 0;
    std::size_t faces_ = 0;
    Penetration best_{};
    NearestSimplex all_;      ///< the corners that proved best_
    NearestSimplex nearest_;  ///< those of them that their nearest point depends on
    double foot_ = 0;         ///< the distance of that nearest point from the origin
    std::array<Difference, kMostCorners> corner_;
    std::array<Face, kMostFaces> face_;
    std::array<Edge, 3 * kMostFaces> edge_;
};

}  // namespace cdprep
