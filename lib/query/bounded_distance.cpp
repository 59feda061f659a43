// SPDX-License-Identifier: MIT
#include "cdprep/bounded_distance.h"

#include <algorithm>
#include <array>

#include "cdprep/format/float_environment.h"
#include "cdprep/format/portable.h"
#include "core/require.h"
#include "core/valid_errors.h"
#include "query/nearest_search.h"

// distance() looks for contact first. Here the search by bounds comes first, so that a late answer
// has bounds. A pair in contact has the bound 0 in every test, so a complete search measures it. So
// nothing touches if all measured pairs are apart. Contact is searched for only if rounding hides
// whether a measured pair touches. If the cache makes contact likely, that search comes first, in
// half of the work. The answers are the same.

namespace cdprep {
namespace {

/// Counts the work of one query, also for who counts the work of all.
class CountedWork {
public:
    CountedWork(Workspace::Storage& scratch, std::uint64_t most) noexcept
        : scratch_(scratch), of_all_(scratch.counts) {
        scratch_.counts = &own_;
        scratch_.most_work = most == 0 ? UINT64_MAX : most;
    }
    CountedWork(const CountedWork&) = delete;
    CountedWork& operator=(const CountedWork&) = delete;
    ~CountedWork() {
        scratch_.counts = of_all_;
        scratch_.most_work = UINT64_MAX;
        if (of_all_ != nullptr) add_to(*of_all_);
    }
    [[nodiscard]] std::uint64_t done() const noexcept {
        return work_of(own_);
    }

private:
    void add_to(QueryCounts& all) const noexcept {
        using Numbers = std::array<std::uint64_t, sizeof(QueryCounts) / sizeof(std::uint64_t)>;
        auto sums = format::bit_cast<Numbers>(all);
        const auto numbers = format::bit_cast<Numbers>(own_);
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += numbers[i];
        all = format::bit_cast<QueryCounts>(sums);
    }

    Workspace::Storage& scratch_;
    QueryCounts* of_all_;  ///< or null
    QueryCounts own_;
};

class BoundedSearch {
public:
    BoundedSearch(const Pair& pair, Workspace& workspace, const DistanceOptions& options) noexcept
        : pair_(pair),
          workspace_(workspace),
          scratch_(workspace.storage()),
          options_(options),
          gap_(pair.cache == nullptr
                   ? 0
                   : std::max(0.0, proven_gap(*pair.cache, pair.a, pair.b, pair.placement))),
          search_(pair.a, pair.b, pair.placement, workspace),
          nearest_(pair.a, pair.b, search_, options_) {}

    BoundedDistance run() noexcept {
        const PairCache* const cache = pair_.cache;
        const Limit known = limit_by(cache, pair_.a, pair_.b);
        if (known == Limit::good) nearest_.start_from({cache->triangle_a, cache->triangle_b});
        bool is_apart = gap_ > 0;
        // Without a gap, a pair that was near before may touch now, as in most steps of a contact.
        if (!is_apart && known == Limit::good) {
            const std::uint64_t most = scratch_.most_work;
            scratch_.most_work = most - most / 2;
            const auto at = find_contact();
            is_apart = !at && !scratch_.is_out_of_work();
            scratch_.most_work = most;
            if (at) return touch(*at);
        }
        if (look(known, !is_apart)) return whole();
        if (is_apart || !nearest_.may_touch() || scratch_.is_out_of_work()) return late();
        if (const auto at = find_contact()) return touch(*at);
        if (scratch_.is_out_of_work()) return late();
        return look(Limit::good, false) ? whole() : late();
    }

private:
    /// Returns a pair in contact. Without one, nothing touches, or the workspace is out of work.
    [[nodiscard]] std::optional<TreePair> find_contact() noexcept {
        return find_contact_by<TriangleTrees>(pair_.a, pair_.b, pair_.placement, workspace_, {});
    }
    /// Returns whether everything within the limit has been seen. May stop where triangles may
    /// touch.
    bool look(Limit known, bool stops_at_touch) noexcept {
        if (stops_at_touch && nearest_.may_touch()) return false;
        return search_.run_best_first(nearest_.limit(), known, [&](const TreePair& at) {
            if (scratch_.is_out_of_work()) return -1.0;
            const double limit = nearest_.take(at);
            return stops_at_touch && nearest_.may_touch() ? -1.0 : limit;
        });
    }
    [[nodiscard]] BoundedDistance touch(const TreePair& at) noexcept {
        if (pair_.cache != nullptr) remember_pair(*pair_.cache, at);
        return {true, 0, 0, touching(pair_.a, pair_.b, pair_.placement, at), 0};
    }
    [[nodiscard]] BoundedDistance whole() noexcept {
        const std::optional<Distance> found = nearest_.answer();
        if (!found) return {true, options_.max_distance, kNever, std::nullopt, 0};
        if (pair_.cache != nullptr) {
            remember_distance(*pair_.cache, pair_.a, pair_.b, pair_.placement, nearest_.nearest(),
                              *found);
        }
        return {true, found->lower, found->upper, found, 0};
    }
    [[nodiscard]] BoundedDistance late() noexcept {
        BoundedDistance found = nearest_.answer_so_far(search_.unseen());
        PairCache* const cache = pair_.cache;
        if (cache != nullptr && found.nearest) remember_pair(*cache, nearest_.nearest());
        if (cache != nullptr && found.lower > gap_) {
            remember_gap(*cache, pair_.a, pair_.b, pair_.placement, found.lower);
        }
        found.lower = std::max(found.lower, gap_);
        if (found.nearest) found.nearest->lower = found.lower;
        return found;
    }

    static constexpr double kNever = std::numeric_limits<double>::infinity();
    const Pair& pair_;
    Workspace& workspace_;
    Workspace::Storage& scratch_;
    const DistanceOptions& options_;
    double gap_;  ///< proven: the surfaces are at least this far apart; or 0
    NearestSearch<TriangleTrees> search_;
    Nearest<TriangleTrees> nearest_;
};

BoundedDistance search(const Pair& pair, Workspace& workspace, const DistanceOptions& options,
                       std::uint64_t most) noexcept {
    BoundedDistance nothing;
    nothing.is_complete = true;
    if (!(options.max_distance >= 0)) return nothing;
    if (pair.a.get().triangle_count() == 0 || pair.b.get().triangle_count() == 0) {
        nothing.lower = options.max_distance;
        return nothing;
    }
    const CountedWork work(workspace.storage(), most);
    BoundedDistance found = BoundedSearch(pair, workspace, options).run();
    found.work = work.done();
    return found;
}

}  // namespace

BoundedDistance bounded_distance(const Pair& pair, Workspace& workspace,
                                 const DistanceOptions& options,
                                 const DistanceBudget& budget) noexcept {
    const format::FloatEnvironment environment;
    require(pair.a, pair.b, Ask::distance);
    const BoundedDistance found = search(pair, workspace, with_valid_errors(options), budget.work);
    if (budget.last != nullptr) budget.last->note(pair.placement, found);
    return found;
}

void LastDistance::note(const Placement& at, const BoundedDistance& found) noexcept {
    if (found.is_complete) {
        *this = {true, at, found, 0};
    } else {
        ++late;
    }
}

}  // namespace cdprep
