// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/validation_text.h"

#include <algorithm>
#include <numeric>

#include "text/number_text.h"
#include "text/printable.h"
#include "text/verdict_words.h"
#include "validate/place_text.h"
#include "validate/severity_name.h"

namespace cdprep::report {
namespace {

constexpr std::size_t kMostTextNumbers = 8;  ///< triangles or vertices per line

enum class Colour : std::uint8_t { red = 31, green = 32, yellow = 33, cyan = 36 };

std::string painted(const std::string& text, Colour colour, const ValidationRun& run) {
    if (!run.coloured) return text;
    return "\x1b[" + std::to_string(static_cast<int>(colour)) + "m" + text + "\x1b[0m";
}

Colour colour_of(mesh::Severity severity) {
    if (severity == mesh::Severity::error) return Colour::red;
    return severity == mesh::Severity::warning ? Colour::yellow : Colour::cyan;
}

std::string findings_text(std::uint64_t errors, std::uint64_t warnings, std::uint64_t notes) {
    return counted(errors, "error", "errors") + ", " + counted(warnings, "warning", "warnings") +
           ", " + counted(notes, "note", "notes");
}

/// Returns "  warning CDP0301 Edge with one triangle: 12 (boundary-edge)".
std::string finding_line(const mesh::Finding& finding, const Judgement& judgement,
                         const ValidationRun& run) {
    const mesh::RuleText& rule = mesh::text_of(finding.rule);
    std::string severity = severity_name(judgement.severity);
    severity.resize(std::string_view("warning").size(), ' ');
    std::string count = count_text(finding, judgement.fresh);
    if (!run.baseline.empty()) count += " new of " + count_text(finding, finding.count);
    return "  " + painted(severity, colour_of(judgement.severity), run) + " " +
           mesh::id_of(finding.rule) + " " + rule.title + ": " + count + " (" + rule.name + ")\n";
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
    return text + "  and " + counted(components - shown, "more component", "more components") +
           "\n";
}

std::string timings_text(const ValidationReport& report) {
    std::string text = "  " + number_text(report.seconds) + " s";
    for (const StageTime& stage : report.stages) {
        text += ", " + stage.stage + " " + number_text(stage.seconds) + " s";
    }
    return text + "\n";
}

std::string head_line(const ValidationReport& report, const ValidationRun& run) {
    ValidationTotals totals;
    totals.add(report);
    const bool is_clean = totals.errors == 0 && totals.warnings == 0;
    const std::string word = report.exit != 0 ? painted("FAILED", Colour::red, run)
                             : is_clean       ? painted("passed", Colour::green, run)
                                              : painted("has findings", Colour::yellow, run);
    std::string text = printable(report.input) + ": " + word + ", " +
                       findings_text(totals.errors, totals.warnings, totals.notes);
    if (report.known > 0) text += ", besides " + std::to_string(report.known) + " known";
    return text + "; " + counted(report.triangles, "triangle", "triangles") + ", " +
           counted(report.vertices, "vertex", "vertices") + "\n";
}

/// Returns the findings by severity, errors first, then in the order of the rules.
std::vector<std::size_t> worst_first(const ValidationReport& report) {
    std::vector<std::size_t> order(report.judgements.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return report.judgements[a].severity > report.judgements[b].severity;
    });
    return order;
}

bool has_news(const ValidationReport& report) {
    return report.error ? !report.known_error : !report.judgements.empty();
}

}  // namespace

std::string places_text(const ValidationReport& report, std::size_t finding, std::size_t most,
                        const std::string& indent) {
    const mesh::Finding& found = report.defects.findings[finding];
    std::string text;
    const std::size_t shown = std::min(found.places.size(), most);
    for (std::size_t i = 0; i < shown; ++i) {
        text += indent + place_text(report, found.rule, found.places[i], kMostTextNumbers) + "\n";
    }
    const std::uint64_t all = report.judgements[finding].fresh;
    if (all <= shown) return text;
    return text + indent + "and " + count_text(found, all - shown) + " more\n";
}

std::string validation_text(const ValidationReport& report, const ValidationRun& run) {
    if (!run.baseline.empty() && !has_news(report)) return "";
    if (report.error) {
        return printable(report.input) + ": UNREADABLE\n  " + printable(*report.error) + "\n";
    }
    std::string text = head_line(report, run);
    for (const std::size_t i : worst_first(report)) {
        text += finding_line(report.defects.findings[i], report.judgements[i], run);
        const bool is_note = report.judgements[i].severity == mesh::Severity::note;
        if (!is_note) text += places_text(report, i, run.max_places, "    ");
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
