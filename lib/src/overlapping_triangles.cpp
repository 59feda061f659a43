// SPDX-License-Identifier: MIT
#include "cdprep/overlapping_triangles.h"

#include <algorithm>

#include "cached_contacts.h"
#include "cdprep/format/float_environment.h"
#include "core/require.h"
#include "smallest_pairs.h"

namespace cdprep {

std::size_t overlapping_triangles(const Model& a, const Model& b, const Placement& placement,
                                  Workspace& workspace, std::span<TrianglePair> pairs,
                                  const OverlapOptions& options, PairCache* cache) noexcept {
    const format::FloatEnvironment environment;
    require(a, b, Ask::overlap);
    return keep_smallest_pairs(a, b, workspace, pairs, [&](auto&& found) {
        for_each_contact(a, b, placement, workspace, options, cache, found);
    });
}

bool visit_overlapping_triangles(const Model& a, const Model& b, const Placement& placement,
                                 Workspace& workspace, PairVisitor visit,
                                 const OverlapOptions& options, PairCache* cache) noexcept {
    format::FloatEnvironment environment;
    require(a, b, Ask::overlap);
    return for_each_contact(
        a, b, placement, workspace, options, cache, [&](std::uint32_t at_a, std::uint32_t at_b) {
            const TrianglePair pair = {source_number(a, at_a), source_number(b, at_b)};
            return environment.outside([&] { return visit(pair); });
        });
}

std::size_t mark_overlapping_triangles(const Model& a, const Model& b, const Placement& placement,
                                       Workspace& workspace, std::span<std::uint64_t> bits_a,
                                       std::span<std::uint64_t> bits_b,
                                       const OverlapOptions& options, PairCache* cache) noexcept {
    const format::FloatEnvironment environment;
    require(a, b, Ask::overlap);
    std::fill(bits_a.begin(), bits_a.end(), 0);
    std::fill(bits_b.begin(), bits_b.end(), 0);
    const auto mark = [](std::span<std::uint64_t> bits, std::uint32_t triangle) {
        bits[triangle / 64] |= std::uint64_t{1} << (triangle % 64);
    };
    const bool wants_a = bits_a.size() * 64 >= a.triangle_count();
    const bool wants_b = bits_b.size() * 64 >= b.triangle_count();
    std::size_t count = 0;
    for_each_contact(a, b, placement, workspace, options, cache,
                     [&](std::uint32_t at_a, std::uint32_t at_b) {
                         if (wants_a) mark(bits_a, source_number(a, at_a));
                         if (wants_b) mark(bits_b, source_number(b, at_b));
                         ++count;
                         return true;
                     });
    return count;
}

}  // namespace cdprep
