// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/bytes_read.h"

#include "cdprep/format/geometry.h"

namespace cdprep::study {
namespace {

/// Returns the bytes of a node with the tight bounds that queries prefer to its boxes. Both kinds
/// of tight bounds have the same size.
double node_bytes(const Model& model) noexcept {
    static_assert(sizeof(format::OrientedNode) == sizeof(format::SweptNode));
    const bool has_tight = !model.bvh().oriented.empty() || !model.bvh().swept.empty();
    return sizeof(format::BvhNode) + (has_tight ? sizeof(format::OrientedNode) : 0);
}

double triangle_bytes(const Model& model) noexcept {
    const std::size_t corner =
        model.mesh().positions_f64.empty() ? sizeof(format::Float3) : sizeof(format::Double3);
    return static_cast<double>(sizeof(format::Triangle) + 3 * corner);
}

}  // namespace

double bytes_read(const QueryCounts& counts, const Model& a, const Model& b) noexcept {
    const std::uint64_t triangles = counts.by_corner + counts.by_filter + counts.by_exact +
                                    counts.measured + counts.measured_again;
    return static_cast<double>(counts.node_pairs) * (node_bytes(a) + node_bytes(b)) +
           static_cast<double>(counts.leaf_pairs) * 2 * sizeof(format::BvhLeaf) +
           static_cast<double>(triangles) * (triangle_bytes(a) + triangle_bytes(b));
}

double mean_bytes_read(const Model& a, const Model& b, Workspace& workspace, std::size_t cases,
                       const std::function<void(std::size_t number)>& ask) {
    QueryCounts counts;
    workspace.count_into(&counts);
    for (std::size_t i = 0; i < cases; ++i) ask(i);
    workspace.count_into(nullptr);
    return cases == 0 ? 0 : bytes_read(counts, a, b) / static_cast<double>(cases);
}

}  // namespace cdprep::study
