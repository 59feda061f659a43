// SPDX-License-Identifier: MIT
// A sheet that is cut along a plane: triangles across the plane are replaced by fragments, the
// halves move apart, and a probe then passes between them. At last the halves become two models,
// and their distance is asked for.
//
//     sample_tearing
#include <array>
#include <iostream>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cdprep/live_model.h"
#include "cdprep/pairs.h"
#include "cdprep/points.h"

namespace {

using cdprep::Double3;
using cdprep::format::Triangle;

struct Mesh {
    std::vector<Double3> positions;
    std::vector<Triangle> triangles;
};

/// A sheet in the plane z = 0, from 0 to 1 along x and y: n times n squares, two triangles each.
Mesh sheet(std::uint32_t n) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < (n + 1) * (n + 1); ++i) {
        const std::uint32_t row = i / (n + 1), column = i % (n + 1);
        mesh.positions.push_back({1.0 * column / n, 1.0 * row / n, 0});
    }
    for (std::uint32_t i = 0; i < n * n; ++i) {
        const std::uint32_t a = i / n * (n + 1) + i % n, b = a + n + 1;
        mesh.triangles.push_back({{a, a + 1, b}});
        mesh.triangles.push_back({{a + 1, b + 1, b}});
    }
    return mesh;
}

/// A plane through a point. What lies along its normal is on the right.
struct Plane {
    Double3 point, normal;

    [[nodiscard]] double height(const Double3& p) const {
        return normal.x * (p.x - point.x) + normal.y * (p.y - point.y) + normal.z * (p.z - point.z);
    }
};

/// The fragments of triangles that cross a plane, with vertices of their own on either side.
class Cut {
public:
    Cut(std::vector<Double3>& positions, const Plane& plane)
        : positions_(positions), plane_(plane) {}

    /// Adds the fragments of a triangle. Returns false if it lies on one side.
    bool add(const Triangle& t) {
        for (std::size_t i = 0; i < 3; ++i) {  // is corner i alone on its side?
            const std::uint32_t a = t.vertex[i], b = t.vertex[(i + 1) % 3],
                                c = t.vertex[(i + 2) % 3];
            if (is_right(a) == is_right(b) || is_right(a) == is_right(c)) continue;
            const std::array<std::uint32_t, 2> ab = on_plane(a, b), ac = on_plane(a, c);
            const std::size_t own = is_right(a) ? 1 : 0, other = 1 - own;
            fragments.push_back({{a, ab[own], ac[own]}});
            fragments.push_back({{ab[other], b, c}});
            fragments.push_back({{ab[other], c, ac[other]}});
            return true;
        }
        return false;
    }
    [[nodiscard]] bool is_right(std::uint32_t vertex) const {
        const auto side = new_on_right_.find(vertex);
        return side != new_on_right_.end() ? side->second : plane_.height(positions_[vertex]) >= 0;
    }

    std::vector<Triangle> fragments;

private:
    /// Returns two vertices where an edge meets the plane: one for each side.
    std::array<std::uint32_t, 2> on_plane(std::uint32_t a, std::uint32_t b) {
        const auto first = static_cast<std::uint32_t>(positions_.size());
        const auto [at, is_new] =
            cuts_.try_emplace(std::minmax(a, b), std::array{first, first + 1});
        if (is_new) {
            const Double3 p = positions_[a], q = positions_[b];
            const double above = plane_.height(p), t = above / (above - plane_.height(q));
            const Double3 m = {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)};
            positions_.insert(positions_.end(), 2, m);
            new_on_right_[first] = false;
            new_on_right_[first + 1] = true;
        }
        return at->second;
    }

    std::vector<Double3>& positions_;
    Plane plane_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<std::uint32_t, 2>> cuts_;
    std::map<std::uint32_t, bool> new_on_right_;
};

/// Memory that starts where a model may: at a multiple of 64 bytes.
struct alignas(cdprep::format::kSectionAlignment) Line {
    std::byte bytes[cdprep::format::kSectionAlignment];
};

/// A live model in memory of its own.
struct Object {
    std::vector<Line> room;
    cdprep::LiveModel live;
};

std::optional<Object> make_object(const std::vector<Double3>& positions,
                                  const std::vector<Triangle>& triangles,
                                  const cdprep::LiveLimits& limits) {
    const auto arrays = cdprep::build::build_model(positions, triangles);
    if (!arrays) return std::nullopt;
    const auto bytes = cdprep::LiveModel::bytes(arrays.value(), limits);
    if (!bytes) return std::nullopt;
    std::vector<Line> room(bytes.value() / sizeof(Line) + 1);
    auto live =
        cdprep::LiveModel::in(std::as_writable_bytes(std::span(room)), arrays.value(), limits);
    if (!live) return std::nullopt;
    return Object{std::move(room), std::move(live).value()};
}

}  // namespace

int main() {
    Mesh mesh = sheet(40);
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    auto sheet_object = make_object(mesh.positions, mesh.triangles,
                                    {.triangles = 2 * count, .vertices = 2 * count});
    if (!sheet_object) return 1;
    cdprep::LiveModel& live = sheet_object->live;

    Cut cut(mesh.positions, {{0.51, 0, 0}, {1, 0, 0}});
    std::vector<std::uint32_t> crossing;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (cut.add(mesh.triangles[i])) crossing.push_back(i);
    }
    // From here on nothing allocates but this program: the cut, then a step of the halves.
    std::vector<std::uint32_t> vertices;
    std::vector<Double3> positions;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        vertices.push_back(v);
        positions.push_back(mesh.positions[v]);
        positions.back().x += cut.is_right(v) ? 0.2 : 0;
    }
    const bool is_cut = live.remove(crossing).ok() && live.refit(vertices, positions).ok() &&
                        live.append(cut.fragments).ok();
    if (!is_cut) return 1;
    std::cout << crossing.size() << " triangles were cut into " << cut.fragments.size() << "\n";

    cdprep::Workspace workspace;
    const cdprep::Sphere probe = {{0.61, 0.5, 0}, 0.05};
    std::cout << "the probe between the halves "
              << (cdprep::touches(live.model(), probe, workspace) ? "touches" : "touches nothing")
              << "\n";

    // Two models, each of the triangles of one half. Their numbers start again.
    std::vector<cdprep::LiveTriangle> all(live.triangle_count());
    live.triangles(all);
    std::array<std::optional<Object>, 2> halves;
    for (const bool right : {false, true}) {
        std::vector<Triangle> half;
        for (const cdprep::LiveTriangle& t : all) {
            if (cut.is_right(t.vertex[0]) == right) half.push_back({t.vertex});
        }
        halves[right ? 1 : 0] = make_object(positions, half, {});
        if (!halves[right ? 1 : 0]) return 1;
        std::cout << (right ? "right" : "left") << " half: " << half.size() << " triangles\n";
    }
    const cdprep::Pair pair = {halves[0]->live.model(), halves[1]->live.model(),
                               cdprep::Placement::b_moves({})};
    std::cout << "the halves are " << cdprep::distance(pair, workspace)->upper << " apart\n";
}
