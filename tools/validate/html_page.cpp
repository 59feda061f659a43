// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/html_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "page/base64.h"
#include "page/page_parts.h"
#include "page/page_surface.h"
#include "page/page_text.h"
#include "text/json_layout.h"
#include "validate/choose_triangles.h"
#include "validate/page_marks.h"

namespace cdprep::report {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t kPlacesOnPage = 50'000;  // listed and marked, on the page
constexpr std::size_t kLeastPlaces = 10;       // per finding, on any page
constexpr std::size_t kMostPagePlaces = 1000;  // per finding
constexpr std::size_t kPlaceNumbers = 100;     // triangles or vertices listed per place
constexpr std::size_t kPartsAPlace = 20;       // segments or triangles drawn per place, on average
constexpr std::size_t kComponents = 5000;      // on the page; each mesh has at least 5
constexpr std::size_t kMostComponents = 200;   // per mesh
constexpr std::size_t kLongestName = 300;      // bytes of a file's or node's name
constexpr double kGhostTriangles = 400'000;    // about; triangles of coarse surfaces, on the page

/// The limits per mesh and finding, so that the page stays bounded.
struct Limits {
    std::vector<std::size_t> triangles;  ///< one per mesh
    std::size_t places;                  ///< per finding
    std::size_t components;              ///< per mesh
    std::uint32_t ghost_cells;
};

Limits limits_of(std::span<const PageMesh> meshes, const PageOptions& options) {
    std::vector<std::size_t> sizes;
    for (const PageMesh& mesh : meshes) sizes.push_back(mesh.triangles.size());
    std::vector<std::size_t> shares = share_triangles(sizes, options.max_triangles);
    std::size_t findings = 1;
    std::size_t ghosts = 1;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        findings += meshes[i].report->defects.findings.size();
        if (shares[i] < meshes[i].triangles.size()) ++ghosts;
    }
    const double cells = std::sqrt(kGhostTriangles / (6.0 * static_cast<double>(ghosts)));
    return {std::move(shares), std::clamp(kPlacesOnPage / findings, kLeastPlaces, kMostPagePlaces),
            std::clamp<std::size_t>(kComponents / std::max<std::size_t>(1, meshes.size()), 5,
                                    kMostComponents),
            static_cast<std::uint32_t>(std::max(4.0, cells))};
}

template <class T>
std::string packed(const std::vector<T>& values) {
    return base64(std::as_bytes(std::span(values)));
}

/// Returns a name cut to a length, between UTF-8 characters.
std::string shortened(const std::string& name) {
    if (name.size() <= kLongestName) return name;
    std::size_t end = kLongestName;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;
    return name.substr(0, end) + "...";
}

/// Names of the nodes that places use, each once.
class NodeNames {
public:
    explicit NodeNames(const ValidationReport& report) : report_(report) {}

    /// Returns the index of the place's node among the used ones; nothing if the file has no
    /// nodes.
    [[nodiscard]] std::optional<std::size_t> number(const mesh::Place& place) {
        if (place.triangles.empty() || report_.first_triangle.empty()) return std::nullopt;
        const auto& first = report_.first_triangle;
        const auto after = std::ranges::upper_bound(first, place.triangles.front());
        if (after == first.begin()) return std::nullopt;
        const auto run = static_cast<std::size_t>(after - first.begin()) - 1;
        if (run >= report_.node_of_triangle_run.size()) return std::nullopt;
        const auto [entry, is_new] = numbers_.try_emplace(run, names_.size());
        if (is_new) names_.push_back(shortened(report_.node_of_triangle_run[run]));
        return entry->second;
    }

    [[nodiscard]] const std::vector<std::string>& names() const {
        return names_;
    }

private:
    const ValidationReport& report_;
    std::map<std::size_t, std::size_t> numbers_;
    std::vector<std::string> names_;
};

const char* severity_word(mesh::Severity severity) {
    switch (severity) {
        case mesh::Severity::error:
            return "error";
        case mesh::Severity::warning:
            return "warning";
        default:
            return "note";
    }
}

mesh::Severity severity_of(const PageMesh& mesh, std::size_t finding) {
    if (finding < mesh.severities.size()) return mesh.severities[finding];
    return mesh::text_of(mesh.report->defects.findings[finding].rule).severity;
}

