// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/component_pairs.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace cdprep::mesh {
namespace {

/// Small enough to use little memory, large enough to make merges cheap.
constexpr std::size_t kLeastWaiting = 1 << 16;

bool pair_comes_before(const ComponentPair& x, const ComponentPair& y) {
    return std::tie(x.a, x.b) < std::tie(y.a, y.b);
}

bool is_same(const ComponentPair& x, const ComponentPair& y) {
    return x.a == y.a && x.b == y.b;
}

void unite(ComponentPair& pair, const ComponentPair& more) {
    pair.meetings += more.meetings;
    std::tie(pair.first_triangle, pair.second_triangle) =
        std::min(std::pair(pair.first_triangle, pair.second_triangle),
                 std::pair(more.first_triangle, more.second_triangle));
}

/// Sorts the pairs and merges equal ones.
void sort_and_unite(std::vector<ComponentPair>& pairs) {
    std::sort(pairs.begin(), pairs.end(), pair_comes_before);
    std::size_t last = 0;
    for (std::size_t i = 1; i < pairs.size(); ++i) {
        if (is_same(pairs[last], pairs[i])) {
            unite(pairs[last], pairs[i]);
        } else {
            pairs[++last] = pairs[i];
        }
    }
    if (!pairs.empty()) pairs.resize(last + 1);
}

}  // namespace

void ComponentPairs::add(const ComponentPair& pair) {
    // A pair above the kept ones is left out, now or later: the number of lower pairs only
    // grows.
    if (kept_.size() == most_ && (most_ == 0 || pair_comes_before(kept_.back(), pair))) {
        is_complete_ = false;
        return;
    }
    waiting_.push_back(pair);
    if (waiting_.size() >= std::max(kLeastWaiting, kept_.size() / 4)) settle();
}

std::vector<ComponentPair> ComponentPairs::take() {
    settle();
    return std::move(kept_);
}

void ComponentPairs::settle() {
    sort_and_unite(waiting_);
    absorb_known();
    merge_new();
    waiting_.clear();
}

/// Adds waiting pairs to equal pairs already kept; the others keep waiting.
void ComponentPairs::absorb_known() {
    std::size_t left = 0;
    auto at = kept_.begin();
    for (const ComponentPair& pair : waiting_) {
        at = std::lower_bound(at, kept_.end(), pair, pair_comes_before);
        if (at != kept_.end() && is_same(*at, pair)) {
            unite(*at, pair);
        } else {
            waiting_[left++] = pair;
        }
    }
    waiting_.resize(left);
}

/// Merges from the back, in place: a second list would double the memory.
void ComponentPairs::merge_new() {
    std::size_t from = kept_.size();
    std::size_t more = waiting_.size();
    // Reserved pages without writes cost nothing; a move to a larger array does.
    if (kept_.capacity() < from + more) kept_.reserve(std::max(from + more, 4 * from));
    kept_.resize(from + more);
    while (more > 0) {
        const bool takes_kept = from > 0 && pair_comes_before(waiting_[more - 1], kept_[from - 1]);
        ComponentPair& to = kept_[from + more - 1];
        to = takes_kept ? kept_[--from] : waiting_[--more];
    }
    if (kept_.size() <= most_) return;
    kept_.resize(most_);
    is_complete_ = false;
}

}  // namespace cdprep::mesh
