// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/sound_mesh.h"

#include <cmath>
#include <optional>

#include "mesh/half_edges.h"
#include "mesh/point_table.h"
#include "mesh/vectors.h"

namespace cdprep::mesh {
namespace {

/// Returns the position with coordinates that are not finite set to 0.
Double3 drawable(const Double3& p) {
    const auto number = [](double x) { return std::isfinite(x) ? x : 0.0; };
    return {number(p.x), number(p.y), number(p.z)};
}

/// Returns for each vertex of the file the lowest one with its position; kNone if it has none.
std::vector<std::uint32_t> join_equal(const TriangleSoup& soup, FindingList& findings,
                                      DefectCounts& counts) {
    std::vector<std::uint32_t> joined(soup.positions.size());
    PointTable table(soup.positions.size());
    for (std::uint32_t i = 0; i < joined.size(); ++i) {
        const Double3& p = soup.positions[i];
        if (!is_finite(p)) {
            joined[i] = kNone;
            ++counts.non_finite_vertices;
            findings.add(Rule::non_finite_coordinate, [&] {
                return Place{{}, {i}, drawable(p), 0};
            });
            continue;
        }
        joined[i] = table.find_or_add(soup.positions, p, i);
        if (joined[i] == i) continue;
        ++counts.duplicate_vertices;
        findings.add(Rule::duplicate_vertex, [&] { return Place{{}, {joined[i], i}, p, 0}; });
    }
    return joined;
}

/// A test for triangles with a corner out of range. An import lists them all, and sets their
/// corners to vertex 0. A soup made by hand has the corners themselves.
class OutOfRangeTest {
public:
    explicit OutOfRangeTest(const TriangleSoup& soup) : soup_(soup) {}

    /// Returns the first number out of range of the triangle, as the file has it; nothing if all
    /// are in range. Call this in ascending order of triangles.
    std::optional<std::int64_t> found_in(std::uint32_t triangle) {
        const std::vector<OutOfRange>& listed = soup_.out_of_range;
        if (next_ < listed.size() && listed[next_].triangle == triangle) {
            return listed[next_++].found;
        }
        for (const std::uint32_t vertex : soup_.triangles[triangle].vertex) {
            if (vertex >= soup_.positions.size()) return vertex;
        }
        return std::nullopt;
    }

private:
    const TriangleSoup& soup_;
    std::size_t next_ = 0;
};

/// Bits of the uses of a vertex of the file.
enum Use : std::uint8_t { used = 1, used_soundly = 2, used_repeatedly = 4 };

/// Separates sound triangles from others, by the lowest equal vertices of their corners.
class TriangleSieve {
public:
    TriangleSieve(const TriangleSoup& soup, const std::vector<std::uint32_t>& joined,
                  FindingList& findings, DefectCounts& counts)
        : soup_(soup), joined_(joined), findings_(findings), counts_(counts) {
        use_.resize(soup.positions.size());
        sound_.mesh.single_precision = soup.single_precision;
        sound_.mesh.triangles.reserve(soup.triangles.size());
        sound_.source_triangle.reserve(soup.triangles.size());
    }

    SoundMesh sieve() {
        OutOfRangeTest out_of_range(soup_);
        for (std::uint32_t i = 0; i < soup_.triangles.size(); ++i) {
            if (const std::optional<std::int64_t> found = out_of_range.found_in(i)) {
                ++counts_.out_of_range_triangles;
                findings_.add(Rule::index_out_of_range, [&] {
                    return Place{{i}, {}, {}, static_cast<double>(*found)};
                });
            } else {
                add(i);
            }
        }
        list_unused();
        renumber();
        return std::move(sound_);
    }

private:
    void add(std::uint32_t number) {
        const Triangle& t = soup_.triangles[number];
        for (const std::uint32_t vertex : t.vertex) use_[vertex] |= used;
        const Triangle corners = {
            {joined_[t.vertex[0]], joined_[t.vertex[1]], joined_[t.vertex[2]]}};
        const auto [a, b, c] = corners.vertex;
        if (a == kNone || b == kNone || c == kNone) return;
        if (a == b || b == c || c == a) {
            ++counts_.degenerate_triangles;
            for (const std::uint32_t vertex : corners.vertex) use_[vertex] |= used_repeatedly;
            sound_.repeated.push_back({number, 0, false});
            findings_.add(Rule::repeated_corner, [&] {
                return Place{
                    {number}, {t.vertex.begin(), t.vertex.end()}, soup_.positions[t.vertex[0]], 0};
            });
            return;
        }
        for (const std::uint32_t vertex : corners.vertex) use_[vertex] |= used_soundly;
        sound_.mesh.triangles.push_back(corners);
        sound_.source_triangle.push_back(number);
    }

    void list_unused() {
        for (std::uint32_t i = 0; i < use_.size(); ++i) {
            if ((use_[i] & used) != 0) continue;
            ++counts_.unreferenced_vertices;
            findings_.add(Rule::unreferenced_vertex, [&] {
                return Place{{}, {i}, drawable(soup_.positions[i]), 0};
            });
        }
    }

    /// Numbers the vertices of sound triangles in file order.
    void renumber() {
        std::vector<std::uint32_t> number(use_.size());
        for (std::uint32_t i = 0; i < use_.size(); ++i) {
            if ((use_[i] & used_soundly) == 0) {
                if ((use_[i] & used_repeatedly) != 0) sound_.repeated_vertex.push_back(i);
                continue;
            }
            number[i] = static_cast<std::uint32_t>(sound_.mesh.positions.size());
            sound_.mesh.positions.push_back(soup_.positions[i]);
            sound_.mesh.source_vertex.push_back(i);
        }
        for (Triangle& triangle : sound_.mesh.triangles) {
            for (std::uint32_t& vertex : triangle.vertex) vertex = number[vertex];
        }
        for (RepeatedCorner& repeated : sound_.repeated) {
            for (const std::uint32_t corner : soup_.triangles[repeated.triangle].vertex) {
                const std::uint32_t vertex = joined_[corner];
                if (repeated.connected || (use_[vertex] & used_soundly) == 0) continue;
                repeated.vertex = number[vertex];
                repeated.connected = true;
            }
        }
    }

    const TriangleSoup& soup_;
    const std::vector<std::uint32_t>& joined_;
    FindingList& findings_;
    DefectCounts& counts_;
    std::vector<std::uint8_t> use_;
    SoundMesh sound_;
};

}  // namespace

SoundMesh find_sound_mesh(const TriangleSoup& soup, FindingList& findings, DefectCounts& counts) {
    const std::vector<std::uint32_t> joined = join_equal(soup, findings, counts);
    return TriangleSieve(soup, joined, findings, counts).sieve();
}

}  // namespace cdprep::mesh
