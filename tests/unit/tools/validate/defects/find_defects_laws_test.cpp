// SPDX-License-Identifier: MIT
// Random soups on coarse grids, where coincidences are common, against counts taken the
// slow way: maps, exact numbers, and all pairs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "mesh/close_groups.h"
#include "support/exact_rational.h"
#include "support/exact_winding.h"
#include "unit/tools/soup_of.h"
#include "validate/defects/find_defects.h"

namespace cdprep::mesh {
namespace {

using test::ExactNumber;
using Point = std::array<double, 3>;
using Edge = std::array<Point, 2>;
using Corner3 = std::array<Point, 3>;

Point point_of(const Double3& p) {
    return {p.x + 0.0, p.y + 0.0, p.z + 0.0};
}

std::array<ExactNumber, 3> minus(const Point& a, const Point& b) {
    return {ExactNumber(a[0]) - b[0], ExactNumber(a[1]) - b[1], ExactNumber(a[2]) - b[2]};
}

bool collinear(const Point& a, const Point& b, const Point& c) {
    const auto u = minus(b, a);
    const auto v = minus(c, a);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        if ((u[i] * v[j] - u[j] * v[i]).sign() != 0) return false;
    }
    return true;
}

/// Strictly between the ends, on the line.
bool between(const Point& p, const Edge& edge) {
    if (!collinear(p, edge[0], edge[1])) return false;
    const auto u = minus(p, edge[0]);
    const auto v = minus(edge[1], p);
    ExactNumber dot;
    for (std::size_t i = 0; i < 3; ++i) dot = dot + u[i] * v[i];
    return dot.sign() > 0;
}

ExactNumber determinant(const Point& a, const Point& b, const Point& c) {
    return ExactNumber(a[0]) * (ExactNumber(b[1]) * c[2] - ExactNumber(b[2]) * c[1]) +
           ExactNumber(a[1]) * (ExactNumber(b[2]) * c[0] - ExactNumber(b[0]) * c[2]) +
           ExactNumber(a[2]) * (ExactNumber(b[0]) * c[1] - ExactNumber(b[1]) * c[0]);
}

/// Labels things that are linked, by taking over the lower label until nothing changes.
template <class Linked>
std::vector<std::size_t> labels(std::size_t count, Linked linked) {
    std::vector<std::size_t> label(count);
    for (std::size_t i = 0; i < count; ++i) label[i] = i;
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; j < count; ++j) {
                if (label[j] >= label[i] || !linked(i, j)) continue;
                label[i] = label[j];
                changed = true;
            }
        }
    }
    return label;
}

std::size_t different(const std::vector<std::size_t>& label) {
    return std::set<std::size_t>(label.begin(), label.end()).size();
}

/// Everything by positions: vertices are the points they stand at.
class SlowCounts {
public:
    explicit SlowCounts(const test::TestMesh& mesh) {
        for (const Triangle& t : mesh.triangles) {
            const Corner3 corners = {point_of(mesh.positions[t.vertex[0]]),
                                     point_of(mesh.positions[t.vertex[1]]),
                                     point_of(mesh.positions[t.vertex[2]])};
            if (std::set<Point>(corners.begin(), corners.end()).size() < 3) {
                ++counts.degenerate_triangles;
                continue;
            }
            triangles_.push_back(corners);
            if (collinear(corners[0], corners[1], corners[2])) ++counts.zero_area_triangles;
        }
        count_edges();
        count_duplicates();
        count_fans();
        count_components();
        count_boundary();
    }

    DefectCounts counts;

    [[nodiscard]] std::int32_t euler() const {
        std::set<Point> points;
        for (const Corner3& t : triangles_) points.insert(t.begin(), t.end());
        return static_cast<std::int32_t>(points.size() + triangles_.size()) -
               static_cast<std::int32_t>(uses_.size());
    }

