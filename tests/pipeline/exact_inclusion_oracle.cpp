// SPDX-License-Identifier: MIT
// Whether points are inside a baked model, through every structure, against CGAL.
//
// Usage: exact_inclusion_oracle sides|rays MODEL COUNT
//
// sides: CGAL's Side_of_triangle_mesh with exact constructions; the model must be closed
// and 2-manifold. rays: what random rays cross, by exact predicates, a ray with a zero sign
// thrown away and another drawn; any balanced model. Points are uniform in the model's box,
// on and near triangles, behind corners along x and as the tetra-tree's centre sees them.
// Prints what was asked; exits with 1 at the first point that any structure gets wrong.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "support/every_structure.h"

#include "cdprep/advanced/query_counts.h"
#include "cdprep/cells.h"
#include "cdprep/points.h"

namespace {

using cdprep::Inclusion;
using cdprep::test::BuilderInput;
using cdprep::test::Double3;

/// Where a point is, by an oracle.
struct Truth {
    bool on_surface = false;
    bool inside = false;  ///< not on the surface
    std::optional<int> winding;
};

/// CGAL's own inclusion of a closed 2-manifold.
class Sides {
public:
    explicit Sides(const BuilderInput& model) {
        for (const Double3& p : model.positions) mesh_.add_vertex({p.x, p.y, p.z});
        for (const cdprep::format::Triangle& t : model.triangles) {
            using Vertex = Mesh::Vertex_index;
            if (mesh_.add_face(Vertex(t.vertex[0]), Vertex(t.vertex[1]), Vertex(t.vertex[2])) ==
                Mesh::null_face()) {
                std::fprintf(stderr, "not a 2-manifold\n");
                std::exit(2);
            }
        }
        sides_ = std::make_unique<Side>(mesh_);
    }

    Truth operator()(const Double3& q) const {
        const CGAL::Bounded_side side = (*sides_)({q.x, q.y, q.z});
        return {side == CGAL::ON_BOUNDARY, side == CGAL::ON_BOUNDED_SIDE, std::nullopt};
    }

private:
    using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
    using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
    using Side = CGAL::Side_of_triangle_mesh<Mesh, Kernel>;

