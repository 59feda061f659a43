// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/moved_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "cdprep/build.h"
#include "cdprep/exact/triangles.h"
#include "cdprep/format/file_header.h"
#include "cdprep/points.h"
#include "mesh/vectors.h"

namespace cdprep::mesh {
namespace {

constexpr double kRelative = 1e-4;
constexpr double kOfModel = 1e-9;
constexpr std::size_t kMostFragments = 200'000;  ///< for all triangles of one direction
/// Each cut halves the sides, so kOfModel takes 30. Further cuts gain nothing, as where middles
/// round to corners.
constexpr int kMostDepth = 40;

/// Triangles that are asked for the one nearest to a point.
class Surface {
public:
    explicit Surface(std::vector<Corners> triangles) : triangles_(std::move(triangles)) {
        std::vector<Double3> positions;
        std::vector<Triangle> numbers;
        for (const Corners& t : triangles_) {
            const auto first = static_cast<std::uint32_t>(positions.size());
            positions.insert(positions.end(), t.begin(), t.end());
            numbers.push_back({{first, first + 1, first + 2}});
        }
        const auto arrays = build::build_model(
            positions, numbers,
            {.bounds = build::BvhBounds::aligned, .quality = build::Quality::fast});
        if (!arrays) return;
        memory_.resize(LiveModel::bytes(arrays.value()).value() / sizeof(Block) + 1);
        model_ = LiveModel::in(std::as_writable_bytes(std::span(memory_)), arrays.value()).value();
    }

    /// Returns the nearest point, whose `triangle` is a number for triangle(). Nothing if there are
    /// no triangles, or a coordinate is too large for a model.
    [[nodiscard]] std::optional<ClosestPoint> nearest(const Double3& p) const {
        if (!model_) return std::nullopt;
        return closest_point(model_->model(), p, workspace_);
    }
    [[nodiscard]] const Corners& triangle(std::uint32_t number) const {
        return triangles_[number];
    }

private:
    struct alignas(format::kSectionAlignment) Block {
        std::array<std::byte, format::kSectionAlignment> bytes;
    };

