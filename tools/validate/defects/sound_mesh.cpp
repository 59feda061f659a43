// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/sound_mesh.h"

#include <cmath>

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

/// A test for triangles with a corner out of range. An import sets all corners of such a
/// triangle to vertex 0, and lists the first thousand. The others are the next triangles with
/// such corners.
class OutOfRange {
public:
    OutOfRange(const TriangleSoup& soup, std::uint64_t non_finite) : soup_(soup) {
        for (const BadNumber& bad : soup.bad_numbers) {
            if (bad.kind == BadNumber::Kind::index_out_of_range) listed_.push_back(&bad);
        }
        const bool some_unlisted = soup.bad_number_count > soup.bad_numbers.size();
        const std::uint64_t known = non_finite + listed_.size();
        if (some_unlisted && soup.bad_number_count > known) {
            unlisted_ = soup.bad_number_count - known;
        }
    }

    /// Returns whether the triangle is out of range, and sets the vertex number of the file.
    /// Call this in ascending order of triangles.
    bool is(std::uint32_t triangle, double& index) {
        bool is_listed = false;
        // A triangle is listed once, or once per corner.
        for (; next_ < listed_.size() && listed_[next_]->triangle <= triangle; ++next_) {
            is_listed = true;
            index = static_cast<double>(listed_[next_]->found);
        }
        if (is_listed) return true;
        bool all_zero = true;
        for (const std::uint32_t vertex : soup_.triangles[triangle].vertex) {
            index = vertex;
            if (vertex >= soup_.positions.size()) return true;
            all_zero &= vertex == 0;
        }
        if (!all_zero || unlisted_ == 0 || next_ < listed_.size()) return false;
        --unlisted_;
        return true;
    }

private:
    const TriangleSoup& soup_;
    std::vector<const BadNumber*> listed_;
    std::size_t next_ = 0;
    std::uint64_t unlisted_ = 0;
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
        OutOfRange out_of_range(soup_, counts_.non_finite_vertices);
        double index = 0;
        for (std::uint32_t i = 0; i < soup_.triangles.size(); ++i) {
            if (out_of_range.is(i, index)) {
                ++counts_.out_of_range_triangles;
                findings_.add(Rule::index_out_of_range, [&] { return Place{{i}, {}, {}, index}; });
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
