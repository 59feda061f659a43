// SPDX-License-Identifier: MIT
// The bodies of reaches() and edges_across(), which all instruction sets share; see kernels.h.
// Products and sums are rounded one by one and in one order, so the answers are the same for every
// table, to the last bit.
#pragma once

#include <cassert>

#include "kernels.h"

namespace cdprep::kernels {
namespace {

/// Three components, eight lanes each. exact/vectors.h has one lane, and no kernel includes it.
template <class D8>
struct Vector8 {
    D8 x, y, z;

    Vector8(const D8& of_x, const D8& of_y, const D8& of_z) noexcept : x(of_x), y(of_y), z(of_z) {}
    explicit Vector8(const double (&rows)[3][kLanes]) noexcept
        : x(D8::load(rows[0])), y(D8::load(rows[1])), z(D8::load(rows[2])) {}
    /// The same vector in every lane.
    explicit Vector8(const double (&vector)[3]) noexcept
        : x(vector[0]), y(vector[1]), z(vector[2]) {}
};
template <class D8>
D8 dot(const Vector8<D8>& a, const Vector8<D8>& b) noexcept {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
template <class D8>
Vector8<D8> cross(const Vector8<D8>& a, const Vector8<D8>& b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The body of reaches().
template <class D8>
void reaches_of(const double* directions, std::size_t blocks, const double* points,
                std::size_t count, double* reaches) noexcept {
    assert(count > 0);
    for (std::size_t block = 0; block < blocks; ++block) {
        const double* rows = directions + 3 * kLanes * block;
        const D8 x = D8::load(rows), y = D8::load(rows + kLanes), z = D8::load(rows + 2 * kLanes);
        D8 most(-format::kInfinity);
        for (const double* p = points; p != points + 3 * count; p += 3) {
            most = max(most, (x * D8(p[0]) + y * D8(p[1])) + z * D8(p[2]));
        }
        most.store(reaches + kLanes * block);
    }
}

/// The body of edges_across().
template <class D8>
void edges_across_of(const EdgeLanes* edges, std::size_t blocks, const OneEdge& edge,
                     double error_of_height, std::uint8_t* across) noexcept {
    const Vector8<D8> along(edge.along), left(edge.left), right(edge.right);
    const D8 length(edge.length), error(error_of_height), zero(0.0);
    for (std::size_t block = 0; block < blocks; ++block) {
        const EdgeLanes& other = edges[block];
        const Vector8<D8> normal = cross(along, Vector8<D8>(other.along));
        const D8 slack = (length * D8::load(other.length)) * error;
        const D8 own_left = dot(normal, left), own_right = dot(normal, right);
        const D8 other_left = dot(normal, Vector8<D8>(other.left));
        const D8 other_right = dot(normal, Vector8<D8>(other.right));
        const D8 above = max(max(own_left, own_right), max(zero - other_left, zero - other_right));
        const D8 below = max(max(zero - own_left, zero - own_right), max(other_left, other_right));
        const unsigned both_sides = bits(greater(above, slack)) & bits(greater(below, slack));
        across[block] = static_cast<std::uint8_t>(~both_sides);
    }
}

}  // namespace
}  // namespace cdprep::kernels
