// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cdprep/cells/octree_search.h"
#include "mesh/mesh.h"
#include "mesh/vectors.h"
#include "study/flush_caches.h"

/// The searches for octree cells, as benchmarks and comparisons time them.
namespace cdprep::study::search {

using format::Double3;
using mesh::dot;
using mesh::minus;
using study::bytes_of;
using study::Memory;
using study::memory_of;

/// The points to search, in the order of the queries.
struct QuerySet {
    const char* name;
    std::vector<Double3> points;
};

using Random = std::mt19937_64;

inline double share(Random& random) {
    return std::uniform_real_distribution<double>(0, 1)(random);
}

inline QuerySet uniform_set(const format::OctreeGrid& grid, std::size_t count, Random& random) {
    QuerySet set{"uniform", {}};
    for (std::size_t i = 0; i < count; ++i) {
        const auto along = [&](double origin) {
            return origin + share(random) * grid.step * (1U << format::kOctreeBits);
        };
        set.points.push_back({along(grid.origin.x), along(grid.origin.y), along(grid.origin.z)});
    }
    return set;
}

inline std::array<Double3, 3> corners_of(const mesh::Mesh& mesh, std::size_t triangle) {
    const auto& vertex = mesh.triangles[triangle].vertex;
    return {mesh.positions[vertex[0]], mesh.positions[vertex[1]], mesh.positions[vertex[2]]};
}

inline Double3 point_in(const std::array<Double3, 3>& t, double u, double v) {
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    const auto along = [&](double a, double b, double c) { return a + u * (b - a) + v * (c - a); };
    return {along(t[0].x, t[1].x, t[2].x), along(t[0].y, t[1].y, t[2].y),
            along(t[0].z, t[1].z, t[2].z)};
}

inline double area(const std::array<Double3, 3>& t) {
    const Double3 u = minus(t[1], t[0]);
    const Double3 v = minus(t[2], t[0]);
    return std::sqrt(std::max(0.0, dot(u, u) * dot(v, v) - dot(u, v) * dot(u, v)));
}

/// Returns points of equal density on the surface; consecutive points are far apart.
inline QuerySet surface_set(const mesh::Mesh& mesh, std::size_t count, Random& random) {
    std::vector<double> sums;
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        sum += area(corners_of(mesh, i));
        sums.push_back(sum);
    }
    QuerySet set{"surface", {}};
    for (std::size_t i = 0; i < count; ++i) {
        const auto at = std::upper_bound(sums.begin(), sums.end() - 1, share(random) * sum);
        const auto triangle = static_cast<std::size_t>(at - sums.begin());
        set.points.push_back(point_in(corners_of(mesh, triangle), share(random), share(random)));
    }
    return set;
}

/// Returns, for each triangle, those across its edges, or itself where there is none.
inline std::vector<std::array<std::uint32_t, 3>> neighbours(const mesh::Mesh& mesh) {
    struct Side {
        std::pair<std::uint32_t, std::uint32_t> edge;
        std::uint32_t triangle;
        std::uint32_t side;
    };
    std::vector<Side> sides;
    std::vector<std::array<std::uint32_t, 3>> across(mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        across[i] = {i, i, i};
        const auto& vertex = mesh.triangles[i].vertex;
        for (std::uint32_t side = 0; side < 3; ++side) {
            sides.push_back({std::minmax(vertex[side], vertex[(side + 1) % 3]), i, side});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::pair(a.edge, a.triangle) < std::pair(b.edge, b.triangle);
    });
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
        if (sides[i].edge != sides[i + 1].edge) continue;
        across[sides[i].triangle][sides[i].side] = sides[i + 1].triangle;
        across[sides[i + 1].triangle][sides[i + 1].side] = sides[i].triangle;
    }
    return across;
}

/// Returns points of a walk from triangle to triangle across edges, one point in each. The walk
/// follows a direction that changes every 64 steps.
inline QuerySet walk_set(const mesh::Mesh& mesh, std::size_t count, Random& random) {
    const auto across = neighbours(mesh);
    const auto middle = [&](std::uint32_t t) {
        return point_in(corners_of(mesh, t), 1. / 3, 1. / 3);
    };
    QuerySet set{"walk", {}};
    auto at = static_cast<std::uint32_t>(random() % mesh.triangles.size());
    std::uint32_t before = at;
    Double3 towards{};
    for (std::size_t i = 0; i < count; ++i) {
        if (i % 64 == 0) towards = {share(random) - .5, share(random) - .5, share(random) - .5};
        set.points.push_back(point_in(corners_of(mesh, at), share(random), share(random)));
        std::uint32_t next = before;
        double best = -std::numeric_limits<double>::infinity();
        for (const std::uint32_t t : across[at]) {
            if (t == before || t == at) continue;
            const double gain = dot(minus(middle(t), middle(at)), towards);
            if (gain > best) next = t;
            best = std::max(best, gain);
        }
        before = std::exchange(at, next);
    }
    return set;
}

/// Returns how many of the ascending codes are at most `code`. The number of steps depends only on
/// the number of codes, and no step branches.
inline std::size_t count_without_branch(std::span<const std::uint64_t> codes, std::uint64_t code) {
    const std::uint64_t* begin = codes.data();
    std::size_t count = codes.size();
    while (count > 1) {
        const std::size_t half = count / 2;
        // Written as `? half : 0`, g++ 12 compiles this to a branch.
        begin += half & -static_cast<std::size_t>(begin[half - 1] <= code);
        count -= half;
    }
    return static_cast<std::size_t>(begin - codes.data()) + (count == 1 && *begin <= code ? 1 : 0);
}

