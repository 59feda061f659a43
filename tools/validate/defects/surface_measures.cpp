// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/surface_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cdprep/exact/triangles.h"
#include "mesh/exact_volume.h"
#include "mesh/vectors.h"

namespace cdprep::mesh {
namespace {

/// Returns the nearest finite double.
double finite(double value) {
    constexpr double kLargest = std::numeric_limits<double>::max();
    return std::isnan(value) ? 0 : std::clamp(value, -kLargest, kLargest);
}

/// A sliver's area is below this times its squared longest edge. Its height is then less than
/// 2e-10 of that edge: too little for normals in floating point.
constexpr double kSliverRatio = 1e-10;

/// A component of a cross product; `certain` if it is proved not to be zero.
struct Minor {
    double value;
    bool certain;
};

Minor minor(double a, double b, double c, double d) {
    const double left = a * d;
    const double right = b * c;
    // Relative errors, with u = 2^-53: u for each difference, 3u for each product, u for the
    // subtraction. The sum is 4u; the bound is twice that. Above kLeast, losses by underflow do
    // not matter.
    constexpr double kBound = 8 * 0x1p-53;
    constexpr double kLeast = 1e-290;
    const double value = left - right;
    const double bound = kBound * (std::fabs(left) + std::fabs(right));
    return {value, std::fabs(value) > bound && std::fabs(value) > kLeast};
}

/// Measures of a triangle that do not depend on its place.
struct Shape {
    double double_area = 0;
    double longest_squared = 0;
    bool has_area = false;  ///< proved; false: unknown
    int exponent = 0;       ///< the true lengths are 2^exponent times these
};

Shape shape_of_edges(const Double3& u, const Double3& v) {
    const Minor x = minor(u.y, u.z, v.y, v.z);
    const Minor y = minor(u.z, u.x, v.z, v.x);
    const Minor z = minor(u.x, u.y, v.x, v.y);
    const Double3 third = minus(v, u);
    const Double3 normal = {x.value, y.value, z.value};
    Shape shape;
    shape.double_area = std::sqrt(dot(normal, normal));
    shape.longest_squared = std::max({dot(u, u), dot(v, v), dot(third, third)});
    shape.has_area = x.certain || y.certain || z.certain;
    return shape;
}

/// Returns the shape at the scale of the edges, where fourth powers would leave the range of
/// double.
Shape shape_far_out(const Corners& t) {
    constexpr int kRoom = 2;  // for sums of coordinates
    const double place = std::max({largest_of(t[0]), largest_of(t[1]), largest_of(t[2])});
    const int first = place > 1 ? std::ilogb(place) + kRoom : 0;
    const auto near = [first](const Double3& p) {
        return Double3{std::ldexp(p.x, -first), std::ldexp(p.y, -first), std::ldexp(p.z, -first)};
    };
    const Double3 u = minus(near(t[1]), near(t[0]));
    const Double3 v = minus(near(t[2]), near(t[0]));
    const double length = std::max(largest_of(u), largest_of(v));
    if (length == 0) return {};
    const int second = std::ilogb(length);
    // In two steps: 2^-second alone may not be a double.
    const auto near_one = [second](const Double3& p) {
        return scaled(scaled(p, std::ldexp(1.0, -second / 2)),
                      std::ldexp(1.0, second / 2 - second));
    };
    Shape shape = shape_of_edges(near_one(u), near_one(v));
    shape.exponent = first + second;
    return shape;
}

Shape shape_of(const Corners& t) {
    constexpr double kLeastSquare = 1e-140;
    constexpr double kMostSquare = 1e140;
    const Shape shape = shape_of_edges(minus(t[1], t[0]), minus(t[2], t[0]));
    const bool in_range =
        shape.longest_squared > kLeastSquare && shape.longest_squared < kMostSquare;
    return in_range ? shape : shape_far_out(t);
}

/// Six times a volume as a running sum of doubles, with a bound on its error.
struct VolumeSum {
    double six_volume = 0;
    double permanent = 0;  ///< the same sum, of absolute values
    std::uint32_t terms = 0;

    void add(const Double3& u, const Double3& v, const Double3& w) {
        const double x1 = v.y * w.z, x2 = v.z * w.y;
        const double y1 = v.z * w.x, y2 = v.x * w.z;
        const double z1 = v.x * w.y, z2 = v.y * w.x;
        six_volume += u.x * (x1 - x2) + u.y * (y1 - y2) + u.z * (z1 - z2);
        permanent += std::fabs(u.x) * (std::fabs(x1) + std::fabs(x2)) +
                     std::fabs(u.y) * (std::fabs(y1) + std::fabs(y2)) +
                     std::fabs(u.z) * (std::fabs(z1) + std::fabs(z2));
        ++terms;
    }

    /// The error of each term is less than 16u times its permanent. The error of each addition
    /// is at most u times the sum so far.
    [[nodiscard]] bool sign_is_certain() const {
        constexpr double kTermBound = 16;
        constexpr double kLeast = 1e-280;
        const double bound = (kTermBound + terms) * 0x1p-52 * permanent;
        return std::fabs(six_volume) > bound && std::fabs(six_volume) > kLeast &&
               std::isfinite(permanent);
    }
};

int sign_of(double value) {
    return value > 0 ? 1 : value < 0 ? -1 : 0;
}

class Measurer {
public:
    Measurer(const SoundMesh& sound, const ComponentNumbers& components)
        : mesh_(sound.mesh), components_(components) {
        measures_.component.resize(components.count);
        sums_.resize(components.count);
    }

