// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/comparison_page.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "compare/comparison_report.h"
#include "page/page_parts.h"
#include "page/page_text.h"
#include "study/cells.h"
#include "text/json_layout.h"
#include "text/number_text.h"

namespace cdprep::report {
namespace {

using study::Cell;
using study::Column;
using study::Table;
using study::Unit;

std::string text_of(const std::string& text) {
    return escaped(valid_utf8(text));
}

/// Returns the tooltip of a cell.
std::string hint_of(const Cell& cell, Unit unit) {
    std::string hint = cell.is_filled() ? "" : cell.reason;
    for (const study::Detail& detail : cell.details) {
        const bool is_time =
            unit == Unit::seconds && detail.name != "cases" && detail.name != "rounds";
        hint += (hint.empty() ? "" : ", ") + detail.name + " " +
                (is_time ? study::seconds_text(detail.value) : in_six_digits(detail.value));
    }
    if (cell.published && !cell.published->remark.empty()) {
        hint += (hint.empty() ? "" : "; ") + std::string(mark_name(cell.published->mark)) + ": " +
                cell.published->remark;
    }
    return hint;
}

std::string cell_html(const Cell& cell, Unit unit) {
    const std::string hint = hint_of(cell, unit);
    std::string kind = unit == Unit::none && !cell.value ? "word" : "";
    if (!cell.is_filled()) kind += kind.empty() ? "none" : " none";
    std::string html = "<td" + (kind.empty() ? "" : " class=\"" + kind + "\"");
    if (!hint.empty()) html += " title=\"" + text_of(hint) + "\"";
    html += '>';
    html += cell.is_filled() ? text_of(cell_text(cell, unit)) : "&ndash;";
    if (cell.published) {
        html += "<span class=\"theirs\">" + text_of(published_text(cell, unit)) + "</span>";
    }
    return html + "</td>";
}

std::string list_html(const char* kind, const std::vector<std::string>& lines) {
    if (lines.empty()) return "";
    std::string html = "<ul class=\"" + std::string(kind) + "\">\n";
    for (const std::string& line : lines) html += "<li>" + text_of(line) + "</li>\n";
    return html + "</ul>\n";
}

/// Returns the notes, the meaning of signs, and why cells are empty.
std::vector<std::string> legend_of(const Table& table) {
    std::vector<std::string> lines = table.notes;
    const auto add = [&](const std::string& line) {
        if (std::ranges::find(lines, line) == lines.end()) lines.push_back(line);
    };
    for (const study::Row& row : table.rows) {
        for (const Cell& cell : row.cells) {
            if (cell.published && cell.published->mark != study::Mark::none) {
                const std::string text = published_text(cell, Unit::none);
                add(text.back() + std::string(" ") + mark_name(cell.published->mark) + ": " +
                    cell.published->remark);
            }
            if (!cell.is_filled()) {
                add("\xe2\x80\x93 " + cell.reason);
            }
        }
    }
    return lines;
}

/// Maps seconds to places on a logarithmic axis.
class Axis {
public:
    void take(double seconds) {
        if (seconds <= 0) return;
        low_ = std::min(low_, std::floor(std::log10(seconds)));
        high_ = std::max(high_, std::ceil(std::log10(seconds)));
    }
    [[nodiscard]] bool is_empty() const {
        return low_ > high_;
    }
    [[nodiscard]] double at(double seconds) const {
        const double range = std::max(1.0, high_ - low_);
        return kLeft + (std::log10(seconds) - low_) / range * kWidth;
    }
    [[nodiscard]] std::string lines(double bottom) const {
        std::string svg = "<g class=\"axis\">";
        const int powers = static_cast<int>(std::max(high_ - low_, 1.0));
        for (int power = 0; power <= powers; ++power) {
            const double seconds = std::pow(10.0, low_ + power);
            const std::string x = fixed(at(seconds), 1);
            svg.append("<line x1=\"").append(x).append("\" x2=\"").append(x);
            svg.append("\" y1=\"20\" y2=\"").append(fixed(bottom, 0)).append("\"/>");
            svg.append("<text text-anchor=\"middle\" y=\"14\" x=\"").append(x).append("\">");
            svg.append(study::seconds_text(seconds)).append("</text>");
        }
        return svg + "</g>\n";
    }

