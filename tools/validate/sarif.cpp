// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/ci_reports.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "text/file_uri.h"
#include "text/json_layout.h"
#include "text/number_text.h"
#include "validate/fingerprint.h"
#include "validate/place_text.h"
#include "validate/severity_name.h"
#include "validate/validation_json.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema =
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json";
constexpr const char* kFingerprint = "cdprepPlace/v1";
constexpr std::size_t kMostSarifNumbers = 8;  ///< logical locations per kind; numbers per message

/// Returns the SARIF level. SARIF calls a rule that is off "none", and not enabled.
const char* level_of(mesh::Severity severity) {
    return severity == mesh::Severity::off ? "none" : severity_name(severity);
}

std::size_t index_of(mesh::Rule rule) {
    const auto rules = mesh::all_rules();
    const auto at = std::find_if(rules.begin(), rules.end(),
                                 [&](const mesh::RuleText& text) { return text.rule == rule; });
    return static_cast<std::size_t>(at - rules.begin());
}

Json rule_json(const mesh::RuleText& rule) {
    return {
        {"id", mesh::id_of(rule.rule)},
        {"name", rule.name},
        {"shortDescription", {{"text", rule.title}}},
        {"fullDescription", {{"text", rule.meaning}}},
        {"help", {{"text", std::string(rule.why) + " " + rule.remedy}}},
        {"defaultConfiguration",
         {{"enabled", rule.severity != mesh::Severity::off}, {"level", level_of(rule.severity)}}},
        {"properties", {{"decided", rule.decided}}}};
}

/// Returns the severities of the run that differ from the rules' own.
Json overrides_json(const RuleSettings& settings) {
    Json overrides = Json::array();
    for (const mesh::RuleText& rule : mesh::all_rules()) {
        const mesh::Severity severity = settings.severity(rule.rule);
        if (severity == rule.severity) continue;
        overrides.push_back(
            {{"descriptor", {{"id", mesh::id_of(rule.rule)}, {"index", index_of(rule.rule)}}},
             {"configuration",
              {{"enabled", severity != mesh::Severity::off}, {"level", level_of(severity)}}}});
    }
    return overrides;
}

Json artifact_location(const std::string& uri, std::size_t index) {
    return {{"uri", uri}, {"index", index}};
}

void add_elements(Json& locations, const char* kind, const std::string& node,
                  const std::vector<std::uint32_t>& numbers) {
    const std::size_t shown = std::min(numbers.size(), kMostSarifNumbers);
    const auto end = numbers.begin() + static_cast<std::ptrdiff_t>(shown);
    const std::string above = node.empty() ? "" : node + "/";
    for (auto at = numbers.begin(); at != end; ++at) {
        // A triangle may repeat a corner; SARIF requires distinct locations.
        if (std::find(numbers.begin(), at, *at) != at) continue;
        const std::string name = std::string(kind) + " " + std::to_string(*at);
        locations.push_back({{"name", name}, {"fullyQualifiedName", above + name}, {"kind", kind}});
    }
}

Json logical_locations(const ValidationReport& report, const mesh::Place& place) {
    Json locations = Json::array();
    std::string node;
    if (!place.triangles.empty()) node = node_of(report, place.triangles.front());
    if (!node.empty()) locations.push_back({{"fullyQualifiedName", node}, {"kind", "node"}});
    add_elements(locations, "triangle", node, place.triangles);
    add_elements(locations, "vertex", node, place.vertices);
    return locations;
}

/// Returns the members shared by the results of a finding.
Json result_json(const ValidationReport& report, std::size_t i, const std::string& text) {
    const mesh::Finding& finding = report.defects.findings[i];
    return {{"ruleId", mesh::id_of(finding.rule)},
            {"ruleIndex", index_of(finding.rule)},
            {"level", level_of(report.judgements[i].severity)},
            {"message", {{"text", std::string(mesh::text_of(finding.rule).title) + ": " + text}}}};
}

Json place_json(const ValidationReport& report, std::size_t i, std::size_t k,
                const Json& artifact) {
    const mesh::Finding& finding = report.defects.findings[i];
    const mesh::Place& place = finding.places[k];
    Json result =
        result_json(report, i, place_text(report, finding.rule, place, kMostSarifNumbers) + ".");
    Json location = {{"physicalLocation", {{"artifactLocation", artifact}}}};
    const Json logical = logical_locations(report, place);
    if (!logical.empty()) location["logicalLocations"] = logical;
    result["locations"] = Json::array({location});
    result["partialFingerprints"] = {
        {kFingerprint, fingerprint_text(report.judgements[i].fingerprints[k])}};
    result["properties"] = {{"position", position_json(place.position)}};
    if (*mesh::text_of(finding.rule).measure != '\0') {
        result["properties"]["measure"] = place.measure;
    }
    return result;
}

