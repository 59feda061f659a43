// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/comparison_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "study/cells.h"
#include "text/csv_text.h"
#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {
namespace {

using Json = nlohmann::ordered_json;
using study::Cell;
using study::Comparison;
using study::Table;
using study::Unit;

constexpr std::size_t kWidth = 118;

std::string value_text(double value, Unit unit) {
    switch (unit) {
        case Unit::count:
            return fixed(value, 0);
        case Unit::seconds:
            return study::seconds_text(value);
        case Unit::mebibytes:
            return fixed(value, 4);
        default:
            return value == std::round(value) && std::fabs(value) < 1e6 ? fixed(value, 0)
                                                                        : fixed(value, 4);
    }
}

char mark_sign(study::Mark mark) {
    switch (mark) {
        case study::Mark::other_counts:
            return '*';
        case study::Mark::stand_in:
            return '~';
        case study::Mark::erratum:
            return '!';
        case study::Mark::not_comparable:
            return '#';
        default:
            return ' ';
    }
}

/// Returns the number of characters of a UTF-8 text.
std::size_t width_of(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char letter) {
        return (static_cast<unsigned char>(letter) & 0xc0U) != 0x80U;
    }));
}

/// A column of text: a heading of one or two lines, and one text per row.
struct TextColumn {
    std::array<std::string, 2> heading;
    std::vector<std::string> rows;

    [[nodiscard]] std::size_t width() const {
        std::size_t most = std::max(width_of(heading[0]), width_of(heading[1]));
        for (const std::string& row : rows) most = std::max(most, width_of(row));
        return most;
    }
};

/// Returns a title broken at the blank or comma that makes the longer line shortest.
std::array<std::string, 2> two_lines(const std::string& title) {
    std::array<std::string, 2> best = {"", title};
    for (std::size_t at = title.find(' '); at != std::string::npos; at = title.find(' ', at + 1)) {
        const std::array<std::string, 2> lines = {title.substr(0, at), title.substr(at + 1)};
        if (std::max(lines[0].size(), lines[1].size()) < std::max(best[0].size(), best[1].size())) {
            best = lines;
        }
    }
    return best;
}

/// The numbered reasons of a table: cells without a value refer to theirs.
class Reasons {
public:
    std::string sign_of(const std::string& reason) {
        const auto at = std::ranges::find(reasons_, reason);
        const auto number = static_cast<std::size_t>(at - reasons_.begin()) + 1;
        if (at == reasons_.end()) reasons_.push_back(reason);
        return std::string("[") + std::to_string(number) + "]";
    }
    [[nodiscard]] std::string lines() const {
        std::string text;
        for (std::size_t i = 0; i < reasons_.size(); ++i) {
            text +=
                std::string("  [") + std::to_string(i + 1) + "] " + printable(reasons_[i]) + '\n';
        }
        return text;
    }

private:
    std::vector<std::string> reasons_;
};

std::vector<TextColumn> text_columns(const Table& table, Reasons& reasons) {
    std::vector<TextColumn> columns;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        const study::Column& column = table.columns[c];
        TextColumn ours = {two_lines(column.title), {}};
        TextColumn theirs = {{"", "published"}, {}};
        bool has_published = false;
        for (const study::Row& row : table.rows) {
            const Cell& cell = row.cells[c];
            ours.rows.push_back(cell.is_filled() ? cell_text(cell, column.unit)
                                                 : reasons.sign_of(cell.reason));
            theirs.rows.push_back(published_text(cell, column.unit));
            has_published = has_published || cell.published;
        }
        columns.push_back(std::move(ours));
        if (has_published) columns.push_back(std::move(theirs));
    }
    return columns;
}

std::string padded_left(const std::string& text, std::size_t width) {
    return std::string(width - std::min(width, width_of(text)), ' ') + text;
}
std::string padded_right(const std::string& text, std::size_t width) {
    return text + std::string(width - std::min(width, width_of(text)), ' ');
}

void add_line(std::string& text, std::string line) {
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
}

