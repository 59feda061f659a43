// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/surface/patch_steps.h"

#include <algorithm>
#include <deque>
#include <vector>

namespace cdprep::convex {
namespace {

using mesh::HalfEdge;
using mesh::kNone;

/// Returns each triangle's distance, in triangles, from one at an edge that patches do not cross.
std::vector<std::uint32_t> crests(const PatchRules& rules) {
    const auto count = static_cast<std::uint32_t>(rules.mesh.triangles.size());
    std::vector<std::uint32_t> distance(count, kNone);
    std::vector<std::uint32_t> front;
    for (HalfEdge h = 0; h < 3 * count; ++h) {
        const bool is_end = rules.edges.kind[h] >= EdgeKind::reflex;
        if (!is_end || distance[h / 3] == 0) continue;
        distance[h / 3] = 0;
        front.push_back(h / 3);
    }
    for (std::size_t i = 0; i < front.size(); ++i) {
        for (HalfEdge h = 3 * front[i]; h < 3 * front[i] + 3; ++h) {
            const HalfEdge twin = rules.edges.twin[h];
            if (twin == kNone || distance[twin / 3] != kNone) continue;
            distance[twin / 3] = distance[front[i]] + 1;
            front.push_back(twin / 3);
        }
    }
    return distance;
}

/// Grows patches one after the other.
class Growth {
public:
    Growth(const PatchRules& rules, PatchSet& patches, PieceOrder order, PatchScope& scope)
        : rules_(rules),
          patches_(patches),
          order_(order),
          scope_(scope),
          refused_by_(rules.mesh.triangles.size(), kNone),
          taken_(rules.mesh.triangles.size(), 0) {}

    void grow(std::uint32_t seed) {
        if (taken_[seed] != 0) return;
        std::uint32_t patch = patches_.patch_of(seed);
        queue_.clear();
        take(seed, patch);
        while (!queue_.empty()) {
            const std::uint32_t next = popped();
            if (taken_[next] != 0 || refused_by_[next] == seed) continue;
            if (!patches_.can_join(patch, next, scope_)) {
                refused_by_[next] = seed;
                continue;
            }
            patch = patches_.join(patch, next, scope_);
            take(next, patch);
        }
    }

private:
    void take(std::uint32_t triangle, std::uint32_t patch) {
        taken_[triangle] = 1;
        for (HalfEdge h = 3 * triangle; h < 3 * triangle + 3; ++h) {
            const HalfEdge twin = rules_.edges.twin[h];
            if (twin == kNone || patches_.patch_of(twin / 3) == patch) continue;
            if (rules_.edges.kind[h] == EdgeKind::reflex && rules_.keeps_inside) continue;
            queue_.push_back(twin / 3);
        }
    }
    [[nodiscard]] std::uint32_t popped() {
        const bool last_first = order_ == PieceOrder::depth_first;
        const std::uint32_t next = last_first ? queue_.back() : queue_.front();
        if (last_first) {
            queue_.pop_back();
        } else {
            queue_.pop_front();
        }
        return next;
    }

    const PatchRules& rules_;
    PatchSet& patches_;
    PieceOrder order_;
    PatchScope& scope_;
    std::deque<std::uint32_t> queue_;
    std::vector<std::uint32_t> refused_by_;  ///< by triangle: the last refusing patch's seed
    std::vector<std::uint8_t> taken_;
};

}  // namespace

void grow_patches(const PatchRules& rules, PatchSet& patches, PieceOrder order,
                  std::span<const std::uint32_t> place, std::uint64_t work,
                  const mesh::StopCheck& stop) {
    std::vector<std::uint32_t> seeds(place.begin(), place.end());
    if (order == PieceOrder::cresting) {
        const std::vector<std::uint32_t> crest = crests(rules);
        std::stable_sort(seeds.begin(), seeds.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return crest[a] > crest[b]; });
    }
    PatchScope scope{0, static_cast<std::uint32_t>(place.size()), work * place.size()};
    Growth growth(rules, patches, order, scope);
    constexpr std::size_t kBetweenLooks = 1024;  // seeds from one call of stop() to the next
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        if (i % kBetweenLooks == 0 && mesh::is_stopped(stop)) return;
        growth.grow(seeds[i]);
    }
}

}  // namespace cdprep::convex
