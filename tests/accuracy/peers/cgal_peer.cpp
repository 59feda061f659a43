// SPDX-License-Identifier: GPL-3.0-or-later
#ifdef CDPREP_HAVE_CGAL
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <iterator>

#include "accuracy/peers/peer.h"

namespace cdprep::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Triangles triangles_of(const TestMesh& mesh) {
    Triangles triangles;
    for (const Triangle& t : mesh.triangles) {
        const auto at = [&](std::size_t i) {
            const Double3& p = mesh.positions[t.vertex[i]];
            return Kernel::Point_3(p.x, p.y, p.z);
        };
        triangles.emplace_back(at(0), at(1), at(2));
    }
    return triangles;
}

PeerAnswer collide(const TestMesh& a, const TestMesh& b) {
    const Triangles of_a = triangles_of(a), of_b = triangles_of(b);
    const Tree tree(of_a.begin(), of_a.end());
    PeerAnswer answer = {false, std::vector<TrianglePair>()};
    std::vector<Triangles::const_iterator> met;
    for (std::uint32_t j = 0; j < of_b.size(); ++j) {
        met.clear();
        tree.all_intersected_primitives(of_b[j], std::back_inserter(met));
        for (const auto& at : met) {
            answer.pairs->push_back({static_cast<std::uint32_t>(at - of_a.begin()), j});
        }
    }
    answer.hit = !answer.pairs->empty();
    return answer;
}

}  // namespace

void add_cgal(std::vector<Peer>& peers) {
    peers.push_back({"CGAL", collide});
}

}  // namespace cdprep::test
#endif
