// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/pruning.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <string>
#include <utility>

#include "cdprep/advanced/convex_distance.h"
#include "cdprep/advanced/object_box.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/cells.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/hulls.h"
#include "cdprep/points.h"
#include "cdprep/pose.h"
#include "cell_searches/literal_octree.h"
#include "cell_searches/potential_set.h"
#include "study/cells.h"
#include "study/source_triangles.h"

namespace cdprep::study {
namespace {

constexpr std::array<double Pruning::*, 16> kMembers = {
    &Pruning::pairs,  &Pruning::found,          &Pruning::cs_a,
    &Pruning::cs_b,   &Pruning::literal_cs_a,   &Pruning::literal_cs_b,
    &Pruning::all_b,  &Pruning::box_b,          &Pruning::cluster_b,
    &Pruning::slab_b, &Pruning::leaf_b,         &Pruning::pcs_b,
    &Pruning::held_b, &Pruning::listed_literal, &Pruning::listed_repaired,
    &Pruning::lost};
static_assert(sizeof(Pruning) == kMembers.size() * sizeof(double));

double as_double(std::size_t count) {
    return static_cast<double>(count);
}

double distinct(const std::vector<TrianglePair>& pairs, std::uint32_t TrianglePair::*side) {
    std::vector<std::uint32_t> numbers;
    numbers.reserve(pairs.size());
    for (const TrianglePair& pair : pairs) numbers.push_back(pair.*side);
    std::ranges::sort(numbers);
    return static_cast<double>(std::unique(numbers.begin(), numbers.end()) - numbers.begin());
}

/// One placement of two models, with the data to query it.
class Placed {
public:
    Placed(const Model& a, const Model& b, const Placement& placement, CellSearch search,
           Workspace& workspace)
        : a_(a), b_(b), placement_(placement), search_(search), workspace_(workspace) {}

