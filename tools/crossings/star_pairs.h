// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// Visits pairs (a, b), a < b, of the triangles around a vertex, which have area: each at
/// most once, in no order, and every two that have more in common than the corners and
/// edges they share.
///
/// Few others where they are seen in different directions from the vertex, or share an edge
/// and lie at different angles around it. O(k log k) for k triangles, and O(pairs) for those
/// that overlap as seen from the vertex.
class StarPairs {
public:
    using Visit = std::function<void(std::uint32_t, std::uint32_t)>;

    /// The mesh must outlive the object.
    StarPairs(const Mesh& mesh, std::uint32_t vertex, std::span<const std::uint32_t> star);
    StarPairs(StarPairs&&) noexcept;
    StarPairs& operator=(StarPairs&&) noexcept;
    ~StarPairs();

    /// Visits the pairs of one more triangle; false when there was none left.
    bool advance(const Visit& visit);

private:
    class Search;
    std::unique_ptr<Search> search_;
};

}  // namespace cdprep::mesh
