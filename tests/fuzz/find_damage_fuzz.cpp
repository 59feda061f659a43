// SPDX-License-Identifier: MIT
// Hostile bytes: what the checker accepts must be safe to ask anything.
//
// Checksums would stop nearly every mutation, so each input is also judged after
// its checksums have been made right again: then only the content can refuse.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "support/aligned_bytes.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/reseal.h"
#include "support/tiny_baker.h"
#include "support/tiny_pieces.h"

#include "cdprep/advanced/convex_penetration.h"
#include "cdprep/advanced/find_falsehood.h"
#include "cdprep/advanced/pair_front.h"
#include "cdprep/cells.h"
#include "cdprep/cells/find_list_damage.h"
#include "cdprep/cells/level_of_detail.h"
#include "cdprep/cells/octree_figures.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/cells/tetra_figures.h"
#include "cdprep/contacts.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/hulls.h"
#include "cdprep/pairs.h"
#include "cdprep/points.h"

namespace {

using namespace cdprep;  // NOLINT(google-build-using-namespace): a program of its own

constexpr std::uint32_t kMostTriangles = 4096;  ///< keeps one input below a second
/// The questions about two models through their boxes.
constexpr Ask kPairs = Ask::collide | Ask::solid | Ask::overlap | Ask::distance | Ask::within;

void ask_pair(const Model& model, Workspace& workspace) {
    static std::vector<TrianglePair> pairs(256);
    const Pose turned = Pose::from_quaternion(1, 2, 3, 4, {0.25, 0, 0}).value();
    for (const Placement& placement :
         {Placement::b_moves(Pose()), Placement::world(turned, Pose())}) {
        (void)overlaps({model, model, placement}, workspace, pairs);
        (void)collide({model, model, placement, {.body = Body::solid}}, workspace);
        (void)distance({model, model, placement}, workspace);
        (void)within({model, model, placement}, 0.125, workspace);
        (void)pairs_within({model, model, placement}, 0.0625, workspace, pairs);
    }
    const Placement apart =
        Placement::b_moves(Pose::from_quaternion(1, 2, 3, 4, {3, 0.25, 0.5}).value());
    (void)distance({model, model, apart}, workspace);
    (void)within({model, model, apart}, 0.5, workspace);
    PairCache cache;
    for (const Placement& placement : {apart, Placement::b_moves(Pose()), apart, apart}) {
        (void)collide({model, model, placement, {}, &cache}, workspace);
        (void)distance({model, model, placement, {}, &cache}, workspace);
    }
    const auto every = [](const Crossing&) { return true; };
    (void)visit_crossings({model, model, Placement::b_moves(Pose())}, workspace, every);
}

void ask_shapes(const Model& model, Workspace& workspace) {
    std::array<std::uint32_t, 16> numbers{};
    const Capsule capsule = {{0, 0, 0.5}, {0.1, 0, -1}, 0.1};
    (void)touching_triangles(model, Box{{-0.5, 0, 0}, {0.5, 1, 1}}, workspace, numbers);
    (void)touching_triangles(model, Sphere{{0, 0, 0}, 0.5}, workspace, numbers);
    (void)touching_triangles(model, capsule, workspace, numbers);
    (void)shape_distance(model, capsule, workspace);
    (void)shape_distance(model, Box{{0.5, 0, 2}, {0.5, 1, 3}}, workspace);
}

void ask_rays(const Model& model, Workspace& workspace) {
    (void)cast_ray(model, {{0.5, 0.25, -3}, {0.125, 0, 1}}, workspace);
    (void)ray_hits(model, {{0, 0, 5}, {0.1, 0, -1}}, workspace);
}

/// Lists that pass the check may say what no geometry bears out.
void ask_structures(const Model& model, Workspace& workspace) {
    static std::vector<TrianglePair> pairs(256);
    const Placement turned =
        Placement::b_moves(Pose::from_quaternion(1, 2, 3, 4, {0.25, 0, 0}).value());
    for (const Structure structure : {Structure::octree, Structure::adaptive_octree,
                                      Structure::hashed_octree, Structure::tetra_tree}) {
        if (!model.serves(ask_of(structure))) continue;
        if (model.serves(Ask::inside)) {
            (void)points_inside(model, {0.5, 0.5, 0.5}, workspace, structure);
        }
        if (!model.serves(kPairs)) continue;
        for (const Placement& placement : {turned, Placement::b_moves(Pose())}) {
            for (const CellSearch search :
                 {CellSearch::sorted, CellSearch::modulus, CellSearch::mixed}) {
                const StructureOptions through = {.structure = structure, .search = search};
                (void)overlaps_through({model, model, placement}, through, workspace, pairs);
                (void)any_overlap_through({model, model, placement}, through, workspace);
                if (structure != Structure::hashed_octree) break;
            }
        }
        for (const Descent descent : {Descent::larger, Descent::a_first, Descent::b_first}) {
            const StructureOptions through = {
                .structure = structure, .leaf_test = LeafTest::feito_torres, .descent = descent};
            (void)any_overlap_through({model, model, turned}, through, workspace);
        }
    }
    if (!model.serves(Ask::tetra_tree)) return;
    for (const std::uint32_t level : {0U, 3U, format::kMaxTetraLevel}) {
        (void)collide_at_level({model, model, turned}, level, workspace);
        (void)level_error(model, level);
    }
}

/// A hull that passes the check may be none, and its neighbours may lead nowhere. The cache
/// goes from one question to the next about other hulls: any content is allowed.
void ask_hulls(const Model& model) {
    constexpr std::size_t kMostHulls = 3;
    constexpr std::uint32_t kMostPoints = 512;
    const auto hulls = model.hulls().hulls.first(std::min(model.hulls().hulls.size(), kMostHulls));
    const Placement turned =
        Placement::b_moves(Pose::from_quaternion(1, 2, 3, 4, {0.25, 0, 0}).value());
    const Placement apart =
        Placement::world(Pose::from_quaternion(4, 3, 2, 1, {3, 0.25, 0.5}).value(), Pose());
    ConvexCache cache;
    for (std::uint32_t i = 0; i < hulls.size(); ++i) {
        (void)find_hull(model, hulls[i].scope, hulls[i].number);
        const ConvexPoints a = convex_points(model, i);
        const ConvexPoints b =
            convex_points(model, static_cast<std::uint32_t>(hulls.size()) - 1 - i);
        if (std::max(a.count, b.count) > kMostPoints) continue;
        for (const Placement& placement : {Placement::b_moves(Pose()), turned, apart}) {
            (void)convex_collide(a, b, placement, &cache);
            (void)convex_distance(a, b, placement, {}, &cache);
            (void)convex_distance(a, b, placement);
            (void)convex_within(a, b, placement, 0.125, &cache);
            (void)convex_penetration(a, b, placement, {}, &cache);
        }
    }
}

/// Part `i` of a list whose parts begin where the pieces say.
template <class T>
std::span<const T> part(const Model& model, std::span<const T> all,
                        std::uint32_t format::Piece::*first, std::size_t i) {
    const auto pieces = model.pieces().pieces;
    const std::size_t end = i + 1 < pieces.size() ? pieces[i + 1].*first : all.size();
    return all.subspan(pieces[i].*first, end - pieces[i].*first);
}

/// Follows every number that a question would.
void ask_pieces(const Model& model) {
    using format::Piece;
    const auto vertex = [&](std::uint32_t v) {
        if (!model.mesh().positions_f64.empty()) return model.mesh().positions_f64[v].x;
        return double{model.mesh().positions_f32[v].x};
    };
    [[maybe_unused]] static volatile double sink = 0;
    for (std::size_t i = 0; i < model.pieces().pieces.size(); ++i) {
        for (const std::uint32_t t :
             part(model, model.pieces().triangles, &Piece::first_triangle, i)) {
            for (const auto v : model.mesh().triangles[t].vertex) sink = vertex(v);
        }
        const auto vertices = part(model, model.pieces().vertices, &Piece::first_vertex, i);
        for (const auto& facet : part(model, model.pieces().facets, &Piece::first_facet, i)) {
            for (const std::uint32_t corner : facet.corner) sink = vertex(vertices[corner]);
        }
    }
}

const std::array<Placement, 4>& piece_placements() {
    static const std::array<Placement, 4> placements = {
        Placement::b_moves(Pose::from_quaternion(1, 2, 3, 4, {0.25, 0, 0}).value()),
        Placement::world(Pose::from_quaternion(4, 3, 2, 1, {3, 0.25, 0.5}).value(), Pose()),
        Placement::b_moves(Pose()),
        Placement::b_moves(Pose::from_quaternion(1, 2, 3, 4, {0.25, 0, 0.001}).value())};
    return placements;
}

/// Boxes and hulls that pass the check may be around nothing that is below them; the cache
/// begins with triangles, leaves and corners that no model has.
void ask_through_pieces(const Model& model, Workspace& workspace) {
    constexpr StructureOptions kThrough = {.structure = Structure::pieces};
    static std::vector<TrianglePair> pairs(256);
    PieceCache cache;
    cache.pair.holds = 7;
    cache.pair.triangle_a = model.triangle_count();
    cache.pair.triangle_b = 0xffffffffU;
    cache.front.models = {1, 2};
    cache.front.count = 0xfffffff0U;
    for (const Placement& placement : piece_placements()) {
        (void)overlaps_through({model, model, placement}, kThrough, workspace, pairs);
        (void)any_overlap_through({model, model, placement}, kThrough, workspace);
        (void)any_overlap_through({model, model, placement, {}, &cache.pair}, kThrough, workspace);
        (void)distance({model, model, placement, {.through = kThrough.structure}}, workspace);
        (void)distance(
            {model, model, placement, {.through = kThrough.structure}, &cache.pair, &cache.front},
            workspace);
        (void)within({model, model, placement, {.through = kThrough.structure}}, 0.125, workspace);
        (void)within(
            {model, model, placement, {.through = kThrough.structure}, &cache.pair, &cache.front},
            0.5, workspace);
    }
}

/// Hulls may have nothing to do with the triangles of their pieces.
void ask_contacts(const Model& model, Workspace& workspace) {
    constexpr std::size_t kMostContacts = 64;
    for (const Placement& placement : piece_placements()) {
        for (const Manifold manifold : {Manifold::none, Manifold::four}) {
            std::size_t count = 0;
            const auto visit = [&](const Contact&) { return ++count < kMostContacts; };
            visit_contacts({model, model, placement}, workspace, visit,
                           {.tolerance = 0.0625, .manifold = manifold});
        }
    }
}

/// Every hull of some against the next ones. Caches go from one question to the next about
/// other hulls, and begin at an edge that no hull has.
void ask_features(const Model& model) {
    constexpr std::size_t kMostHulls = 6;
    constexpr std::uint32_t kMostPoints = 128;
    std::vector<FeatureHull> hulls;
    const std::size_t count = std::min(model.pieces().pieces.size(), kMostHulls);
    for (std::uint32_t i = 0; i < count; ++i) {
        const FeatureHull hull = feature_hull(model, i);
        if (hull.points.count <= kMostPoints) hulls.push_back(hull);
    }
    FeatureCache cache = {true, {FeatureKind::face, FeatureKind::edge}, {0xffffffffU, 0}};
    for (const FeatureHull& a : hulls) {
        for (const FeatureHull& b : hulls) {
            for (const Placement& placement : piece_placements()) {
                (void)closest_features(a, b, placement, &cache);
            }
        }
    }
}

void ask(const Model& model) {
    static Workspace workspace(cells());
    if (model.serves(kPairs)) ask_pair(model, workspace);
    if (model.serves(kPairs | Ask::pieces)) ask_through_pieces(model, workspace);
    if (model.serves(Ask::contacts)) {
        ask_contacts(model, workspace);
        ask_features(model);
    }
    ask_structures(model, workspace);
    if (model.serves(Ask::hulls)) ask_hulls(model);
    if (model.serves(Ask::pieces | Ask::corners)) ask_pieces(model);
    (void)octree_figures(model);
    (void)adaptive_octree_figures(model);
    (void)tetra_figures(model);
    if (model.serves(Ask::ray)) ask_rays(model, workspace);
    if (model.serves(Ask::touch)) ask_shapes(model, workspace);
    if (model.serves(Ask::closest)) (void)closest_point(model, {0.25, 0.5, 2}, workspace);
    if (model.serves(Ask::inside)) (void)points_inside(model, {0.5, 0.5, 0.5}, workspace);
    for (std::uint32_t i = 0; i < 4; ++i) (void)model.name(SectionId::group_names, i);
}

void judge(const test::AlignedBytes& bytes) {
    const auto opened = Model::open(bytes.span());
    if (!opened) return;
    if (opened->triangle_count() <= kMostTriangles) {
        ask(*opened);
        (void)find_list_damage(bytes.span(), *opened);
        (void)find_hull_falsehood(bytes.span(), *opened);
    }
    (void)format::find_deep_damage(bytes.span());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    test::AlignedBytes bytes(std::as_bytes(std::span(data, size)));
    judge(bytes);
    test::reseal(bytes.span());
    judge(bytes);
    return 0;
}

/// A few whole files to start from, in place of a stored corpus.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed);
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

std::vector<test::AlignedBytes> make_seeds() {
    std::vector<test::AlignedBytes> seeds;
    for (const test::TestMesh& mesh :
         {test::TestMesh{}, test::unit_cube(), test::icosphere(1), test::coarse_grid_soup(1, 40, 2),
          test::copies_of_one_triangle(20)}) {
        seeds.push_back(test::bake_tiny(mesh.positions, mesh.triangles));
        seeds.push_back(
            test::bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true}));
        seeds.push_back(test::with_octree(seeds.back(), {.threshold = 4}));
        seeds.push_back(test::with_adaptive_octree(seeds.back(), {.threshold = 4}));
        seeds.push_back(test::with_tetra_tree(seeds.back(), {.threshold = 4}));
        seeds.push_back(test::with_piece_tree(test::bake_tiny(mesh.positions, mesh.triangles)));
        // Twice: small files, in which a change more often meets what is about hulls.
        for (const bool is_double : {false, true}) {
            seeds.push_back(test::with_hulls(
                test::bake_tiny(mesh.positions, mesh.triangles, {.double_precision = is_double})));
        }
        seeds.push_back(test::with_pieces(seeds.back()));
        for (const auto& with : {test::with_pieces, test::with_piece_tree}) {
            seeds.push_back(
                test::with_contacts(with(test::bake_tiny(mesh.positions, mesh.triangles))));
        }
    }
    for (const test::TestMesh& mesh : {test::unit_cube(), test::icosphere(1)}) {
        seeds.push_back(test::with_one_piece(test::bake_tiny(mesh.positions, mesh.triangles)));
        seeds.push_back(test::with_contacts(seeds.back()));
    }
    return seeds;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
    static const std::vector<test::AlignedBytes> seeds = make_seeds();
    const auto& start = seeds[seed % seeds.size()];
    if ((size < 4200 || seed % 97 == 0) && start.size() <= max_size) {
        std::memcpy(data, start.span().data(), start.size());
        size = start.size();
    }
    return LLVMFuzzerMutate(data, size, max_size);
}
