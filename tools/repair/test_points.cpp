// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/test_points.h"

#include <algorithm>
#include <array>
#include <set>

namespace cdprep::mesh {
namespace {

/// Returns the middle of two numbers; nothing if it is no double.
std::optional<double> exact_middle(double a, double b) {
    const double sum = a + b, part = sum - a;
    const double error = (a - (sum - part)) + (b - part);
    if (error != 0 || 2 * (sum / 2) != sum) return std::nullopt;  // also if it overflows
    return sum / 2;
}
std::optional<Double3> exact_middle(const Double3& a, const Double3& b) {
    const auto x = exact_middle(a.x, b.x), y = exact_middle(a.y, b.y), z = exact_middle(a.z, b.z);
    if (!x || !y || !z) return std::nullopt;
    return Double3{*x, *y, *z};
}

enum class PointKind : std::uint8_t { corner, edge, face };

/// Returns the point of this kind at corner a, if the next corners are b and c.
std::optional<Double3> point_at(PointKind kind, const Double3& a, const Double3& b,
                                const Double3& c) {
    if (kind == PointKind::corner) return a;
    if (kind == PointKind::edge) return exact_middle(a, b);
    const auto opposite = exact_middle(b, c);
    return opposite ? exact_middle(a, *opposite) : std::nullopt;
}

/// The points of a part that were tested. They are counted once, however many triangles share
/// them.
class TestedPoints {
public:
    [[nodiscard]] bool is_full() const {
        return points_.size() == kMostTestPoints;
    }
    bool add(const Double3& p) {
        return points_.insert({p.x, p.y, p.z}).second;
    }

private:
    std::set<std::array<double, 3>> points_;
};

/// Calls `visit` with the triangles of a part until it returns true. Neighbours often lie on the
/// same wall, so the first kMostTestPoints corners come from the whole part.
template <class Visit>
void visit_spread(std::span<const std::uint32_t> part, Visit&& visit) {
    const std::size_t stride =
        std::max<std::size_t>(1, (3 * part.size() + kMostTestPoints - 1) / kMostTestPoints);
    for (std::size_t first = 0; first < std::min(stride, part.size()); ++first) {
        for (std::size_t i = first; i < part.size(); i += stride) {
            if (visit(part[i])) return;
        }
    }
}

}  // namespace

std::optional<int> find_number_at_part(std::span<const Double3> positions,
                                       std::span<const Triangle> triangles,
                                       std::span<const std::uint32_t> part,
                                       const NumberAt& number_at, const StopCheck& stop) {
    std::optional<int> number;
    for (const PointKind kind : {PointKind::corner, PointKind::edge, PointKind::face}) {
        TestedPoints tested;
        const auto ends_at = [&](const Double3& p) {
            if (!tested.add(p)) return false;
            number = number_at(p);
            return number || tested.is_full() || is_stopped(stop);
        };
        visit_spread(part, [&](std::uint32_t t) {
            for (std::size_t i = 0; i < 3; ++i) {
                const auto at = [&](std::size_t k) -> const Double3& {
                    return positions[triangles[t].vertex[(i + k) % 3]];
                };
                const auto p = point_at(kind, at(0), at(1), at(2));
                if (p && ends_at(*p)) return true;
            }
            return false;
        });
        if (number || is_stopped(stop)) break;
    }
    return number;
}

}  // namespace cdprep::mesh