/// Returns the columns [first, last), beside the labels.
std::string block_of(const Table& table, const std::vector<TextColumn>& columns, std::size_t first,
                     std::size_t last, std::size_t label_width) {
    std::string text;
    for (std::size_t line = 0; line < 2; ++line) {
        std::string heading = padded_right(line == 1 ? table.label_title : "", label_width);
        for (std::size_t c = first; c < last; ++c) {
            heading += "  " + padded_left(columns[c].heading[line], columns[c].width());
        }
        if (heading.find_first_not_of(' ') != std::string::npos) add_line(text, "  " + heading);
    }
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        std::string row = padded_right(printable(table.rows[r].label), label_width);
        for (std::size_t c = first; c < last; ++c) {
            row += "  " + padded_left(columns[c].rows[r], columns[c].width());
        }
        add_line(text, "  " + row);
    }
    return text;
}

/// Returns the signs behind published figures, with their meaning in this table.
std::string marks_of(const Table& table) {
    std::vector<std::string> lines;
    for (const study::Row& row : table.rows) {
        for (const Cell& cell : row.cells) {
            if (!cell.published || cell.published->mark == study::Mark::none) continue;
            const std::string line = std::string("  ") + mark_sign(cell.published->mark) + ' ' +
                                     mark_name(cell.published->mark) + ": " +
                                     printable(cell.published->remark) + '\n';
            if (std::ranges::find(lines, line) == lines.end()) lines.push_back(line);
        }
    }
    std::string text;
    for (const std::string& line : lines) text += line;
    return text;
}

/// Returns the spread between rounds as shares of the medians. Empty for tables without timings.
std::string spread_line(const Table& table) {
    std::vector<double> shares;
    double rounds = 0;
    for (const study::Row& row : table.rows) {
        for (const Cell& cell : row.cells) {
            for (const study::Detail& detail : cell.details) {
                if (detail.name == "rounds") rounds = std::max(rounds, detail.value);
                const bool is_spread = detail.name == "spread" && cell.value && *cell.value > 0;
                if (is_spread) shares.push_back(detail.value / *cell.value);
            }
        }
    }
    if (rounds == 0) return "";
    if (rounds == 1) return "  Measured once: no spread is known.\n";
    std::ranges::sort(shares);
    return "  Spread: the middle half of " + fixed(rounds, 0) + " rounds is within " +
           fixed(100 * shares[shares.size() / 2], 1) +
           " % of the median; in the worst cell, within " + fixed(100 * shares.back(), 1) + " %.\n";
}

std::string table_text(const Table& table) {
    Reasons reasons;
    const std::vector<TextColumn> columns = text_columns(table, reasons);
    std::size_t label_width = table.label_title.size();
    for (const study::Row& row : table.rows) {
        label_width = std::max(label_width, width_of(printable(row.label)));
    }
    std::string text = "\nTable " + table.key + ". " + printable(table.title) + '\n';
    for (std::size_t first = 0; first < columns.size();) {
        std::size_t last = first;
        std::size_t width = 2 + label_width;
        while (last < columns.size()) {
            const std::size_t more = 2 + columns[last].width();
            // A published figure stays beside ours.
            const bool follows = last > first && columns[last].heading[1] == "published";
            if (last > first && !follows && width + more > kWidth) break;
            width += more;
            ++last;
        }
        if (first > 0) text += '\n';
        text += block_of(table, columns, first, last, label_width);
        first = last;
    }
    text += reasons.lines() + marks_of(table) + spread_line(table);
    for (const std::string& note : table.notes) text += "  " + printable(note) + '\n';
    return text;
}

/// Returns the summary in the last lines.
std::string summary_text(const Comparison& comparison) {
    const auto count = [&](study::Verdict verdict, bool is_promise) {
        return std::to_string(std::ranges::count_if(comparison.checks, [&](const auto& check) {
            return check.verdict == verdict && check.is_promise == is_promise;
        }));
    };
    using enum study::Verdict;
    return "\nIn short: " + count(holds, false) + " published claims hold here, " +
           count(fails, false) + " do not, and " + count(not_asked, false) +
           " were not tested. Of the promises of this library, " + count(holds, true) +
           " hold and " + count(fails, true) + " fail.\n";
}

