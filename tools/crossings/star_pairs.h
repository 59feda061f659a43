// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// Visits pairs (a, b), a < b, of the triangles around a vertex. Visits each at most once, in no
/// order. Visits every two triangles that share more than common corners and edges. The
/// triangles must have area.
///
/// Visits few other pairs if the triangles appear in different directions from the vertex. The
/// same holds if they share an edge and lie at different angles around it. O(k log k) for k
/// triangles, and O(pairs) for those that overlap as seen from the vertex.
class StarPairs {
public:
    using Visit = std::function<void(std::uint32_t, std::uint32_t)>;

    /// The mesh must outlive the object.
    StarPairs(const Mesh& mesh, std::uint32_t vertex, std::span<const std::uint32_t> star);
    StarPairs(StarPairs&&) noexcept;
    StarPairs& operator=(StarPairs&&) noexcept;
    ~StarPairs();

    /// Visits the pairs of one more triangle; returns false if there was none left.
    bool advance(const Visit& visit);

private:
    class Search;
    std::unique_ptr<Search> search_;
};

}  // namespace cdprep::mesh
