// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/feature_probes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "cdprep/cells/overlap_through.h"
#include "compare/strategy.h"
#include "study/cells.h"

namespace cdprep::study {
namespace {

using format::Double3;

/// Returns a closed box from 0 to 1 along each axis, wound outwards.
StudyMesh unit_box() {
    StudyMesh box;
    box.name = "box";
    for (std::uint32_t i = 0; i < 8; ++i) {
        box.mesh.positions.push_back({static_cast<double>(i & 1U),
                                      static_cast<double>(i >> 1U & 1U),
                                      static_cast<double>(i >> 2U)});
        box.mesh.source_vertex.push_back(i);
    }
    box.mesh.triangles = {{{0, 2, 1}}, {{1, 2, 3}}, {{4, 5, 6}}, {{5, 7, 6}},
                          {{0, 1, 4}}, {{1, 5, 4}}, {{2, 6, 3}}, {{3, 6, 7}},
                          {{0, 4, 2}}, {{2, 4, 6}}, {{1, 3, 5}}, {{3, 7, 5}}};
    box.mesh.single_precision = true;
    return box;
}

StudyMesh of_corners(const char* name, std::vector<Double3> corners) {
    StudyMesh made;
    made.name = name;
    made.mesh.positions = std::move(corners);
    for (std::uint32_t i = 0; i < made.mesh.positions.size(); ++i) {
        made.mesh.source_vertex.push_back(i);
    }
    for (std::uint32_t i = 0; i + 2 < made.mesh.positions.size(); i += 3) {
        made.mesh.triangles.push_back({{i, i + 1, i + 2}});
    }
    made.mesh.single_precision = true;
    return made;
}

/// Returns two level triangles, one a unit above the other.
StudyMesh two_floors() {
    return of_corners("two floors",
                      {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 1}, {4, 0, 1}, {0, 4, 1}});
}

/// Returns an upright triangle, from its tip at 1, 1, 0 up to 0.5.
StudyMesh wedge() {
    return of_corners("wedge", {{1, 1, 0}, {1.5, 1, 0.5}, {0.5, 1, 0.5}});
}

/// The models that the probes query.
struct Probed {
    ModelForms box;
    ModelForms floors;
    ModelForms wedge;
};

Result<Probed> make_probed() {
    Result<ModelForms> box = make_model_forms(unit_box(), serial_for);
    if (!box) return box.error();
    Result<ModelForms> floors = make_model_forms(two_floors(), serial_for);
    if (!floors) return floors.error();
    Result<ModelForms> upright = make_model_forms(wedge(), serial_for);
    if (!upright) return upright.error();
    return Probed{std::move(box).value(), std::move(floors).value(), std::move(upright).value()};
}

Placement moved_by(double x, double y, double z) {
    Pose pose;
    const std::array<double, 12> rows = {1, 0, 0, 0, 1, 0, 0, 0, 1, x, y, z};
    if (auto made = Pose::from_rows(rows)) pose = made.value();
    return Placement::b_moves(pose);
}

/// Probes a box against a box: apart, face on face, corner on corner, and overlapping.
std::string probe_collide(const Strategy& strategy, const Probed& probed) {
    StrategyPair pair(strategy, probed.box, probed.box);
    if (pair.collides(moved_by(1.5, 0.25, 0))) return "boxes half a unit apart collide";
    if (!pair.collides(moved_by(1, 0.25, 0.5))) return "boxes with a common face do not collide";
    if (!pair.collides(moved_by(1, 1, 1))) return "boxes with a common corner do not collide";
    if (!pair.collides(moved_by(0.5, 0.25, 0.125))) return "boxes that cross do not collide";
    return "";
}

/// Probes the wedge with no floor, the lower floor at its tip, either floor, or both.
std::string probe_overlap(const Strategy& strategy, const Probed& probed) {
    StrategyPair pair(strategy, probed.floors, probed.wedge);
    const auto finds = [&](double z, const std::vector<TrianglePair>& expected) {
        return std::ranges::equal(pair.pairs(moved_by(0, 0, z)), expected);
    };
    if (!finds(0.25, {})) return "a triangle between two overlaps one";
    if (!finds(0, {{0, 0}})) return "a corner on a triangle is not its only overlap";
    if (!finds(-0.25, {{0, 0}})) return "a triangle through one is not its only overlap";
    if (!finds(0.75, {{1, 0}})) return "a triangle through the other is not its only overlap";
    if (!finds(0.5, {{1, 0}})) return "an edge on a triangle is not its only overlap";
    return "";
}

/// Probes distances that are exact in float: an interval must contain them too.
std::string probe_distance(const Strategy& strategy, const Probed& probed) {
    StrategyPair pair(strategy, probed.box, probed.box);
    struct Case {
        Placement placement;
        double distance;
        const char* what;
    };
    const std::array<Case, 3> cases = {{{moved_by(1.5, 0.25, 0), 0.5, "face to face"},
                                        {moved_by(4, 5, 0), 5, "edge to edge"},
                                        {moved_by(1, 0.25, 0.5), 0, "touching"}}};
    for (const auto& [placement, distance, what] : cases) {
        const Gap gap = pair.gap(placement);
        constexpr double kSlack = 1e-12;  // lower and upper may differ by a few ulps
        if (gap.lower <= distance && distance <= gap.upper && gap.upper - gap.lower <= kSlack) {
            continue;
        }
        return std::string("boxes ") + what + " are " + formatted("%g", distance) + " apart, not " +
               formatted("%.17g", gap.lower) + " to " + formatted("%.17g", gap.upper);
    }
    return "";
}

/// Probes that the limit is inclusive.
std::string probe_within(const Strategy& strategy, const Probed& probed) {
    StrategyPair pair(strategy, probed.box, probed.box);
    const Placement apart = moved_by(1.5, 0.25, 0);
    if (!pair.is_within(apart, 0.5)) return "boxes 0.5 apart are not within 0.5";
    if (pair.is_within(apart, std::nextafter(0.5, 0.0)))
        return "boxes 0.5 apart are within less than 0.5";
    if (!pair.is_within(moved_by(1, 0.25, 0.5), 0)) return "boxes that touch are not within 0";
    return "";
}

/// Probes boxes face to face, a sixteenth apart: the normal is along x, and the distance is known.
std::string probe_contacts(const Strategy& strategy, const Probed& probed) {
    StrategyPair pair(strategy, probed.box, probed.box);
    constexpr double kGap = 0.0625;
    const Placement apart = moved_by(1 + kGap, 0.25, 0.25);
    std::array<Contact, 8> room{};
    const std::size_t count = pair.contacts(apart, 2 * kGap, room);
    if (count == 0) return "faces within the tolerance have no contact";
    const Contact& first = room[0];
    if (std::fabs(first.normal.x - 1) > 1e-9) return "the normal between parallel faces is wrong";
    if (first.lower > kGap || first.upper < kGap) return "the distance of a contact is wrong";
    if (first.feature_a.triangle >= 12) return "a contact has no triangle";
    if (pair.contacts(apart, kGap / 2) != 0) return "faces beyond the tolerance have a contact";
    return "";
}

struct Feature {
    const char* name;
    Asked asked;
    std::string (*probe)(const Strategy&, const Probed&);
    /// The cells of Table 1 of the comparative study for Feito, GJK, PQP and SWIFT++.
    std::array<bool, 4> published;
};
constexpr std::array<Feature, 5> kFeatures = {{
    {"Collision", Asked::collide, probe_collide, {true, true, true, true}},
    {"Overlapping triangles", Asked::overlap, probe_overlap, {true, false, true, false}},
    {"Distance", Asked::distance, probe_distance, {false, true, true, true}},
    {"Tolerance", Asked::within, probe_within, {false, false, true, true}},
    {"Contact features", Asked::contacts, probe_contacts, {false, false, false, true}},
}};

/// A column of ours, and the published column beside it.
struct Probing {
    const char* key;
    const char* title;
    const char* name;     ///< of the strategy
    const char* setting;  ///< of the strategy
    int published;        ///< in Feature::published; -1: none
};
constexpr std::array<Probing, 7> kProbings = {{
    {"octree", "octree (Feito)", "octree", "paper", 0},
    {"hashed_octree", "hashed octree (Feito)", "hashed octree", "paper", 0},
    {"tetra_tree", "tetra-tree (Feito)", "tetra-tree", "paper", 0},
    {"gjk", "GJK on hulls", "GJK on hulls", "", 1},
    {"pqp_style", "PQP-style BVH", "PQP-style BVH", "", 2},
    {"pieces", "SWIFT++-style pieces", "SWIFT++-style pieces", "", 3},
    {"bvh", "exact BVH", "exact BVH", "", -1},
}};

/// Returns the strategy of a column. In the comparative study, triangles in cells are compared by
/// the test of Feito and Torres (1997).
Strategy strategy_of(const Probing& probing) {
    const auto all = strategies();
    Strategy found = *std::ranges::find_if(all, [&](const Strategy& strategy) {
        return strategy.name == std::string(probing.name) &&
               strategy.setting == std::string(probing.setting);
    });
    if (probing.published == 0) found.through.leaf_test = LeafTest::feito_torres;
    return found;
}

Cell probed_cell(const Feature& feature, const Strategy& strategy, const Probed& probed) {
    const StrategyPair pair(strategy, probed.box, probed.box);
    std::string reason = pair.find_reason(feature.asked);
    if (!reason.empty()) return without(std::move(reason));
    const std::string wrong = feature.probe(strategy, probed);
    return wrong.empty() ? word("X") : without("the probe failed: " + wrong);
}

}  // namespace

