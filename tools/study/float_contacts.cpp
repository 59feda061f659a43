// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/float_contacts.h"

#include <optional>

#include "walk/contact_pairs.h"
#include "walk/leaf_batch.h"
#include "walk/walk_pairs.h"
#include "walk/walked_trees.h"

namespace cdprep::study {
namespace {

/// As for_each_contact(), without what it asks of each pair.
template <Search kSearch>
bool visit_by(const Model& a, const Model& b, const Placement& placement, Workspace& workspace,
              Visitor<FloatContact> visit) {
    Workspace::Storage& scratch = workspace.storage();
    const PlacedBoxes placed = place_boxes(a, b, placement);
    LeafBatch batch(a, b, placed, scratch);
    const TriangleTrees trees(a, b, scratch);
    const auto found = [&](std::uint32_t at_a, std::uint32_t at_b, bool certain) {
        return visit({source_number(a, at_a), source_number(b, at_b), certain});
    };
    const auto add = [&](const LeafView& in_a, const LeafView& in_b) {
        batch.add(in_a, in_b);
        return !batch.full() || batch.flush(found);
    };
    const bool whole = walk_pairs<kSearch>(
        trees.a, trees.b, placed, scratch, [&](std::uint32_t leaf_a, std::uint32_t leaf_b) {
            return trees.each_pair(batch, leaf_a, leaf_b, add) &&
                   (kSearch == Search::all || batch.flush(found));
        });
    return whole && batch.flush(found);
}

}  // namespace

bool visit_float_contacts(const Model& a, const Model& b, const Placement& placement,
                          Workspace& workspace, FloatSearch search, Visitor<FloatContact> visit) {
    if (a.triangle_count() == 0 || b.triangle_count() == 0) return true;
    return search == FloatSearch::all ? visit_by<Search::all>(a, b, placement, workspace, visit)
                                      : visit_by<Search::first>(a, b, placement, workspace, visit);
}

}  // namespace cdprep::study
