// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/ci_reports.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>

#include "text/json_layout.h"
#include "validate/place_text.h"
#include "validate/severity_name.h"
#include "validate/validation_text.h"

namespace cdprep::report {
namespace {

constexpr const char* kReplacement = "\xEF\xBF\xBD";  ///< U+FFFD

/// U+FFFE and U+FFFF are UTF-8, but no XML.
std::string without_noncharacters(std::string text) {
    for (const std::string_view unwanted : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"}) {
        for (std::size_t at = text.find(unwanted); at != std::string::npos;
             at = text.find(unwanted, at)) {
            text.replace(at, unwanted.size(), kReplacement);
        }
    }
    return text;
}

/// Text that XML 1.0 can hold, within quotes too: what it cannot is replaced.
std::string escaped(std::string_view text) {
    std::string xml;
    for (const char c : without_noncharacters(valid_utf8(text))) {
        if (c == '&') {
            xml += "&amp;";
        } else if (c == '<') {
            xml += "&lt;";
        } else if (c == '>') {
            xml += "&gt;";
        } else if (c == '"') {
            xml += "&quot;";
        } else if (static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t') {
            xml += kReplacement;
        } else {
            xml += c;
        }
    }
    return xml;
}

/// An attribute value keeps no line breaks when it is read.
std::string attribute(const char* name, std::string_view value) {
    std::string text = escaped(value);
    std::replace(text.begin(), text.end(), '\n', ' ');
    return std::string(" ") + name + "=\"" + text + "\"";
}

std::string element(const char* name, const std::string& attributes, const std::string& text) {
    return std::string("<") + name + attributes + ">" + escaped(text) + "</" + name + ">";
}

std::optional<std::size_t> finding_of(const ValidationReport& report, mesh::Rule rule) {
    const auto& findings = report.defects.findings;
    const auto at = std::find_if(findings.begin(), findings.end(),
                                 [&](const mesh::Finding& found) { return found.rule == rule; });
    if (at == findings.end()) return std::nullopt;
    return static_cast<std::size_t>(at - findings.begin());
}

std::string finding_element(const ValidationReport& report, const ValidationRun& run,
                            std::size_t i) {
    const mesh::Finding& finding = report.defects.findings[i];
    const Judgement& judgement = report.judgements[i];
    const std::string message = std::string(mesh::text_of(finding.rule).title) + ": " +
                                count_text(finding, judgement.fresh) +
                                (run.baseline.empty() ? "" : " new");
    const std::string places = places_text(report, i, run.max_places, "");
    if (!run.rules.fails(finding.rule)) {
        return element(
            "system-out", "",
            std::string(severity_name(judgement.severity)) + ": " + message + "\n" + places);
    }
    return element(
        "failure",
        attribute("message", message) + attribute("type", severity_name(judgement.severity)),
        places);
}

/// What a rule's test case holds; "" when it passed.
std::string outcome(const ValidationReport& report, const ValidationRun& run, mesh::Rule rule) {
    if (run.rules.severity(rule) == mesh::Severity::off) return "<skipped/>";
    const auto found = finding_of(report, rule);
    return found ? finding_element(report, run, *found) : "";
}

std::string test_case(const ValidationReport& report, const std::string& name,
                      const std::string& outcome) {
    const std::string begin =
        "  <testcase" + attribute("classname", report.input) + attribute("name", name);
    return outcome.empty() ? begin + "/>\n" : begin + ">" + outcome + "</testcase>\n";
}

/// XML's decimals have no exponent.
std::string decimal(double seconds) {
    constexpr std::size_t kLongest = 64;
    constexpr int kPlaces = 6;
    std::array<char, kLongest> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), seconds,
                                   std::chars_format::fixed, kPlaces)
                         .ptr;
    return {digits.data(), end};
}

struct Suite {
    std::string cases;
    std::size_t tests = 0;
    std::size_t failures = 0;
    std::size_t errors = 0;
    std::size_t skipped = 0;
};

Suite error_suite(const ValidationReport& report) {
    Suite suite;
    suite.tests = 1;
    suite.errors = report.known_error ? 0 : 1;
    suite.skipped = report.known_error ? 1 : 0;
    suite.cases = test_case(
        report, "can be read",
        report.known_error
            ? "<skipped" + attribute("message", *report.error) + "/>"
            : element("error",
                      attribute("message", *report.error) + attribute("type", "unreadable"),
                      *report.error));
    return suite;
}

Suite rule_suite(const ValidationReport& report, const ValidationRun& run) {
    Suite suite;
    for (const mesh::RuleText& rule : mesh::all_rules()) {
        const std::string found = outcome(report, run, rule.rule);
        suite.cases += test_case(report, mesh::id_of(rule.rule) + " " + rule.name, found);
        ++suite.tests;
        if (found.starts_with("<failure")) ++suite.failures;
        if (found.starts_with("<skipped")) ++suite.skipped;
    }
    return suite;
}

}  // namespace

std::string junit_head() {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"cdprep validate\">\n";
}

std::string junit_suite(const ValidationReport& report, const ValidationRun& run) {
    const Suite suite = report.error ? error_suite(report) : rule_suite(report, run);
    std::string text = " <testsuite" + attribute("name", report.input) +
                       attribute("tests", std::to_string(suite.tests)) +
                       attribute("failures", std::to_string(suite.failures)) +
                       attribute("errors", std::to_string(suite.errors)) +
                       attribute("skipped", std::to_string(suite.skipped));
    if (run.timings) text += attribute("time", decimal(report.seconds));
    text += ">\n" + suite.cases;
    std::string remarks;
    for (const std::string& remark : report.remarks) remarks += remark + "\n";
    if (!remarks.empty()) text += "  " + element("system-out", "", remarks) + "\n";
    return text + " </testsuite>\n";
}

std::string junit_tail() {
    return "</testsuites>\n";
}

}  // namespace cdprep::report
