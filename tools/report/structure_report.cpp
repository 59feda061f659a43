// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/structure_report.h"

#include <algorithm>
#include <utility>

#include "report/fixed.h"
#include "report/structure_name.h"

namespace cdprep::report {
namespace {

nlohmann::ordered_json as_json(const StructureReport& report) {
    nlohmann::ordered_json json = {{"level", report.settings.level},
                                   {"threshold", report.settings.threshold}};
    if (!report.settings.rule.empty()) json[report.settings.rule] = report.settings.rule_value;
    json["nodes"] = report.nodes;
    json["leaves"] = report.leaves;
    json["references"] = report.references;
    json["references_per_triangle"] = report.references_per_triangle;
    json["largest_leaf"] = report.largest_leaf;
    json["bytes"] = report.bytes;
    if (report.cones) {
        json["centre"] = report.cones->centre;
        json["at_centre"] = report.cones->at_centre;
        json["mean_layers"] = report.cones->mean_layers;
        json["most_layers"] = report.cones->most_layers;
        json["share_in_more_than_8_cones"] = report.cones->share_in_many;
    }
    return json;
}

std::string as_text(const StructureReport& report) {
    const StructureSettings& settings = report.settings;
    std::string text = "level " + std::to_string(settings.level) + ", threshold " +
                       std::to_string(settings.threshold);
    if (!settings.rule.empty()) text += ", " + settings.rule + " " + settings.rule_value;
    text += ": " + std::to_string(report.nodes) + " nodes, " + std::to_string(report.leaves) +
            " leaves, " + fixed(report.references_per_triangle, 2) +
            " references a triangle, largest leaf " + std::to_string(report.largest_leaf) + ", " +
            std::to_string(report.bytes) + " bytes";
    if (!report.cones) return text;
    const ConeFigures& cones = *report.cones;
    return text + "; centre " + cones.centre + ", " + fixed(cones.mean_layers, 2) +
           " layers a cone, " + fixed(cones.most_layers, 0) + " at most, " +
           fixed(100 * cones.share_in_many, 2) + " % of triangles in more than 8 cones";
}

std::uint64_t bytes_of(Structure structure, std::span<const SectionBytes> sections) {
    const format::SectionSet own = sections_of(structure);
    std::uint64_t bytes = 0;
    for (const SectionBytes& section : sections) {
        if (own.contains(section.id)) bytes += section.bytes;
    }
    return bytes;
}

/// `leaf_size(node)` is the number of a leaf's references, nothing for an inner node.
template <class Node, class LeafSize>
StructureReport counted(std::span<const Node> nodes, std::span<const std::uint32_t> references,
                        std::uint64_t triangle_count, LeafSize leaf_size) {
    StructureReport report;
    report.nodes = nodes.size();
    report.references = references.size();
    for (const Node& node : nodes) {
        const std::optional<std::uint32_t> size = leaf_size(node);
        if (!size) continue;
        ++report.leaves;
        report.largest_leaf = std::max<std::uint64_t>(report.largest_leaf, *size);
    }
    if (triangle_count > 0) {
        report.references_per_triangle =
            static_cast<double>(references.size()) / static_cast<double>(triangle_count);
    }
    return report;
}

template <class Node>
std::optional<std::uint32_t> octree_leaf_size(const Node& node) {
    if ((node.count & format::kInnerNode) != 0) return std::nullopt;
    return node.count;
}

std::optional<std::uint32_t> tetra_leaf_size(const format::TetraNode& node) {
    if ((node.flags & format::tetra_inner) != 0) return std::nullopt;
    return node.count;
}

const char* centre_of(const format::TetraTree& tree) {
    if ((tree.flags & format::tetra_centre_on) != 0) return "on the surface";
    return (tree.flags & format::tetra_centre_inside) != 0 ? "inside" : "outside";
}

}  // namespace

StructureViews views_of(const Model& model) {
    return {model.octree_grid(),
            model.octree_nodes(),
            model.octree_references(),
            model.sections().contains(SectionId::octree_leaf_codes),
            model.adaptive_octree(),
            model.adaptive_octree_nodes(),
            model.adaptive_octree_references(),
            model.tetra_tree(),
            model.tetra_nodes(),
            model.tetra_references()};
}

std::vector<StructureReport> structure_reports(const StructureViews& views,
                                               std::uint64_t triangle_count,
                                               std::span<const SectionBytes> sections) {
    std::vector<StructureReport> reports;
    const auto add = [&](StructureReport report, StructureSettings settings) {
        report.bytes = bytes_of(settings.structure, sections);
        report.settings = std::move(settings);
        reports.push_back(std::move(report));
    };
    if (const auto* tree = views.octree) {
        const StructureReport report =
            counted(views.octree_nodes, views.octree_references, triangle_count,
                    octree_leaf_size<format::OctreeNode>);
        add(report, {Structure::octree, tree->level, tree->threshold, "", ""});
        if (views.is_hashed) {
            add(report, {Structure::hashed_octree, tree->level, tree->threshold, "", ""});
        }
    }
    if (const auto* tree = views.adaptive_octree) {
        add(counted(views.adaptive_octree_nodes, views.adaptive_octree_references, triangle_count,
                    octree_leaf_size<format::AdaptiveOctreeNode>),
            {Structure::adaptive_octree, tree->level, tree->threshold, "split",
             split_name(tree->rule)});
    }
    if (const auto* tree = views.tetra_tree) {
        StructureReport report =
            counted(views.tetra_nodes, views.tetra_references, triangle_count, tetra_leaf_size);
        report.cones = ConeFigures();
        report.cones->at_centre = tree->centre_count;
        report.cones->centre = centre_of(*tree);
        add(std::move(report), {Structure::tetra_tree, tree->level, tree->threshold, "bounding",
                                bounding_name(tree->bounding)});
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
