// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/structure_report.h"

#include <algorithm>

#include "text/number_text.h"
#include "text/structure_name.h"

namespace cdprep::report {
namespace {

/// Returns the share of `part` in all triangles; 0 if there are no triangles.
double share(std::uint64_t part, std::uint64_t triangles) {
    return triangles == 0 ? 0 : static_cast<double>(part) / static_cast<double>(triangles);
}

nlohmann::ordered_json as_json(const StructureReport& report) {
    nlohmann::ordered_json json = {{"level", report.settings.level},
                                   {"threshold", report.settings.threshold}};
    for (const StructureRule& rule : report.settings.rules) json[rule.name] = rule.value;
    json["nodes"] = report.nodes;
    json["leaves"] = report.leaves;
    json["deepest"] = report.deepest;
    json["references"] = report.references;
    json["references_per_triangle"] = share(report.references, report.triangles);
    json["shared"] = report.shared;
    json["largest_leaf"] = report.largest_leaf;
    json["bytes"] = report.bytes;
    if (report.cones) {
        json["centre"] = report.cones->centre;
        json["at_centre"] = report.cones->at_centre;
        json["mean_layers"] = report.cones->mean_layers;
        json["most_layers"] = report.cones->most_layers;
        json["share_in_more_than_8_cones"] = share(report.cones->in_many, report.triangles);
    }
    return json;
}

std::string as_text(const StructureReport& report) {
    const StructureSettings& settings = report.settings;
    std::string text = "level " + std::to_string(settings.level) + ", threshold " +
                       std::to_string(settings.threshold);
    for (const StructureRule& rule : settings.rules) text += ", " + rule.name + " " + rule.value;
    text += ": " + std::to_string(report.nodes) + " nodes, " + std::to_string(report.leaves) +
            " leaves, " + fixed(share(report.references, report.triangles), 2) +
            " references per triangle, largest leaf " + std::to_string(report.largest_leaf) + ", " +
            std::to_string(report.bytes) + " bytes";
    if (!report.cones) return text;
    const ConeFigures& cones = *report.cones;
    return text + "; centre " + cones.centre + ", " + fixed(cones.mean_layers, 2) +
           " layers per cone, " + std::to_string(cones.most_layers) + " at most, " +
           fixed(100 * share(cones.in_many, report.triangles), 2) +
           " % of triangles in more than 8 cones";
}

/// Returns a report with the figures that OctreeFigures and TetraFigures share.
template <class Figures>
StructureReport counted(const Figures& figures) {
    StructureReport report;
    report.triangles = figures.triangles;
    report.nodes = figures.nodes;
    report.leaves = figures.leaves;
    report.deepest = figures.deepest;
    report.references = figures.references;
    report.shared = figures.shared;
    report.largest_leaf = figures.largest_leaf;
    report.bytes = figures.bytes;
    return report;
}

}  // namespace

StructureReport report_of(Structure which, const format::OctreeGrid& grid,
                          const OctreeFigures& figures, bool has_boxes) {
    StructureReport report = counted(figures);
    report.settings = {which, grid.level, grid.threshold, {{"bounding", bounding_name(has_boxes)}}};
    if (which == Structure::octree) report.bytes -= figures.table_bytes;
    return report;
}

StructureReport report_of(const format::AdaptiveOctree& tree, const OctreeFigures& figures,
                          bool has_boxes) {
    StructureReport report = counted(figures);
    report.settings = {Structure::adaptive_octree,
                       tree.level,
                       tree.threshold,
                       {{"split", split_name(tree.rule)}, {"bounding", bounding_name(has_boxes)}}};
    return report;
}

StructureReport report_of(const format::TetraTree& tree, const TetraFigures& figures) {
    StructureReport report = counted(figures);
    report.settings = {Structure::tetra_tree,
                       tree.level,
                       tree.threshold,
                       {{"bounding", bounding_name(tree.bounding)}}};
    const bool on_surface = (tree.flags & format::tetra_centre_on) != 0;
    report.cones = ConeFigures{on_surface              ? "on the surface"
                               : figures.centre_inside ? "inside"
                                                       : "outside",
                               figures.centre_count, figures.mean_layers, figures.most_layers,
                               figures.in_many};
    return report;
}

std::vector<StructureReport> structure_reports(const Model& model) {
    std::vector<StructureReport> reports;
    if (const format::OctreeGrid* grid = model.octree().grid) {
        const OctreeFigures figures = octree_figures(model);
        const bool has_boxes = model.sections().contains(format::SectionId::octree_boxes);
        reports.push_back(report_of(Structure::octree, *grid, figures, has_boxes));
        if (model.serves(Ask::hashed_octree)) {
            reports.push_back(report_of(Structure::hashed_octree, *grid, figures, has_boxes));
        }
    }
    if (const format::AdaptiveOctree* tree = model.adaptive_octree().tree) {
        reports.push_back(
            report_of(*tree, adaptive_octree_figures(model),
                      model.sections().contains(format::SectionId::adaptive_octree_boxes)));
    }
    if (const format::TetraTree* tree = model.tetra_tree().tree) {
        reports.push_back(report_of(*tree, tetra_figures(model)));
    }
    return reports;
}

nlohmann::ordered_json structures_json(const std::vector<StructureReport>& reports) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (const StructureReport& report : reports) {
        json[structure_name(report.settings.structure)] = as_json(report);
    }
    return json;
}

std::string structures_text(const std::vector<StructureReport>& reports) {
    std::string text;
    for (const StructureReport& report : reports) {
        const std::string name = structure_name(report.settings.structure);
        text += "  " + name + std::string(16 - std::min<std::size_t>(15, name.size()), ' ') +
                as_text(report) + "\n";
    }
    return text;
}

}  // namespace cdprep::report
