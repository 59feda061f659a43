// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <span>
#include <variant>

#include "cdprep/format/geometry.h"

namespace cdprep::scenes {

using format::Double3;

/// The box of the vertices of a model at rest. A point at the origin without vertices.
struct RestBox {
    Double3 lower{};
    Double3 upper{};

    /// Returns the box of at least one point, or RestBox().
    [[nodiscard]] static RestBox of(std::span<const Double3> points) noexcept;
    [[nodiscard]] Double3 middle() const noexcept;
};

/// Coordinate `of` of each vertex grows by factor(time) times coordinate `along`, counted from the
/// middle of the box. Axes are 0, 1 and 2 for x, y and z.
struct Shear {
    std::uint32_t of = 0;
    std::uint32_t along = 1;  ///< not `of`
    double rate_per_s = 0;    ///< without a period, the factor is rate_per_s * time
    double amplitude = 0;     ///< with a period, it is amplitude * sin(2 pi time / period_s)
    double period_s = 0;      ///< above 0, or 0 for none

    [[nodiscard]] double factor(double time_s) const noexcept;
    auto operator<=>(const Shear&) const = default;
};

/// Each vertex turns about the axis through the middle of the box. The angle is proportional to
/// its coordinate on the axis, counted from the middle. One end of the box turns by angle(time)
/// more than the other. A model that is flat along the axis stays as it is.
struct Twist {
    std::uint32_t axis = 2;
    double angle_rad = 0;  ///< angle(time) is angle_rad * sin(2 pi time / period_s)
    double period_s = 1;   ///< above 0

    [[nodiscard]] double angle(double time_s) const noexcept;
    auto operator<=>(const Twist&) const = default;
};

/// The positions of a Point Cache 2 file: sample i is that of the time i * step_s. Positions
/// between two samples are linear in time.
struct Stream {
    std::filesystem::path file;
    double step_s = 1;  ///< above 0
    /// Whether the first sample follows the last one, a step later. Otherwise the last one stays.
    bool repeats = false;

    auto operator<=>(const Stream&) const = default;
};

using Deform = std::variant<Shear, Twist, Stream>;

/// Moves the vertices of a model at rest by a factor of a shear. 0 keeps every bit. `moved` has as
/// many elements as `rest`.
void shear(const Shear& shear, double factor, const RestBox& box, std::span<const Double3> rest,
           std::span<Double3> moved) noexcept;

/// Moves them by an angle of a twist. 0 keeps every bit.
void twist(const Twist& twist, double angle, const RestBox& box, std::span<const Double3> rest,
           std::span<Double3> moved) noexcept;

}  // namespace cdprep::scenes