/// Returns the last of the first `before` leaves if it contains `code`.
inline std::uint32_t last_leaf(const OctreeIndex& index, std::size_t before, std::uint64_t code) {
    if (before == 0) return kNoNode;
    const std::uint32_t node = index.leaf_nodes[before - 1];
    const std::uint64_t key = index.nodes[node].key;
    return key_at(code, format::level_of(key)) == key ? node : kNoNode;
}

/// One way to find the leaf of a point.
struct Contender {
    std::string name;
    Memory memory;  ///< all that a search reads
    /// Finds the leaf of each point; the processor may overlap searches.
    std::function<void(std::span<const Double3>, std::span<std::uint32_t>)> ask;
    /// The same, but each point is known only after the leaf of the previous point.
    std::function<void(std::span<const Double3>, std::span<std::uint32_t>)> ask_in_turn;
};

/// Returns a contender; find(point) returns the leaf and is compiled into the loops.
template <class Find>
Contender contender(std::string name, Memory memory, Find find) {
    return {std::move(name), std::move(memory),
            [find](std::span<const Double3> points, std::span<std::uint32_t> leaves) {
                for (std::size_t i = 0; i < points.size(); ++i) leaves[i] = find(points[i]);
            },
            [find](std::span<const Double3> points, std::span<std::uint32_t> leaves) {
                std::uint64_t zero = 0;
                for (std::size_t i = 0; i < points.size(); ++i) {
                    const std::uint32_t leaf = find(points[i + zero]);
                    leaves[i] = leaf;
                    zero = leaf;
                    asm volatile("" : "+r"(zero));  // hides the known range from the compiler
                    zero >>= 32;
                }
            }};
}

/// The relation between successive searches.
enum State : std::size_t { warm, in_turn, cold };
constexpr std::array<const char*, 3> kStates = {"warm", "in_turn", "cold"};
constexpr std::size_t kBurst = 64;          ///< searches after the caches were flushed
constexpr std::size_t kBurstsARound = 5;    ///< in the cold state
constexpr std::size_t kQueries = 1U << 17;  ///< points of a set
/// The number of searches timed together: a fraction of a millisecond. Other work of the machine
/// then falls into few timings, which the median ignores.
constexpr std::size_t kRun = 1U << 11;

/// Returns ns per search, one value for each timing.
inline std::vector<double> time_round(const Contender& contender, std::span<const Double3> points,
                                      State state, Random random) {
    static std::vector<std::uint32_t> leaves(kQueries);
    const auto timed = [&](const auto& ask, std::span<const Double3> some) {
        const auto begun = std::chrono::steady_clock::now();
        ask(some, std::span(leaves).first(some.size()));
        const std::chrono::duration<double, std::nano> taken =
            std::chrono::steady_clock::now() - begun;
        return taken.count() / static_cast<double>(some.size());
    };
    std::vector<double> ns;
    if (state != cold) {
        const auto& ask = state == warm ? contender.ask : contender.ask_in_turn;
        const std::size_t count = state == warm ? points.size() : points.size() / 4;
        for (std::size_t i = 0; i < count; i += kRun) {
            ns.push_back(timed(ask, points.subspan(i, kRun)));
        }
        return ns;
    }
    for (std::size_t i = 0; i < kBurstsARound; ++i) {
        const auto burst = points.subspan(random() % (points.size() - kBurst), kBurst);
        timed(contender.ask, burst);  // points and answers are in the caches
        flush(contender.memory);
        ns.push_back(timed(contender.ask, burst));
    }
    return ns;
}

/// Returns [contender][timing]. Contenders alternate, round by round, with the same queries.
inline std::vector<std::vector<double>> time_all(const std::vector<Contender>& contenders,
                                                 std::span<const Double3> points, State state,
                                                 std::size_t rounds) {
    std::vector<std::vector<double>> ns(contenders.size());
    for (std::size_t round = 0; round < rounds; ++round) {
        for (std::size_t c = 0; c < contenders.size(); ++c) {
            const auto more = time_round(contenders[c], points, state, Random(round));
            ns[c].insert(ns[c].end(), more.begin(), more.end());
        }
    }
    return ns;
}

/// The result of a search of all points.
struct Found {
    double share = 0;   ///< of points that lie in a leaf
    std::string other;  ///< a contender whose leaves differ from the first's; empty: none
};

/// Compares the contenders' answers.
[[nodiscard]] inline Found compare_leaves(const std::vector<Contender>& contenders,
                                          std::span<const Double3> points) {
    std::vector<std::uint32_t> expected(points.size());
    contenders.front().ask(points, expected);
    std::vector<std::uint32_t> leaves(points.size());
    Found found;
    for (const Contender& contender : contenders) {
        for (const auto* ask : {&contender.ask, &contender.ask_in_turn}) {
            std::fill(leaves.begin(), leaves.end(), 0);
            (*ask)(points, leaves);
            if (leaves != expected) found.other = contender.name;
        }
    }
    const auto none = std::count(expected.begin(), expected.end(), kNoNode);
    found.share = 1 - static_cast<double>(none) / static_cast<double>(points.size());
    return found;
}

}  // namespace cdprep::study::search
