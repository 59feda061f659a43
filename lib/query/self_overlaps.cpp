// SPDX-License-Identifier: MIT
#include <algorithm>

#include "cdprep/format/float_environment.h"
#include "cdprep/self.h"
#include "core/require.h"
#include "walk/contact_pairs.h"
#include "walk/self_pairs.h"
#include "walk/smallest_pairs.h"

namespace cdprep {
namespace {

/// Tests pairs of leaves of one model, many at a time. Calls found(a, b), tree order, for every
/// pair of triangles in contact.
template <class Found>
class OwnContacts {
public:
    OwnContacts(const Model& model, const PlacedBoxes& placed, const SelfOptions& options,
                Workspace::Storage& scratch, Found& found) noexcept
        : batch_(model, model, placed, scratch),
          numbers_a_(model, scratch.gathered_numbers[0]),
          numbers_b_(model, scratch.gathered_numbers[1]),
          touch_({model, nullptr}, {model, nullptr},
                 {.overlap = options.overlap, .degenerate = options.degenerate}, scratch.counts),
          found_(found) {}

    /// Returns false when `found` did.
    bool add(std::uint32_t leaf_a, std::uint32_t leaf_b) noexcept {
        const bool has_places = numbers_a_.has_place(leaf_a) && numbers_b_.has_place(leaf_b);
        if ((batch_.full() || !has_places) && !flush()) return false;
        batch_.add(leaf_a, leaf_b, {numbers_a_.of(leaf_a), numbers_b_.of(leaf_b)});
        return true;
    }
    bool flush() noexcept {
        numbers_a_.next_batch();
        numbers_b_.next_batch();
        return batch_.flush_own([&](std::uint32_t at_a, std::uint32_t at_b, bool certain) {
            return !touch_(at_a, at_b, certain) || found_(at_a, at_b);
        });
    }

private:
    LeafBatch batch_;
    LeafNumbers numbers_a_;
    LeafNumbers numbers_b_;
    ContactTest touch_;
    Found& found_;
};

/// Calls found(pair), source numbers, for every pair of triangles of a model that are in contact
/// and share no vertex. Stops and returns false when `found` returns false.
template <class Found>
bool for_each_own_contact(const Model& model, Workspace& workspace, const SelfOptions& options,
                          Found&& found) noexcept {
    if (model.triangle_count() == 0) return true;
    Workspace::Storage& scratch = workspace.storage();
    const format::FileHeader& header = model.header();
    const PlacedBoxes placed = place_upon_itself(header.frame_origin, header.frame_exponent);
    const SelfBoxes boxes(model.bvh().nodes.data(), model.bvh().shape, placed.placement);
    const auto rename = [&](std::uint32_t at_a, std::uint32_t at_b) {
        const auto [a, b] = std::minmax({source_number(model, at_a), source_number(model, at_b)});
        return static_cast<bool>(found(TrianglePair{a, b}));
    };
    OwnContacts contacts(model, placed, options, scratch, rename);
    const TreePlace root = {boxes.levels(), 0};
    std::size_t pending = 0;
    scratch.pending[pending++] = PendingPair{root, root}.packed();
    while (pending > 0) {
        const PendingPair pair = PendingPair::unpacked(scratch.pending[--pending]);
        const std::uint32_t height = pair.a.height - 1;
        bool go_on = true;
        if (scratch.counts != nullptr) {
            boxes.count_step(pair.a.height, pair.a.index, pair.b.index, *scratch.counts);
        }
        boxes.for_children(
            pair.a.height, pair.a.index, pair.b.index, [&](std::uint32_t a, std::uint32_t b) {
                if (height == 0) {
                    go_on = go_on && contacts.add(a, b);
                    return;
                }
                assert(pending < scratch.pending.size());
                scratch.pending[pending++] = PendingPair{{height, a}, {height, b}}.packed();
            });
        if (!go_on) return false;
    }
    return contacts.flush();
}

}  // namespace

std::size_t self_overlaps(const Model& model, Workspace& workspace, std::span<TrianglePair> room,
                          const SelfOptions& options) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::overlap | Ask::corners);
    return keep_smallest_pairs(workspace, room, [&](auto&& found) {
        for_each_own_contact(model, workspace, options, found);
    });
}

bool visit_self_overlaps(const Model& model, Workspace& workspace, PairVisitor visit,
                         const SelfOptions& options) noexcept {
    format::FloatEnvironment environment;
    require(model, Ask::overlap | Ask::corners);
    return for_each_own_contact(model, workspace, options, [&](const TrianglePair& pair) {
        return environment.outside([&] { return visit(pair); });
    });
}

}  // namespace cdprep
