// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace cdprep::build {

/// A partition of the numbers 0 ... count - 1 into sets. At first, each number is a set of its own.
/// The lowest number of a set is its root.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    std::uint32_t root_of(std::uint32_t number) {
        while (parent_[number] != number) {
            number = parent_[number] = parent_[parent_[number]];
        }
        return number;
    }

    /// Unites the sets of two numbers. Returns whether the two sets were different before.
    bool unite(std::uint32_t a, std::uint32_t b) {
        a = root_of(a);
        b = root_of(b);
        parent_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

    [[nodiscard]] std::size_t size() const {
        return parent_.size();
    }

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace cdprep::build
