// SPDX-License-Identifier: GPL-3.0-or-later
#include "cell_searches/spatial_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "study/cells.h"

namespace cdprep::study {
namespace {

constexpr std::array<const char*, 5> kKindNames = {"tetra-tree", "octree", "hashed octree",
                                                   "adaptive, median", "adaptive, area"};

const SpatialBuild* find_build(const SpatialMesh& mesh, const std::string& setting,
                               SpatialKind kind) {
    const auto at = std::find_if(
        mesh.builds.begin(), mesh.builds.end(),
        [&](const SpatialBuild& build) { return build.setting == setting && build.kind == kind; });
    return at == mesh.builds.end() ? nullptr : &*at;
}

/// Adds the published figures to the cells for seconds and size.
void set_beside(const Likeness& likeness, SpatialKind kind, Cell& seconds, Cell& size) {
    const PublishedBuild* published = find_published_build(likeness, kind);
    if (published == nullptr) {
        const bool is_published = kind == SpatialKind::tetra_tree || kind == SpatialKind::octree;
        if (is_published) seconds.published = size.published = beside(likeness, 0);
        return;
    }
    seconds.published = beside(likeness, published->seconds);
    size.published = beside(likeness, published->mebibytes, published->erratum);
}

/// Returns the largest number of nodes for a tetra-tree of the published size, with one reference
/// for each of the published triangles.
double node_bound(const PublishedModel& model) {
    constexpr double kRoot = 340;
    constexpr double kNode = 88;
    const double bytes = model.tetra_tree.mebibytes * kMebibyte;
    return std::floor((bytes - kRoot - 4.0 * model.triangles) / kNode);
}

Check order_of_builds(const SpatialMesh& mesh) {
    Check check;
    check.claim = mesh.mesh->name + ": the tetra-tree is built faster than the octree (Table 2)";
    bool holds = true;
    for (const char* setting : {"paper", "tuned"}) {
        const SpatialBuild* tetra = find_build(mesh, setting, SpatialKind::tetra_tree);
        const SpatialBuild* octree = find_build(mesh, setting, SpatialKind::octree);
        if (tetra == nullptr || octree == nullptr) return check;
        const double one = octree->one.median_s / tetra->one.median_s;
        const double all = octree->all.median_s / tetra->all.median_s;
        if (std::string(setting) == "paper") holds = one > 1;
        check.evidence += std::string(check.evidence.empty() ? "" : "; ") + setting +
                          ": the octree takes " + formatted("%.2f", one) +
                          " times as long on one thread, " + formatted("%.2f", all) +
                          " times on all threads";
    }
    const auto& likeness = mesh.mesh->likeness;
    if (likeness.model) {
        const PublishedModel& model = kPublished[*likeness.model];
        check.evidence +=
            "; published " + formatted("%.2f", model.octree.seconds / model.tetra_tree.seconds);
    }
    if (!holds) {
        const SpatialBuild* tetra = find_build(mesh, "paper", SpatialKind::tetra_tree);
        const SpatialBuild* octree = find_build(mesh, "paper", SpatialKind::octree);
        check.evidence +=
            ". Octree cells follow from keys, in one pass per level, but triangles are tested "
            "against cones exactly. References: " +
            std::to_string(octree->figures.references) + " in the octree, " +
            std::to_string(tetra->figures.references) + " in the tetra-tree";
    }
    check.verdict = verdict_of(holds);
    return check;
}

Check bound_of_nodes(const SpatialMesh& mesh, const PublishedModel& model) {
    const double bound = node_bound(model);
    Check check;
    check.claim = mesh.mesh->name + ": the published size leaves room for at most " +
                  formatted("%.0f", bound) + " nodes of a tetra-tree";
    const SpatialBuild* paper = find_build(mesh, "paper", SpatialKind::tetra_tree);
    const SpatialBuild* nearest = find_build(mesh, "nearest", SpatialKind::tetra_tree);
    const SpatialBuild* asked = nearest != nullptr ? nearest : paper;
    check.evidence = "setting 'paper': " + std::to_string(paper->figures.nodes_all);
    if (nearest != nullptr) {
        check.evidence +=
            "; setting nearest in size: " + std::to_string(nearest->figures.nodes_all) +
            " (level " + std::to_string(nearest->limits.level) + ", threshold " +
            std::to_string(nearest->limits.threshold) + ")";
    }
    const double nodes = static_cast<double>(asked->figures.nodes_all);
    check.verdict = verdict_of(nodes <= bound);
    if (nodes > bound) {
        const double listed = static_cast<double>(asked->figures.references) /
                              static_cast<double>(mesh.mesh->mesh.triangles.size());
        check.evidence +=
            ". The bound assumes that each triangle is listed once; here it is listed " +
            formatted("%.3f", listed) + " times on average, and empty cones count too";
    }
    return check;
}

/// Checks the mesh that is certainly the published one.
std::optional<Check> bunny_sizes(const SpatialMesh& mesh) {
    const Likeness& likeness = mesh.mesh->likeness;
    const bool is_bunny = likeness.model && likeness.mark == Mark::none &&
                          std::string(kPublished[*likeness.model].name) == "Bunny";
    if (!is_bunny) return std::nullopt;
    const auto size = [&](SpatialKind kind) {
        const auto bytes = find_build(mesh, "paper", kind)->figures.formula_all;
        return static_cast<double>(bytes) / kMebibyte;
    };
    const double tetra = size(SpatialKind::tetra_tree);
    const double octree = size(SpatialKind::octree);
    return Check{mesh.mesh->name +
                     ": with 512 leaf cells, the formula gives 0.37 to 0.43 MiB for the "
                     "tetra-tree and 0.33 to 0.35 for the octree",
                 formatted("%.4f", tetra) + " and " + formatted("%.4f", octree) + " MiB",
                 verdict_of(tetra >= 0.37 && tetra <= 0.43 && octree >= 0.33 && octree <= 0.35)};
}

}  // namespace

Table spatial_table(const std::vector<SpatialMesh>& meshes) {
    Table table = {"2",
                   "Pre-processing time and size of the spatial decompositions, 512 leaf cells "
                   "each",
                   "model",
                   {{"vertices", "vertices", Unit::count},
                    {"triangles", "triangles", Unit::count},
                    {"hash", "hash as read", Unit::none},
                    {"built_vertices", "built from: vertices", Unit::count},
                    {"built_triangles", "triangles", Unit::count},
                    {"tetra_tree_s", "tetra-tree", Unit::seconds},
                    {"tetra_tree_mib", "tetra-tree, MiB", Unit::mebibytes},
                    {"octree_s", "octree", Unit::seconds},
                    {"octree_mib", "octree, MiB", Unit::mebibytes}},
                   {},
                   {"Sizes by the published formula: 340 bytes for a tetra-tree's root, 88 for a "
                    "cone, 72 for an octree's root, 80 for a node, 4 for a reference.",
                    "One thread."}};
    for (const SpatialMesh& mesh : meshes) {
        const StudyMesh& of = *mesh.mesh;
        const auto counted = [&](std::size_t count, std::uint32_t PublishedModel::*member) {
            Cell cell = count_cell(count);
            if (const auto& model = of.likeness.version_of) {
                cell.published = beside(of.likeness, kPublished[*model].*member);
            }
            return cell;
        };
        Row row = {
            of.name,
            {counted(of.read_vertices, &PublishedModel::vertices),
             counted(of.read_triangles, &PublishedModel::triangles), word(hash_text(of.read_hash)),
             count_cell(of.mesh.positions.size()), count_cell(of.mesh.triangles.size())}};
        for (const SpatialKind kind : {SpatialKind::tetra_tree, SpatialKind::octree}) {
            const SpatialBuild& build = *find_build(mesh, "paper", kind);
            Cell seconds = seconds_cell(build.one);
            Cell size = size_cell(static_cast<double>(build.figures.formula_all));
            set_beside(of.likeness, kind, seconds, size);
            row.cells.push_back(std::move(seconds));
            row.cells.push_back(std::move(size));
        }
        table.rows.push_back(std::move(row));
        if (!of.likeness.version_of) {
            table.notes.push_back(of.name + " has no published figures: " + of.likeness.sentence +
                                  ".");
        }
    }
    return table;
}

Table spatial_details(const SpatialMesh& mesh) {
    const StudyMesh& of = *mesh.mesh;
    Table table = {
        "2." + of.name,
        "Spatial decompositions of " + of.name + ": " + of.likeness.sentence,
        "setting, structure",
        {{"level", "level", Unit::count},
         {"threshold", "threshold", Unit::count},
         {"seconds_1", "1 thread", Unit::seconds},
         {"seconds_all", "all threads", Unit::seconds},
         {"nodes", "nodes", Unit::count},
         {"nodes_stored", "non-empty nodes", Unit::count},
         {"leaves", "leaves", Unit::count},
         {"references", "references per triangle", Unit::none},
         {"largest_leaf", "largest leaf", Unit::count},
         {"formula_mib", "formula, MiB", Unit::mebibytes},
         {"formula_stored_mib", "formula, non-empty", Unit::mebibytes},
         {"real_mib", "actual, MiB", Unit::mebibytes}},
        {},
        {"Built from " + std::to_string(of.mesh.positions.size()) + " vertices and " +
         std::to_string(of.mesh.triangles.size()) + " triangles, hash " + hash_text(of.built_hash) +
         ". Threshold: cells of fewer triangles are not divided. The level of a tetra-tree is its "
         "number of splits; the published code counts one more."}};
    for (const SpatialBuild& build : mesh.builds) {
        const SpatialFigures& f = build.figures;
        Cell seconds = seconds_cell(build.one);
        Cell formula = size_cell(static_cast<double>(f.formula_all));
        if (build.setting != "tuned") set_beside(of.likeness, build.kind, seconds, formula);
        table.rows.push_back(
            {build.setting + ", " + kKindNames[static_cast<std::size_t>(build.kind)],
             {count_cell(build.limits.level), count_cell(build.limits.threshold),
              std::move(seconds), seconds_cell(build.all), count_cell(f.nodes_all),
              count_cell(f.nodes), count_cell(f.leaves),
              number(static_cast<double>(f.references) /
                     static_cast<double>(std::max<std::size_t>(1, of.mesh.triangles.size()))),
              count_cell(f.largest_leaf), std::move(formula),
              size_cell(static_cast<double>(f.formula)), size_cell(static_cast<double>(f.bytes))}});
    }
    return table;
}

std::vector<Check> spatial_checks(const std::vector<SpatialMesh>& meshes) {
    std::vector<Check> checks;
    checks.reserve(meshes.size());
    for (const SpatialMesh& mesh : meshes) checks.push_back(order_of_builds(mesh));
    for (const SpatialMesh& mesh : meshes) {
        const Likeness& likeness = mesh.mesh->likeness;
        if (!likeness.model) continue;
        checks.push_back(bound_of_nodes(mesh, kPublished[*likeness.model]));
        if (auto check = bunny_sizes(mesh)) checks.push_back(std::move(*check));
    }
    return checks;
}

}  // namespace cdprep::study