std::string checks_text(const Comparison& comparison) {
    std::string text = "\nPublished claims, and promises of this library\n";
    std::size_t failed = 0;
    std::size_t held = 0;
    for (const study::Check& check : comparison.checks) {
        if (check.verdict == study::Verdict::fails) ++failed;
        if (check.verdict == study::Verdict::holds) ++held;
        text += std::string("  ") + padded_right(verdict_text(check.verdict), 11) +
                printable(check.claim) + ": " + printable(check.evidence) + '\n';
    }
    return text + "  " + std::to_string(held) + " hold here, " + std::to_string(failed) +
           " do not.\n";
}

Json published_json(const study::Published& published) {
    Json json = Json::object();
    if (published.value) {
        json["value"] = *published.value;
    } else {
        json["text"] = published.text;
    }
    if (published.mark != study::Mark::none) {
        json["mark"] = mark_name(published.mark);
        json["remark"] = published.remark;
    }
    return json;
}

Json cell_json(const Cell& cell) {
    Json json = Json::object();
    if (cell.value) json["value"] = *cell.value;
    if (!cell.text.empty()) json["text"] = cell.text;
    if (!cell.is_filled()) json["reason"] = cell.reason;
    for (const study::Detail& detail : cell.details) json[detail.name] = detail.value;
    if (!cell.published) return json;
    json["published"] = published_json(*cell.published);
    const auto& theirs = cell.published->value;
    if (theirs && cell.value && *cell.value > 0) json["published_ratio"] = *theirs / *cell.value;
    return json;
}

Json table_json(const Table& table) {
    Json json = {{"table", table.key}, {"title", table.title}, {"columns", Json::array()}};
    for (const study::Column& column : table.columns) {
        json["columns"].push_back(
            {{"key", column.key}, {"title", column.title}, {"unit", unit_name(column.unit)}});
    }
    json["rows"] = Json::array();
    for (const study::Row& row : table.rows) {
        Json cells = Json::object();
        for (std::size_t c = 0; c < table.columns.size(); ++c) {
            cells[table.columns[c].key] = cell_json(row.cells[c]);
        }
        json["rows"].push_back({{"label", row.label}, {"cells", std::move(cells)}});
    }
    json["notes"] = table.notes;
    return json;
}

Json settings_json(const study::ComparisonSettings& settings) {
    return {{"version", settings.version}, {"quick", settings.quick},
            {"seed", settings.seed},       {"poses_per_stratum", settings.per_stratum},
            {"poses", settings.poses},     {"pairs_left_out", settings.pairs_left_out},
            {"rounds", settings.rounds},   {"threads", settings.threads}};
}

Json model_json(const study::ComparedModel& model) {
    return {{"name", model.name},
            {"file", model.file},
            {"read_vertices", model.read_vertices},
            {"read_triangles", model.read_triangles},
            {"read_hash", study::hash_text(model.read_hash)},
            {"built_vertices", model.built_vertices},
            {"built_triangles", model.built_triangles},
            {"built_hash", study::hash_text(model.built_hash)},
            {"likeness", model.likeness}};
}

Json poses_json(const study::ComparedPair& pair) {
    Json poses = Json::array();
    for (const study::StudyPose& pose : pair.poses.poses) {
        const auto& r = pose.a_from_b.rotation();
        const format::Double3& t = pose.a_from_b.translation();
        poses.push_back(
            {{"stratum", study::kStratumNames[static_cast<std::size_t>(pose.stratum)]},
             {"a_from_b", {r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], t.x, t.y, t.z}},
             {"hit", pose.hit}});
    }
    Json json = {{"a", pair.a}, {"b", pair.b}};
    if (pair.poses.source.empty()) {
        json["seed"] = pair.poses.seed;
    } else {
        json["source"] = pair.poses.source;
    }
    json["hash"] = study::hash_text(study::hash_of(pair.poses));
    json["poses"] = std::move(poses);
    return json;
}

std::string csv_number(double value) {
    return compact(Json(value));
}