    std::vector<Corners> triangles_;
    std::vector<Block> memory_;
    std::optional<LiveModel> model_;
    mutable Workspace workspace_;
};

double apart(const Double3& a, const Double3& b) {
    return safe_length(minus(a, b));
}

struct Fragment {
    Corners corners;
    double upper;
    int depth = 0;  ///< the number of cuts that made it
    bool operator<(const Fragment& other) const {
        return upper < other.upper;
    }
};

/// Returns an upper bound on the distance between a point and a triangle; 0 exactly if the point
/// is on it.
double distance_at_most(const Double3& p, const Corners& t) {
    const PointTriangleDistance found = exact::point_triangle_distance(p, t);
    return found.lower == 0 && exact::is_within({&p, 1}, t, 0) ? 0 : found.upper;
}

bool lexicographically_less(const Double3& a, const Double3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

Corners ordered(Corners c) {
    std::sort(c.begin(), c.end(), lexicographically_less);
    return c;
}

bool less_corners(const Corners& a, const Corners& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                        lexicographically_less);
}

/// Returns the sorted triangle. A triangle of zero area becomes its segment, as a triangle whose
/// last two corners are equal. The ends of the segment are the first and last of the sorted points.
Corners shape_of(const Corners& c) {
    const Corners sorted = ordered(c);
    return exact::is_degenerate(c) ? Corners{sorted[0], sorted[2], sorted[2]} : sorted;
}

std::vector<Corners> cut_in_middles(const Corners& c) {
    const Double3 ab = middle_of(c[0], c[1]);
    if (c[1] == c[2]) return {{c[0], ab, ab}, {ab, c[1], c[1]}};
    const Double3 bc = middle_of(c[1], c[2]), ca = middle_of(c[2], c[0]);
    return {{c[0], ab, ca}, {ab, c[1], bc}, {ca, bc, c[2]}, {ab, bc, ca}};
}

/// Bounds the distance of a fragment from the surface. The distance to one triangle is convex, so
/// it is largest at a corner of the fragment. The bound is the least over the triangles nearest to
/// the corners. If these are far apart, the longest side bounds better: no point of the fragment is
/// farther than that from some corner. Without a nearest triangle the bound is infinite.
Fragment bounded(const Corners& corners, const Surface& surface, double& lower) {
    double most = 0;
    std::array<Corners, 3> near;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::optional<ClosestPoint> found = surface.nearest(corners[k]);
        if (!found) return {corners, std::numeric_limits<double>::infinity()};
        near[k] = surface.triangle(found->triangle);
        most = std::max(most, distance_at_most(corners[k], near[k]));
        lower = std::max(lower, found->lower);
    }
    const double side = std::max({apart(corners[0], corners[1]), apart(corners[1], corners[2]),
                                  apart(corners[2], corners[0])});
    double upper = most + side;
    for (const Corners& t : near) {
        double to_t = 0;
        for (const Double3& corner : corners) {
            to_t = std::max(to_t, distance_at_most(corner, t));
        }
        upper = std::min(upper, to_t);
    }
    return {corners, upper};
}

double largest_coordinate(const std::vector<Corners>& triangles) {
    double largest = 0;
    for (const Corners& c : triangles) {
        for (const Double3& p : c) {
            largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
        }
    }
    return largest;
}

/// Splits the fragment with the largest bound until that bound is close to an attained distance.
MovedDistance farthest(const std::vector<Corners>& triangles, const Surface& surface,
                       double diagonal) {
    MovedDistance distance;
    if (triangles.empty()) return distance;
    // Each cut rounds its middles: half an ulp along each axis, which is farther off far from 0.
    constexpr double kHalfUlps = 2e-16;  // sqrt(3) * 2^-53, and more
    const double per_cut =
        kHalfUlps * largest_coordinate(triangles) + std::numeric_limits<double>::denorm_min();
    std::priority_queue<Fragment> fragments;
    for (const Corners& t : triangles) {
        fragments.push(bounded(t, surface, distance.lower));
    }
    int deepest = 0;
    std::size_t left = kMostFragments;
    while (left > 0 && fragments.top().depth < kMostDepth && std::isfinite(fragments.top().upper) &&
           fragments.top().upper > distance.lower * (1 + kRelative) + kOfModel * diagonal) {
        const Fragment whole = fragments.top();
        fragments.pop();
        const int depth = whole.depth + 1;
        deepest = std::max(deepest, depth);
        for (const Corners& part : cut_in_middles(whole.corners)) {
            double lower = 0;
            Fragment fragment = bounded(part, surface, lower);
            fragment.depth = depth;
            fragments.push(fragment);
            distance.lower = std::max(distance.lower, lower - depth * per_cut);
        }
        left -= std::min<std::size_t>(left, 4);
    }
    distance.upper = fragments.top().upper;
    if (deepest > 0) distance.upper += std::max(1e-15 * diagonal, deepest * per_cut);
    distance.lower = std::min(distance.lower, distance.upper);
    return distance;
}

/// Returns the source triangles that have a place. An import marks those with a corner out of
/// range, and stores vertex 0 for their corners.
std::vector<bool> find_placed(const TriangleSoup& soup) {
    std::vector<bool> placed(soup.triangles.size());
    for (std::size_t t = 0; t < placed.size(); ++t) {
        const auto& corners = soup.triangles[t].vertex;
        placed[t] = std::all_of(corners.begin(), corners.end(), [&](std::uint32_t vertex) {
            const Double3& p = soup.positions[vertex];
            return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
        });
    }
    for (const OutOfRange& bad : soup.out_of_range) placed[bad.triangle] = false;
    return placed;
}

template <class Mesh>
Corners corners_of(const Mesh& mesh, const Triangle& t) {
    return {mesh.positions[t.vertex[0]], mesh.positions[t.vertex[1]], mesh.positions[t.vertex[2]]};
}

bool same_corners(const Corners& a, const Corners& b) {
    return std::is_permutation(a.begin(), a.end(), b.begin());
}

/// The shapes of source triangles that are not in the output as they were. Bounds the distance
/// of a shape to the output if a triangle with a known bound has it as itself, a side or a
/// corner.
class MissingShapes {
public:
    void add(const Corners& triangle) {
        shapes_.push_back({shape_of(triangle), kUnknown});
    }
    [[nodiscard]] bool empty() const {
        return shapes_.empty();
    }
    /// Call this after the last add().
    void sort() {
        const auto less = [](const Shape& a, const Shape& b) {
            return less_corners(a.corners, b.corners);
        };
        std::sort(shapes_.begin(), shapes_.end(), less);
        const auto equal = [](const Shape& a, const Shape& b) { return a.corners == b.corners; };
        shapes_.erase(std::unique(shapes_.begin(), shapes_.end(), equal), shapes_.end());
        for (const Shape& shape : shapes_) {
            corners_.insert(corners_.end(), shape.corners.begin(), shape.corners.end());
        }
        std::sort(corners_.begin(), corners_.end(), lexicographically_less);
        corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
    }
    [[nodiscard]] bool has_corner(const Double3& p) const {
        return std::binary_search(corners_.begin(), corners_.end(), p, lexicographically_less);
    }
    /// Records that no point of the triangle is farther than `upper` from the output.
    void know(const Corners& triangle, double upper) {
        const Corners c = ordered(triangle);
        know_shape(c, upper);
        for (std::size_t k = 0; k < 3; ++k) {
            know_shape({c[k], c[k], c[k]}, upper);
            const auto [low, high] = std::minmax({k, (k + 1) % 3});
            know_shape({c[low], c[high], c[high]}, upper);
        }
    }
    /// Returns the largest known bound; shapes without one go to `rest`.
    [[nodiscard]] double find_known(std::vector<Corners>& rest) const {
        double most = 0;
        for (const Shape& shape : shapes_) {
            if (shape.upper == kUnknown) {
                rest.push_back(shape.corners);
            } else {
                most = std::max(most, shape.upper);
            }
        }
        return most;
    }

private:
    static constexpr double kUnknown = std::numeric_limits<double>::infinity();
    struct Shape {
        Corners corners;
        double upper;
    };