    [[nodiscard]] std::vector<TrianglePair> pairs() {
        const Pair pair = {a_, b_, placement_};
        std::vector<TrianglePair> found(overlaps(pair, workspace_, {}));
        found.resize(overlaps(pair, workspace_, found));
        return found;
    }
    /// Returns the counts of this library's form of the search.
    [[nodiscard]] QueryCounts repaired_counts() {
        QueryCounts counts;
        workspace_.count_into(&counts);
        static_cast<void>(overlaps_through(
            {a_, b_, placement_}, {.structure = Structure::hashed_octree, .search = search_},
            workspace_, {}));
        workspace_.count_into(nullptr);
        return counts;
    }
    /// Returns the pairs that the literal search finds, sorted, and its counts.
    [[nodiscard]] std::vector<TrianglePair> literal_pairs(QueryCounts& counts) {
        std::vector<TrianglePair> found;
        const auto keep = [&](const TrianglePair& pair) {
            found.push_back(pair);
            return true;
        };
        visit_literal_overlaps(a_, b_, placement_, {.search = search_, .counts = &counts}, keep);
        std::ranges::sort(found);
        return found;
    }
    /// Returns the groups that the oriented boxes do not clip.
    [[nodiscard]] GroupsOfBoth groups(std::uint32_t height) const {
        return groups_in_boxes(a_, b_, placement_, height);
    }
    /// Returns those of the groups whose extents meet.
    [[nodiscard]] GroupsOfBoth in_slabs(const GroupsOfBoth& groups) const {
        return groups_in_slabs(a_, b_, placement_, groups);
    }

private:
    const Model& a_;
    const Model& b_;
    const Placement& placement_;
    CellSearch search_;
    Workspace& workspace_;
};

bool meet(const WorldBox& a, const WorldBox& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (a.lower[k] > b.upper[k] || b.lower[k] > a.upper[k]) return false;
    }
    return true;
}

/// Returns how many of the pairs have a triangle that one of the steps does not keep.
std::size_t lost_pairs(const Model& a, const Model& b, const std::vector<TrianglePair>& pairs,
                       std::initializer_list<const GroupsOfBoth*> steps) {
    const SourceTriangles of_a(a), of_b(b);
    return static_cast<std::size_t>(std::ranges::count_if(pairs, [&](const TrianglePair& pair) {
        return std::ranges::any_of(steps, [&](const GroupsOfBoth* step) {
            return !step->a.has(of_a.place(pair.a)) || !step->b.has(of_b.place(pair.b));
        });
    }));
}

constexpr const char* kLostKey = "lost";

/// More than rounding moves the points of models with a diagonal of 1 that are near each other.
constexpr double kMovedRounding = 0x1p-40;

/// A column of the table, and its number.
template <class Numbers>
struct NumberColumn {
    const char* key;
    const char* title;
    double Numbers::*member;
};
using ObjectColumn = NumberColumn<ObjectPruning>;
using PruningColumn = NumberColumn<Pruning>;

constexpr std::array<ObjectColumn, 3> kObjectColumns = {{
    {"boxes", "boxes meet", &ObjectPruning::boxes},
    {"oriented", "oriented boxes meet", &ObjectPruning::oriented},
    {"hulls", "hulls touch", &ObjectPruning::hulls},
}};
static_assert(sizeof(ObjectPruning) == kObjectColumns.size() * sizeof(double));

constexpr std::array<PruningColumn, 15> kColumns = {{
    {"all_b", "triangles of B", &Pruning::all_b},
    {"box_b", "in A's box", &Pruning::box_b},
    {"cluster_b", "clusters not clipped", &Pruning::cluster_b},
    {"slab_b", "clusters in slabs", &Pruning::slab_b},
    {"leaf_b", "leaves not clipped", &Pruning::leaf_b},
    {"pcs_b", "PCS of B", &Pruning::pcs_b},
    {"held_b", "kept, repaired", &Pruning::held_b},
    {"cs_a", "CS of A", &Pruning::cs_a},
    {"cs_b", "CS of B", &Pruning::cs_b},
    {"literal_cs_a", "literal CS of A", &Pruning::literal_cs_a},
    {"literal_cs_b", "literal CS of B", &Pruning::literal_cs_b},
    {"pairs", "pairs", &Pruning::pairs},
    {"listed_literal", "listed, literal", &Pruning::listed_literal},
    {"listed_repaired", "listed, repaired", &Pruning::listed_repaired},
    {kLostKey, "pairs lost", &Pruning::lost},
}};

}  // namespace

Pruning& Pruning::operator+=(const Pruning& other) noexcept {
    for (double Pruning::*member : kMembers) this->*member += other.*member;
    return *this;
}

Pruning& Pruning::operator/=(double count) noexcept {
    for (double Pruning::*member : kMembers) this->*member /= count;
    return *this;
}

ObjectPruning& ObjectPruning::operator+=(const ObjectPruning& other) noexcept {
    for (const ObjectColumn& column : kObjectColumns) this->*column.member += other.*column.member;
    return *this;
}

ObjectPruning& ObjectPruning::operator/=(double count) noexcept {
    for (const ObjectColumn& column : kObjectColumns) this->*column.member /= count;
    return *this;
}

ObjectPruning prune_objects(const Model& a, const Model& b, const Pose& a_from_b) {
    const RootBox root_a = root_box(a, Pose(), 0), root_b = root_box(b, a_from_b, 0);
    const auto hull_of = [](const Model& model) {
        return convex_points(model, find_hull(model, format::HullScope::whole).value());
    };
    const auto share = [](bool meets) { return meets ? 1.0 : 0.0; };
    return {.boxes = share(meet(world_box(root_a), world_box(root_b))),
            .oriented = share(may_meet(root_a, root_b)),
            .hulls = share(convex_within(hull_of(a), hull_of(b), Placement::b_moves(a_from_b),
                                         kMovedRounding))};
}

bool keeps_models(const ObjectPruning& pruning) noexcept {
    return std::ranges::all_of(
        kObjectColumns, [&](const ObjectColumn& column) { return pruning.*column.member > 0; });
}