std::string csv_cell(const Cell& cell) {
    std::string line = cell.value ? csv_number(*cell.value) : "";
    line += ',' + (cell.text.empty() ? "" : csv_text(cell.text));
    line += ',' + (cell.is_filled() ? "" : csv_text(cell.reason));
    if (cell.published) {
        const study::Published& theirs = *cell.published;
        line += ',' + (theirs.value ? csv_number(*theirs.value) : csv_text(theirs.text));
        line += std::string(",") + mark_name(theirs.mark) + ',';
        if (!theirs.remark.empty()) line += csv_text(theirs.remark);
    } else {
        line += ",,,";
    }
    for (const char* name : {"p95", "spread", "low", "high", "cases", "rounds"}) {
        const auto at = std::ranges::find(cell.details, name, &study::Detail::name);
        line += ',';
        if (at != cell.details.end()) line += csv_number(at->value);
    }
    return line;
}

std::string medians_of(std::size_t rounds) {
    return rounds == 1 ? "measured once"
                       : "medians of " + std::to_string(rounds) + " alternating rounds";
}

}  // namespace

const char* verdict_name(study::Verdict verdict) noexcept {
    if (verdict == study::Verdict::not_asked) return "not asked";
    return verdict == study::Verdict::holds ? "holds" : "fails";
}

const char* verdict_text(study::Verdict verdict) noexcept {
    return verdict == study::Verdict::not_asked ? "not tested" : verdict_name(verdict);
}

const char* unit_name(study::Unit unit) noexcept {
    switch (unit) {
        case Unit::count:
            return "count";
        case Unit::seconds:
            return "s";
        case Unit::mebibytes:
            return "MiB";
        case Unit::share:
            return "share";
        default:
            return "";
    }
}

const char* mark_name(study::Mark mark) noexcept {
    switch (mark) {
        case study::Mark::other_counts:
            return "other counts";
        case study::Mark::stand_in:
            return "stand-in";
        case study::Mark::erratum:
            return "erratum";
        case study::Mark::not_comparable:
            return "not comparable";
        default:
            return "";
    }
}

std::string cell_text(const Cell& cell, Unit unit) {
    if (cell.value) return value_text(*cell.value, unit);
    if (!cell.text.empty()) return cell.text;
    std::string reason = "[";
    reason += cell.reason;
    return reason + "]";
}

std::string published_text(const Cell& cell, Unit unit) {
    if (!cell.published) return "";
    const study::Published& theirs = *cell.published;
    std::string text = theirs.value ? value_text(*theirs.value, unit) : theirs.text;
    if (theirs.mark != study::Mark::none) text += mark_sign(theirs.mark);
    return text;
}

std::vector<std::string> provenance_lines(const Comparison& comparison) {
    const study::Machine& machine = comparison.machine;
    const study::ComparisonSettings& settings = comparison.settings;
    std::vector<std::string> lines = {
        "cdprep " + settings.version + ", " + machine.compiler + ", " + machine.build +
            ", kernels " + machine.kernels,
        machine.processor + ", " + std::to_string(machine.processors) + " processors, " +
            std::to_string(machine.memory >> 30U) + " GiB; " + machine.system,
        (settings.poses.empty() ? "Seed " + std::to_string(settings.seed) + ", " +
                                      std::to_string(settings.per_stratum) + " poses per stratum"
                                : "Poses from " + settings.poses) +
            "; " + medians_of(settings.rounds) + "; one thread; all threads: " +
            std::to_string(settings.threads) + (settings.quick ? "; --quick" : "")};
    lines.emplace_back(
        "Published figures: tables 1 to 4 of 'A comparative study of implemented collision "
        "detection strategies' (authors and year unknown), and the talk 'Some techniques to speed "
        "up collision detection' by Yalmar Ponce Atencio");
    for (const study::ComparedModel& model : comparison.models) {
        lines.push_back(
            model.name + " (" + model.file + "): " + std::to_string(model.read_vertices) +
            " vertices and " + std::to_string(model.read_triangles) + " triangles read, hash " +
            study::hash_text(model.read_hash) + "; built from " +
            std::to_string(model.built_vertices) + " and " + std::to_string(model.built_triangles) +
            ", hash " + study::hash_text(model.built_hash) + "; " + model.likeness);
    }
    for (const study::ComparedPair& pair : comparison.pairs) {
        const study::PoseSet& poses = pair.poses;
        lines.push_back(pair.a + " x " + pair.b + ": " + std::to_string(poses.poses.size()) +
                        " poses " +
                        (poses.source.empty() ? "by seed " + std::to_string(poses.seed)
                                              : "of " + poses.source) +
                        ", hash " + study::hash_text(study::hash_of(poses)));
    }
    if (settings.pairs_left_out > 0) {
        lines.push_back(
            "--quick measures " + std::to_string(comparison.pairs.size()) + " of " +
            std::to_string(comparison.pairs.size() + settings.pairs_left_out) +
            " pairs, with each model in at least one; --pairs paper or all measures more.");
    }
    if (!comparison.pairs.empty()) {
        lines.emplace_back(
            "The JSON report contains the poses; --save-poses writes them to files.");
    }
    lines.insert(lines.end(), comparison.peers.begin(), comparison.peers.end());
    return lines;
}

