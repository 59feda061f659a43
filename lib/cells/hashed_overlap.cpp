// SPDX-License-Identifier: MIT
#include "cells/hashed_overlap.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

#include "cells/cell_contacts.h"
#include "cells/octree_codes.h"
#include "cells/octree_parts.h"
#include "walk/walk_pairs.h"

// Slack. Cells are tested against boxes in float, pair units, v = 2^-24; box_placement.cpp has the
// terms. Boxes of A lie within s_a of its frame's origin, planes within r. Let |t| be the shift.
// The numbers that are added are at most r + s_b + |t|. Along an oriented box's axis, they are at
// most the square root of 3 times that. A box turned along A's axes is off by 11 v s_b + 2 v |t|.
// An axis is off by 5 v, the same in both of its products. This tilts it: 9 v of the distance
// between two centres. Two dot products are off by 5 v each. Three steps to a cell's middle and the
// sums are off by another 10 v. All these are of at most 1.8 (r + s_b + |t|). Planes are rounded to
// float once. In all less than 64 v (r + s_b + |t|): twice the slack of boxes, and 64 v r for the
// planes.

namespace cdprep {
namespace {

/// A cell of an octree, its contents, and the boxes of a node of the other model's hierarchy that
/// may meet it.
struct KeyedCell {
    OctreePart part;
    CellPlace first;
    std::uint32_t level;
    unsigned boxes;
};

/// Eight cells of one level, two along each axis.
struct CellBlock {
    CellPlace first;  ///< finest cell
    std::uint32_t level;

    [[nodiscard]] std::uint32_t steps() const noexcept {
        return kOctreeSteps >> level;
    }
    [[nodiscard]] CellPlace cell(unsigned i) const noexcept {
        return {first[0] + (i & 1) * steps(), first[1] + (i >> 1 & 1) * steps(),
                first[2] + (i >> 2) * steps()};
    }
};

/// The number of cells that each of eight boxes meets.
using MeetingCounts = std::array<std::uint8_t, format::kBvhWidth>;

/// Moves bit j to the lowest bit of byte j. The result times a set of A's boxes is the set of all
/// pairs with those.
kernels::BoxPairs spread_to_rows(unsigned of_b) noexcept {
    assert(of_b >> format::kBvhWidth == 0);
    // Byte j keeps only bit j, and then becomes 1 if that is set.
    const kernels::BoxPairs bits =
        kernels::BoxPairs{of_b} * 0x0101010101010101U & 0x8040201008040201U;
    return ((bits + 0x7f7f7f7f7f7f7f7fU) >> 7) & 0x0101010101010101U;
}

/// The planes of a model's octree in the units of a pair.
class PairPlanes {
public:
    PairPlanes(const Model& a, const PlacedBoxes& placed) noexcept {
        const format::OctreeGrid& grid = *a.octree().grid;
        const Double3& o = a.header().frame_origin;
        const std::array<double, 3> from = {grid.origin.x - o.x, grid.origin.y - o.y,
                                            grid.origin.z - o.z};
        for (std::size_t i = 0; i < 3; ++i) first_[i] = scaled(from[i], placed.exponent);
        step_ = scaled(grid.step, placed.exponent);
    }

    [[nodiscard]] double plane(std::size_t axis, std::uint32_t i) const noexcept {
        return first_[axis] + static_cast<double>(i) * step_;
    }
    [[nodiscard]] kernels::OctantPlanes planes(const CellBlock& block) const noexcept {
        kernels::OctantPlanes planes;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                planes.plane[axis][k] =
                    static_cast<float>(plane(axis, block.first[axis] + k * block.steps()));
            }
        }
        planes.half = static_cast<float>(0.5 * step_ * block.steps());
        return planes;
    }
    /// Returns the finest cell that holds x, or the nearest one; `if_no_number` for NaN.
    [[nodiscard]] std::uint32_t cell(std::size_t axis, double x,
                                     std::uint32_t if_no_number) const noexcept {
        const double cell = (x - first_[axis]) / step_;
        if (cell < kOctreeSteps) return cell > 0 ? static_cast<std::uint32_t>(cell) : 0;
        return cell >= kOctreeSteps ? kOctreeSteps - 1 : if_no_number;
    }
    /// Returns the largest |coordinate|.
    [[nodiscard]] double reach() const noexcept {
        double reach = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            reach = std::max({reach, std::fabs(first_[i]), std::fabs(plane(i, kOctreeSteps))});
        }
        return reach;
    }

private:
    std::array<double, 3> first_{};
    double step_;
};

