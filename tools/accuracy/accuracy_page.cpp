// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <utility>

#include "accuracy/accuracy_chart.h"
#include "accuracy/accuracy_report.h"
#include "page/page_parts.h"
#include "page/page_text.h"
#include "text/json_layout.h"

namespace cdprep::report {
namespace page {

extern const std::string_view kAccuracyFrame;   ///< accuracy.html, with places for the rest
extern const std::string_view kAccuracyStyle;   ///< accuracy.css
extern const std::string_view kAccuracyScript;  ///< accuracy.js

}  // namespace page
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// Returns a table with a header row. With a ladder's number, each row refers to one of its rungs.
std::string table_element(const Rows& rows, const std::string& ladder) {
    std::string text = "<div class=\"table\"><table>\n<thead><tr>";
    for (const std::string& name : rows.front()) text += "<th>" + escaped(name) + "</th>";
    text += "</tr></thead>\n<tbody>\n";
    for (std::size_t i = 1; i < rows.size(); ++i) {
        text += "<tr";
        if (!ladder.empty()) {
            text += " data-ladder=\"" + ladder + "\" data-rung=\"" + std::to_string(i - 1) + "\"";
        }
        text += ">";
        for (const std::string& cell : rows[i]) text += "<td>" + escaped(cell) + "</td>";
        text += "</tr>\n";
    }
    return text + "</tbody></table></div>\n";
}

std::string figure_element(const Chart& chart) {
    return "<figure><h3>" + escaped(chart.title) + "</h3><figcaption>" +
           escaped(chart.explanation) + "</figcaption>\n<svg viewBox=\"0 0 " +
           std::to_string(kChartWidth) + " " + std::to_string(chart.height) +
           "\" role=\"group\" aria-label=\"" + escaped(chart.title) + "\">\n" + chart.body +
           "</svg></figure>\n";
}

std::string ladder_elements(const AccuracyReport& report) {
    const std::vector<Chart> charts = accuracy_charts(report);
    std::string text;
    for (std::size_t i = 0; i < report.study.ladders.size(); ++i) {
        const study::Ladder& ladder = report.study.ladders[i];
        text += "<section id=\"" + ladder.name + "\">\n<h2>" + escaped(ladder.name) +
                "</h2><p class=\"lead\">" + escaped(ladder.question) + "?</p>\n";
        for (const Chart& chart : charts) {
            if (chart.title.starts_with(ladder.name + ":")) text += figure_element(chart);
        }
        text += table_element(ladder_table(ladder), std::to_string(i));
        for (const std::string& sentence : ladder.left_out) {
            text += "<p class=\"left-out\">Left out: " + escaped(sentence) + "</p>\n";
        }
        text += "</section>\n";
    }
    return text;
}

std::string facts_element(const study::AccuracyStudy& study) {
    std::string text = "<dl>\n";
    for (const auto& fact : study_facts(study)) {
        text += "<dt>" + escaped(fact[0]) + "</dt><dd>" + escaped(fact[1]) + "</dd>\n";
    }
    return text + "</dl>\n";
}

std::string broken_element(const study::Broken& broken) {
    if (broken.empty()) return "";
    std::string text = "<section id=\"broken\"><h2>Broken promises</h2>\n";
    for (const std::string& sentence : broken) text += "<p>" + escaped(sentence) + "</p>\n";
    return text + "</section>\n";
}

std::string nav_links(const std::vector<study::Ladder>& ladders) {
    std::string text;
    for (const study::Ladder& ladder : ladders) {
        text += "<a href=\"#" + ladder.name + "\">" + escaped(ladder.name) + "</a>";
    }
    return text + "<a href=\"#next\">next digit</a>";
}

}  // namespace

std::string accuracy_page(const AccuracyReport& report) {
    const std::string heading = report.input + " against " + report.input_b;
    const std::array<std::pair<std::string_view, std::string>, 11> parts = {{
        {"@title@", escaped(valid_utf8(heading)) + " - cdprep accuracy"},
        {"@heading@", escaped(valid_utf8(heading))},
        {"@version@", escaped(report.version)},
        {"@css@", chart_style() + "\n" + std::string(page::kAccuracyStyle)},
        {"@about@", facts_element(report.study)},
        {"@broken@", broken_element(report.study.broken)},
        {"@nav@", nav_links(report.study.ladders)},
        {"@ladders@", ladder_elements(report)},
        {"@digits@", table_element(next_digit_table(report.study.ladders), "")},
        {"@data@", script_element("study", "application/json", accuracy_page_data(report))},
        {"@js@", std::string(page::kAccuracyScript)},
    }};
    return filled(page::kAccuracyFrame, parts);
}

}  // namespace cdprep::report
