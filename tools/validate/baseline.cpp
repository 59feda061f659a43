// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/baseline.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "validate/fingerprint.h"
#include "validate/validation_json.h"

namespace cdprep::report {
namespace {

using json = nlohmann::ordered_json;

Error unreadable(const std::string& name, const std::string& why) {
    return {ErrorCode::unreadable, name + ": cannot be the baseline: " + why +
                                       ". Write one with 'cdprep validate --format json -o FILE'."};
}

/// Skips the rules of a newer program: this program has nothing to compare with them.
void add_finding(KnownMesh& mesh, const json& finding) {
    const auto rule = mesh::find_rule(finding.at("rule").get<std::string>());
    if (!rule) return;
    KnownFinding& known = mesh.findings[*rule];
    known.count = finding.at("count").get<std::uint64_t>();
    for (const json& place : finding.at("places")) {
        const auto fingerprint = parse_fingerprint(place.at("fingerprint").get<std::string>());
        if (fingerprint) known.fingerprints.push_back(*fingerprint);
    }
    std::sort(known.fingerprints.begin(), known.fingerprints.end());
}

KnownMesh known_mesh(const json& mesh) {
    KnownMesh known;
    known.is_unreadable = mesh.contains("error");
    if (known.is_unreadable) return known;
    for (const json& finding : mesh.at("findings")) add_finding(known, finding);
    return known;
}

}  // namespace

std::uint64_t KnownMesh::largest_count() const noexcept {
    std::uint64_t largest = 0;
    for (const auto& [rule, finding] : findings) largest = std::max(largest, finding.count);
    return largest;
}

Result<Baseline> Baseline::parse(std::string_view text, const std::string& name) {
    try {
        const json report = json::parse(text);
        if (!report.is_object() || report.value("report", "") != kValidationReportName) {
            return unreadable(name, "it is JSON, but not a report of 'cdprep validate'");
        }
        if (const int version = report.at("version").get<int>();
            version != kValidationReportVersion) {
            return unreadable(name, "it has version " + std::to_string(version) +
                                        "; this program reads " +
                                        std::to_string(kValidationReportVersion));
        }
        if (!report.at("baseline").is_null()) {
            return unreadable(
                name, "it was made with --baseline, so it lacks the findings of its own baseline");
        }
        Baseline baseline;
        for (const json& mesh : report.at("meshes")) {
            baseline.meshes_[mesh.at("uri").get<std::string>()] = known_mesh(mesh);
        }
        return baseline;
    } catch (const json::parse_error& error) {
        return unreadable(name, "its JSON is invalid at byte " + std::to_string(error.byte));
    } catch (const json::exception&) {
        return unreadable(name, "it does not follow tools/validate/validation.schema.json");
    }
}

const KnownMesh* Baseline::find(const std::string& uri) const {
    const auto at = meshes_.find(uri);
    return at == meshes_.end() ? nullptr : &at->second;
}

}  // namespace cdprep::report