/// One query: the boxes of B's hierarchy among the cells of A's octree.
template <class Contacts>
class KeyedWalk {
public:
    KeyedWalk(const QuestionThrough& question, const PlacedBoxes& placed,
              Contacts& contacts) noexcept
        : search_(question.search),
          tree_a_(question.a),
          tree_b_(question.b),
          parts_(octree_index(question.a), question.a.octree().references, question.through.search),
          planes_(question.a, placed),
          placed_(placed),
          cell_placement_(placed.placement),
          boxes_of_a_(question.a.octree().boxes.data()),
          scratch_(question.workspace.storage()),
          contacts_(contacts),
          kernel_(kernels::active()) {
        cell_placement_.slack =
            static_cast<float>(2 * double{cell_placement_.slack} + 0x1p-18 * planes_.reach());
    }

    /// Returns false when the contacts ended the query.
    bool walk() noexcept {
        std::size_t depth = 0;
        scratch_.pending[depth++] = PendingPair{{tree_b_.shape.levels, 0}, {0, 0}}.packed();
        while (depth > 0) {
            const TreePlace place = PendingPair::unpacked(scratch_.pending[--depth]).a;
            const TestedBoxes below = boxes_of(tree_b_, place, true);
            std::array<KeyedCell, 8> cells;
            const std::size_t count = find_cells(below, cells);
            if (count == 0) continue;
            const auto met = std::span(cells).first(count);
            if (place.height > 1) {
                depth = push_met(met, below.first_below, depth);
            } else if (!(search_ == Search::all ? look_at(below, met) : try_each(below, met))) {
                return false;
            }
        }
        return contacts_.flush();
    }

private:
    /// Finds the cells with triangles that B's boxes may meet: at most eight, about as large as all
    /// the boxes together. Returns their number.
    std::size_t find_cells(const TestedBoxes& side, std::array<KeyedCell, 8>& cells) noexcept;

    /// Returns the block of the deepest cells, two along each axis, that holds the boxes.
    [[nodiscard]] CellBlock block_around(unsigned boxes) const noexcept;

    /// Adds those of B's boxes that meet one of the cells' children to the pending places. The
    /// first box is at `first_below`. Returns the new depth. Boxes that meet most children are
    /// visited first.
    std::size_t push_met(std::span<const KeyedCell> cells, const TreePlace& first_below,
                         std::size_t depth) noexcept;
    /// Returns, for each box, the number of the cells' children with triangles that it meets.
    /// Counts the cells instead if these have boxes, which are tighter than their children's cells.
    [[nodiscard]] MeetingCounts count_met(std::span<const KeyedCell> cells) noexcept;

    /// Returns which of some of B's boxes may meet the contents of a part that is one node.
    [[nodiscard]] unsigned meeting_node(const OctreePart& part, unsigned boxes) const noexcept;

    /// Counts the box tests of one block of cells.
    void count_boxes(unsigned boxes) const noexcept {
        if (scratch_.counts == nullptr) return;
        scratch_.counts->box_pairs += 8 * static_cast<std::uint64_t>(std::popcount(boxes));
    }

    /// Adds the children of a cell that boxes meet to `met`. Returns the new count.
    std::size_t open(const KeyedCell& cell, KeyedCell* met, std::size_t count) noexcept;

    /// Tests the triangles that the leaf cells below list against those below B's lowest node.
    bool look_at(const TestedBoxes& side, std::span<const KeyedCell> cells) noexcept;
    /// The same cell by cell, so that a hit comes early. Pairs of leaves may be repeated.
    bool try_each(const TestedBoxes& side, std::span<const KeyedCell> cells) noexcept {
        for (const KeyedCell& cell : cells) {
            if (!look_at(side, std::span(&cell, 1)) || !contacts_.flush()) return false;
        }
        return true;
    }
    /// Collects the nodes of A's hierarchy with triangles that the leaf cells below list.
    void gather(std::span<const KeyedCell> cells) noexcept;
    void add_listed(std::span<const std::uint32_t> references, unsigned boxes) noexcept;
    bool test_candidates(const TestedBoxes& side) noexcept;
    [[nodiscard]] kernels::BoxPairs meeting(const CandidateNode& candidate,
                                            const TestedBoxes& side) const noexcept;

    Search search_;
    Tree tree_a_;
    Tree tree_b_;
    OctreeParts parts_;
    PairPlanes planes_;
    const PlacedBoxes& placed_;
    kernels::BoxPlacement cell_placement_;
    const format::CellBox* boxes_of_a_;  ///< by node, or null
    Workspace::Storage& scratch_;
    Contacts& contacts_;
    const kernels::Table& kernel_;
    kernels::BoxesAmongCells boxes_;  ///< of the current node
};

