// SPDX-License-Identifier: MIT
#include "cdprep/cells/overlap_through.h"

#include "cdprep/format/float_environment.h"
#include "cells/contacts_through.h"
#include "cells/hashed_overlap.h"
#include "core/require.h"
#include "walk/cell_searches.h"
#include "walk/smallest_pairs.h"

namespace cdprep {
namespace {

bool is_of_cells(Structure structure) noexcept {
    return structure != Structure::bvh && structure != Structure::pieces;
}

Pair with_structure(const Pair& pair, Structure structure) noexcept {
    Pair other = pair;
    other.options.through = structure;
    return other;
}

bool visit_contacts_through(const QuestionThrough& question, TreePairVisitor visit) noexcept {
    if (question.a.triangle_count() == 0 || question.b.triangle_count() == 0) return true;
    switch (question.through.structure) {
        case Structure::octree:
        case Structure::adaptive_octree:
        case Structure::tetra_tree:
            return visit_contacts_through_trees(question, visit);
        default:
            return visit_contacts_through_keys(question, visit);
    }
}

}  // namespace

std::size_t overlaps_through(const Pair& pair, const StructureOptions& through,
                             Workspace& workspace, std::span<TrianglePair> room) noexcept {
    if (!is_of_cells(through.structure)) {
        return overlaps(with_structure(pair, through.structure), workspace, room);
    }
    const format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    require(a, b, Ask::overlap | ask_of(through.structure));
    static_cast<void>(require_cells(workspace));
    const QuestionThrough question = {through,      a,          b, pair.placement, workspace,
                                      pair.options, Search::all};
    return keep_smallest_pairs(a, b, workspace, room, [&](auto&& found) {
        const auto visit = [&](const TreePair& at) { return found(at.a, at.b); };
        visit_contacts_through(question, visit);
    });
}

bool any_overlap_through(const Pair& pair, const StructureOptions& through,
                         Workspace& workspace) noexcept {
    if (!is_of_cells(through.structure)) {
        Pair surfaces = with_structure(pair, through.structure);
        surfaces.options.body = Body::surface;
        return collide(surfaces, workspace).hit == Answer::yes;
    }
    const format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    // No triangle is named, so their numbers are not needed.
    require(a, b, Ask::collide | ask_of(through.structure));
    static_cast<void>(require_cells(workspace));
    const QuestionThrough question = {through,      a, b, pair.placement, workspace, pair.options,
                                      Search::first};
    const auto visit = [](const TreePair& /*at*/) { return false; };
    return !visit_contacts_through(question, visit);
}

}  // namespace cdprep