Json rest_json(const ValidationReport& report, std::size_t i, std::uint64_t count,
               const Json& artifact) {
    Json result = result_json(
        report, i,
        counted(count, "more place is", "more places are") + " not listed (--max-issues).");
    result["locations"] = Json::array({{{"physicalLocation", {{"artifactLocation", artifact}}}}});
    result["occurrenceCount"] = count;
    return result;
}

/// Returns one result for a note, whatever its number of places. Services list errors and
/// warnings place by place, and hundreds of notes would hide them.
Json note_json(const ValidationReport& report, std::size_t i, const Json& artifact) {
    const std::uint64_t count = report.judgements[i].fresh;
    Json result = result_json(report, i, counted(count, "place", "places") + ".");
    result["locations"] = Json::array({{{"physicalLocation", {{"artifactLocation", artifact}}}}});
    result["occurrenceCount"] = count;
    return result;
}

Json notification_json(const std::string& text, const char* level, const Json& artifact) {
    return {{"level", level},
            {"message", {{"text", text}}},
            {"locations", Json::array({{{"physicalLocation", {{"artifactLocation", artifact}}}}})}};
}

Json artifact_json(const ValidationReport& report, const std::string& uri) {
    Json properties = {{"exit", report.exit}};
    if (!report.error) {
        properties["triangles"] = report.triangles;
        properties["vertices"] = report.vertices;
        properties["counts"] = counts_json(report.defects.counts);
    }
    return {{"location", {{"uri", uri}}},
            {"roles", Json::array({"analysisTarget"})},
            {"properties", properties}};
}

std::string joined(const std::vector<std::string>& items) {
    std::string text;
    for (const std::string& item : items) text += (text.empty() ? "\n" : ",\n") + item;
    return text;
}

}  // namespace

std::string Sarif::head() const {
    std::vector<std::string> rules;
    for (const mesh::RuleText& rule : mesh::all_rules()) {
        rules.push_back(compact(rule_json(rule)));
    }
    return std::string("{\"$schema\":\"") + kSchema +
           "\",\n\"version\":\"2.1.0\",\n\"runs\":[{\"tool\":{\"driver\":{\"name\":\"cdprep\","
           "\"version\":" +
           compact(run_.tool_version) + ",\n\"rules\":[" + joined(rules) + "]}},\n\"results\":[\n";
}

std::string Sarif::add(const ValidationReport& report) {
    const std::string uri = file_uri(report.input, run_.folder);
    const Json artifact = artifact_location(uri, artifacts_.size());
    artifacts_.push_back(compact(artifact_json(report, uri)));
    if (report.error) {
        const char* level = report.known_error ? "note" : "error";
        notifications_.push_back(compact(notification_json(*report.error, level, artifact)));
    }
    for (const std::string& remark : report.remarks) {
        notifications_.push_back(compact(notification_json(remark, "note", artifact)));
    }
    std::string text;
    const auto append = [&](Json result) {
        if (!run_.baseline.empty()) result["baselineState"] = "new";
        text += (is_first_ ? "" : ",\n") + compact(result);
        is_first_ = false;
    };
    for (std::size_t i = 0; i < report.defects.findings.size(); ++i) {
        if (report.judgements[i].severity == mesh::Severity::note) {
            if (report.judgements[i].fresh > 0) append(note_json(report, i, artifact));
            continue;
        }
        const std::size_t kept =
            std::min(report.defects.findings[i].places.size(), run_.max_places);
        for (std::size_t k = 0; k < kept; ++k) append(place_json(report, i, k, artifact));
        const std::uint64_t all = report.judgements[i].fresh;
        if (all > kept) append(rest_json(report, i, all - kept, artifact));
    }
    return text;
}

std::string Sarif::tail(const ValidationTotals& totals) const {
    const bool is_whole = totals.unreadable == 0 && !totals.interrupted;
    return "],\n\"artifacts\":[" + joined(artifacts_) +
           "],\n\"invocations\":[{\"executionSuccessful\":" + (is_whole ? "true" : "false") +
           ",\"exitCode\":" + std::to_string(totals.exit) +
           ",\n\"ruleConfigurationOverrides\":" + compact(overrides_json(run_.rules)) +
           ",\n\"toolExecutionNotifications\":[" + joined(notifications_) + "]}]}]}\n";
}

}  // namespace cdprep::report