template <class Contacts>
CellBlock KeyedWalk<Contacts>::block_around(unsigned boxes) const noexcept {
    assert(boxes != 0);
    CellPlace least;
    CellPlace most;
    std::uint32_t widest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto first = static_cast<unsigned>(std::countr_zero(boxes));
        float lower = boxes_.lower[i][first];
        float upper = boxes_.upper[i][first];
        for (unsigned rest = boxes & (boxes - 1); rest != 0; rest &= rest - 1) {
            const auto j = static_cast<unsigned>(std::countr_zero(rest));
            lower = std::min(lower, boxes_.lower[i][j]);
            upper = std::max(upper, boxes_.upper[i][j]);
        }
        least[i] = planes_.cell(i, lower, 0);
        // Never below `least`, although boxes of a damaged file may end before they begin.
        most[i] = std::max(planes_.cell(i, upper, kOctreeSteps - 1), least[i]);
        widest = std::max(widest, most[i] - least[i]);
    }
    auto shift = static_cast<std::uint32_t>(std::bit_width(widest));
    bool finer = shift > 0;
    for (std::size_t i = 0; i < 3 && finer; ++i) {
        finer = (most[i] >> (shift - 1)) - (least[i] >> (shift - 1)) <= 1;
    }
    if (finer) --shift;
    shift = std::max(shift, format::kOctreeBits - parts_.deepest());
    CellBlock block{{}, format::kOctreeBits - shift};
    for (std::size_t i = 0; i < 3; ++i) block.first[i] = least[i] >> shift << shift;
    return block;
}

template <class Contacts>
std::size_t KeyedWalk<Contacts>::find_cells(const TestedBoxes& side,
                                            std::array<KeyedCell, 8>& cells) noexcept {
    kernel_.place_among_cells(cell_placement_, node_boxes(tree_b_, side, false), boxes_);
    const CellBlock block = block_around(chosen(side));
    std::array<std::uint8_t, 8> met;
    kernel_.cells_met(boxes_, planes_.planes(block), chosen(side), met.data());
    std::size_t count = 0;
    for (unsigned i = 0; i < 8; ++i) {
        if (met[i] == 0) continue;
        const CellPlace first = block.cell(i);
        if (std::max({first[0], first[1], first[2]}) >= kOctreeSteps) continue;
        const OctreePart part = parts_.at(octree_code(first), block.level);
        if (scratch_.counts != nullptr) ++scratch_.counts->cells_sought;
        if (!part.empty()) cells[count++] = {part, first, block.level, met[i]};
    }
    return count;
}

template <class Contacts>
std::size_t KeyedWalk<Contacts>::open(const KeyedCell& cell, KeyedCell* met,
                                      std::size_t count) noexcept {
    assert(cell.level < parts_.deepest());
    const CellBlock block = {cell.first, cell.level + 1};
    std::array<std::uint8_t, 8> boxes;
    const unsigned children = parts_.children(cell.part);
    kernel_.cells_met(boxes_, planes_.planes(block), cell.boxes, boxes.data());
    count_boxes(cell.boxes);
    for (unsigned i = 0; i < 8; ++i) {
        if (boxes[i] == 0 || ((children >> i) & 1) == 0) continue;
        const CellPlace first = block.cell(i);
        const OctreePart part = parts_.child(cell.part, i, octree_code(first), block.level);
        if (!part.empty()) met[count++] = {part, first, block.level, boxes[i]};
    }
    return count;
}

template <class Contacts>
unsigned KeyedWalk<Contacts>::meeting_node(const OctreePart& part, unsigned boxes) const noexcept {
    if (boxes_of_a_ == nullptr) return boxes;
    // The slack of B's boxes here exceeds their slack against boxes of A's frame.
    const format::CellBox& box = boxes_of_a_[parts_.node_of(part)];
    std::array<std::uint32_t, format::kBvhWidth> apart{};
    for (std::size_t i = 0; i < 3; ++i) {
        const float lower = box.lower[i] * placed_.placement.scale_a;
        const float upper = box.upper[i] * placed_.placement.scale_a;
        for (std::size_t lane = 0; lane < format::kBvhWidth; ++lane) {
            apart[lane] |= static_cast<std::uint32_t>(boxes_.lower[i][lane] > upper) |
                           static_cast<std::uint32_t>(boxes_.upper[i][lane] < lower);
        }
    }
    unsigned met = 0;
    for (unsigned lane = 0; lane < format::kBvhWidth; ++lane) met |= (apart[lane] ^ 1) << lane;
    return boxes & met;
}