Pruning prune(const Model& a, const Model& b, const Pose& a_from_b, CellSearch search,
              Workspace& workspace, std::vector<TrianglePair>& missed) {
    const Placement placement = Placement::b_moves(a_from_b);
    Placed asked(a, b, placement, search, workspace);
    const auto all = asked.pairs();
    QueryCounts literal;
    const auto found = asked.literal_pairs(literal);
    missed.clear();
    std::ranges::set_difference(all, found, std::back_inserter(missed));
    const QueryCounts repaired = asked.repaired_counts();
    const GroupsOfBoth leaves = asked.groups(kLeaf), clusters = asked.groups(kCluster);
    const GroupsOfBoth in_slabs = asked.in_slabs(clusters);
    const Box box = {a.record().bounds->lower, a.record().bounds->upper};
    return {.pairs = as_double(all.size()),
            .found = as_double(found.size()),
            .cs_a = distinct(all, &TrianglePair::a),
            .cs_b = distinct(all, &TrianglePair::b),
            .literal_cs_a = distinct(found, &TrianglePair::a),
            .literal_cs_b = distinct(found, &TrianglePair::b),
            .all_b = as_double(b.triangle_count()),
            .box_b = as_double(
                touching_triangles(b, box, workspace, {}, {.world_from_model = a_from_b})),
            .cluster_b = as_double(clusters.b.triangles_of(b)),
            .slab_b = as_double(in_slabs.b.triangles_of(b)),
            .leaf_b = as_double(leaves.b.triangles_of(b)),
            .pcs_b = as_double(literal.potential),
            .held_b = as_double(repaired.potential),
            .listed_literal = as_double(literal.references),
            .listed_repaired = as_double(repaired.references),
            .lost = as_double(lost_pairs(a, b, all, {&leaves, &clusters, &in_slabs}))};
}

namespace {

/// What the steps leave of a pair, as means of some poses.
struct MeanPruning {
    ObjectPruning objects;
    Pruning triangles;
};

MeanPruning prune_at(const PairStudy& study, const std::vector<std::size_t>& poses,
                     std::span<const ModelForms* const> forms, Workspace& workspace) {
    const Model &plain_a = forms[study.a]->plain.model, &plain_b = forms[study.b]->plain.model;
    const Model& a = forms[study.a]->tuned_hashed.model;
    const Model& b = forms[study.b]->tuned_hashed.model;
    std::vector<TrianglePair> missed;
    MeanPruning sum;
    for (const std::size_t number : poses) {
        const Pose& pose = study.poses.poses[number].a_from_b;
        const ObjectPruning objects = prune_objects(plain_a, plain_b, pose);
        Pruning triangles = prune(a, b, pose, CellSearch::modulus, workspace, missed);
        if (!keeps_models(objects)) triangles.lost = triangles.pairs;
        sum.objects += objects;
        sum.triangles += triangles;
    }
    sum.objects /= as_double(poses.size());
    sum.triangles /= as_double(poses.size());
    return sum;
}

std::vector<Cell> pruning_cells(const MeanPruning& mean) {
    std::vector<Cell> cells;
    cells.reserve(kObjectColumns.size() + kColumns.size() + 1);
    for (const ObjectColumn& column : kObjectColumns) {
        cells.push_back(number(mean.objects.*column.member));
    }
    for (const PruningColumn& column : kColumns) {
        cells.push_back(number(mean.triangles.*column.member));
    }
    cells.push_back(mean.triangles.pairs > 0 ? number(mean.triangles.found / mean.triangles.pairs)
                                             : without("nothing overlaps"));
    return cells;
}

}  // namespace