    void know_shape(const Corners& shape, double upper) {
        const auto less = [](const Shape& a, const Corners& b) {
            return less_corners(a.corners, b);
        };
        const auto at = std::lower_bound(shapes_.begin(), shapes_.end(), shape, less);
        if (at != shapes_.end() && at->corners == shape) at->upper = std::min(at->upper, upper);
    }

    std::vector<Shape> shapes_;
    std::vector<Double3> corners_;
};

/// Returns the outline: the edges, by position, that an odd number of fragments has. It starts at
/// the first corner of the triangle that was cut. Empty if the edges are not one loop.
std::vector<Double3> find_outline(const std::vector<Corners>& fragments, const Double3& first) {
    using OutlineEdge = std::array<Double3, 2>;
    const auto less = [](const OutlineEdge& a, const OutlineEdge& b) {
        return a[0] == b[0] ? lexicographically_less(a[1], b[1])
                            : lexicographically_less(a[0], b[0]);
    };
    std::vector<OutlineEdge> edges;
    for (const Corners& fragment : fragments) {
        const Corners c = ordered(fragment);
        edges.insert(edges.end(), {{c[0], c[1]}, {c[1], c[2]}, {c[0], c[2]}});
    }
    std::sort(edges.begin(), edges.end(), less);
    std::vector<OutlineEdge> outline;  // in both directions
    for (const OutlineEdge& edge : edges) {
        if (!outline.empty() && outline.back() == OutlineEdge{edge[1], edge[0]}) {
            outline.resize(outline.size() - 2);
        } else {
            outline.push_back(edge);
            outline.push_back({edge[1], edge[0]});
        }
    }
    std::sort(outline.begin(), outline.end(), less);
    std::vector<Double3> loop;
    Double3 before{}, at = first;
    do {
        const auto next = std::partition_point(
            outline.begin(), outline.end(),
            [&](const OutlineEdge& edge) { return lexicographically_less(edge[0], at); });
        if (outline.end() - next < 2 || !(next[0][0] == at) || !(next[1][0] == at)) return {};
        if (outline.end() - next > 2 && next[2][0] == at) return {};
        const bool back = !loop.empty() && next[0][1] == before;
        loop.push_back(at);
        before = at;
        at = next[back ? 1 : 0][1];
    } while (!(at == first) && loop.size() <= outline.size());
    return 2 * loop.size() == outline.size() ? loop : std::vector<Double3>{};
}

/// Returns a bound on the distance from a triangle to its fragments; nothing if some may be
/// missing.
///
/// No fragment is missing if the edges of an odd number of fragments form one loop through the
/// three corners. Proof: seen along the normal, the loop surrounds every point of the triangle that
/// is farther from its sides than the loop is. So the fragments cover that point, and their height
/// there is at most that of a corner of a fragment. Any other point is nearer to a side than the
/// loop. The loop passes along that whole side, so the point is within twice that distance of the
/// loop.
std::optional<double> distance_to_fragments(const Corners& whole,
                                            const std::vector<Corners>& fragments) {
    const std::vector<Double3> loop = find_outline(fragments, whole[0]);
    const auto second = std::find(loop.begin(), loop.end(), whole[1]);
    const auto third = std::find(loop.begin(), loop.end(), whole[2]);
    if (second == loop.end() || third == loop.end()) return std::nullopt;
    // In loop order: from corner to corner.
    const std::array<Double3, 4> corner = second < third
                                              ? std::array{whole[0], whole[1], whole[2], whole[0]}
                                              : std::array{whole[0], whole[2], whole[1], whole[0]};
    double farthest = 0;
    std::size_t side = 0;
    for (const Double3& p : loop) {
        if (p == corner[side + 1]) ++side;
        const Corners segment = {corner[side], corner[side + 1], corner[side + 1]};
        if (p == segment[0]) continue;
        farthest = std::max(farthest, 2 * distance_at_most(p, segment));
    }
    for (const Corners& fragment : fragments) {
        for (const Double3& p : fragment) {
            if (std::find(whole.begin(), whole.end(), p) != whole.end()) continue;
            farthest = std::max(farthest, distance_at_most(p, whole));
        }
    }
    return farthest;
}

/// Returns for each source triangle the bound on the distance to its fragments, if none is missing.
std::vector<std::optional<double>> find_fragments(const TriangleSoup& soup,
                                                  const std::vector<bool>& placed,
                                                  const RepairMesh& mesh) {
    std::vector<std::optional<double>> bounds(soup.triangles.size());
    struct FragmentOf {
        std::uint32_t source, triangle;
    };
    std::vector<FragmentOf> all;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const Origin& origin = mesh.triangle_origin[t];
        if (origin.source == kNone || !origin.step) continue;
        if (placed[origin.source]) all.push_back({origin.source, t});
    }
    std::sort(all.begin(), all.end(), [](const FragmentOf& a, const FragmentOf& b) {
        return a.source != b.source ? a.source < b.source : a.triangle < b.triangle;
    });
    std::vector<Corners> fragments;
    for (std::size_t i = 0; i < all.size(); ++i) {
        fragments.push_back(corners_of(mesh, mesh.triangles[all[i].triangle]));
        const std::uint32_t source = all[i].source;
        if (i + 1 < all.size() && all[i + 1].source == source) continue;
        const Corners whole = corners_of(soup, soup.triangles[source]);
        if (!exact::is_degenerate(whole)) bounds[source] = distance_to_fragments(whole, fragments);
        fragments.clear();
    }
    return bounds;
}