template <class Contacts>
MeetingCounts KeyedWalk<Contacts>::count_met(std::span<const KeyedCell> cells) noexcept {
    MeetingCounts counts{};
    const auto add = [&](unsigned boxes) {
        for (unsigned rest = boxes; rest != 0; rest &= rest - 1) {
            ++counts[static_cast<unsigned>(std::countr_zero(rest))];
        }
    };
    for (const KeyedCell& cell : cells) {
        const bool has_box = boxes_of_a_ != nullptr && parts_.is_node(cell.part);
        if (has_box || parts_.is_single_leaf(cell.part)) {
            add(meeting_node(cell.part, cell.boxes));
            continue;
        }
        const CellBlock block = {cell.first, cell.level + 1};
        std::array<std::uint8_t, 8> boxes;
        kernel_.cells_met(boxes_, planes_.planes(block), cell.boxes, boxes.data());
        count_boxes(cell.boxes);
        for (unsigned i = 0; i < 8; ++i) {
            if (boxes[i] != 0 &&
                parts_.has_child(cell.part, i, octree_code(block.cell(i)), block.level))
                add(boxes[i]);
        }
    }
    return counts;
}

template <class Contacts>
std::size_t KeyedWalk<Contacts>::push_met(std::span<const KeyedCell> cells,
                                          const TreePlace& first_below,
                                          std::size_t depth) noexcept {
    const MeetingCounts counts = count_met(cells);
    const std::size_t begin = depth;
    unsigned met = 0;
    for (std::uint32_t box = 0; box < format::kBvhWidth; ++box) {
        if (counts[box] == 0) continue;
        met |= 1U << box;
        const TreePlace child{first_below.height, first_below.index + box};
        assert(depth < scratch_.pending.size());
        std::size_t at = depth++;
        for (; at > begin &&
               counts[PendingPair::unpacked(scratch_.pending[at - 1]).a.index - first_below.index] >
                   counts[box];
             --at) {
            scratch_.pending[at] = scratch_.pending[at - 1];
        }
        scratch_.pending[at] = PendingPair{child, {0, 0}}.packed();
    }
    prefetch_children(tree_b_, first_below, met);
    return depth;
}

template <class Contacts>
void KeyedWalk<Contacts>::add_listed(std::span<const std::uint32_t> references,
                                     unsigned boxes) noexcept {
    constexpr std::uint32_t kTrianglesOfNode = format::kBvhWidth * format::kBvhWidth;
    const kernels::BoxPairs rows = spread_to_rows(boxes);
    if (scratch_.counts != nullptr) scratch_.counts->references += references.size();
    std::uint32_t node = 0;
    unsigned leaves = 0;
    for (const std::uint32_t reference : references) {
        const std::uint32_t triangle = reference & ~format::kSharedReference;
        const std::uint32_t of_this = triangle / kTrianglesOfNode;
        if (of_this != node && leaves != 0) {
            cells_of(scratch_).candidate_nodes.add(node, rows * leaves);
            leaves = 0;
        }
        node = of_this;
        leaves |= 1U << (triangle / format::kBvhWidth % format::kBvhWidth);
    }
    if (leaves != 0) cells_of(scratch_).candidate_nodes.add(node, rows * leaves);
}

template <class Contacts>
void KeyedWalk<Contacts>::gather(std::span<const KeyedCell> cells) noexcept {
    // Depth first: seven siblings wait on each level.
    std::array<KeyedCell, 8 * (format::kOctreeBits + 1)> pending;
    assert(cells.size() <= 8);
    std::size_t depth = 0;
    for (const KeyedCell& cell : cells) pending[depth++] = cell;
    while (depth > 0) {
        const KeyedCell cell = pending[--depth];
        if (!parts_.is_single_leaf(cell.part)) {
            assert(depth + 8 <= pending.size());
            depth = open(cell, pending.data(), depth);
            continue;
        }
        const unsigned boxes = meeting_node(cell.part, cell.boxes);
        if (boxes != 0) add_listed(parts_.references(cell.part), boxes);
    }
}

template <class Contacts>
bool KeyedWalk<Contacts>::look_at(const TestedBoxes& side,
                                  std::span<const KeyedCell> cells) noexcept {
    CandidateNodes& candidates = cells_of(scratch_).candidate_nodes;
    for (std::uint32_t from = 0; from != CandidateNodes::kNoLimit; from = candidates.limit()) {
        candidates.begin(from);
        gather(cells);
        if (!test_candidates(side)) return false;
    }
    return true;
}

