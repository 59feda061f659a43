// SPDX-License-Identifier: MIT
#include "cells/adaptive_octree_tree.h"
#include "cells/cell_contacts.h"
#include "cells/centre_cell.h"
#include "cells/contacts_through.h"
#include "cells/meet_cells.h"
#include "cells/octree_tree.h"
#include "cells/tetra_tree_cells.h"
#include "cells/walk_cells.h"

// Each pair once. A triangle is listed in all the cells that it touches, so two triangles in
// contact meet in several pairs of leaf cells. TestedPairs remembers which pairs of triangles were
// answered. Where it has no room, one pair of leaf cells answers: the first that brings the two in
// a confined walk. That is the same walk, confined to cells that list the two. The full walk comes
// to that pair too, and brings the two there: each step tests the same boxes by the same kernel.
// Such a pair exists: the cells that hold a common point of the two.

namespace cdprep {
namespace {

/// The restriction of a walk to cells that list two triangles.
struct ListingLanes {
    std::uint32_t at_a;
    std::uint32_t at_b;
    Corners a;  ///< as stored in the files
    Corners b;

    template <class TreeA, class TreeB>
    [[nodiscard]] kernels::BoxPairs kept(const TreeA& tree_a, const typename TreeA::Cell& cell_a,
                                         const TreeB& tree_b,
                                         const typename TreeB::Cell& cell_b) const noexcept {
        const unsigned of_a = tree_a.lanes_listing(cell_a, at_a, a);
        return of_a == 0 ? 0 : lane_pairs(of_a, tree_b.lanes_listing(cell_b, at_b, b));
    }
};

/// A visitor that stops at two given BVH leaves, in place of CellContacts.
struct FirstPlace {
    std::uint32_t leaf_a;
    std::uint32_t leaf_b;
    std::uint64_t place = ~std::uint64_t{0};  ///< the pair of cells that brought them

    bool add(const LeafLanes& a, const LeafLanes& b, std::uint64_t at) noexcept {
        if (a.leaf != leaf_a || b.leaf != leaf_b) return true;
        place = at;
        return false;
    }
    static bool forgets() noexcept {
        return true;
    }
};

/// One walk of two trees in a query.
template <Search kSearch, class TreeA, class TreeB>
class Walk {
public:
    Walk(const QuestionThrough& question, const PlacedBoxes& placed, const TreeA& a,
         const TreeB& b) noexcept
        : question_(question), placed_(placed), a_(a), b_(b) {}

    bool run(TreePairVisitor visit) const noexcept {
        if (a_.is_empty() || b_.is_empty()) return true;
        Workspace::Storage& scratch = question_.workspace.storage();
        const auto found = [&](std::uint32_t at_a, std::uint32_t at_b) {
            return visit({at_a, at_b});
        };
        const auto owns = [&](std::uint64_t place, std::uint32_t at_a, std::uint32_t at_b) {
            return remembered_first_place(at_a, at_b) == place;
        };
        CellContacts contacts(question_.a, question_.b, question_.placement, placed_,
                              question_.through.leaf_test, question_.options, scratch, found, owns);
        if (kSearch == Search::first) contacts.hurry();
        CellStorage& cells = cells_of(scratch);
        MeetCells meet(question_.a, question_.b, placed_, cells.node_lists_a, cells.node_lists_b,
                       &cells.met_nodes);
        CellWalk<kSearch, TreeA, TreeB, AllLanes> walk(a_, b_, placed_, question_.through.descent,
                                                       AllLanes{});
        walk.use(scratch);
        const bool whole =
            walk.run([&](const Pair& pair, const CellBounds& bounds_a, const CellBounds& bounds_b) {
                if (scratch.counts != nullptr) ++scratch.counts->cell_pairs;
                return meet_at(pair, bounds_a, bounds_b, meet, contacts) &&
                       (kSearch == Search::all || contacts.flush());
            });
        return whole && contacts.flush();
    }

private:
    using Pair = CellPair<typename TreeA::Cell, typename TreeB::Cell>;

    static std::uint64_t place_of(std::uint32_t node_a, std::uint32_t node_b) noexcept {
        return std::uint64_t{node_a} << 32 | node_b;
    }

