// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/judge.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "validate/fingerprint.h"

namespace cdprep::report {
namespace {

void keep_first(mesh::Finding& finding, Judgement& judgement, std::size_t count) {
    if (finding.places.size() <= count) return;
    finding.places.resize(count);
    judgement.fingerprints.resize(count);
}

/// Returns for each place whether it is new: one known fingerprint matches one place. `known`
/// must be ascending.
std::vector<bool> find_fresh(const std::vector<std::uint64_t>& fingerprints,
                             const std::vector<std::uint64_t>& known) {
    std::vector<std::size_t> order(fingerprints.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return fingerprints[a] < fingerprints[b];
    });
    std::vector<bool> fresh(fingerprints.size(), true);
    auto at = known.begin();
    for (const std::size_t i : order) {
        at = std::lower_bound(at, known.end(), fingerprints[i]);
        if (at == known.end() || *at != fingerprints[i]) continue;
        fresh[i] = false;
        ++at;
    }
    return fresh;
}

void keep_fresh_places(mesh::Finding& finding, Judgement& judgement,
                       const std::vector<std::uint64_t>& known) {
    const std::vector<bool> fresh = find_fresh(judgement.fingerprints, known);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < fresh.size(); ++i) {
        if (!fresh[i]) continue;
        if (kept != i) finding.places[kept] = std::move(finding.places[i]);
        judgement.fingerprints[kept++] = judgement.fingerprints[i];
    }
    keep_first(finding, judgement, kept);
}

std::string compared_by_count(const mesh::Finding& finding, const KnownFinding& known) {
    const std::string kept = known.is_complete()
                                 ? "there are now too many places to compare each one"
                                 : "the baseline lists only " +
                                       std::to_string(known.fingerprints.size()) + " of its places";
    return mesh::id_of(finding.rule) + " was compared by its count, " +
           std::to_string(finding.count) + " now and " + std::to_string(known.count) +
           " before: " + kept +
           ". Places listed as new may be old. A baseline with a larger --max-issues distinguishes "
           "them.";
}

void compare(mesh::Finding& finding, Judgement& judgement, const KnownFinding& known,
             ValidationReport& report) {
    const bool is_complete = finding.places.size() == finding.count && known.is_complete();
    keep_fresh_places(finding, judgement, known.fingerprints);
    if (is_complete) {
        judgement.fresh = finding.places.size();
        return;
    }
    judgement.fresh = finding.count - std::min(finding.count, known.count);
    report.remarks.push_back(compared_by_count(finding, known));
    keep_first(finding, judgement, judgement.fresh);
}

Judgement judged(mesh::Finding& finding, Fingerprints& fingerprints, const JudgeOptions& options,
                 ValidationReport& report) {
    Judgement judgement;
    judgement.severity = options.rules.severity(finding.rule);
    judgement.fresh = finding.count;
    for (const mesh::Place& place : finding.places) {
        judgement.fingerprints.push_back(fingerprints.of(finding.rule, place));
    }
    if (options.known == nullptr) return judgement;
    const auto at = options.known->findings.find(finding.rule);
    if (at != options.known->findings.end()) compare(finding, judgement, at->second, report);
    report.known += finding.count - judgement.fresh;
    return judgement;
}

}  // namespace

bool judge(ValidationReport& report, const mesh::TriangleSoup& soup, const JudgeOptions& options) {
    bool fails = false;
    Fingerprints fingerprints(soup);
    std::vector<mesh::Finding> findings;
    for (mesh::Finding& finding : report.defects.findings) {
        if (options.rules.severity(finding.rule) == mesh::Severity::off) continue;
        Judgement judgement = judged(finding, fingerprints, options, report);
        if (judgement.fresh == 0) continue;
        fails = fails || options.rules.fails(finding.rule);
        keep_first(finding, judgement, options.max_places);
        report.judgements.push_back(std::move(judgement));
        findings.push_back(std::move(finding));
    }
    report.defects.findings = std::move(findings);
    return fails;
}

bool fails_on_pairs(const RuleSettings& rules) {
    return rules.fails(mesh::Rule::overlapping_components) ||
           rules.fails(mesh::Rule::crossing_triangles) ||
           rules.fails(mesh::Rule::touching_triangles) || rules.fails(mesh::Rule::coplanar_overlap);
}

}  // namespace cdprep::report