std::string comparison_text(const Comparison& comparison) {
    std::string text;
    for (const std::string& line : provenance_lines(comparison)) text += printable(line) + '\n';
    for (const Table& table : comparison.tables) text += table_text(table);
    if (!comparison.checks.empty()) text += checks_text(comparison);
    text += "\nErrata of the published figures\n";
    for (const std::string& erratum : comparison.errata) text += "  " + erratum + '\n';
    return text + summary_text(comparison);
}

std::string comparison_json(const ComparisonReport& report) {
    if (!report.error.empty()) {
        return laid_out({{"input", report.input}, {"exit", report.exit}, {"error", report.error}},
                        0) +
               '\n';
    }
    const Comparison& comparison = report.comparison;
    Json json = {{"exit", report.exit},
                 {"settings", settings_json(comparison.settings)},
                 {"machine", study::machine_json<Json>(comparison.machine)}};
    json["models"] = Json::array();
    for (const study::ComparedModel& model : comparison.models) {
        json["models"].push_back(model_json(model));
    }
    json["tables"] = Json::array();
    for (const Table& table : comparison.tables) json["tables"].push_back(table_json(table));
    json["checks"] = Json::array();
    for (const study::Check& check : comparison.checks) {
        json["checks"].push_back({{"claim", check.claim},
                                  {"verdict", verdict_name(check.verdict)},
                                  {"promise", check.is_promise},
                                  {"evidence", check.evidence}});
    }
    json["errata"] = comparison.errata;
    json["peers"] = comparison.peers;
    json["pairs"] = Json::array();
    for (const study::ComparedPair& pair : comparison.pairs) {
        json["pairs"].push_back(poses_json(pair));
    }
    return laid_out(json, 0) + '\n';
}

std::string comparison_csv(const Comparison& comparison) {
    std::string text =
        "table,row,column,unit,value,text,reason,published,mark,remark,p95,spread,low,high,"
        "cases,rounds\n";
    const std::string no_figures = ",,,,,,\n";
    for (const std::string& line : provenance_lines(comparison)) {
        text += "\"provenance\",,,,," + csv_text(printable(line)) + ",,,," + no_figures;
    }
    for (const Table& table : comparison.tables) {
        for (const study::Row& row : table.rows) {
            for (std::size_t c = 0; c < table.columns.size(); ++c) {
                text += csv_text(table.key) + ',' + csv_text(row.label) + ',' +
                        table.columns[c].key + ',' + unit_name(table.columns[c].unit) + ',' +
                        csv_cell(row.cells[c]) + '\n';
            }
        }
    }
    for (const study::Check& check : comparison.checks) {
        text += "\"claims\"," + csv_text(printable(check.claim)) + ",verdict,,," +
                csv_text(verdict_name(check.verdict)) + ",,,," +
                csv_text(printable(check.evidence)) + no_figures;
    }
    return text;
}

}  // namespace cdprep::report
