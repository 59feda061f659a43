// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "cdprep/pairs.h"

namespace cdprep::cli {

/// Room for lists of triangle pairs. It grows with them, and is used again.
class TriangleLists {
public:
    /// Calls `find(room)`, and again with more room if the pairs did not fit. Returns the pairs,
    /// which stay until the next call.
    template <class Find>
    std::span<const TrianglePair> pairs(const Find& find) {
        while (true) {
            const std::size_t count = find(std::span(pairs_));
            if (count <= pairs_.size()) return std::span(pairs_).first(count);
            pairs_.resize(count);
        }
    }

    /// Returns the crossings of a pair, sorted by their triangles. They stay until the next call.
    std::span<const Crossing> crossings(const Pair& pair, Workspace& workspace) {
        crossings_.clear();
        const auto keep = [this](const Crossing& crossing) {
            crossings_.push_back(crossing);
            return true;
        };
        visit_crossings(pair, workspace, keep);
        std::sort(crossings_.begin(), crossings_.end(),
                  [](const Crossing& x, const Crossing& y) { return x.pair < y.pair; });
        return crossings_;
    }

private:
    std::vector<TrianglePair> pairs_ = std::vector<TrianglePair>(4096);
    std::vector<Crossing> crossings_;
};

}  // namespace cdprep::cli
