// SPDX-License-Identifier: MIT
#include "cdprep/advanced/float_contacts.h"

#include "cdprep/format/float_environment.h"
#include "core/require.h"
#include "walk/contact_pairs.h"
#include "walk/leaf_batch.h"
#include "walk/walk_pairs.h"
#include "walk/walked_trees.h"

namespace cdprep {
namespace {

/// As for_each_contact(), without the exact test of each pair.
template <Search kSearch>
bool visit_by(const Pair& pair, Workspace& workspace, format::FloatEnvironment& environment,
              Visitor<FloatContact> visit) {
    const Model &a = pair.a, &b = pair.b;
    Workspace::Storage& scratch = workspace.storage();
    const PlacedBoxes placed = place_boxes(a, b, pair.placement);
    LeafBatch batch(a, b, placed, scratch);
    const TriangleTrees trees(a, b, scratch);
    const auto found = [&](std::uint32_t at_a, std::uint32_t at_b, bool certain) {
        const FloatContact contact = {source_number(a, at_a), source_number(b, at_b), certain};
        return environment.outside([&] { return visit(contact); });
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

bool visit_float_contacts(const Pair& pair, Workspace& workspace, FloatSearch search,
                          Visitor<FloatContact> visit) {
    format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    require(a, b, Ask::overlap);
    if (a.triangle_count() == 0 || b.triangle_count() == 0) return true;
    return search == FloatSearch::all
               ? visit_by<Search::all>(pair, workspace, environment, visit)
               : visit_by<Search::first>(pair, workspace, environment, visit);
}

}  // namespace cdprep