    void add_triangles(const SoundMesh& sound, FindingList& findings, DefectCounts& counts) {
        anchor_.resize(components_.count);
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            const Corners t = corners_of(i);
            const Shape shape = shape_of(t);
            const std::uint32_t component = component_of(i);
            measures_.component[component].area += area_of(shape);
            if (sums_[component].terms == 0) anchor_[component] = t[0];
            const Double3& o = anchor_[component];
            sums_[component].add(minus(t[0], o), minus(t[1], o), minus(t[2], o));
            judge(sound.source_triangle[i], t, shape, findings, counts);
        }
    }

    SurfaceMeasures finish(const std::vector<bool>& balanced) {
        std::vector<std::uint32_t> uncertain;
        bool all_balanced = true;
        for (std::uint32_t i = 0; i < components_.count; ++i) {
            SurfaceMeasure& measure = measures_.component[i];
            measures_.whole.area = finite(measures_.whole.area + measure.area);
            measure.area = finite(measure.area);
            measure.volume = finite(sums_[i].six_volume / 6);
            measure.volume_sign = sign_of(measure.volume);
            all_balanced = all_balanced && balanced[i];
            if (balanced[i] && !sums_[i].sign_is_certain()) uncertain.push_back(i);
        }
        if (!uncertain.empty()) decide_exactly(uncertain);
        if (components_.count == 1) {
            measures_.whole = measures_.component.front();
        } else {
            measure_whole(all_balanced);
        }
        return std::move(measures_);
    }

private:
    [[nodiscard]] Corners corners_of(std::uint32_t triangle) const {
        const auto& v = mesh_.triangles[triangle].vertex;
        return {mesh_.positions[v[0]], mesh_.positions[v[1]], mesh_.positions[v[2]]};
    }
    [[nodiscard]] std::uint32_t component_of(std::uint32_t triangle) const {
        return components_.of_vertex[mesh_.triangles[triangle].vertex[0]];
    }

    static double area_of(const Shape& shape) {
        const double area = shape.double_area / 2;
        return shape.exponent == 0 ? area : std::ldexp(area, 2 * shape.exponent);
    }

    static Place place_of(std::uint32_t source, const Corners& t, double measure) {
        const auto middle = [](double a, double b, double c) { return a / 3 + b / 3 + c / 3; };
        return {{source},
                {},
                {middle(t[0].x, t[1].x, t[2].x), middle(t[0].y, t[1].y, t[2].y),
                 middle(t[0].z, t[1].z, t[2].z)},
                measure};
    }

    static void judge(std::uint32_t source, const Corners& t, const Shape& shape,
                      FindingList& findings, DefectCounts& counts) {
        if (!shape.has_area && exact::is_degenerate(t)) {
            ++counts.zero_area_triangles;
            findings.add(Rule::zero_area, [&] {
                const double edge = std::ldexp(std::sqrt(shape.longest_squared), shape.exponent);
                return place_of(source, t, finite(edge));
            });
            return;
        }
        const double area = shape.double_area / 2;
        if (!(area < kSliverRatio * shape.longest_squared)) return;
        ++counts.sliver_triangles;
        findings.add(Rule::sliver,
                     [&] { return place_of(source, t, area / shape.longest_squared); });
    }

    /// Sums the triangles of these components once more, exactly, one component after the other.
    void decide_exactly(const std::vector<std::uint32_t>& uncertain) {
        std::vector<std::uint32_t> order(mesh_.triangles.size());
        std::iota(order.begin(), order.end(), 0U);
        std::stable_sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) {
            return component_of(a) < component_of(b);
        });
        auto at = order.begin();
        for (const std::uint32_t component : uncertain) {
            at = std::lower_bound(at, order.end(), component,
                                  [this](std::uint32_t triangle, std::uint32_t wanted) {
                                      return component_of(triangle) < wanted;
                                  });
            ExactVolume exact;
            for (; at != order.end() && component_of(*at) == component; ++at) add(exact, *at);
            measures_.component[component].volume = exact.volume();
            measures_.component[component].volume_sign = exact.sign();
        }
    }

    void add(ExactVolume& exact, std::uint32_t triangle) const {
        const Corners t = corners_of(triangle);
        exact.add(t[0], t[1], t[2]);
    }

    void measure_whole(bool all_balanced) {
        SurfaceMeasure& whole = measures_.whole;
        VolumeSum sum;
        for (std::size_t i = 0; i < components_.count; ++i) {
            whole.volume += measures_.component[i].volume;
            sum.permanent += sums_[i].permanent;
            sum.terms += sums_[i].terms;
        }
        whole.volume = finite(whole.volume);
        whole.volume_sign = sign_of(whole.volume);
        sum.six_volume = 6 * whole.volume;
        if (!all_balanced || sum.sign_is_certain() || components_.count == 0) return;
        ExactVolume exact;
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) add(exact, i);
        whole.volume = exact.volume();
        whole.volume_sign = exact.sign();
    }

    const Mesh& mesh_;
    const ComponentNumbers& components_;
    std::vector<Double3> anchor_;  ///< a corner of each component, the origin of its volume
    std::vector<VolumeSum> sums_;
    SurfaceMeasures measures_;
};

}  // namespace

SurfaceMeasures measure_surface(const SoundMesh& sound, const ComponentNumbers& components,
                                const std::vector<bool>& balanced, FindingList& findings,
                                DefectCounts& counts) {
    Measurer measurer(sound, components);
    measurer.add_triangles(sound, findings, counts);
    return measurer.finish(balanced);
}

}  // namespace cdprep::mesh
