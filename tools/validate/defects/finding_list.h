// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "validate/defects/finding.h"

namespace cdprep::mesh {

/// Counts occurrences and keeps the first places of each rule.
class FindingList {
public:
    explicit FindingList(std::size_t max_places) : max_places_(max_places) {}

    /// Adds one occurrence. Calls make() for its Place only while there is room. Call this in
    /// source order.
    template <class Make>
    void add(Rule rule, Make&& make) {
        Finding& finding = finding_of(rule);
        ++finding.count;
        if (finding.places.size() < max_places_) finding.places.push_back(make());
    }

    /// Counts occurrences without places; call it after the add() calls.
    void count_more(Rule rule, std::uint64_t found) {
        if (found > 0) finding_of(rule).count += found;
    }

    /// Adds a place for each record, in the order of `before`. Sorts only the records to keep.
    template <class Record, class Before, class Make>
    void add_sorted(Rule rule, std::vector<Record>& records, Before before, Make make) {
        const auto kept =
            records.begin() + static_cast<std::ptrdiff_t>(std::min(max_places_, records.size()));
        std::partial_sort(records.begin(), kept, records.end(), before);
        for (auto record = records.begin(); record != kept; ++record) {
            add(rule, [&] { return make(*record); });
        }
        count_more(rule, static_cast<std::uint64_t>(records.end() - kept));
    }

    /// Marks a rule's count as a lower bound, if the rule found anything.
    void mark_lower_bound(Rule rule) {
        const auto found = findings_.find(rule);
        if (found != findings_.end()) found->second.is_lower_bound = true;
    }

    [[nodiscard]] std::size_t max_places() const {
        return max_places_;
    }

    /// Returns all findings, by ascending id.
    [[nodiscard]] std::vector<Finding> take() {
        std::vector<Finding> all;
        for (auto& [rule, finding] : findings_) all.push_back(std::move(finding));
        findings_.clear();
        return all;
    }

private:
    Finding& finding_of(Rule rule) {
        return findings_.try_emplace(rule, Finding{rule, 0, {}, false}).first->second;
    }

    std::size_t max_places_;
    std::map<Rule, Finding> findings_;
};

}  // namespace cdprep::mesh