    /// Of the whole; whether it can be oriented is not asked.
    [[nodiscard]] std::uint32_t facts() const {
        if (uses_.empty()) return 0;  // nothing is said of nothing
        const bool balanced = std::all_of(uses_.begin(), uses_.end(), [](const auto& edge) {
            return std::accumulate(edge.second.begin(), edge.second.end(), 0) == 0;
        });
        const bool manifold = counts.non_manifold_edges == 0 && counts.non_manifold_vertices == 0;
        std::uint32_t bits = balanced ? format::verdict_balanced : 0U;
        if (counts.boundary_edges == 0) bits |= format::verdict_closed;
        if (manifold) bits |= format::verdict_two_manifold;
        if (counts.inconsistent_edges == 0) bits |= format::verdict_oriented;
        return bits;
    }

private:
    static std::set<Point> corner_set(const Corner3& t) {
        return {t.begin(), t.end()};
    }

    static bool even(const Corner3& t) {
        const auto least =
            static_cast<std::size_t>(std::min_element(t.begin(), t.end()) - t.begin());
        return t[(least + 1) % 3] < t[(least + 2) % 3];
    }

    void count_edges() {
        for (const Corner3& t : triangles_) {
            for (std::size_t i = 0; i < 3; ++i) {
                const Point& a = t[i];
                const Point& b = t[(i + 1) % 3];
                uses_[{std::min(a, b), std::max(a, b)}].push_back(a < b ? 1 : -1);
            }
        }
        for (const auto& [edge, uses] : uses_) {
            counts.boundary_edges += uses.size() == 1 ? 1 : 0;
            counts.non_manifold_edges += uses.size() > 2 ? 1 : 0;
            counts.inconsistent_edges += uses.size() == 2 && uses[0] == uses[1] ? 1 : 0;
            if (uses.size() == 1) boundary_.push_back(edge);
        }
    }

    void count_duplicates() {
        std::map<std::set<Point>, bool> first;
        for (const Corner3& t : triangles_) {
            const auto [at, is_new] = first.try_emplace(corner_set(t), even(t));
            if (is_new) continue;
            ++counts.duplicate_triangles;
            counts.opposite_triangles += at->second != even(t) ? 1 : 0;
        }
    }

    void count_fans() {
        std::map<Point, std::vector<Corner3>> stars;
        for (const Corner3& t : triangles_) {
            for (const Point& p : t) stars[p].push_back(t);
        }
        for (const auto& [vertex, star] : stars) {
            const auto share_an_edge = [&, &vertex = vertex, &star = star](std::size_t i,
                                                                           std::size_t j) {
                return std::any_of(star[i].begin(), star[i].end(), [&](const Point& p) {
                    return p != vertex && corner_set(star[j]).contains(p);
                });
            };
            if (different(labels(star.size(), share_an_edge)) > 1) ++counts.non_manifold_vertices;
        }
    }

    void count_components() {
        const auto share_a_vertex = [this](std::size_t i, std::size_t j) {
            return std::any_of(triangles_[i].begin(), triangles_[i].end(), [&](const Point& p) {
                return corner_set(triangles_[j]).contains(p);
            });
        };
        const std::vector<std::size_t> label = labels(triangles_.size(), share_a_vertex);
        counts.components = different(label);
        for (const std::size_t component : std::set<std::size_t>(label.begin(), label.end())) {
            judge_component(label, component);
        }
    }

    void judge_component(const std::vector<std::size_t>& label, std::size_t component) {
        ExactNumber six_volume;
        std::map<Edge, int> balance;
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            if (label[i] != component) continue;
            const Corner3& t = triangles_[i];
            six_volume = six_volume + determinant(t[0], t[1], t[2]);
            for (std::size_t k = 0; k < 3; ++k) {
                const Point& a = t[k];
                const Point& b = t[(k + 1) % 3];
                balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
            }
        }
        const bool balanced = std::all_of(balance.begin(), balance.end(),
                                          [](const auto& edge) { return edge.second == 0; });
        counts.inverted_components += balanced && six_volume.sign() < 0 ? 1 : 0;
    }

    void count_boundary() {
        const auto share_an_end = [this](std::size_t i, std::size_t j) {
            const Edge& a = boundary_[i];
            const Edge& b = boundary_[j];
            return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
        };
        counts.boundary_loops = different(labels(boundary_.size(), share_an_end));
        std::set<Point> ends;
        for (const Edge& edge : boundary_) ends.insert(edge.begin(), edge.end());
        for (const Edge& edge : boundary_) {
            for (const Point& p : ends) counts.t_junctions += between(p, edge) ? 1 : 0;
        }
    }

    std::vector<Corner3> triangles_;
    std::map<Edge, std::vector<int>> uses_;
    std::vector<Edge> boundary_;
};

