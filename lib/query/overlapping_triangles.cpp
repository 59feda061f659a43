// SPDX-License-Identifier: MIT
#include <algorithm>

#include "cdprep/format/float_environment.h"
#include "cdprep/pairs.h"
#include "core/require.h"
#include "query/cached_contacts.h"
#include "walk/cell_searches.h"
#include "walk/smallest_pairs.h"

namespace cdprep {

std::size_t overlaps(const Pair& pair, Workspace& workspace,
                     std::span<TrianglePair> room) noexcept {
    const format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    const Structure through = pair.options.through;
    require(a, b, Ask::overlap | ask_of(through));
    if (through != Structure::bvh && through != Structure::pieces) {
        return require_cells(workspace).overlaps(pair, workspace, room);
    }
    return keep_smallest_pairs(a, b, workspace, room, [&](auto&& found) {
        if (through == Structure::bvh) {
            for_each_contact(a, b, pair.placement, workspace, pair.options, pair.cache, found);
        } else if (a.triangle_count() > 0 && b.triangle_count() > 0) {
            for_each_contact<Search::all, PieceTrees>(a, b, pair.placement, workspace, pair.options,
                                                      found);  // each triangle is in one piece
        }
    });
}

bool visit_overlaps(const Pair& pair, Workspace& workspace, PairVisitor visit) noexcept {
    format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    require(a, b, Ask::overlap);
    return for_each_contact(
        a, b, pair.placement, workspace, pair.options, pair.cache,
        [&](std::uint32_t at_a, std::uint32_t at_b) {
            const TrianglePair found = {source_number(a, at_a), source_number(b, at_b)};
            return environment.outside([&] { return visit(found); });
        });
}

std::size_t mark_overlaps(const Pair& pair, Workspace& workspace, std::span<std::uint64_t> bits_a,
                          std::span<std::uint64_t> bits_b) noexcept {
    const format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    require(a, b, Ask::overlap);
    std::fill(bits_a.begin(), bits_a.end(), 0);
    std::fill(bits_b.begin(), bits_b.end(), 0);
    const auto mark = [](std::span<std::uint64_t> bits, std::uint32_t triangle) {
        bits[triangle / 64] |= std::uint64_t{1} << (triangle % 64);
    };
    const bool wants_a = bits_a.size() * 64 >= a.triangle_number_bound();
    const bool wants_b = bits_b.size() * 64 >= b.triangle_number_bound();
    std::size_t count = 0;
    for_each_contact(a, b, pair.placement, workspace, pair.options, pair.cache,
                     [&](std::uint32_t at_a, std::uint32_t at_b) {
                         if (wants_a) mark(bits_a, source_number(a, at_a));
                         if (wants_b) mark(bits_b, source_number(b, at_b));
                         ++count;
                         return true;
                     });
    return count;
}

}  // namespace cdprep
