// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/ci_reports.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <pugixml.hpp>
#include <sstream>
#include <string_view>

#include "text/json_layout.h"
#include "validate/place_text.h"
#include "validate/severity_name.h"
#include "validate/validation_text.h"

namespace cdprep::report {
namespace {

using pugi::xml_node;

constexpr const char* kReplacement = "\xEF\xBF\xBD";  ///< U+FFFD

/// Returns the text with U+FFFD for what XML 1.0 forbids: control characters, U+FFFE and U+FFFF.
std::string xml_text(std::string_view text) {
    std::string valid = valid_utf8(text);
    for (const std::string_view unwanted : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"}) {
        for (std::size_t at = valid.find(unwanted); at != std::string::npos;
             at = valid.find(unwanted, at)) {
            valid.replace(at, unwanted.size(), kReplacement);
        }
    }
    std::string result;
    for (const char c : valid) {
        if (static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t') {
            result += kReplacement;
        } else {
            result += c;
        }
    }
    return result;
}

/// Sets an attribute; line breaks become spaces, since readers would replace them.
void set(xml_node element, const char* attribute, std::string_view value) {
    std::string text = xml_text(value);
    std::replace(text.begin(), text.end(), '\n', ' ');
    element.append_attribute(attribute).set_value(text.c_str());
}

xml_node add_element(xml_node parent, const char* name, std::string_view text) {
    xml_node element = parent.append_child(name);
    element.text().set(xml_text(text).c_str());
    return element;
}

std::optional<std::size_t> finding_of(const ValidationReport& report, mesh::Rule rule) {
    const auto& findings = report.defects.findings;
    const auto at = std::find_if(findings.begin(), findings.end(),
                                 [&](const mesh::Finding& found) { return found.rule == rule; });
    if (at == findings.end()) return std::nullopt;
    return static_cast<std::size_t>(at - findings.begin());
}

void add_finding(xml_node test_case, const ValidationReport& report, const ValidationRun& run,
                 std::size_t i) {
    const mesh::Finding& finding = report.defects.findings[i];
    const Judgement& judgement = report.judgements[i];
    const std::string message = std::string(mesh::text_of(finding.rule).title) + ": " +
                                count_text(finding, judgement.fresh) +
                                (run.baseline.empty() ? "" : " new");
    const std::string places = places_text(report, i, run.max_places, "");
    const std::string severity(severity_name(judgement.severity));
    if (!run.rules.fails(finding.rule)) {
        add_element(test_case, "system-out", severity + ": " + message + "\n" + places);
        return;
    }
    const xml_node failure = add_element(test_case, "failure", places);
    set(failure, "message", message);
    set(failure, "type", severity);
}

xml_node add_test_case(xml_node suite, const ValidationReport& report, std::string_view name) {
    const xml_node test_case = suite.append_child("testcase");
    set(test_case, "classname", report.input);
    set(test_case, "name", name);
    return test_case;
}

/// Returns a decimal without an exponent, as XML requires.
std::string decimal(double seconds) {
    constexpr std::size_t kLongest = 64;
    constexpr int kPlaces = 6;
    std::array<char, kLongest> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), seconds,
                                   std::chars_format::fixed, kPlaces)
                         .ptr;
    return {digits.data(), end};
}

void add_error_case(xml_node suite, const ValidationReport& report) {
    xml_node test_case = add_test_case(suite, report, "can be read");
    if (report.known_error) {
        set(test_case.append_child("skipped"), "message", *report.error);
        return;
    }
    const xml_node error = add_element(test_case, "error", *report.error);
    set(error, "message", *report.error);
    set(error, "type", "unreadable");
}

void add_rule_cases(xml_node suite, const ValidationReport& report, const ValidationRun& run) {
    for (const mesh::RuleText& rule : mesh::all_rules()) {
        xml_node test_case = add_test_case(suite, report, mesh::id_of(rule.rule) + " " + rule.name);
        if (run.rules.severity(rule.rule) == mesh::Severity::off) {
            test_case.append_child("skipped");
        } else if (const auto found = finding_of(report, rule.rule)) {
            add_finding(test_case, report, run, *found);
        }
    }
}

std::size_t count_cases(xml_node suite, const char* outcome) {
    std::size_t count = 0;
    for (const xml_node test_case : suite.children("testcase")) {
        if (!outcome || test_case.child(outcome)) ++count;
    }
    return count;
}

}  // namespace

std::string junit_head() {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"cdprep validate\">\n";
}

std::string junit_suite(const ValidationReport& report, const ValidationRun& run) {
    pugi::xml_document document;
    const xml_node suite = document.append_child("testsuite");
    if (report.error) {
        add_error_case(suite, report);
    } else {
        add_rule_cases(suite, report, run);
    }
    set(suite, "name", report.input);
    set(suite, "tests", std::to_string(count_cases(suite, nullptr)));
    set(suite, "failures", std::to_string(count_cases(suite, "failure")));
    set(suite, "errors", std::to_string(count_cases(suite, "error")));
    set(suite, "skipped", std::to_string(count_cases(suite, "skipped")));
    if (run.timings) set(suite, "time", decimal(report.seconds));
    std::string remarks;
    for (const std::string& remark : report.remarks) remarks += remark + "\n";
    if (!remarks.empty()) add_element(suite, "system-out", remarks);
    std::ostringstream text;
    suite.print(text, " ", pugi::format_default, pugi::encoding_utf8, 1);
    return text.str();
}

std::string junit_tail() {
    return "</testsuites>\n";
}

}  // namespace cdprep::report
