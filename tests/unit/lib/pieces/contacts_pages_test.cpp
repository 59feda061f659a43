// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "support/guarded_pages.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/same_contacts.h"

#include "cdprep/contacts.h"

namespace cdprep::test {
namespace {

/// What the effect "contacts" bakes and a question reads.
constexpr format::SectionSet kWanted = {
    SectionId::positions_f32,  SectionId::triangles,       SectionId::bvh_nodes,
    SectionId::bvh_leaves,     SectionId::source_triangle, SectionId::pieces,
    SectionId::piece_vertices, SectionId::piece_triangles, SectionId::piece_facets,
    SectionId::triangle_piece, SectionId::piece_adjacency, SectionId::edge_convexity,
    SectionId::source_vertex,  SectionId::piece_nodes,     SectionId::piece_leaves,
    SectionId::piece_swept,    SectionId::piece_node_hulls};

std::vector<Contact> all_contacts(const Model& a, const Model& b, const Placement& placement,
                                  Workspace& workspace) {
    std::vector<Contact> found;
    const auto keep = [&](const Contact& contact) {
        found.push_back(contact);
        return true;
    };
    visit_contacts({a, b, placement}, workspace, keep,
                   {.tolerance = 0.125, .manifold = Manifold::four});
    return found;
}

// On read-only pages, with every other section closed; the answers are those of the whole file.
TEST(ContactsPages, ReadOnlyWhatTheyNeed) {
    const TestMesh ball = icosphere(1), ring = torus(1, 0.25, 16, 8);
    const AlignedBytes file_a =
        on_pages(with_contacts(with_one_piece(bake_tiny(ball.positions, ball.triangles))));
    const AlignedBytes file_b =
        on_pages(with_contacts(with_pieces(bake_tiny(ring.positions, ring.triangles))));
    const OpenModel whole_a = open_tiny(AlignedBytes(file_a.span()));
    const OpenModel whole_b = open_tiny(AlignedBytes(file_b.span()));
    const GuardedPages pages_a(file_a.span(), kWanted), pages_b(file_b.span(), kWanted);
    EXPECT_GE(pages_a.guarded() + pages_b.guarded(), 4);
    const auto a = Model::open(pages_a.bytes(), kWanted);
    const auto b = Model::open(pages_b.bytes(), kWanted);
    ASSERT_TRUE(a && b);
    Workspace workspace;
    std::mt19937 random(3);
    std::size_t overlapping = 0, count = 0;
    for (int i = 0; i < 20; ++i) {
        const Placement placement = Placement::b_moves(random_pose(random, 2));
        const auto expected = all_contacts(whole_a.model, whole_b.model, placement, workspace);
        const auto found = all_contacts(a.value(), b.value(), placement, workspace);
        ASSERT_EQ(expected.size(), found.size());
        for (std::size_t k = 0; k < found.size(); ++k) {
            expect_same(expected[k], found[k]);
            overlapping += found[k].flags & contact_overlap;
        }
        count += found.size();
    }
    EXPECT_GT(overlapping, count / 20);
    EXPECT_LT(overlapping, count * 19 / 20);
}

}  // namespace
}  // namespace cdprep::test