Result<Table> feature_table() {
    const Result<Probed> probed = make_probed();
    if (!probed) return probed.error();
    Table table = {
        "1",
        "Features of each strategy: X where a probe passed",
        "feature",
        {},
        {},
        {"Probes query boxes and triangles whose answers are known by hand. Triangles in cells of "
         "octrees and tetra-trees are compared by the segment test of Feito and Torres (1997).",
         "GJK on hulls: X means that the answer for the convex hulls is right. Hulls fit concave "
         "models badly."}};
    for (const Probing& probing : kProbings) {
        table.columns.push_back({probing.key, probing.title, Unit::none});
    }
    for (const Feature& feature : kFeatures) {
        Row row{feature.name, {}};
        for (const Probing& probing : kProbings) {
            Cell cell = probed_cell(feature, strategy_of(probing), probed.value());
            if (probing.published >= 0) {
                const bool has = feature.published[static_cast<std::size_t>(probing.published)];
                cell.published = Published{.text = has ? "X" : "-"};
            }
            row.cells.push_back(std::move(cell));
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

Check feature_check(const Table& table) {
    Check check;
    check.claim = "No feature of Table 1 of the comparative study is missing";
    check.verdict = Verdict::holds;
    check.is_promise = true;
    std::size_t passed = 0;
    std::size_t more = 0;
    for (const Row& row : table.rows) {
        for (std::size_t c = 0; c < row.cells.size(); ++c) {
            const Cell& cell = row.cells[c];
            const bool is_published = cell.published && cell.published->text == "X";
            if (cell.is_filled()) {
                ++passed;
                if (cell.published && !is_published) ++more;
            } else if (is_published) {
                check.verdict = Verdict::fails;
                check.evidence +=
                    row.label + ", " + table.columns[c].title + ": " + cell.reason + "; ";
            }
        }
    }
    check.evidence += std::to_string(passed) + " probes passed, " + std::to_string(more) +
                      " of them for features that the comparative study does not have";
    return check;
}

}  // namespace cdprep::study