void expect_as_slow(const test::TestMesh& mesh, const char* name, std::uint32_t seed) {
    const DefectReport report = find_defects(test::soup_of(mesh), {.crossings = false});
    const DefectCounts& ours = report.counts;
    const SlowCounts slowly(mesh);
    const DefectCounts& slow = slowly.counts;
    const std::uint32_t not_asked = format::verdict_orientable | format::verdict_inverted;
    EXPECT_EQ(report.verdicts[0].facts & ~not_asked, slowly.facts()) << name << seed;
    EXPECT_EQ(report.verdicts[0].euler, slowly.euler()) << name << seed;
    std::int32_t euler = 0;
    std::uint32_t all_of_them = ~0U;
    for (std::size_t i = 1; i < report.verdicts.size(); ++i) {
        euler += report.verdicts[i].euler;
        all_of_them &= report.verdicts[i].facts;
    }
    EXPECT_EQ(euler, slowly.euler()) << name << seed;
    if (report.verdicts.size() > 1) {
        // Each is true of the whole when it is of every component; but for the volume's sign.
        EXPECT_EQ(report.verdicts[0].facts | format::verdict_inverted,
                  all_of_them | format::verdict_inverted)
            << name << seed;
    }
    const auto tied = [](const DefectCounts& c) {
        return std::array{c.degenerate_triangles, c.zero_area_triangles,
                          c.duplicate_triangles,  c.opposite_triangles,
                          c.boundary_edges,       c.boundary_loops,
                          c.non_manifold_edges,   c.non_manifold_vertices,
                          c.inconsistent_edges,   c.t_junctions,
                          c.components,           c.inverted_components};
    };
    EXPECT_EQ(tied(ours), tied(slow)) << name << ", seed " << seed;
}

TEST(FindDefectsLaws, CountsAreThoseTakenTheSlowWay) {
    int t_junctions = 0, pinched = 0, non_manifold = 0, duplicates = 0;
    constexpr int kRounds = 100;
    for (std::uint32_t seed = 1; seed <= kRounds; ++seed) {
        // Denser and denser, so that each defect is sometimes there and sometimes not.
        const int step = static_cast<int>(seed % 10);
        test::TestMesh mesh = test::coarse_grid_soup(seed, 2 + step * step / 2, 1);
        if (seed % 2 == 0) {
            for (Double3& p : mesh.positions) p.z = 0;
        }
        expect_as_slow(mesh, "grid", seed);
        const DefectCounts counts = SlowCounts(mesh).counts;
        t_junctions += counts.t_junctions > 0 ? 1 : 0;
        pinched += counts.non_manifold_vertices > 0 ? 1 : 0;
        non_manifold += counts.non_manifold_edges > 0 ? 1 : 0;
        duplicates += counts.duplicate_triangles > 0 ? 1 : 0;
    }
    for (const int often : {t_junctions, non_manifold, duplicates}) {
        EXPECT_GT(often, kRounds * 2 / 10);
        EXPECT_LT(often, kRounds * 9 / 10);
    }
    EXPECT_GT(pinched, kRounds / 2);
}

// Closed surfaces with a few triangles turned, doubled or missing: most edges are sound, and
// components are inverted as often as not.
TEST(FindDefectsLaws, CountsOfDamagedSolidsAreThoseTakenTheSlowWay) {
    constexpr std::uint32_t kRounds = 60;
    std::mt19937 random(20261121);
    std::uint64_t inverted = 0;
    for (std::uint32_t round = 0; round < kRounds; ++round) {
        test::TestMesh mesh = test::in_floats(test::icosphere(1));
        mesh = test::joined(mesh, test::moved_by(test::torus(2, 0.5, 8, 5), 1, {9, 0, 0}));
        if (round % 2 == 0) mesh = test::reversed(mesh);
        for (std::uint32_t damage = round % 3; damage > 0; --damage) {
            auto& corners = mesh.triangles[random() % mesh.triangles.size()].vertex;
            switch (random() % 3) {
                case 0:
                    std::swap(corners[0], corners[1]);
                    break;
                case 1:
                    mesh.triangles.push_back({corners});
                    break;
                default:
                    corners[0] = corners[1];
            }
        }
        expect_as_slow(mesh, "solids", round);
        inverted += SlowCounts(mesh).counts.inverted_components;
    }
    EXPECT_GT(inverted, kRounds * 2 * 2 / 10);
    EXPECT_LT(inverted, kRounds * 2 * 7 / 10);
}