    Mesh mesh_;
    std::unique_ptr<Side> sides_;
};

/// The winding number by counting.
class Rays {
public:
    explicit Rays(const BuilderInput& model) {
        for (const cdprep::format::Triangle& t : model.triangles) {
            std::array<Point, 3> corners;
            for (std::size_t i = 0; i < 3; ++i) {
                const Double3& p = model.positions[t.vertex[i]];
                corners[i] = {p.x, p.y, p.z};
                reach_ = std::max({reach_, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
            }
            surface_.push_back(corners);
        }
    }

    Truth operator()(const Double3& query) {
        const Point q{query.x, query.y, query.z};
        for (const auto& t : surface_) {
            if (lies_on(q, t)) return {true, false, 0};
        }
        std::uniform_real_distribution<double> component(-reach_, reach_);
        for (;;) {
            const double x = component(random_), y = component(random_), z = component(random_);
            if (const auto sum = crossings(q, {x, y, z})) return {false, *sum != 0, sum};
        }
    }

private:
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Point = Kernel::Point_3;

    static bool lies_on(const Point& q, const std::array<Point, 3>& t) {
        if (CGAL::orientation(t[0], t[1], t[2], q) != CGAL::COPLANAR) return false;
        if (!CGAL::collinear(t[0], t[1], t[2])) {
            return Kernel::Triangle_3(t[0], t[1], t[2]).has_on(q);
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const Point &a = t[i], &b = t[(i + 1) % 3];
            if (a == b ? q == a : Kernel::Segment_3(a, b).has_on(q)) return true;
        }
        return false;
    }

    /// What the ray from q through `to` crosses, or nothing when it meets an edge.
    [[nodiscard]] std::optional<int> crossings(const Point& q, const Point& to) const {
        int sum = 0;
        for (const auto& t : surface_) {
            const int first = CGAL::orientation(q, to, t[0], t[1]);
            const int second = CGAL::orientation(q, to, t[1], t[2]);
            if (first * second < 0) continue;
            const int third = CGAL::orientation(q, to, t[2], t[0]);
            if (first * third < 0 || second * third < 0) continue;
            if (first == 0 || second == 0 || third == 0) {
                if (CGAL::collinear(t[0], t[1], t[2])) continue;
                return std::nullopt;
            }
            // The line turns round inside the triangle; it is met on the way where q is
            // on the side that the line comes from.
            if (CGAL::orientation(t[0], t[1], t[2], q) == -first) sum += first;
        }
        return sum;
    }

    std::vector<std::array<Point, 3>> surface_;
    double reach_ = 0;
    std::mt19937_64 random_{1};
};

/// Points that are easy, and points that are not.
class Points {
public:
    Points(const BuilderInput& model, const Double3& centre) : model_(model), centre_(centre) {
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        lower_ = {kInfinity, kInfinity, kInfinity};
        upper_ = {-kInfinity, -kInfinity, -kInfinity};
        for (const Double3& p : model.positions) {
            lower_ = {std::min(lower_.x, p.x), std::min(lower_.y, p.y), std::min(lower_.z, p.z)};
            upper_ = {std::max(upper_.x, p.x), std::max(upper_.y, p.y), std::max(upper_.z, p.z)};
        }
    }

    Double3 next() {
        switch (number_++ % 8) {
            case 0:
                return corner();
            case 1: {  // its ray along x runs through a corner
                const Double3 v = corner();
                return {anywhere().x, v.y, v.z};
            }
            case 2: {  // and as the centre sees it, as far as double holds such points
                const Double3 v = corner();
                const double part = std::ldexp(1.0, -1 - static_cast<int>(random_() % 3));
                return {centre_.x + part * (v.x - centre_.x), centre_.y + part * (v.y - centre_.y),
                        centre_.z + part * (v.z - centre_.z)};
            }
            case 3:
            case 4:
            case 5:
                return near_surface();
            default:
                return anywhere();
        }
    }

private:
    double part() {
        return std::uniform_real_distribution<double>(0, 1)(random_);
    }
    Double3 corner() {
        const auto& t = model_.triangles[random_() % model_.triangles.size()];
        return model_.positions[t.vertex[random_() % 3]];
    }
    Double3 anywhere() {
        const double x = part(), y = part(), z = part();
        return {lower_.x + x * (upper_.x - lower_.x), lower_.y + y * (upper_.y - lower_.y),
                lower_.z + z * (upper_.z - lower_.z)};
    }
    /// Off a point of a triangle by a half to 2^-60 of the model's size, or by rounding.
    Double3 near_surface() {
        const auto& t = model_.triangles[random_() % model_.triangles.size()];
        double u = part(), v = part();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Double3 &a = model_.positions[t.vertex[0]], &b = model_.positions[t.vertex[1]],
                      &c = model_.positions[t.vertex[2]];
        const double away = std::ldexp(1.0, -1 - static_cast<int>(random_() % 60));
        const Double3 some = anywhere();
        const auto mixed = [&](double at_a, double at_b, double at_c, double at_some, double low,
                               double high) {
            return at_a + u * (at_b - at_a) + v * (at_c - at_a) +
                   away * (at_some - 0.5 * (low + high));
        };
        return {mixed(a.x, b.x, c.x, some.x, lower_.x, upper_.x),
                mixed(a.y, b.y, c.y, some.y, lower_.y, upper_.y),
                mixed(a.z, b.z, c.z, some.z, lower_.z, upper_.z)};
    }

    const BuilderInput& model_;
    Double3 centre_;
    Double3 lower_{}, upper_{};
    std::mt19937_64 random_{2};
    std::size_t number_ = 0;
};

bool agrees(const Inclusion& found, const Truth& truth) {
    const bool yes = truth.on_surface || truth.inside;
    return found.on_surface == truth.on_surface &&
           found.answer == (yes ? cdprep::Answer::yes : cdprep::Answer::no) &&
           (truth.on_surface || !truth.winding || found.winding == *truth.winding);
}

template <class Oracle>
int compare(const cdprep::Model& model, const BuilderInput& input, Oracle&& oracle,
            std::size_t count) {
    using cdprep::test::kStructures;
    Points points(input, model.tetra_tree().tree->centre);
    cdprep::Workspace workspace(cdprep::cells());
    std::array<cdprep::QueryCounts, kStructures.size()> counts;
    std::size_t on_surface = 0, inside = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Double3 q = points.next();
        const Truth truth = oracle(q);
        for (std::size_t s = 0; s < kStructures.size(); ++s) {
            workspace.count_into(&counts[s]);
            const Inclusion found = cdprep::points_inside(model, q, workspace, kStructures[s]);
            if (agrees(found, truth)) continue;
            std::printf(
                "point %zu, (%a, %a, %a): %s says %s, %d around, on it: %d; exact: %d, %d\n", i,
                q.x, q.y, q.z, cdprep::test::name_of(kStructures[s]).c_str(),
                found.answer == cdprep::Answer::yes ? "in" : "not in",
                static_cast<int>(found.winding), static_cast<int>(found.on_surface),
                truth.winding.value_or(truth.inside ? 1 : 0), static_cast<int>(truth.on_surface));
            return 1;
        }
        on_surface += truth.on_surface ? 1 : 0;
        inside += truth.inside ? 1 : 0;
    }
    std::printf("points %zu on_surface %zu inside %zu\n", count, on_surface, inside);
    for (std::size_t s = 0; s < kStructures.size(); ++s) {
        std::printf("%s looks at %.1f of %zu triangles a point\n",
                    cdprep::test::name_of(kStructures[s]).c_str(),
                    static_cast<double>(counts[s].ray_triangles) / static_cast<double>(count),
                    input.triangles.size());
    }
    return 0;
}

cdprep::test::OpenModel open_file(const char* path) {
    std::ifstream in(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    const cdprep::test::AlignedBytes file(std::as_bytes(std::span(bytes)));
    return cdprep::test::open_tiny(
        cdprep::test::with_every_structure(file, {.level = 5, .threshold = 16}));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    const std::string by = argv[1];
    const cdprep::test::OpenModel open = open_file(argv[2]);
    const std::size_t count = std::strtoull(argv[3], nullptr, 10);
    if (!open.model.is_balanced()) {
        std::fprintf(stderr, "%s is unbalanced\n", argv[2]);
        return 2;
    }
    const BuilderInput input = cdprep::test::builder_input(open.model);
    if (by == "sides") return compare(open.model, input, Sides(input), count);
    if (by == "rays") return compare(open.model, input, Rays(input), count);
    return 2;
}