template <class Contacts>
kernels::BoxPairs KeyedWalk<Contacts>::meeting(const CandidateNode& candidate,
                                               const TestedBoxes& side) const noexcept {
    const TestedBoxes side_a = {tree_a_.shape.first[0] + candidate.node, 0, 8, {}};
    const auto of_a = static_cast<std::uint8_t>(kernels::boxes_of_a(candidate.pairs));
    const auto of_b = static_cast<std::uint8_t>(kernels::boxes_of_b(candidate.pairs));
    if (scratch_.counts != nullptr) {
        scratch_.counts->box_pairs += std::uint64_t(std::popcount(of_a)) * std::popcount(of_b);
    }
    kernels::BoxSizes sizes;
    return candidate.pairs & kernel_.overlapping_boxes(
                                 placed_.placement, node_boxes(tree_a_, side_a, false),
                                 node_boxes(tree_b_, side, false), {of_a, of_b, nullptr}, sizes);
}

template <class Contacts>
bool KeyedWalk<Contacts>::test_candidates(const TestedBoxes& side) noexcept {
    kernels::BoxPairs all = 0;
    for (const CandidateNode& candidate : cells_of(scratch_).candidate_nodes.nodes()) {
        all |= candidate.pairs;
        for (kernels::BoxPairs pairs = meeting(candidate, side); pairs != 0; pairs &= pairs - 1) {
            const auto bit = static_cast<std::uint32_t>(std::countr_zero(pairs));
            const std::uint32_t leaf_a = candidate.node * format::kBvhWidth + bit % 8;
            const std::uint32_t leaf_b = side.first_below.index + bit / 8;
            if (!contacts_.add_once({leaf_a, 0xff}, {leaf_b, 0xff})) return false;
        }
    }
    if (scratch_.counts != nullptr) {
        scratch_.counts->potential +=
            8 * static_cast<std::uint64_t>(std::popcount(kernels::boxes_of_b(all)));
    }
    return true;
}

/// Returns the placement with the two models exchanged.
Placement swapped(const Placement& placement) noexcept {
    if (!placement.a_is_moved()) return Placement::a_moves(placement.pose_b());
    if (!placement.b_is_moved()) return Placement::b_moves(placement.pose_a());
    return Placement::world(placement.pose_b(), placement.pose_a());
}

bool has_hashed_octree(const Model& model) noexcept {
    return model.octree().grid != nullptr && !model.octree().nodes.empty() &&
           !model.octree().leaf_codes.empty() && !model.octree().leaf_nodes.empty() &&
           !model.octree().top.empty() && !model.octree().modulus_table.empty() &&
           !model.octree().mixed_table.empty();
}

/// Visits the contacts of B's boxes among A's cells.
bool visit_repaired(const QuestionThrough& question, TreePairVisitor visit) noexcept {
    const PlacedBoxes placed = place_boxes(question.a, question.b, question.placement);
    if (placed.apart) return true;
    Workspace::Storage& scratch = question.workspace.storage();
    const auto found = [&](std::uint32_t at_a, std::uint32_t at_b) { return visit({at_a, at_b}); };
    const auto owns = [](std::uint64_t /*place*/, std::uint32_t /*at_a*/, std::uint32_t /*at_b*/) {
        return true;
    };
    CellContacts contacts(question.a, question.b, question.placement, placed,
                          question.through.leaf_test, question.options, scratch, found, owns);
    if (question.search == Search::first) contacts.hurry();
    return KeyedWalk(question, placed, contacts).walk();
}

bool visit_swapped(const QuestionThrough& question, TreePairVisitor visit) noexcept {
    const Placement placement = swapped(question.placement);
    const auto swap_back = [&](const TreePair& pair) { return visit({pair.b, pair.a}); };
    return visit_repaired({question.through, question.b, question.a, placement, question.workspace,
                           question.options, question.search},
                          swap_back);
}

}  // namespace

bool visit_contacts_through_keys(const QuestionThrough& question, TreePairVisitor visit) noexcept {
    if (!has_hashed_octree(question.a) || !has_hashed_octree(question.b)) return true;
    // Measured: the model with fewer triangles has fewer boxes to test against the other's cells,
    // up to 5 times. The cells are sized for the other's triangles.
    return question.a.triangle_count() < question.b.triangle_count()
               ? visit_swapped(question, visit)
               : visit_repaired(question, visit);
}

}  // namespace cdprep
