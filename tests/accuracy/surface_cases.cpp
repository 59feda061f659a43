// SPDX-License-Identifier: MIT
// D: convex pieces of surfaces, convex parts that enclose solids, findings and repairs. Pieces are
// judged by exact rationals; findings are known by hand.
#include <array>
#include <cmath>
#include <map>
#include <span>

#include "accuracy/epeck.h"
#include "accuracy/exact_change.h"
#include "accuracy/hard_cases.h"
#include "accuracy/mesh_variants.h"
#include "decompose/enclose/approximate_parts.h"
#include "decompose/surface/surface_pieces.h"
#include "mesh/weld.h"
#include "repair/repair.h"
#include "support/concave_solids.h"
#include "support/defect_zoo.h"
#include "support/hard_point_sets.h"
#include "support/rounds.h"
#include "support/small_hull.h"
#include "unit/tools/pieces_flaw.h"
#include "unit/tools/soup_of.h"
#include "validate/defects/find_defects.h"

#include "cdprep/advanced/convex_distance.h"

namespace cdprep::test {
namespace {

using convex::EdgeKind;
using convex::PieceOrder;
using convex::SurfacePieces;

constexpr std::array kOrders = {PieceOrder::greedy, PieceOrder::depth_first,
                                PieceOrder::breadth_first, PieceOrder::cresting};
constexpr std::array kOrderNames = {"greedy", "depth first", "breadth first", "cresting"};

/// A surface, and what must be said of its pieces.
struct HardSurface {
    std::string id;
    TestMesh mesh;
    std::optional<std::size_t> pieces{};  ///< of the greedy order, known by hand
    std::optional<bool> contained{};      ///< all of them, or none
    std::map<EdgeKind, std::size_t> edges{};
    bool is_solid = true;  ///< hulls of contained pieces are proved to be so
};

TestMesh hull_mesh(const std::vector<Double3>& points) {
    const SmallHull hull(points);
    TestMesh mesh = {hull.points(), {}};
    for (const auto& t : hull.triangles()) mesh.triangles.push_back({t});
    return mesh;
}

TestMesh strip(double height) {
    TestMesh mesh = grid_sheet(2, 1);
    for (Double3& p : mesh.positions) {
        p.z = 1;
        if (p.x == 1) p.z = height;
    }
    return mesh;
}

std::vector<HardSurface> hard_surfaces(bool full) {
    std::vector<HardSurface> all;
    all.push_back({"D01 a box", unit_cube(), 1, true, {{EdgeKind::flat, 6}}});
    all.push_back({"D01 a ball", icosphere(full ? 5 : 2), 1, true, {{EdgeKind::reflex, 0}}});
    all.push_back({"D01 a hull of points of a sphere", hull_mesh(lattice_sphere(15)), 1, true});
    for (const auto& [name, mesh] :
         {std::pair("L", l_prism()), std::pair("U", u_prism()), std::pair("plus", plus_prism())}) {
        all.push_back({std::string("D02 prism over ") + name, mesh, {}, true});
    }
    all.push_back({"D03 a star", star(), {}, true});
    all.push_back({"D03 a torus", torus(2, 0.5, full ? 24 : 12, full ? 12 : 6), {}, true});
    if (full) {
        all.push_back({"D03 a spiral stair", spiral_stair(), {}, true});
        all.push_back({"D03 a trefoil tube", trefoil_tube(), {}, true});
    }
    for (const double thickness : {1e-3, 1e-12, 0x1p-300, 5e-324}) {
        TestMesh box = unit_cube();
        for (Double3& p : box.positions) p.z *= thickness;
        all.push_back(
            {"D04 a box " + std::to_string(std::ilogb(thickness)) + " bits thin", box, 1, true});
    }
    all.push_back(
        {"D05 three sheets", three_sheets(), 3, false, {{EdgeKind::non_manifold, 1}}, false});
    for (const double z : {1.0, 0.0}) {
        all.push_back({z == 1 ? "D05 cubes that share a vertex" : "D05 cubes that share an edge",
                       joined(unit_cube(), moved_by(unit_cube(), 1, {1, 1, z})),
                       2,
                       true,
                       {{EdgeKind::non_manifold, z == 1 ? 0U : 1U}}});
    }
    all.push_back({"D06 a Moebius strip", moebius_strip(16), {}, false, {}, false});
    all.push_back({"D06 a Klein bottle",
                   klein_bottle(full ? 16 : 6, 7),
                   {},
                   false,
                   {{EdgeKind::border, 0}, {EdgeKind::inconsistent, 7}},
                   false});
    all.push_back({"D07 a hemisphere", upper_half(icosphere(full ? 3 : 2)), 1, false, {}, false});
    all.push_back({"D10 a flat strip", strip(1), 1, false, {{EdgeKind::flat, 3}}, false});
    all.push_back({"D10 a vertex one ulp low",
                   strip(std::nextafter(1.0, 0.0)),
                   {},
                   false,
                   {{EdgeKind::reflex, 1}},
                   false});
    all.push_back({"D10 a vertex one ulp high",
                   strip(std::nextafter(1.0, 2.0)),
                   {},
                   false,
                   {{EdgeKind::reflex, 0}, {EdgeKind::convex, 1}},
                   false});
    all.push_back({"D11 a box with a fine side",
                   box_with_a_fine_side(full ? 100 : 20, full ? 50 : 10),
                   1,
                   true,
                   {{EdgeKind::reflex, 0}}});
    return all;
}

/// What is wrong with where pieces lie. Most orders find the same pieces: those are judged once.
class PieceJudge {
public:
    PieceJudge(const HardSurface& hard, const mesh::Mesh& mesh) : hard_(hard), mesh_(mesh) {}