    template <class Meet, class Contacts>
    bool meet_at(const Pair& pair, const CellBounds& bounds_a, const CellBounds& bounds_b,
                 Meet& meet, Contacts& contacts) const noexcept {
        const auto leaf_a = a_.child(pair.a, pair.lane_a);
        const auto leaf_b = b_.child(pair.b, pair.lane_b);
        const MetCell met_a = {leaf_a.node, a_.references(leaf_a), &bounds_a.boxes, pair.lane_a};
        const MetCell met_b = {leaf_b.node, b_.references(leaf_b), &bounds_b.boxes, pair.lane_b};
        return meet(met_a, met_b, place_of(leaf_a.node, leaf_b.node), contacts);
    }

    [[nodiscard]] std::uint64_t remembered_first_place(std::uint32_t at_a,
                                                       std::uint32_t at_b) const noexcept {
        CellStorage& cells = cells_of(question_.workspace.storage());
        const std::uint64_t walk = cells.bounds_a.question;
        FirstPlaces::Slot& slot = cells.first_places.of(at_a, at_b);
        if (slot.walk != walk || slot.at_a != at_a || slot.at_b != at_b) {
            slot = {walk, at_a, at_b, first_place(at_a, at_b)};
        }
        return slot.place;
    }

    /// Returns the first pair of leaf cells that brings two triangles.
    [[nodiscard]] std::uint64_t first_place(std::uint32_t at_a, std::uint32_t at_b) const noexcept {
        const ListingLanes listing = {at_a, at_b, MovedModel(question_.a, nullptr).corners(at_a),
                                      MovedModel(question_.b, nullptr).corners(at_b)};
        CellWalk<Search::all, TreeA, TreeB, ListingLanes> walk(a_, b_, placed_,
                                                               question_.through.descent, listing);
        NodeLists<1> lists_a;
        NodeLists<1> lists_b;
        MeetCells meet(question_.a, question_.b, placed_, lists_a, lists_b, nullptr);
        FirstPlace first = {at_a / format::kBvhWidth, at_b / format::kBvhWidth};
        walk.run([&](const Pair& pair, const CellBounds& bounds_a, const CellBounds& bounds_b) {
            return meet_at(pair, bounds_a, bounds_b, meet, first);
        });
        return first.place;
    }

    const QuestionThrough& question_;
    const PlacedBoxes& placed_;
    const TreeA& a_;
    const TreeB& b_;
};

template <Search kSearch, class TreeA, class TreeB>
bool walk_trees(const QuestionThrough& question, const PlacedBoxes& placed, const TreeA& a,
                const TreeB& b, TreePairVisitor visit) noexcept {
    return Walk<kSearch, TreeA, TreeB>(question, placed, a, b).run(visit);
}

/// Walks two tetra-trees, and the triangles that hold either's centre: these touch every cone.
template <Search kSearch>
bool walk_tetra_trees(const QuestionThrough& question, const PlacedBoxes& placed,
                      TreePairVisitor visit) noexcept {
    const TetraTreeCells a(question.a);
    const TetraTreeCells b(question.b);
    const CentreCell centre_a(a.at_centre());
    const CentreCell centre_b(b.at_centre());
    return walk_trees<kSearch>(question, placed, a, b, visit) &&
           walk_trees<kSearch>(question, placed, centre_a, b, visit) &&
           walk_trees<kSearch>(question, placed, a, centre_b, visit) &&
           walk_trees<kSearch>(question, placed, centre_a, centre_b, visit);
}

template <Search kSearch>
bool walk_structure(const QuestionThrough& question, const PlacedBoxes& placed,
                    TreePairVisitor visit) noexcept {
    switch (question.through.structure) {
        case Structure::octree:
            return walk_trees<kSearch>(question, placed, OctreeTree(question.a),
                                       OctreeTree(question.b), visit);
        case Structure::adaptive_octree:
            return walk_trees<kSearch>(question, placed, AdaptiveOctreeTree(question.a),
                                       AdaptiveOctreeTree(question.b), visit);
        default:
            return walk_tetra_trees<kSearch>(question, placed, visit);
    }
}

}  // namespace

bool visit_contacts_through_trees(const QuestionThrough& question, TreePairVisitor visit) noexcept {
    const PlacedBoxes placed = place_boxes(question.a, question.b, question.placement);
    if (placed.apart) return true;
    CellStorage& cells = cells_of(question.workspace.storage());
    cells.tested_pairs.begin();
    cells.met_nodes.begin();
    return question.search == Search::first ? walk_structure<Search::first>(question, placed, visit)
                                            : walk_structure<Search::all>(question, placed, visit);
}

}  // namespace cdprep
