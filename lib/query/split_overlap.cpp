// SPDX-License-Identifier: MIT
#include "cdprep/parallel.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstdint>

#include "cdprep/format/float_environment.h"
#include "core/guarded_for.h"
#include "core/require.h"
#include "core/share_out.h"
#include "core/sort_pairs.h"
#include "walk/contact_pairs.h"

// One thread descends both hierarchies until there are enough pairs of places to share out. The
// workers continue from these, each with its own workspace, and store pairs wherever room is left
// in the caller's span. The order of the stored pairs depends on the threads. The set of pairs does
// not, nor does their order after sorting. One thread divides them into parts, and the workers sort
// those.

namespace cdprep {
namespace {

/// The number of pairs of places for each worker. Pairs differ much in cost, and the last to end
/// should be short.
constexpr std::size_t kPlacesForAWorker = 64;

/// The pairs of places where walks still have to start, breadth first.
class Places {
public:
    explicit Places(Workspace::Storage& scratch) noexcept
        : scratch_(scratch), places_(scratch.frontier), other_(scratch.frontier_pairs) {}

    /// Descends from the roots until there are `wanted` pairs, or as many as there is room for.
    void find(const Tree& a, const Tree& b, const PlacedBoxes& placed, std::size_t wanted) noexcept;

    [[nodiscard]] std::size_t size() const noexcept {
        return size_;
    }
    [[nodiscard]] PendingPair operator[](std::size_t i) const noexcept {
        assert(i < size_);
        return PendingPair::unpacked(places_[i]);
    }

private:
    /// Replaces every pair by the pairs below it that are at most `height` high. Returns false and
    /// changes nothing if there is no room.
    bool go_down(std::uint32_t height, const Tree& a, const Tree& b,
                 const PlacedBoxes& placed) noexcept;

    Workspace::Storage& scratch_;
    std::span<std::uint64_t> places_;
    std::span<std::uint64_t> other_;
    std::size_t size_ = 0;
};

void Places::find(const Tree& a, const Tree& b, const PlacedBoxes& placed,
                  std::size_t wanted) noexcept {
    if (a.triangles == 0 || b.triangles == 0 || placed.apart) return;
    places_[size_++] = roots(a, b).packed();
    std::uint32_t height = std::max(a.shape.levels, b.shape.levels);
    while (height > 0 && size_ > 0 && size_ < wanted) {
        if (!go_down(--height, a, b, placed)) return;
    }
}

bool Places::go_down(std::uint32_t height, const Tree& a, const Tree& b,
                     const PlacedBoxes& placed) noexcept {
    std::size_t found = 0;
    for (std::size_t i = 0; i < size_; ++i) {
        const bool whole = walk_pairs_from<Search::all>((*this)[i], height, a, b, placed, scratch_,
                                                        [&](const PendingPair& pair) {
                                                            if (found == other_.size())
                                                                return false;
                                                            other_[found++] = pair.packed();
                                                            return true;
                                                        });
        if (!whole) return false;
    }
    std::swap(places_, other_);
    size_ = found;
    return true;
}

/// Room for pairs that several workers fill.
class SharedRoom {
public:
    explicit SharedRoom(std::span<TrianglePair> room) noexcept : room_(room) {}

    /// Stores the pairs if all of them fit; counts them in any case.
    void add(std::span<const TrianglePair> pairs) noexcept {
        const std::size_t first = count_.fetch_add(pairs.size(), std::memory_order_relaxed);
        if (first > room_.size() || pairs.size() > room_.size() - first) return;
        std::copy(pairs.begin(), pairs.end(), room_.begin() + static_cast<std::ptrdiff_t>(first));
    }
    /// Returns the number of pairs added; final when all workers have ended.
    [[nodiscard]] std::size_t count() const noexcept {
        return count_.load(std::memory_order_relaxed);
    }

private:
    std::span<TrianglePair> room_;
    std::atomic<std::size_t> count_ = 0;
};

/// Collects the pairs that one worker finds, until its scratch is full.
class Found {
public:
    Found(SortScratch& scratch, SharedRoom& room) noexcept : scratch_(scratch), room_(room) {}

