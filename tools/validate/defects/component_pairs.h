// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cdprep::mesh {

/// Two components with triangles that cross or share area in a plane.
struct ComponentPair {
    std::uint32_t a;  ///< a < b
    std::uint32_t b;
    std::uint32_t first_triangle;  ///< of the lowest meeting pair; numbers of the mesh
    std::uint32_t second_triangle;
    std::uint64_t meetings;
};

/// Sums up meetings by the components of their triangles, in bounded memory. Keeps the lowest
/// pairs of components by (a, b), at most `most` of them. The result does not depend on the
/// order of add(). Takes 24 bytes per kept pair.
class ComponentPairs {
public:
    explicit ComponentPairs(std::size_t most) : most_(most) {}

    void add(const ComponentPair& pair);

    /// Returns the kept pairs, sorted by (a, b).
    [[nodiscard]] std::vector<ComponentPair> take();

    /// Returns whether no pair was left out. Call it after take().
    [[nodiscard]] bool is_complete() const {
        return is_complete_;
    }

private:
    void settle();
    void absorb_known();
    void merge_new();

    std::size_t most_;
    bool is_complete_ = true;
    std::vector<ComponentPair> kept_;     ///< sorted, each pair of components once
    std::vector<ComponentPair> waiting_;  ///< added since the last merge, in any order
};

}  // namespace cdprep::mesh