json numbers_json(const std::vector<std::uint32_t>& numbers) {
    const std::size_t count = std::min(numbers.size(), kPlaceNumbers);
    return std::vector<std::uint32_t>(numbers.begin(),
                                      numbers.begin() + static_cast<std::ptrdiff_t>(count));
}

json place_json(const mesh::Place& place, NodeNames& nodes) {
    json listed = {
        {"t", numbers_json(place.triangles)},
        {"nt", place.triangles.size()},
        {"v", numbers_json(place.vertices)},
        {"nv", place.vertices.size()},
        {"p", {place.position.x, place.position.y, place.position.z}},
        {"m", place.measure},
    };
    if (const std::optional<std::size_t> node = nodes.number(place)) listed["n"] = *node;
    return listed;
}

json marks_json(const Marks& marks, const MarkStyle& style) {
    return {{"places", packed(marks.places)},
            {"segments", packed(marks.segments)},
            {"segment_ends", packed(marks.segment_ends)},
            {"triangles", packed(marks.triangles)},
            {"triangle_ends", packed(marks.triangle_ends)},
            {"pins", style.pins},
            {"wide", style.wide}};
}

json finding_json(const PageMesh& mesh, std::size_t index, const std::optional<PageFrame>& frame,
                  std::size_t max_places, NodeNames& nodes) {
    const mesh::Finding& finding = mesh.report->defects.findings[index];
    const std::size_t count = std::min(finding.places.size(), max_places);
    const auto places = std::span(finding.places).first(count);
    json listed = json::array();
    for (const mesh::Place& place : places) listed.push_back(place_json(place, nodes));
    Marks marks;
    if (frame) {
        marks = make_marks(mesh.positions, mesh.triangles, *frame, finding.rule, places,
                           count * kPartsAPlace + kMostPagePlaces);
    }
    return {{"rule", mesh::id_of(finding.rule)},
            {"severity", severity_word(severity_of(mesh, index))},
            {"count", finding.count},
            {"lower", finding.is_lower_bound},
            {"places", std::move(listed)},
            {"marks", marks_json(marks, mark_style(finding.rule))}};
}

json verdict_json(const PageMesh& mesh, const format::Verdict& verdict) {
    json listed = {{"facts", verdict.facts},
                   {"promises", verdict.promises},
                   {"triangles", verdict.triangle_count},
                   {"first", verdict.first_triangle},
                   {"loops", verdict.boundary_loops},
                   {"euler", verdict.euler},
                   {"genus", verdict.genus},
                   {"area", verdict.area},
                   {"volume", verdict.volume}};
    if (verdict.first_triangle < mesh.triangles.size() &&
        is_drawable(mesh.positions, mesh.triangles[verdict.first_triangle])) {
        const mesh::Double3& at =
            mesh.positions[mesh.triangles[verdict.first_triangle].vertex.front()];
        listed["at"] = {at.x, at.y, at.z};
    }
    return listed;
}

json verdicts_json(const PageMesh& mesh, std::size_t max_components) {
    const std::vector<format::Verdict>& verdicts = mesh.report->defects.verdicts;
    json listed = json::array();
    for (std::size_t i = 0; i < std::min(verdicts.size(), max_components + 1); ++i) {
        listed.push_back(verdict_json(mesh, verdicts[i]));
    }
    return listed;
}

json frame_json(const std::optional<PageFrame>& frame) {
    const PageFrame shown = frame.value_or(PageFrame{});
    return {{"centre", {shown.centre.x, shown.centre.y, shown.centre.z}},
            {"exponent", shown.exponent}};
}

/// The triangles of a mesh as elements, and the facts about them for the page.
struct Drawing {
    json facts;  ///< null if there is nothing to draw
    std::string elements;
};

Drawing draw(const PageMesh& mesh, const std::optional<PageFrame>& frame, std::size_t limit,
             std::uint32_t ghost_cells, const std::string& id) {
    if (!frame) return {};
    const std::vector<std::uint32_t> chosen = choose_triangles(
        mesh.positions, mesh.triangles, *frame, mesh.report->defects.findings, limit);
    const bool whole = mesh.triangles.size() <= limit;
    const DrawnTriangles drawn = draw_triangles(mesh.positions, mesh.triangles, *frame, chosen);
    DrawnTriangles ghost;
    if (!whole)
        ghost = coarse_triangles(mesh.positions, mesh.triangles, *frame, chosen, ghost_cells);
    constexpr const char* kType = "text/plain";
    return {{{"triangles", chosen.size()}, {"whole", whole}, {"half", frame->half_box}},
            script_element(id + "-positions", kType, packed(drawn.positions)) +
                script_element(id + "-indices", kType, packed(drawn.indices)) +
                script_element(id + "-ghost-positions", kType, packed(ghost.positions)) +
                script_element(id + "-ghost-indices", kType, packed(ghost.indices))};
}