// All pairs of a boundary vertex and an edge of another triangle: every triangle of this soup
// is apart from the others, a loop of its own.
TEST(FindDefectsLaws, SeamsOfTrianglesApartAreAllThatAreNear) {
    int near = 0, all = 0;
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
        const test::TestMesh mesh = test::random_soup(seed, 30, 0.6);
        constexpr double kWidth = 0.2;
        std::uint64_t expected = 0;
        for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
            double least = 1e9;
            for (const Triangle& t : mesh.triangles) {
                if (std::find(t.vertex.begin(), t.vertex.end(), v) != t.vertex.end()) continue;
                for (std::size_t i = 0; i < 3; ++i) {
                    const Double3& a = mesh.positions[t.vertex[i]];
                    const Double3& b = mesh.positions[t.vertex[(i + 1) % 3]];
                    const Double3& p = mesh.positions[v];
                    const double along = (p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y) +
                                         (p.z - a.z) * (b.z - a.z);
                    const double length = distance_between(a, b);
                    const double share = std::clamp(along / (length * length), 0.0, 1.0);
                    least = std::min(least, distance_between(p, {a.x + share * (b.x - a.x),
                                                                 a.y + share * (b.y - a.y),
                                                                 a.z + share * (b.z - a.z)}));
                }
            }
            expected += least <= kWidth ? 1 : 0;
            ++all;
        }
        const DefectReport report =
            find_defects(test::soup_of(mesh), {.seam_width = kWidth, .crossings = false});
        EXPECT_EQ(report.counts.near_seams, expected) << "seed " << seed;
        near += static_cast<int>(expected);
    }
    EXPECT_GT(near, all * 3 / 10);
    EXPECT_LT(near, all * 7 / 10);
}

// Cubes of random sizes and places, some turned inside out: the winding number of one around
// the other's first vertex, by exact rays.
TEST(FindDefectsLaws, NestedComponentsAreThoseWithAWindingNumber) {
    std::mt19937 random(20261121);
    std::uniform_real_distribution<double> place(0, 10);
    std::uniform_real_distribution<double> size(1, 12);
    int nested = 0;
    for (int round = 0; round < 60; ++round) {
        constexpr std::uint32_t kSolids = 6;
        std::vector<test::TestMesh> solids;
        test::TestMesh all;
        for (std::uint32_t i = 0; i < kSolids; ++i) {
            test::TestMesh solid = test::moved_by(test::icosphere(1), size(random),
                                                  {place(random), place(random), place(random)});
            if (random() % 2 == 0) solid = test::reversed(solid);
            solids.push_back(solid);
            all = test::joined(all, solid);
        }
        std::uint64_t expected = 0;
        for (const test::TestMesh& inner : solids) {
            for (const test::TestMesh& outer : solids) {
                if (&inner == &outer) continue;
                std::vector<Corners> surface;
                for (const Triangle& t : outer.triangles) {
                    surface.push_back({outer.positions[t.vertex[0]], outer.positions[t.vertex[1]],
                                       outer.positions[t.vertex[2]]});
                }
                expected += *test::exact_winding(surface, inner.positions[0]) != 0 ? 1 : 0;
            }
        }
        const DefectReport report = find_defects(test::soup_of(all), {.crossings = false});
        EXPECT_EQ(report.counts.nested_components, expected) << "round " << round;
        nested += static_cast<int>(expected);
    }
    EXPECT_GT(nested, 60 * 30 * 2 / 10);
    EXPECT_LT(nested, 60 * 30 * 8 / 10);
}

}  // namespace
}  // namespace cdprep::mesh
