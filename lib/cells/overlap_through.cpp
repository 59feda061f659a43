// SPDX-License-Identifier: MIT
#include "cdprep/study/overlap_through.h"

#include "cdprep/format/float_environment.h"
#include "cells/contacts_through.h"
#include "cells/hashed_overlap.h"
#include "core/require.h"
#include "pieces/piece_contact.h"
#include "walk/contact_pairs.h"
#include "walk/smallest_pairs.h"

namespace cdprep {
namespace {

/// Each pair once: a triangle is in one piece.
bool visit_contacts_through_pieces(const QuestionThrough& question, ContactVisitor visit) noexcept {
    const auto found = [&](std::uint32_t at_a, std::uint32_t at_b) { return visit({at_a, at_b}); };
    return for_each_contact<Search::all, PieceTrees>(question.a, question.b, question.placement,
                                                     question.workspace, question.options, found);
}

bool visit_contacts_through(const QuestionThrough& question, ContactVisitor visit) noexcept {
    if (question.a.triangle_count() == 0 || question.b.triangle_count() == 0) return true;
    switch (question.through.structure) {
        case Structure::octree:
        case Structure::adaptive_octree:
        case Structure::tetra_tree:
            return visit_contacts_through_trees(question, visit);
        case Structure::hashed_octree:
        case Structure::hashed_octree_literal:
            return visit_contacts_through_keys(question, visit);
        case Structure::pieces:
            return visit_contacts_through_pieces(question, visit);
        default:
            return true;
    }
}

}  // namespace

std::size_t overlaps_through(const Pair& pair, const StructureOptions& through,
                             Workspace& workspace, std::span<TrianglePair> room) noexcept {
    const format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    require(a, b, Ask::overlap | ask_of(through.structure));
    if (through.structure == Structure::bvh) {
        PairOptions options = pair.options;
        options.through = Structure::bvh;
        return overlaps({a, b, pair.placement, options, pair.cache}, workspace, room);
    }
    const QuestionThrough question = {through,      a,          b, pair.placement, workspace,
                                      pair.options, Search::all};
    return keep_smallest_pairs(a, b, workspace, room, [&](auto&& found) {
        const auto visit = [&](const TreePair& at) { return found(at.a, at.b); };
        visit_contacts_through(question, visit);
    });
}

bool any_overlap_through(const Pair& pair, const StructureOptions& through,
                         Workspace& workspace) noexcept {
    const format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    // No triangle is named, so their numbers are not needed.
    require(a, b, Ask::collide | ask_of(through.structure));
    if (through.structure == Structure::bvh) {
        return any_contact(a, b, pair.placement, workspace, pair.options, pair.cache);
    }
    if (through.structure == Structure::pieces) {
        return any_contact_of_pieces(a, b, pair.placement, workspace, pair.options, pair.cache);
    }
    const QuestionThrough question = {through,      a, b, pair.placement, workspace, pair.options,
                                      Search::first};
    const auto visit = [](const TreePair& /*at*/) { return false; };
    return !visit_contacts_through(question, visit);
}

}  // namespace cdprep
