// SPDX-License-Identifier: MIT
#include "build/degenerate.h"

#include <algorithm>
#include <cassert>

#include "build/chunks.h"
#include "build/frame_map.h"
#include "cdprep/advanced/mesh_arrays.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/float_environment.h"
#include "core/guarded_for.h"
#include "exact/triangle_contact.h"

namespace cdprep::build {
namespace {

using format::Double3;
using format::Float3;
using format::Triangle;

constexpr std::size_t kBits = 64;

template <class Position>
void mark_some(std::span<const Position> positions, std::span<const Triangle> triangles,
               std::span<std::uint64_t> words, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
        const auto& v = triangles[i].vertex;
        const bool is_flat = is_degenerate(
            {as_double(positions[v[0]]), as_double(positions[v[1]]), as_double(positions[v[2]])});
        const std::uint64_t bit = std::uint64_t{1} << (i % kBits);
        std::uint64_t& word = words[i / kBits];
        word = is_flat ? word | bit : word & ~bit;
    }
}

template <class Position>
void mark(std::span<const Position> positions, std::span<const Triangle> triangles,
          std::span<std::uint64_t> words, ParallelFor parallel_for) {
    assert(words.size() == (triangles.size() + kBits - 1) / kBits);
    static_assert(kItemsPerTask % kBits == 0);  // no two tasks share a word
    for_chunks(triangles.size(), kItemsPerTask, parallel_for,
               [&](std::size_t first, std::size_t last) {
                   mark_some(positions, triangles, words, first, last);
               });
}

}  // namespace

void mark_degenerate(std::span<const Double3> positions, std::span<const Triangle> triangles,
                     std::span<std::uint64_t> words, ParallelFor parallel_for) {
    mark(positions, triangles, words, parallel_for);
}

void mark_degenerate(std::span<const Float3> positions, std::span<const Triangle> triangles,
                     std::span<std::uint64_t> words, ParallelFor parallel_for) {
    mark(positions, triangles, words, parallel_for);
}

std::vector<std::uint64_t> find_degenerate(std::span<const Double3> positions,
                                           std::span<const Triangle> triangles,
                                           ParallelFor parallel_for) {
    format::FloatEnvironment environment;
    const GuardedFor guarded(environment, parallel_for);
    std::vector<std::uint64_t> words((triangles.size() + kBits - 1) / kBits);
    mark_degenerate(positions, triangles, words, guarded);
    const bool any = std::ranges::any_of(words, [](std::uint64_t word) { return word != 0; });
    if (!any) words.clear();
    return words;
}

}  // namespace cdprep::build