/// Records the bounds of the triangles that the output contains, whole or in fragments.
void know_output(const TriangleSoup& soup, const RepairMesh& mesh,
                 const std::vector<std::optional<double>>& fragments, MissingShapes& missing) {
    std::vector<bool> is_corner(mesh.positions.size());
    for (std::size_t v = 0; v < is_corner.size(); ++v) {
        is_corner[v] = missing.has_corner(mesh.positions[v]);
    }
    for (const Triangle& t : mesh.triangles) {
        const auto& v = t.vertex;
        if (is_corner[v[0]] || is_corner[v[1]] || is_corner[v[2]]) {
            missing.know(corners_of(mesh, t), 0);
        }
    }
    for (std::size_t t = 0; t < fragments.size(); ++t) {
        if (fragments[t]) missing.know(corners_of(soup, soup.triangles[t]), *fragments[t]);
    }
}

std::vector<Corners> placed_triangles(const TriangleSoup& soup, const std::vector<bool>& placed) {
    std::vector<Corners> all;
    all.reserve(soup.triangles.size());
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        if (placed[t]) all.push_back(corners_of(soup, soup.triangles[t]));
    }
    return all;
}

std::vector<Corners> all_triangles(const RepairMesh& mesh) {
    std::vector<Corners> all;
    all.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) all.push_back(corners_of(mesh, t));
    return all;
}

