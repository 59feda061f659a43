// SPDX-License-Identifier: MIT
#include "build/mesh_fault.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "build/bad_argument.h"
#include "build/frame_map.h"
#include "cdprep/format/limits.h"
#include "cdprep/format/portable.h"

namespace cdprep::build {
namespace {

using format::Double3;
using format::Float3;
using format::Triangle;

/// Returns whether x is an allowed coordinate; false for NaN.
bool is_coordinate(double x) {
    return std::fabs(x) <= format::kMaxCoordinate;
}

// Without branches: nearly all are good.
bool is_good(const Double3& p) {
    return (int{is_coordinate(p.x)} & int{is_coordinate(p.y)} & int{is_coordinate(p.z)}) != 0;
}

bool are_good(std::span<const Double3> positions) {
    bool all = true;
    for (const Double3& p : positions) all &= is_good(p);
    return all;
}
// Finite floats are in range. As integers, several are compared at a time.
bool are_good(std::span<const Float3> positions) {
    static_assert(sizeof(Float3) == 3 * sizeof(float));
    if (positions.empty()) return true;
    constexpr std::uint32_t kExponent = 0x7f800000;
    const float* const x = &positions.front().x;
    std::uint32_t bad = 0;
    for (std::size_t i = 0; i < 3 * positions.size(); ++i) {
        const bool is_bad = (format::bit_cast<std::uint32_t>(x[i]) & kExponent) == kExponent;
        bad |= static_cast<std::uint32_t>(is_bad);
    }
    return bad == 0;
}

const char* fault_of(double x) {
    if (std::isnan(x)) return "is NaN";
    return std::isinf(x) ? "is infinite" : "lies beyond 2^1000";
}

std::string sentence(std::size_t vertex, const Double3& p) {
    const bool x = is_coordinate(p.x);
    const bool y = is_coordinate(p.y);
    const char* name = !x ? "x" : !y ? "y" : "z";
    return "Vertex " + std::to_string(vertex) + " cannot be used: its " + name + " coordinate " +
           fault_of(!x   ? p.x
                    : !y ? p.y
                         : p.z) +
           ".";
}

template <class Position>
std::optional<Error> find_bad(std::span<const Position> positions,
                              std::span<const std::uint32_t> vertices) {
    if (positions.size() > format::kMaxVertices) {
        return bad_argument(std::to_string(positions.size()) + " vertices are more than the " +
                            std::to_string(format::kMaxVertices) + " that a model may have.");
    }
    if (are_good(positions)) return std::nullopt;
    const auto at = std::ranges::find_if_not(
        positions, [](const Position& p) { return is_good(as_double(p)); });
    const auto index = static_cast<std::size_t>(at - positions.begin());
    return bad_argument(sentence(vertices.empty() ? index : vertices[index], as_double(*at)));
}

}  // namespace

std::optional<Error> find_bad_position(std::span<const Double3> positions,
                                       std::span<const std::uint32_t> vertices) {
    return find_bad(positions, vertices);
}

std::optional<Error> find_bad_position(std::span<const Float3> positions,
                                       std::span<const std::uint32_t> vertices) {
    return find_bad(positions, vertices);
}

std::optional<Error> find_bad_triangle(std::size_t vertex_count,
                                       std::span<const Triangle> triangles) {
    if (triangles.size() > format::kMaxTriangles) {
        return bad_argument(std::to_string(triangles.size()) + " triangles are more than the " +
                            std::to_string(format::kMaxTriangles) + " that a model may have.");
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const std::uint32_t greatest = std::ranges::max(triangles[i].vertex);
        if (greatest < vertex_count) continue;
        return bad_argument("Triangle " + std::to_string(i) + " uses vertex " +
                            std::to_string(greatest) + " of " + std::to_string(vertex_count) +
                            ": vertices are numbered from 0.");
    }
    return std::nullopt;
}

}  // namespace cdprep::build