    std::string flaw_of(const SurfacePieces& pieces) {
        const bool is_judged = judged_ && is_same(*judged_, pieces);
        if (!is_judged) flaw_ = exact_flaw_of(pieces);
        judged_ = pieces;
        return flaw_;
    }

private:
    static bool is_same(const SurfacePieces& a, const SurfacePieces& b) {
        return a.triangles == b.triangles && a.first == b.first &&
               std::equal(a.pieces.begin(), a.pieces.end(), b.pieces.begin(), b.pieces.end(),
                          [](const convex::SurfacePiece& p, const convex::SurfacePiece& q) {
                              return p.contained == q.contained;
                          });
    }
    [[nodiscard]] std::string exact_flaw_of(const SurfacePieces& pieces) const {
        if (std::string flaw = partition_flaw(mesh_, pieces); !flaw.empty()) return flaw;
        if (std::string flaw = hull_face_flaw(mesh_, pieces); !flaw.empty()) return flaw;
        return hard_.is_solid ? containment_flaw(mesh_, pieces) : "";
    }

    const HardSurface& hard_;
    const mesh::Mesh& mesh_;
    std::optional<SurfacePieces> judged_;
    std::string flaw_;
};

/// What is wrong with how many they are, and of what kind.
std::string flaw_of(const HardSurface& hard, const SurfacePieces& pieces, PieceOrder order) {
    if (order == PieceOrder::greedy && hard.pieces && pieces.pieces.size() != *hard.pieces) {
        return std::to_string(pieces.pieces.size()) + " pieces";
    }
    for (const convex::SurfacePiece& piece : pieces.pieces) {
        if (hard.contained && piece.contained != *hard.contained) return "contained, or not";
        if (piece.outer_error != 0) return "an error where none is permitted";
    }
    for (const auto& [kind, count] : hard.edges) {
        const std::size_t found = pieces.edges[static_cast<std::size_t>(kind)];
        if (found != count) {
            return std::to_string(found) + " edges of kind " +
                   std::to_string(static_cast<int>(kind));
        }
    }
    return "";
}

void ask_pieces(const HardSurface& hard, Scoreboard& board, bool few) {
    const auto ask = [&](const TestMesh& of, const std::string& change) {
        const mesh::Mesh mesh = mesh::weld(soup_of(of)).mesh;
        PieceJudge judge(hard, mesh);
        for (std::size_t i = 0; i < kOrders.size(); ++i) {
            const SurfacePieces pieces = convex::find_surface_pieces(mesh, {.order = kOrders[i]});
            std::string flaw = judge.flaw_of(pieces);
            if (flaw.empty()) flaw = flaw_of(hard, pieces, kOrders[i]);
            board.of(hard.id, std::string("pieces/") + kOrderNames[i]).expect(flaw.empty(), [&] {
                return hard.id + ": " + change + ": " + flaw;
            });
        }
    };
    ask(relabelled(hard.mesh, 1).mesh, "relabelled");
    for (const ExactChange& change : exact_changes(few)) {
        if (const auto mesh = change(hard.mesh)) ask(*mesh, change.name);
    }
}

/// What is found of surfaces, by rule, is known by hand.
void ask_findings(const HardCaseOptions& options, Scoreboard& board) {
    const auto expect = [&](const std::string& id, bool is_right) {
        if (!options.wants(id)) return;
        board.of(id, "findings").expect(is_right, [&] { return id; });
    };
    const auto report_of = [](const TestMesh& mesh) { return mesh::find_defects(soup_of(mesh)); };
    const double place = 0x1p40, thickness = std::nextafter(place, 2 * place) - place;
    TestMesh box = unit_cube();
    for (Double3& p : box.positions) p.z = place + p.z * thickness;
    expect("D04 a thin shell has its volume", report_of(box).verdicts[1].volume == thickness);
    expect("D05 three sheets", report_of(three_sheets()).counts.non_manifold_edges == 1);
    const TestMesh corner = joined(unit_cube(), moved_by(unit_cube(), 1, {1, 1, 1}));
    expect("D05 a pinched vertex", report_of(corner).counts.non_manifold_vertices == 1);
    const mesh::DefectReport bottle =
        mesh::find_defects(soup_of(klein_bottle(6, 7)), {.crossings = false});
    expect("D06 a Klein bottle",
           bottle.counts.non_orientable_components == 1 && bottle.counts.inconsistent_edges == 7);
    expect("D06 a Moebius strip",
           report_of(moebius_strip(16)).counts.non_orientable_components == 1);
    const mesh::DefectReport half = report_of(upper_half(icosphere(3)));
    expect("D07 a hemisphere", half.counts.boundary_loops == 1 && half.verdicts[1].euler == 1);
    expect("D11 a coplanar strip", report_of(grid_sheet(100, 50)).findings.size() == 2);
}

constexpr std::array kPresets = {"safe", "closed", "solid"};

/// Every source triangle is accounted for. These soups have corners out of range, which no import
/// leaves.
void ask_repairs(const ZooAnimal& animal, std::span<const char* const> presets, Scoreboard& board) {
    for (const char* preset : presets) {
        mesh::RepairOptions options;
        options.steps = *mesh::find_repair_preset(preset);
        const mesh::Repaired mended = mesh::repair(soup_of(animal.mesh), options);
        const mesh::RepairCounts& counts = mended.report.counts;
        const bool adds_up =
            counts.kept + counts.reversed + counts.cut + counts.dropped ==
                counts.source_triangles &&
            counts.source_triangles == animal.mesh.triangles.size() &&
            mended.mesh.triangles.size() + counts.dropped >= counts.source_triangles;
        board.of("D08", "repair").expect(adds_up, [&] {
            return "D08 " + animal.name + ", " + preset;
        });
    }
}

/// D08: each animal of the zoo, scaled and beside the next, has what is wrong with it; and what
/// a repair says it did adds up.
void ask_zoo(const HardCaseOptions& options, Scoreboard& board) {
    if (!options.wants("D08")) return;
    const std::vector<ZooAnimal> zoo = defect_zoo();
    for (std::size_t i = 0; i < zoo.size(); ++i) {
        const ZooAnimal both = side_by_side(zoo[i], zoo[(i + 5) % zoo.size()]);
        for (const ZooAnimal& animal : {zoo[i], both}) {
            for (const int exponent : {0, -40, -20, 20, 40}) {
                mesh::DefectOptions wide;
                wide.weld_distance = wide.seam_width = std::ldexp(kZooWidth, exponent);
                std::map<int, std::uint64_t> expected = animal.found, found;
                if (animal.components > 1) expected[404] = animal.components;
                const auto told = [&] {
                    return "D08 " + animal.name + " times 2^" + std::to_string(exponent);
                };
                const TestMesh mesh = scaled_by(animal, exponent).mesh;
                const mesh::DefectReport report = mesh::find_defects(soup_of(mesh), wide);
                for (const mesh::Finding& finding : report.findings) {
                    found[static_cast<int>(finding.rule)] = finding.count;
                }
                board.of("D08", "findings").expect(found == expected, told);
                if (exponent != 0) continue;
                const std::size_t meet = epeck_meeting_pairs(mesh);
                board.of("D08", "EPECK")
                    .expect(report.counts.self_intersecting_pairs == meet, told);
            }
        }
        ask_repairs(zoo[i], kPresets, board);
        // In the short form one preset in turn.
        const bool all = options.size == CaseSize::full || asks_all();
        const auto in_turn = std::span(kPresets).subspan(i % kPresets.size(), 1);
        ask_repairs(both, all ? kPresets : in_turn, board);
    }
}

/// D09: parts stick out of a wall by what is permitted and no more: what is left of a slot
/// between two walls is free for a probe that is narrower by twice that. Where less is reached
/// than was asked for, the parts say so, and that counts as missed.
void ask_slots(const HardCaseOptions& options, Scoreboard& board) {
    if (!options.wants("D09")) return;
    for (const double width : {0.5, 0.125}) {
        TestMesh block = u_prism();  // the slot is 1 <= x <= 2, y >= 1
        for (Double3& p : block.positions) p.x = p.x >= 2 ? p.x - 1 + width : p.x;
        const mesh::Mesh mesh = mesh::weld(soup_of(block)).mesh;
        convex::ApproximateOptions permitted;
        permitted.max_error = 0.45 * width;
        const convex::ApproximateParts parts = convex::find_approximate_parts(mesh, permitted);
        // In the middle of the slot, well above its ground.
        const SmallHull probe(box_corners(0.04 * width, 0.2, 0.2));
        const Placement placement = Placement::b_moves(
            Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, 1 + width / 2, 1.75, 0.5}).value());
        bool collides = false;
        for (const convex::ApproximatePart& part : parts.parts) {
            const SmallHull hull(part.hull.points);
            collides = collides || convex_collide(hull.view(), probe.view(), placement);
        }
        Tally& tally = board.of("D09", "enclosing");
        const auto told = [&] { return "D09 a slot of width " + std::to_string(width); };
        tally.expect(parts.proof.outside == 0, told);
        if (!parts.is_as_asked) {
            tally.expect(parts.outer_error > *permitted.max_error, told);
            ++tally.missed;
            continue;
        }
        tally.expect(!collides, told);
        tally.expect_narrow(parts.outer_error, *permitted.max_error, told);
    }
}

}  // namespace

void score_surfaces(const HardCaseOptions& options, Scoreboard& board) {
    const bool full = options.size == CaseSize::full;
    for (const HardSurface& hard : hard_surfaces(full)) {
        constexpr std::size_t kMany = 30;
        if (options.wants(hard.id)) {
            ask_pieces(hard, board, !full || hard.mesh.triangles.size() > kMany);
        }
    }
    ask_findings(options, board);
    ask_zoo(options, board);
    ask_slots(options, board);
}

}  // namespace cdprep::test