Table pruning_table(const std::vector<StudyMesh>& meshes, const std::vector<PairStudy>& studies,
                    std::span<const ModelForms* const> forms) {
    Table table = {
        "talk",
        "Triangles that each step of Ponce Atencio's search leaves, means over the poses",
        "pair, poses",
        {},
        {},
        {"Boxes, oriented boxes and hulls are those of whole models: the share of poses at which "
         "they meet. PCS: the potentially colliding set, the triangles of B that A's oriented box "
         "does not clip. Leaves have up to 8 triangles, clusters up to 64. In slabs: along each of "
         "13 directions, a cluster's extent meets that of some cluster of A. CS: the colliding "
         "set, the triangles in overlapping pairs. Literal: the search looks up cells only at the "
         "corners of B's triangles, so it misses pairs. Repaired: it looks up all cells that a "
         "triangle overlaps. Listed: triangles in the lists of these cells. Lost: pairs with a "
         "triangle that a step excludes.",
         "Hashed octrees have the setting 'tuned': 6 levels, and cells of fewer than 32 triangles "
         "are not divided. Cells are found by the last bits of the key, as Ponce Atencio "
         "describes."}};
    for (const ObjectColumn& column : kObjectColumns) {
        table.columns.push_back({column.key, column.title, Unit::share});
    }
    for (const PruningColumn& column : kColumns) {
        table.columns.push_back({column.key, column.title, Unit::count});
    }
    table.columns.push_back({"recall", "literal recall", Unit::share});
    Workspace workspace(cells());
    for (const PairStudy& study : studies) {
        for (const Stratum stratum : {Stratum::deep, Stratum::shallow, Stratum::near}) {
            const std::vector<std::size_t> poses = study.poses.of(stratum);
            const std::string name = kStratumNames[static_cast<std::size_t>(stratum)];
            Row row{meshes[study.a].name + " x " + meshes[study.b].name + ", " + name, {}};
            if (poses.empty()) {
                row.cells.assign(table.columns.size(), without("no pose is " + name));
            } else {
                row.cells = pruning_cells(prune_at(study, poses, forms, workspace));
            }
            table.rows.push_back(std::move(row));
        }
    }
    return table;
}

namespace {

Check check_recall(const Table& table) {
    Check check;
    check.claim = "Ponce Atencio's search at the corners of triangles finds every overlapping pair";
    double least = 1;
    std::string where;
    std::size_t asked = 0;
    for (const Row& row : table.rows) {
        const auto& recall = row.cells.back().value;
        if (!recall) continue;
        ++asked;
        if (*recall < least) {
            least = *recall;
            where = row.label;
        }
    }
    if (asked == 0) return check;
    check.verdict = verdict_of(least == 1);
    check.evidence =
        "in " + std::to_string(asked) + " sets of poses, " +
        (where.empty()
             ? "all pairs are found"
             : "the smallest share of pairs found is " + formatted("%.4f", least) + " (" + where +
                   "): a triangle may cross cells in which it has no corner. The repaired search "
                   "looks up all cells that a triangle overlaps, and finds all pairs");
    return check;
}

Check check_groups(const Table& table) {
    Check check;
    check.claim = "Every step of pruning keeps both triangles of every overlapping pair";
    check.is_promise = true;
    const auto found = std::ranges::find(table.columns, kLostKey, &Column::key);
    if (found == table.columns.end()) return check;
    const auto column = static_cast<std::size_t>(found - table.columns.begin());
    double most = 0;
    std::string where;
    std::size_t asked = 0;
    for (const Row& row : table.rows) {
        // A recall says that there are overlapping pairs.
        if (!row.cells.back().value || !row.cells[column].value) continue;
        ++asked;
        if (*row.cells[column].value > most) {
            most = *row.cells[column].value;
            where = row.label;
        }
    }
    if (asked == 0) return check;
    check.verdict = verdict_of(most == 0);
    check.evidence = "in " + std::to_string(asked) + " sets of poses, " +
                     (where.empty() ? "no pair is lost"
                                    : "the worst loses " + formatted("%.4g", most) +
                                          " pairs per pose (" + where + ")");
    return check;
}

}  // namespace

std::vector<Check> pruning_checks(const Table& table) {
    return {check_recall(table), check_groups(table)};
}

}  // namespace cdprep::study