double diagonal_of(const std::vector<Corners>& triangles) {
    Double3 lower = triangles.empty() ? Double3{} : triangles[0][0], upper = lower;
    for (const Corners& c : triangles) {
        for (const Double3& p : c) {
            lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
            upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
        }
    }
    return apart(lower, upper);
}

/// Bounds the distance of changed output triangles from their sources. No inner point is farther
/// than a corner, since the distance to one triangle is convex. Triangles without a source go to
/// `made`. Sources that are present unchanged are marked in `found`.
double bound_by_sources(const TriangleSoup& soup, const std::vector<bool>& placed,
                        const RepairMesh& mesh, std::vector<bool>& found,
                        std::vector<Corners>& made) {
    double upper = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::uint32_t source = mesh.triangle_origin[t].source;
        const Corners triangle = corners_of(mesh, mesh.triangles[t]);
        if (source == kNone || !placed[source]) {
            made.push_back(shape_of(triangle));
            continue;
        }
        const Corners whole = corners_of(soup, soup.triangles[source]);
        if (same_corners(triangle, whole)) {
            found[source] = true;
            continue;
        }
        for (const Double3& corner : triangle) {
            if (std::find(whole.begin(), whole.end(), corner) != whole.end()) continue;
            upper = std::max(upper, distance_at_most(corner, whole));
        }
    }
    return upper;
}

/// Bounds the distance of source triangles from their fragments, if none is missing. Other
/// triangles that are not `found` go to `missing`.
double bound_by_fragments(const TriangleSoup& soup, const std::vector<bool>& placed,
                          const std::vector<bool>& found,
                          const std::vector<std::optional<double>>& fragments,
                          MissingShapes& missing) {
    double upper = 0;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        if (found[t] || !placed[t]) continue;
        if (fragments[t]) {
            upper = std::max(upper, *fragments[t]);
        } else {
            missing.add(corners_of(soup, soup.triangles[t]));
        }
    }
    missing.sort();
    return upper;
}

void widen(MovedDistance& distance, const MovedDistance& other) {
    distance.lower = std::max(distance.lower, other.lower);
    distance.upper = std::max(distance.upper, other.upper);
}

}  // namespace

MovedDistances find_moved_distances(const TriangleSoup& soup, const RepairMesh& mesh) {
    MovedDistances moved;
    const std::vector<bool> placed = find_placed(soup);
    std::vector<bool> found(soup.triangles.size(), false);
    std::vector<Corners> made, lost;
    moved.output_to_input.upper = bound_by_sources(soup, placed, mesh, found, made);
    const std::vector<std::optional<double>> fragments = find_fragments(soup, placed, mesh);
    MissingShapes missing;
    moved.input_to_output.upper = bound_by_fragments(soup, placed, found, fragments, missing);
    if (!missing.empty()) {
        know_output(soup, mesh, fragments, missing);
        widen(moved.input_to_output, {0, missing.find_known(lost)});
    }
    if (lost.empty() && made.empty()) return moved;
    std::vector<Corners> input = placed_triangles(soup, placed);
    const double diagonal = diagonal_of(input);
    if (!lost.empty()) {
        widen(moved.input_to_output, farthest(lost, Surface(all_triangles(mesh)), diagonal));
    }
    if (!made.empty()) {
        widen(moved.output_to_input, farthest(made, Surface(std::move(input)), diagonal));
    }
    return moved;
}

}  // namespace cdprep::mesh