std::string mesh_elements(const PageMesh& mesh, std::size_t index, const Limits& limits) {
    const ValidationReport& report = *mesh.report;
    const std::string id = "mesh-" + std::to_string(index);
    const std::optional<PageFrame> frame = find_page_frame(mesh.positions, mesh.triangles);
    const Drawing drawing = draw(mesh, frame, limits.triangles[index], limits.ghost_cells, id);
    NodeNames nodes(report);
    json findings = json::array();
    for (std::size_t i = 0; i < report.defects.findings.size(); ++i) {
        findings.push_back(finding_json(mesh, i, frame, limits.places, nodes));
    }
    const std::size_t verdicts = report.defects.verdicts.size();
    const json value = {{"name", shortened(report.input)},
                        {"error", report.error ? json(*report.error) : json(nullptr)},
                        {"triangles", report.triangles},
                        {"vertices", report.vertices},
                        {"frame", frame_json(frame)},
                        {"drawn", drawing.facts},
                        {"findings", std::move(findings)},
                        {"nodes", nodes.names()},
                        {"verdicts", verdicts_json(mesh, limits.components)},
                        {"components", verdicts > 0 ? verdicts - 1 : 0}};
    return script_element(id, "application/json", script_json(compact(value))) + drawing.elements;
}

json summary_json(const PageMesh& mesh) {
    std::map<std::string, std::uint64_t> counts = {{"error", 0}, {"warning", 0}, {"note", 0}};
    json rules = json::array();
    const std::vector<mesh::Finding>& findings = mesh.report->defects.findings;
    for (std::size_t i = 0; i < findings.size(); ++i) {
        counts[severity_word(severity_of(mesh, i))] += findings[i].count;
        rules.push_back(mesh::id_of(findings[i].rule));
    }
    json summary = counts;
    summary["name"] = shortened(mesh.report->input);
    summary["failed"] = mesh.report->error.has_value();
    summary["rules"] = std::move(rules);
    return summary;
}

json rules_json() {
    json rules = json::object();
    for (const mesh::RuleText& text : mesh::all_rules()) {
        rules[mesh::id_of(text.rule)] = {
            {"name", text.name},       {"title", text.title},
            {"meaning", text.meaning}, {"why", text.why},
            {"remedy", text.remedy},   {"decided", text.decided},
            {"measure", text.measure}, {"hue", mark_style(text.rule).hue},
        };
    }
    return rules;
}

std::string data_elements(std::span<const PageMesh> meshes, const Limits& limits) {
    json summaries = json::array();
    for (const PageMesh& mesh : meshes) summaries.push_back(summary_json(mesh));
    const json page = {{"rules", rules_json()}, {"meshes", std::move(summaries)}};
    std::string elements =
        script_element("page-data", "application/json", script_json(compact(page)));
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        elements += mesh_elements(meshes[i], i, limits);
    }
    return elements;
}

std::string title_of(std::span<const PageMesh> meshes) {
    if (meshes.size() == 1) return shortened(meshes.front().report->input) + " - cdprep validate";
    return std::to_string(meshes.size()) + " meshes - cdprep validate";
}

}  // namespace

std::string html_page(std::span<const PageMesh> meshes, const PageOptions& options) {
    const std::array<std::pair<std::string_view, std::string>, 8> parts = {{
        {"@title@", escaped(title_of(meshes))},
        {"@version@", escaped(options.version)},
        {"@css@", std::string(page::kStyle)},
        {"@license@", escaped(page::kLicense)},
        {"@data@", data_elements(meshes, limits_of(meshes, options))},
        {"@three@", std::string(page::kThree)},
        {"@controls@", std::string(page::kControls)},
        {"@js@", std::string(page::kElements) + std::string(page::kView) +
                     std::string(page::kList) + std::string(page::kPage)},
    }};
    return filled(page::kFrame, parts);
}

}  // namespace cdprep::report