    void add(const TrianglePair& pair) noexcept {
        if (count_ == scratch_.size()) flush();
        scratch_[count_++] = pair;
    }
    void flush() noexcept {
        room_.add(std::span(scratch_).first(count_));
        count_ = 0;
    }

private:
    SortScratch& scratch_;
    SharedRoom& room_;
    std::size_t count_ = 0;
};

/// A query that several workers share.
struct Question {
    const Model& a;
    const Model& b;
    const Placement& placement;
    const PairOptions& options;
    const PlacedBoxes& placed;
};

/// Performs one worker's share of the walk.
void walk_shares(const Question& question, const Places& places, Shares& shares,
                 Workspace::Storage& scratch, SharedRoom& room) noexcept {
    const Tree a(question.a);
    const Tree b(question.b);
    const ContactTest touch(question.a, question.b, question.placement, question.options,
                            scratch.counts);
    LeafBatch batch(question.a, question.b, question.placed, scratch);
    Found found(scratch.sort_scratch, room);
    const auto decide = [&](std::uint32_t at_a, std::uint32_t at_b, bool certain) {
        if (touch(at_a, at_b, certain)) {
            found.add({source_number(question.a, at_a), source_number(question.b, at_b)});
        }
        return true;
    };
    shares.take([&](std::size_t i) {
        walk_pairs_from<Search::all>(places[i], 0, a, b, question.placed, scratch,
                                     [&](const PendingPair& pair) {
                                         batch.add(pair.a.index, pair.b.index);
                                         return !batch.full() || batch.flush(decide);
                                     });
    });
    batch.flush(decide);
    found.flush();
}

void sort_shared(std::span<TrianglePair> pairs, std::span<Workspace> workspaces,
                 ParallelFor parallel_for) noexcept {
    assert(!workspaces.empty());
    SortScratch& scratch = workspaces[0].storage().sort_scratch;
    if (pairs.size() <= scratch.size() || workspaces.size() == 1) {
        return sort_pairs(pairs, scratch);
    }
    const PairParts parts = divide_pairs(pairs);
    Shares shares(PairParts::kParts, 1);
    run_workers(workspaces.size(), parallel_for, [&](std::size_t worker) {
        shares.take([&](std::size_t i) {
            sort_pairs(pairs.subspan(parts.first[i], parts.first[i + 1] - parts.first[i]),
                       workspaces[worker].storage().sort_scratch);
        });
    });
}

}  // namespace

std::size_t split_overlaps(const Pair& pair, std::span<Workspace> workspaces,
                           ParallelFor parallel_for, std::span<TrianglePair> pairs) noexcept {
    format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    require(a, b, Ask::overlap);
    require_workspaces(workspaces.size());
    const GuardedFor guarded(environment, parallel_for);
    const PlacedBoxes placed = place_boxes(a, b, pair.placement);
    Places places(workspaces[0].storage());
    places.find(Tree(a), Tree(b), placed, kPlacesForAWorker * workspaces.size());
    if (places.size() == 0) return 0;
    SharedRoom room(pairs);
    Shares shares(places.size(), 1);
    const Question question = {a, b, pair.placement, pair.options, placed};
    run_workers(std::min(workspaces.size(), places.size()), guarded, [&](std::size_t worker) {
        walk_shares(question, places, shares, workspaces[worker].storage(), room);
    });
    const std::size_t count = room.count();
    if (count > pairs.size()) {
        if (pairs.empty()) return count;
        PairOptions options = pair.options;
        options.through = Structure::bvh;
        return overlaps({a, b, pair.placement, options}, workspaces[0], pairs);
    }
    sort_shared(pairs.first(count), workspaces, guarded);
    return count;
}

}  // namespace cdprep
