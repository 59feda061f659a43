// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/baked_findings.h"

#include <algorithm>

#include "cli/command.h"
#include "cli/signals.h"
#include "repair/repair_report.h"
#include "text/number_text.h"
#include "validate/defects/find_defects.h"
#include "validate/judge.h"
#include "validate/place_text.h"
#include "validate/rule_settings.h"
#include "validate/validation_json.h"

namespace cdprep::cli {
namespace {

/// The number of places that a baked file stores for each finding. 'cdprep validate' lists more.
constexpr std::size_t kPlaces = 100;
constexpr std::size_t kNumbersInSentence = 4;

/// Returns the soup with each vertex where welding has put it.
mesh::TriangleSoup as_welded(const mesh::TriangleSoup& soup, const mesh::Mesh& welded) {
    mesh::TriangleSoup joined = soup;
    for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            joined.positions[soup.triangles[i].vertex[corner]] =
                welded.positions[welded.triangles[i].vertex[corner]];
        }
    }
    return joined;
}

bool is_refused(const report::Judgement& judgement) {
    return judgement.severity >= mesh::Severity::warning;
}

/// Returns the message for a search that a limit ended: --max-pairs, or that of its work.
std::string unfinished_refusal(std::uint64_t pairs, std::uint64_t max_pairs) {
    const bool is_of_pairs = pairs >= max_pairs;
    const std::string limit = is_of_pairs ? "--max-pairs " + std::to_string(max_pairs)
                                          : std::string("the limit of its work");
    return "the search for crossing triangles ended early, at " + limit + ", after " +
           report::counted(pairs, "pair that meets", "pairs that meet") +
           ". --strict requires a complete search: " +
           (is_of_pairs ? "raise --max-pairs, or bake without --strict."
                        : "bake without --strict.");
}

}  // namespace

report::ValidationReport find_for_bake(const mesh::TriangleSoup& soup, const mesh::Mesh& welded,
                                       std::uint64_t max_pairs, ParallelFor parallel_for) {
    const mesh::TriangleSoup joined = as_welded(soup, welded);
    report::ValidationReport found = report::report_on("", joined);
    mesh::DefectOptions options;
    options.max_places = kPlaces;
    options.max_pairs = max_pairs;
    options.stop = is_interrupted;
    options.parallel_for = parallel_for;
    found.defects = mesh::find_defects(joined, options);
    report::remark_on_limits(found, options);
    const report::RuleSettings rules;
    static_cast<void>(report::judge(found, joined, {rules, nullptr, kPlaces}));
    found.exit = static_cast<int>(count_warnings(found) > 0 ? Exit::findings : Exit::success);
    return found;
}

std::uint64_t count_warnings(const report::ValidationReport& found) {
    return static_cast<std::uint64_t>(
        std::count_if(found.judgements.begin(), found.judgements.end(), is_refused));
}

std::string strict_refusal(const report::ValidationReport& found, std::uint64_t max_pairs) {
    if (count_warnings(found) == 0) {
        return unfinished_refusal(found.defects.counts.self_intersecting_pairs, max_pairs);
    }
    const auto first = static_cast<std::size_t>(
        std::find_if(found.judgements.begin(), found.judgements.end(), is_refused) -
        found.judgements.begin());
    const std::uint64_t rules = count_warnings(found);
    const mesh::Finding& finding = found.defects.findings[first];
    std::string sentence = mesh::id_of(finding.rule) + ", " + mesh::text_of(finding.rule).title +
                           ": " + report::count_text(finding, finding.count);
    if (!finding.places.empty()) {
        sentence += ", first " +
                    report::place_text(found, finding.rule, finding.places[0], kNumbersInSentence);
    }
    if (rules > 1) {
        sentence += "; " + std::to_string(rules - 1) + " more " +
                    (rules == 2 ? "rule has findings" : "rules have findings");
    }
    return sentence + ". --strict refuses this mesh: repair it, or bake without --strict.";
}

std::string kept_findings(const report::ValidationReport& found,
                          const std::optional<mesh::RepairReport>& repair) {
    return report::baked_findings_json(
        found, repair ? report::repair_summary_json(*repair) : std::string(), kPlaces);
}

}  // namespace cdprep::cli
