// SPDX-License-Identifier: MIT
#include "accuracy/mesh_variants.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

namespace cdprep::test {
namespace {

std::vector<std::uint32_t> any_order(std::size_t count, std::mt19937& random) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), random);
    return order;
}

/// Vertices as a pose moves them, by the formula of the contract.
TestMesh placed(TestMesh mesh, const Pose& pose, bool is_moved) {
    if (!is_moved) return mesh;
    for (Double3& p : mesh.positions) p = transform_point(pose, p);
    return mesh;
}

void relabel(MeshVariant& variant, std::uint32_t seed) {
    Relabelled a = relabelled(variant.a, seed), b = relabelled(variant.b, seed + 1);
    variant.name += ", relabelled";
    variant.a = std::move(a.mesh);
    variant.b = std::move(b.mesh);
    variant.was_a = std::move(a.was);
    variant.was_b = std::move(b.was);
}

void swap(MeshVariant& variant) {
    variant.name += ", swapped";
    std::swap(variant.a, variant.b);
    std::swap(variant.was_a, variant.was_b);
    variant.is_swapped = !variant.is_swapped;
    const Placement& p = variant.placement;
    if (p.b_is_moved() && !p.a_is_moved()) {
        variant.placement = Placement::a_moves(p.pose_b());
    } else {
        variant.placement = Placement::world(p.pose_b(), p.pose_a());
    }
}

}  // namespace

Relabelled relabelled(const TestMesh& mesh, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto vertices = any_order(mesh.positions.size(), random);  // number before, by place
    std::vector<std::uint32_t> place(vertices.size());
    Relabelled made;
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        made.mesh.positions.push_back(mesh.positions[vertices[i]]);
        place[vertices[i]] = i;
    }
    made.was = any_order(mesh.triangles.size(), random);
    for (const std::uint32_t t : made.was) {
        Triangle corners = mesh.triangles[t];
        for (std::uint32_t& v : corners.vertex) v = place[v];
        std::rotate(corners.vertex.begin(), corners.vertex.begin() + random() % 3,
                    corners.vertex.end());
        made.mesh.triangles.push_back(corners);
    }
    return made;
}

std::vector<TrianglePair> MeshVariant::told(const std::vector<TrianglePair>& pairs) const {
    const auto now = [](const std::vector<std::uint32_t>& was) {
        std::vector<std::uint32_t> result(was.size());
        for (std::uint32_t i = 0; i < was.size(); ++i) result[was[i]] = i;
        return result;
    };
    const std::vector<std::uint32_t> now_a = now(was_a), now_b = now(was_b);
    std::vector<TrianglePair> result = pairs;
    for (TrianglePair& pair : result) {
        if (is_swapped) std::swap(pair.a, pair.b);
        if (!now_a.empty()) pair.a = now_a[pair.a];
        if (!now_b.empty()) pair.b = now_b[pair.b];
    }
    std::sort(result.begin(), result.end());
    return result;
}

std::vector<MeshVariant> mesh_variants(const TestMesh& a, const TestMesh& b,
                                       const Placement& placement, bool few) {
    const MeshVariant as_placed = {"as placed", a, b, placement};
    std::vector<MeshVariant> all = {as_placed};
    MeshVariant other = as_placed;
    relabel(other, 1);
    all.push_back(other);
    swap(other);
    all.push_back(other);

    const TestMesh at_a = placed(a, placement.pose_a(), placement.a_is_moved());
    const TestMesh at_b = placed(b, placement.pose_b(), placement.b_is_moved());
    std::uint32_t number = 0;
    for (const ExactChange& change : exact_changes(few)) {
        auto changed_a = change(at_a), changed_b = change(at_b);
        if (!changed_a || !changed_b) continue;
        ++number;
        MeshVariant variant = {change.name, std::move(*changed_a), std::move(*changed_b),
                               Placement::b_moves(Pose()), change};
        if (number % 2 == 0) {  // the poses turn and shift instead
            ExactChange scale;
            scale.exponent = change.exponent;
            variant.a = *scale(at_a);
            variant.b = *scale(at_b);
            variant.placement = Placement::world(change.pose(), change.pose());
            variant.name += ", by poses";
        }
        if (number % 3 == 0) relabel(variant, number);
        if (number % 5 == 0) swap(variant);
        all.push_back(std::move(variant));
    }
    return all;
}

}  // namespace cdprep::test
