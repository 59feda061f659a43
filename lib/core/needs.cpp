// SPDX-License-Identifier: MIT
#include <array>

#include "cdprep/ask.h"

namespace cdprep {
namespace {

using format::SectionId;
using format::SectionSet;

constexpr SectionSet with(SectionSet a, SectionSet b) noexcept {
    a.insert(b);
    return a;
}

constexpr SectionSet kPositions = {SectionId::positions_f32, SectionId::positions_f64};
/// The sections for the corners of triangles, and the marks of degenerate triangles.
constexpr SectionSet kGeometry =
    with(kPositions, {SectionId::triangles, SectionId::degenerate_bits});
/// Tighter bounds for the BVH, which make queries about pairs faster.
constexpr SectionSet kTighter = {SectionId::oriented_nodes, SectionId::swept_nodes};
/// The sections that locate an answer in the imported file.
constexpr SectionSet kSource = {
    SectionId::source_vertex, SectionId::source_face,    SectionId::repaired_from,
    SectionId::instances,     SectionId::instance_names, SectionId::group_runs,
    SectionId::group_names,   SectionId::material_runs,  SectionId::material_names};
constexpr SectionSet kBvh = {SectionId::bvh_nodes};
constexpr SectionSet kPair = {SectionId::bvh_nodes, SectionId::bvh_leaves};
constexpr SectionSet kNumbered = {SectionId::source_triangle};
/// The sections from which a live model starts. It reads no kTighter, but a bake for one has it.
/// Queries of the bake itself then name the same triangles as those of any other bake.
constexpr SectionSet kLive = {SectionId::bvh_nodes, SectionId::bvh_leaves, SectionId::triangles,
                              SectionId::source_triangle, SectionId::source_vertex};

constexpr SectionSet kOctree = {SectionId::octree_grid, SectionId::octree_nodes,
                                SectionId::octree_references};
constexpr SectionSet kHashedOctree = with(
    kOctree, {SectionId::octree_leaf_codes, SectionId::octree_leaf_nodes, SectionId::octree_top,
              SectionId::octree_modulus_table, SectionId::octree_mixed_table});
constexpr SectionSet kAdaptiveOctree = {SectionId::adaptive_octree,
                                        SectionId::adaptive_octree_nodes,
                                        SectionId::adaptive_octree_references};
constexpr SectionSet kTetraTree = {SectionId::tetra_tree, SectionId::tetra_nodes,
                                   SectionId::tetra_references, SectionId::tetra_top};
constexpr SectionSet kHulls = {SectionId::hulls,         SectionId::hull_blocks,
                               SectionId::hull_vertices, SectionId::hull_facets,
                               SectionId::hull_groups,   SectionId::hull_neighbours,
                               SectionId::hull_starts};
constexpr SectionSet kPieces = {SectionId::pieces,           SectionId::piece_triangles,
                                SectionId::piece_nodes,      SectionId::piece_leaves,
                                SectionId::piece_node_hulls, SectionId::piece_swept};
/// The hulls of single pieces.
constexpr SectionSet kPieceHulls = {SectionId::piece_vertices, SectionId::piece_facets};
/// The sections that contacts between pieces require in addition.
constexpr SectionSet kContacts = {SectionId::piece_adjacency, SectionId::edge_convexity,
                                  SectionId::triangle_piece};
/// What contacts need, and what they use.
constexpr SectionSet kNeededByContacts =
    with(with(with(kPair, kNumbered), {SectionId::source_vertex, SectionId::triangles}),
         with(with(kPieces, kPieceHulls), kContacts));
constexpr SectionSet kUsedByContacts = with(with(with(kGeometry, kTighter), kSource), kHulls);

// Queries that return triangles require source numbers: a number in tree order would be a wrong
// answer.
constexpr std::array<Needs, 24> kNeeds = {{
    {Ask::collide, "collide", "--effects collide", kPair, Vertices::corners,
     with(with(kGeometry, kTighter), {SectionId::components})},
    {Ask::overlap, "overlap", "--effects overlap", with(kPair, kNumbered), Vertices::corners,
     with(with(kGeometry, kTighter), kSource)},
    {Ask::distance, "distance", "--effects distance", with(kPair, kNumbered), Vertices::corners,
     with(with(kGeometry, kTighter), kSource)},
    {Ask::within, "within", "--effects within", with(kPair, kNumbered), Vertices::corners,
     with(with(kGeometry, kTighter), kSource)},
    {Ask::contacts, "contacts", "--effects contacts", kNeededByContacts, Vertices::positions,
     kUsedByContacts},
    // Bodies push each other by their contacts.
    {Ask::response, "response", "--effects response",
     with(kNeededByContacts, {SectionId::mass_properties}), Vertices::positions, kUsedByContacts},
    {Ask::continuous, "continuous", "--effects continuous", with(kPair, kNumbered),
     Vertices::corners, with(with(kGeometry, kTighter), kSource)},
    {Ask::self, "self", "--effects self", with(with(kPair, kNumbered), {SectionId::triangles}),
     Vertices::positions, with(with(kGeometry, kTighter), kSource)},
    {Ask::deform, "deform", "--effects deform", kLive, Vertices::positions,
     with(with(kGeometry, kTighter), {SectionId::components})},
    {Ask::tear, "tear", "--effects tear", kLive, Vertices::positions,
     with(with(kGeometry, kTighter), {SectionId::components})},
    {Ask::haptic, "haptic", "--effects haptic", with(kPair, kNumbered), Vertices::corners,
     with(with(kGeometry, kTighter), kSource)},
    {Ask::inside, "inside", "--effects inside", kBvh, Vertices::corners,
     with(kGeometry, {SectionId::components})},
    {Ask::ray, "ray", "--effects ray", with(kBvh, kNumbered), Vertices::corners,
     with(kGeometry, kSource)},
    {Ask::closest, "closest", "--effects closest", with(kBvh, kNumbered), Vertices::corners,
     with(kGeometry, kSource)},
    {Ask::touch, "touch", "--effects touch", with(kBvh, kNumbered), Vertices::corners,
     with(kGeometry, kSource)},
    {Ask::hulls, "hull", "--structures hull", kHulls, Vertices::none, {}},
    {Ask::pieces, "pieces", "--effects pieces",
     with(with(kPair, kNumbered), with(kPieces, kPieceHulls)), Vertices::positions,
     with(with(kGeometry, kTighter), kSource)},
    {Ask::corners, "corners", "--effects corners", with(kNumbered, {SectionId::triangles}),
     Vertices::positions, with(with(kGeometry, kSource), {SectionId::components})},
    {Ask::inaccessible, "inaccessible", "--effects inaccessible",
     with(kNumbered, {SectionId::triangles, SectionId::tetra_tree}), Vertices::positions,
     with(kGeometry, kSource)},
    {Ask::octree,
     "octree",
     "--structures octree",
     kOctree,
     Vertices::none,
     {SectionId::octree_boxes}},
    {Ask::adaptive_octree,
     "octree-adaptive",
     "--structures octree-adaptive",
     kAdaptiveOctree,
     Vertices::none,
     {SectionId::adaptive_octree_boxes}},
    {Ask::tetra_tree,
     "tetra-tree",
     "--structures tetra-tree",
     kTetraTree,
     Vertices::none,
     {SectionId::tetra_boxes, SectionId::tetra_oriented}},
    {Ask::hashed_octree,
     "hashed-octree",
     "--structures hashed-octree",
     kHashedOctree,
     Vertices::none,
     {SectionId::octree_boxes}},
    {Ask::solid, "solid", "--effects collide", with(kBvh, {SectionId::components}),
     Vertices::positions, kGeometry},
}};

constexpr SectionSet missing_from(SectionSet needed, SectionSet sections) noexcept {
    needed.erase(sections);
    return needed;
}

bool has_positions(SectionSet sections) noexcept {
    return sections.contains(SectionId::positions_f32) ||
           sections.contains(SectionId::positions_f64);
}

SectionSet missing_vertices(Vertices vertices, SectionSet sections,
                            bool has_exact_leaves) noexcept {
    SectionSet missing;
    if (vertices == Vertices::none) return missing;
    const bool has_leaves = has_exact_leaves && sections.contains(SectionId::bvh_leaves);
    const bool needs_positions = vertices == Vertices::positions || !has_leaves;
    if (needs_positions && !has_positions(sections)) missing.insert(SectionId::positions_f32);
    if (!has_leaves && !sections.contains(SectionId::triangles)) {
        missing.insert(SectionId::triangles);
    }
    return missing;
}

}  // namespace

std::span<const Needs> needs() noexcept {
    return kNeeds;
}

const Needs* find_needs(Ask one) noexcept {
    for (const Needs& row : kNeeds) {
        if (row.ask == one) return &row;
    }
    return nullptr;
}

const Needs* find_needs(std::string_view name) noexcept {
    for (const Needs& row : kNeeds) {
        if (name == row.name) return &row;
    }
    return nullptr;
}

Ask known_asks() noexcept {
    Ask known = Ask::nothing;
    for (const Needs& row : kNeeds) known = known | row.ask;
    return known;
}

SectionSet sections_for(Ask asks) noexcept {
    SectionSet sections;
    for (const Needs& row : kNeeds) {
        if ((row.ask & asks) == Ask::nothing) continue;
        sections.insert(row.needed);
        sections.insert(row.used);
    }
    return sections;
}

SectionSet missing_sections(Ask ask, SectionSet sections, bool has_exact_leaves) noexcept {
    const Needs* row = find_needs(ask);
    if (row == nullptr) return {};
    SectionSet missing = missing_from(row->needed, sections);
    missing.insert(missing_vertices(row->vertices, sections, has_exact_leaves));
    return missing;
}

Ask served_by(SectionSet sections, bool has_exact_leaves) noexcept {
    Ask served = Ask::nothing;
    for (const Needs& row : kNeeds) {
        const SectionSet missing = missing_sections(row.ask, sections, has_exact_leaves);
        if (missing == SectionSet{}) served = served | row.ask;
    }
    return served;
}

}  // namespace cdprep