    static constexpr double kLeft = 320;
    static constexpr double kWidth = 590;

private:
    double low_ = 99;
    double high_ = -99;
};

const Cell* find_cell(const Table& table, const study::Row& row, std::string_view key) {
    const auto at = std::ranges::find(table.columns, key, &Column::key);
    if (at == table.columns.end()) return nullptr;
    return &row.cells[static_cast<std::size_t>(at - table.columns.begin())];
}

/// The values drawn for a row.
struct Marks {
    std::optional<double> collide, overlap, paper_collide, paper_overlap;
};

Marks marks_of(const Table& table, const study::Row& row) {
    Marks marks;
    if (const Cell* cell = find_cell(table, row, "collide_deep")) {
        marks.collide = cell->value;
        if (cell->published) marks.paper_collide = cell->published->value;
    }
    if (const Cell* cell = find_cell(table, row, "overlap_deep")) {
        marks.overlap = cell->value;
        if (cell->published) marks.paper_overlap = cell->published->value;
    }
    return marks;
}

std::string circle(const char* kind, double x, double y, const std::string& hint) {
    return "<circle class=\"" + std::string(kind) + "\" r=\"4.5\" cx=\"" + fixed(x, 1) +
           "\" cy=\"" + fixed(y, 1) + "\"><title>" + text_of(hint) + "</title></circle>";
}

std::string cross(double x, double y, const std::string& hint) {
    return "<path class=\"paper\" d=\"M" + fixed(x - 4, 1) + " " + fixed(y - 4, 1) +
           "l8 8m0 -8l-8 8\"><title>" + text_of(hint) + "</title></path>";
}

/// Returns a chart of collide and overlap of each strategy over the deep poses, with the
/// comparative study's figures. Empty for other tables.
std::string chart_of(const Table& table) {
    constexpr double kStep = 22;
    Axis axis;
    std::vector<Marks> rows;
    for (const study::Row& row : table.rows) {
        const Marks marks = marks_of(table, row);
        for (const auto& value :
             {marks.collide, marks.overlap, marks.paper_collide, marks.paper_overlap}) {
            if (value) axis.take(*value);
        }
        rows.push_back(marks);
    }
    if (axis.is_empty()) return "";
    const double bottom = 26 + kStep * static_cast<double>(rows.size());
    std::string svg = "<svg viewBox=\"0 0 950 " + fixed(bottom + 30, 0) +
                      "\" width=\"950\" role=\"img\" aria-label=\"Times of each strategy\">\n" +
                      axis.lines(bottom);
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const double y = 38 + kStep * static_cast<double>(r);
        const std::string& label = table.rows[r].label;
        svg += "<text text-anchor=\"end\" x=\"308\" y=\"" + fixed(y + 4, 1) + "\">" +
               text_of(label) + "</text>";
        const auto hint = [&](const char* what, double seconds) {
            return label + ", " + what + ": " + study::seconds_text(seconds);
        };
        const Marks& marks = rows[r];
        if (marks.collide) {
            svg += circle("collide", axis.at(*marks.collide), y, hint("collide", *marks.collide));
        }
        if (marks.overlap) {
            svg += circle("overlap", axis.at(*marks.overlap), y, hint("overlap", *marks.overlap));
        }
        if (marks.paper_collide) {
            svg += cross(axis.at(*marks.paper_collide), y,
                         hint("collide, published", *marks.paper_collide));
        }
        if (marks.paper_overlap) {
            svg += cross(axis.at(*marks.paper_overlap), y,
                         hint("overlap, published", *marks.paper_overlap));
        }
        svg += '\n';
    }
    const double y = bottom + 18;
    svg += circle("collide", 306, y - 4, "collide") + "<text x=\"316\" y=\"" + fixed(y, 0) +
           "\">collide</text>" + circle("overlap", 386, y - 4, "overlap") + "<text x=\"396\" y=\"" +
           fixed(y, 0) + "\">overlap</text>" + cross(476, y - 4, "published") +
           "<text x=\"486\" y=\"" + fixed(y, 0) +
           "\">published, for other poses (ours: deep poses)</text>";
    return svg + "</svg>\n";
}

std::string id_of(const Table& table) {
    std::string id = "table-";
    for (const char letter : table.key) {
        const bool is_plain = (letter >= '0' && letter <= '9') ||
                              (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z');
        id += is_plain ? letter : '-';
    }
    return id;
}

/// Returns true for a column of words: it is aligned left, like its cells.
bool holds_words(const Table& table, std::size_t column) {
    return table.columns[column].unit == Unit::none &&
           std::ranges::none_of(table.rows, [&](const study::Row& row) {
               return row.cells[column].value.has_value();
           });
}

/// Returns the settings that all outputs begin with; the details are folded.
std::string provenance_html(const study::Comparison& comparison) {
    constexpr std::ptrdiff_t kShown = 3;
    const std::vector<std::string> lines = provenance_lines(comparison);
    const auto shown = lines.begin() + std::min(kShown, std::ssize(lines));
    return list_html("lines", {lines.begin(), shown}) +
           "<details><summary>Models, poses and peers</summary>\n" +
           list_html("lines", {shown, lines.end()}) + "</details>\n";
}

std::string table_html(const Table& table) {
    std::string html = "<section id=\"" + id_of(table) + "\">\n<h2><span class=\"number\">Table " +
                       text_of(table.key) + "</span> " + text_of(table.title) + "</h2>\n" +
                       chart_of(table) + "<div class=\"wide\"><table>\n<thead><tr><th>" +
                       text_of(table.label_title) + "</th>";
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        html += holds_words(table, c) ? "<th class=\"word\">" : "<th>";
        html += text_of(table.columns[c].title) + "</th>";
    }
    html += "</tr></thead>\n<tbody>\n";
    for (const study::Row& row : table.rows) {
        html += "<tr><th scope=\"row\">" + text_of(row.label) + "</th>";
        for (std::size_t c = 0; c < row.cells.size(); ++c) {
            html += cell_html(row.cells[c], table.columns[c].unit);
        }
        html += "</tr>\n";
    }
    return html + "</tbody>\n</table></div>\n" + list_html("notes", legend_of(table)) +
           "</section>\n";
}

std::string checks_html(const std::vector<study::Check>& checks) {
    std::string html =
        "<section id=\"checks\">\n<h2>Published claims, and promises of this library</h2>\n"
        "<ul class=\"checks\">\n";
    for (const study::Check& check : checks) {
        const bool is_open = check.verdict == study::Verdict::not_asked;
        const std::string kind = is_open ? "open" : verdict_name(check.verdict);
        html += "<li class=\"" + kind + "\"><b>" + verdict_text(check.verdict) + "</b> " +
                text_of(check.claim) + " <span>" + text_of(check.evidence) + "</span></li>\n";
    }
    return html + "</ul>\n</section>\n";
}

std::string contents_html(const study::Comparison& comparison) {
    std::string html = "<nav>";
    for (const Table& table : comparison.tables) {
        html += "<a href=\"#" + id_of(table) + "\">" + text_of(table.key) + "</a> ";
    }
    return html + "<a href=\"#checks\">checks</a> <a href=\"#errata\">errata</a></nav>\n";
}

}  // namespace

std::string comparison_page(const study::Comparison& comparison) {
    std::string names;
    for (const study::ComparedModel& model : comparison.models) {
        names += (names.empty() ? "" : ", ") + model.name;
    }
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
        "'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n"
        "<meta name=\"generator\" content=\"cdprep\">\n<link rel=\"icon\" href=\"data:,\">\n"
        "<title>" +
        text_of(names) + " - cdprep compare</title>\n<style>\n" + std::string(page::kTables) +
        "</style>\n</head>\n<body>\n<h1><span class=\"brand\">cdprep compare</span> " +
        text_of(names) + "</h1>\n" + provenance_html(comparison) + contents_html(comparison);
    for (const Table& table : comparison.tables) html += table_html(table);
    if (!comparison.checks.empty()) html += checks_html(comparison.checks);
    return html + "<section id=\"errata\">\n<h2>Errata of the published figures</h2>\n" +
           list_html("notes", comparison.errata) + "</section>\n</body>\n</html>\n";
}

}  // namespace cdprep::report
