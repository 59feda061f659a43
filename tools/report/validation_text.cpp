// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/validation_text.h"

#include <algorithm>

#include "report/place_text.h"
#include "report/severity_name.h"
#include "report/verdict_words.h"

namespace cdprep::report {
namespace {

constexpr std::size_t kMostNumbers = 8;  ///< of triangles or vertices in a line

std::string counted(std::uint64_t count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string findings_text(std::uint64_t errors, std::uint64_t warnings, std::uint64_t notes) {
    return counted(errors, "error", "errors") + ", " + counted(warnings, "warning", "warnings") +
           ", " + counted(notes, "note", "notes");
}

/// "  warning CDP0301 Edge with one triangle: 12 (boundary-edge)".
std::string finding_line(const mesh::Finding& finding, const Judgement& judgement, bool compared) {
    const mesh::RuleText& rule = mesh::text_of(finding.rule);
    std::string severity = severity_name(judgement.severity);
    severity.resize(std::string_view("warning").size(), ' ');
    std::string count = std::to_string(judgement.fresh);
    if (compared) count += " new of " + std::to_string(finding.count);
    return "  " + severity + " " + mesh::id_of(finding.rule) + " " + rule.title + ": " + count +
           " (" + rule.name + ")\n";
}

std::string verdict_lines(const ValidationReport& report, const ValidationRun& run) {
    const std::vector<format::Verdict>& verdicts = report.defects.verdicts;
    if (verdicts.empty()) return "";
    std::string text = "  verdict: " + verdict_text(verdicts[0]) +
                       "\n  promises: " + promises_text(verdicts[0]) + "\n";
    const std::size_t components = verdicts.size() - 1;
    if (components < 2) return text;
    const std::size_t shown = std::min(components, run.max_places);
    for (std::size_t i = 1; i <= shown; ++i) {
        text += "  component " + std::to_string(i - 1) + ", " +
                counted(verdicts[i].triangle_count, "triangle", "triangles") + " from " +
                std::to_string(verdicts[i].first_triangle) + ": " + verdict_text(verdicts[i]) +
                "\n";
    }
    if (shown == components) return text;
    return text + "  and " + std::to_string(components - shown) + " more components\n";
}

std::string timings_text(const ValidationReport& report) {
    std::string text = "  " + number_text(report.seconds) + " s";
    for (const StageTime& stage : report.stages) {
        text += ", " + stage.stage + " " + number_text(stage.seconds) + " s";
    }
    return text + "\n";
}

std::string head_line(const ValidationReport& report) {
    ValidationTotals totals;
    totals.add(report);
    std::string text = report.input + ": " + (report.exit == 0 ? "passed" : "FAILED") + ", " +
                       findings_text(totals.errors, totals.warnings, totals.notes);
    if (report.known > 0) text += ", besides " + std::to_string(report.known) + " known";
    return text + "; " + counted(report.triangles, "triangle", "triangles") + ", " +
           counted(report.vertices, "vertex", "vertices") + "\n";
}

}  // namespace

std::string places_text(const ValidationReport& report, std::size_t finding, std::size_t most,
                        const std::string& indent) {
    const mesh::Finding& found = report.defects.findings[finding];
    std::string text;
    const std::size_t shown = std::min(found.places.size(), most);
    for (std::size_t i = 0; i < shown; ++i) {
        text += indent + place_text(report, found.rule, found.places[i], kMostNumbers) + "\n";
    }
    const std::uint64_t all = report.judgements[finding].fresh;
    return all <= shown ? text : text + indent + "and " + std::to_string(all - shown) + " more\n";
}

std::string validation_text(const ValidationReport& report, const ValidationRun& run) {
    if (report.error) {
        return report.input + ": " + (report.known_error ? "known as unreadable" : "UNREADABLE") +
               "\n  " + *report.error + "\n";
    }
    std::string text = head_line(report);
    for (std::size_t i = 0; i < report.defects.findings.size(); ++i) {
        text +=
            finding_line(report.defects.findings[i], report.judgements[i], !run.baseline.empty());
        text += places_text(report, i, run.max_places, "    ");
    }
    for (const std::string& remark : report.remarks) text += "  " + remark + "\n";
    text += verdict_lines(report, run);
    return run.timings ? text + timings_text(report) : text;
}

std::string totals_text(const ValidationTotals& totals) {
    std::string text = counted(totals.files, "file", "files") + ": " +
                       std::to_string(totals.failed) + " failed, " +
                       std::to_string(totals.unreadable) + " unreadable; " +
                       findings_text(totals.errors, totals.warnings, totals.notes);
    if (totals.known > 0) text += ", besides " + std::to_string(totals.known) + " known";
    return text + (totals.interrupted ? "; stopped before the end\n" : "\n");
}

}  // namespace cdprep::report
