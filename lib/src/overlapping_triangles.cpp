// SPDX-License-Identifier: MIT
#include "cdprep/overlapping_triangles.h"

#include <algorithm>

#include "contact_pairs.h"
#include "sort_pairs.h"

namespace cdprep {
namespace {

/// Keeps the smallest pairs of those added, as many as fit.
class SmallestPairs {
public:
    explicit SmallestPairs(std::span<TrianglePair> kept) noexcept : kept_(kept) {}

    void add(const TrianglePair& pair) noexcept {
        if (count_ < kept_.size()) {
            kept_[count_] = pair;
        } else if (!kept_.empty()) {
            // From here on a heap: its front is the greatest kept pair.
            if (count_ == kept_.size()) std::make_heap(kept_.begin(), kept_.end());
            if (pair < kept_.front()) replace_greatest(pair);
        }
        ++count_;
    }

    /// Sorts what was kept; returns how many were added.
    std::size_t finish(SortScratch& scratch) noexcept {
        sort_pairs(kept_.first(std::min(count_, kept_.size())), scratch);
        return count_;
    }

private:
    void replace_greatest(const TrianglePair& pair) noexcept {
        std::pop_heap(kept_.begin(), kept_.end());
        kept_.back() = pair;
        std::push_heap(kept_.begin(), kept_.end());
    }

    std::span<TrianglePair> kept_;
    std::size_t count_ = 0;
};

}  // namespace

std::size_t overlapping_triangles(const Model& a, const Model& b, const Placement& placement,
                                  Workspace& workspace, std::span<TrianglePair> pairs,
                                  const OverlapOptions& options) noexcept {
    SmallestPairs smallest(pairs);
    for_each_contact<Search::all>(
        a, b, placement, workspace, options, [&](std::uint32_t at_a, std::uint32_t at_b) {
            smallest.add({source_number(a, at_a), source_number(b, at_b)});
            return true;
        });
    return smallest.finish(workspace.storage().sort_scratch);
}

bool visit_overlapping_triangles(const Model& a, const Model& b, const Placement& placement,
                                 Workspace& workspace, PairVisitor visit,
                                 const OverlapOptions& options) noexcept {
    return for_each_contact<Search::all>(
        a, b, placement, workspace, options, [&](std::uint32_t at_a, std::uint32_t at_b) {
            return visit({source_number(a, at_a), source_number(b, at_b)});
        });
}

std::size_t mark_overlapping_triangles(const Model& a, const Model& b, const Placement& placement,
                                       Workspace& workspace, std::span<std::uint64_t> bits_a,
                                       std::span<std::uint64_t> bits_b,
                                       const OverlapOptions& options) noexcept {
    std::fill(bits_a.begin(), bits_a.end(), 0);
    std::fill(bits_b.begin(), bits_b.end(), 0);
    const auto mark = [](std::span<std::uint64_t> bits, std::uint32_t triangle) {
        bits[triangle / 64] |= std::uint64_t{1} << (triangle % 64);
    };
    const bool wants_a = bits_a.size() * 64 >= a.triangle_count();
    const bool wants_b = bits_b.size() * 64 >= b.triangle_count();
    std::size_t count = 0;
    for_each_contact<Search::all>(a, b, placement, workspace, options,
                                  [&](std::uint32_t at_a, std::uint32_t at_b) {
                                      if (wants_a) mark(bits_a, source_number(a, at_a));
                                      if (wants_b) mark(bits_b, source_number(b, at_b));
                                      ++count;
                                      return true;
                                  });
    return count;
}

}  // namespace cdprep
