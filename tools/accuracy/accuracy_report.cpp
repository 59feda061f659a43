// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/accuracy_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "text/csv_text.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {
namespace {

using study::Ladder;
using study::Rung;

constexpr double kLeastPriced = 1.5;  ///< minimum ratio of errors for a price per digit

std::string padded(std::string text, std::size_t width) {
    if (text.size() < width) text.insert(0, width - text.size(), ' ');
    return text;
}

std::string left(std::string text, std::size_t width) {
    if (text.size() < width) text.append(width - text.size(), ' ');
    return text;
}

std::string in_three_digits(double value) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.3g", value);
    return text.data();
}

/// Returns a share in per cent with few digits.
std::string per_cent(double share) {
    if (share == 0) return "0";
    const double value = 100 * share;
    if (value >= 10 && value < 1000) return fixed(value, 0) + " %";
    if (value >= 0.1 && value < 10) return fixed(value, 1) + " %";
    return in_three_digits(value) + " %";
}

/// Returns a range of shares: "1.5..7.2 %".
std::string per_cent_between(double low, double high) {
    std::string from = per_cent(low);
    const std::string to = per_cent(high);
    if (from.ends_with(" %") && to.ends_with(" %")) from.resize(from.size() - 2);
    return from + ".." + to;
}

std::string in_bytes(double bytes) {
    if (bytes < 10'000) return fixed(bytes, 0) + " B";
    if (bytes < 1e7) return fixed(bytes / 1000, 0) + " kB";
    return fixed(bytes / 1e6, 1) + " MB";
}

std::string error_word(const Rung& rung) {
    if (!rung.error) return "-";
    std::string word = per_cent(*rung.error);
    if (rung.error_high > *rung.error) {
        word += " (" + per_cent_between(rung.error_low, rung.error_high) + ")";
    }
    return word;
}

std::string misses_word(const Rung& rung) {
    if (rung.answers.empty()) return "-";
    std::size_t misses = 0;
    std::size_t of = 0;
    for (const auto& stratum : rung.strata) {
        misses += stratum.misses.count;
        of += stratum.misses.of;
    }
    const study::ShareInterval share = study::clopper_pearson(misses, of);
    return std::to_string(misses) + "/" + std::to_string(of) + " (" +
           per_cent_between(share.low, share.high) + ")";
}

/// Returns the number of wrong answers and the number of poses, as "2/250", over the poses whose
/// answer is proved at level E3.
std::string rigid_word(const study::RigidErrors& rigid) {
    return std::to_string(rigid.misses.count + rigid.false_hits.count) + "/" +
           std::to_string(rigid.misses.of + rigid.false_hits.of);
}

/// The columns of a ladder's table that are not empty.
struct Columns {
    bool misses = false;
    bool pairs = false;
    bool outer = false;
    bool build = false;
    bool bytes = false;
    bool touched = false;
    bool moved = false;
    bool distance = false;
};

Columns columns_of(const Ladder& ladder) {
    Columns columns;
    for (const Rung& rung : ladder.rungs) {
        columns.misses |= !rung.answers.empty();
        columns.pairs |= rung.pairs.has_value();
        columns.outer |= rung.outer.has_value() && !rung.displacement;
        columns.build |= rung.build_s.has_value();
        columns.bytes |= rung.bytes.has_value();
        columns.touched |= rung.touched.has_value();
        columns.moved |= rung.displacement.has_value();
        columns.distance |= rung.distance.has_value();
    }
    return columns;
}

template <class Value, class Write>
std::string or_dash(const std::optional<Value>& value, Write write) {
    return value ? write(*value) : "-";
}

std::vector<std::string> head_of(const Columns& columns) {
    std::vector<std::string> head = {"rung", "median", "p95", "p99.9"};
    if (columns.build) head.emplace_back("build");
    if (columns.bytes) head.emplace_back("size");
    if (columns.touched) head.emplace_back("reads");
    if (columns.outer) head.emplace_back("outer error");
    if (columns.moved) head.emplace_back("moved");
    head.emplace_back("error");
    if (columns.misses) {
        head.emplace_back("misses");
        head.emplace_back("wrong at E3");
    }
    if (columns.pairs) {
        head.emplace_back("recall");
        head.emplace_back("precision");
    }
    if (columns.distance) head.emplace_back("holds");
    return head;
}

std::vector<std::string> row_of(const Rung& rung, const Columns& columns) {
    std::vector<std::string> row = {rung.name, in_time(rung.time.median_s),
                                    in_time(rung.time.p95_s), in_time(rung.time.p999_s)};
    const auto bytes = [](std::uint64_t value) { return in_bytes(static_cast<double>(value)); };
    if (columns.build) row.push_back(or_dash(rung.build_s, in_time));
    if (columns.bytes) row.push_back(or_dash(rung.bytes, bytes));
    if (columns.touched) row.push_back(or_dash(rung.touched, in_bytes));
    if (columns.outer) row.push_back(or_dash(rung.outer, per_cent));
    if (columns.moved) row.push_back(or_dash(rung.displacement, per_cent));
    row.push_back(error_word(rung));
    if (columns.misses) {
        row.push_back(misses_word(rung));
        row.push_back(or_dash(rung.rigid, rigid_word));
    }
    if (columns.pairs) {
        row.push_back(
            or_dash(rung.pairs, [](const auto& pairs) { return fixed(pairs.recall.share, 5); }));
        row.push_back(
            or_dash(rung.pairs, [](const auto& pairs) { return fixed(pairs.precision.share, 5); }));
    }
    if (columns.distance) {
        row.push_back(or_dash(rung.distance, [](const auto& distance) {
            return std::to_string(distance.holds.count) + "/" + std::to_string(distance.holds.of);
        }));
    }
    return row;
}

std::string strata_text(const study::PoseSet& set) {
    std::string text;
    for (std::size_t s = 0; s < study::kStrata; ++s) {
        const std::size_t count = set.of(static_cast<study::Stratum>(s)).size();
        text += (s > 0 ? ", " : "") + std::to_string(count) + " " + study::kStratumNames[s];
        if (set.missing[s] > 0) text += " (" + std::to_string(set.missing[s]) + " not found)";
    }
    return text;
}

std::string aligned(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths;
    for (const auto& row : rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t i = 0; i < row.size(); ++i) {
            widths[i] = std::max(widths[i], row[i].size());
        }
    }
    std::string text;
    for (const auto& row : rows) {
        std::string line = "  ";
        for (std::size_t i = 0; i < row.size(); ++i) {
            line += i == 0 ? left(row[i], widths[i]) : "  " + padded(row[i], widths[i]);
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string ladder_text(const Ladder& ladder) {
    std::string text =
        "\n" + ladder.name + ": " + ladder.question + "?\n  error: " + ladder.error + "\n";
    text += ladder.rungs.empty() ? "  no rung was measured\n" : aligned(ladder_table(ladder));
    for (const std::string& sentence : ladder.left_out) text += "  left out: " + sentence + "\n";
    return text;
}

/// The cells of a row, one after the other. Cells without a measurement are empty.
class CsvRow {
public:
    void add(const std::string& cell) {
        text_ += text_.empty() ? cell : "," + cell;
    }
    void add(double value) {
        std::array<char, 40> text;
        std::snprintf(text.data(), text.size(), "%.9g", value);
        add(std::string(text.data()));
    }
    void add_count(std::size_t count) {
        add(std::to_string(count));
    }
    template <class Value>
    void add_any(const std::optional<Value>& value) {
        value ? add(static_cast<double>(*value)) : add(std::string());
    }
    void add_none(std::size_t cells) {
        for (std::size_t i = 0; i < cells; ++i) add(std::string());
    }
    [[nodiscard]] std::string line() const {
        return text_;
    }

private:
    std::string text_;
};

void add_shares(const study::ShareInterval& misses, const study::ShareInterval& false_hits,
                CsvRow& row) {
    for (const std::size_t count : {misses.count, misses.of, false_hits.count, false_hits.of}) {
        row.add_count(count);
    }
}

void add_flags(const Rung& rung, CsvRow& row) {
    if (rung.answers.empty() || !rung.rigid) return row.add_none(7);
    std::size_t misses = 0;
    std::size_t false_hits = 0;
    for (const auto& stratum : rung.strata) {
        misses += stratum.misses.count;
        false_hits += stratum.false_hits.count;
    }
    row.add_count(misses);
    row.add_count(false_hits);
    add_shares(rung.rigid->misses, rung.rigid->false_hits, row);
    row.add_count(rung.rigid->undecided);
}

void add_errors(const Rung& rung, CsvRow& row) {
    if (rung.pairs) {
        for (const study::ShareBand& band : {rung.pairs->recall, rung.pairs->precision}) {
            for (const double share : {band.share, band.low, band.high}) row.add(share);
        }
    } else {
        row.add_none(6);
    }
    if (rung.distance) {
        row.add(rung.distance->worst);
        row.add(rung.distance->median);
        row.add(rung.distance->holds.share());
    } else {
        row.add_none(3);
    }
}

/// Returns the facts that all rungs share, as the last cells of every row. Readers of CSV would
/// take a comment line for a row.
std::string study_cells(const AccuracyReport& report) {
    const study::AccuracyStudy& study = report.study;
    std::string cells;
    for (const std::string& text : {report.input, report.input_b}) {
        cells += ",";
        cells += csv_text(printable(text));
    }
    cells += "," + std::to_string(study.set.seed);
    for (const std::string& text :
         {study.machine.processor, study.machine.compiler, std::string(study.machine.kernels)}) {
        cells += ",";
        cells += csv_text(printable(text));
    }
    return cells + "," + std::to_string(study.timing.rounds) + "\n";
}

std::string csv_row(const std::string& ladder, const Rung& rung, bool is_dominated) {
    CsvRow row;
    row.add(ladder);
    row.add(csv_text(printable(rung.name)));
    row.add(csv_text(promise_name(rung.promise)));
    for (const double seconds : {rung.time.median_s, rung.time.p95_s, rung.time.p999_s,
                                 rung.time.spread_s, rung.time.low_s, rung.time.high_s}) {
        row.add(seconds);
    }
    row.add_count(rung.time.cases);
    row.add_count(rung.time.asked);
    row.add_any(rung.build_s);
    row.add_any(rung.bytes);
    row.add_any(rung.touched);
    row.add_any(rung.error);
    row.add_any(rung.error ? std::optional(rung.error_low) : std::nullopt);
    row.add_any(rung.error ? std::optional(rung.error_high) : std::nullopt);
    add_flags(rung, row);
    add_errors(rung, row);
    row.add_any(rung.outer);
    row.add_any(rung.inner);
    row.add_any(rung.displacement);
    row.add_any(rung.degenerate);
    row.add(std::string(is_dominated ? "1" : "0"));
    for (const auto& stratum : rung.strata) {
        row.add_any(stratum.median_s > 0 ? std::optional(stratum.median_s) : std::nullopt);
        if (rung.answers.empty()) {
            row.add_none(5);
            continue;
        }
        add_shares(stratum.misses, stratum.false_hits, row);
        row.add_count(stratum.unknown);
    }
    return row.line();
}

}  // namespace

std::string in_time(double seconds) {
    if (seconds < 1e-6) return in_three_digits(seconds * 1e9) + " ns";
    if (seconds < 1e-3) return in_three_digits(seconds * 1e6) + " us";
    if (seconds < 1) return in_three_digits(seconds * 1e3) + " ms";
    return in_three_digits(seconds) + " s";
}

const char* promise_name(study::Promise promise) noexcept {
    switch (promise) {
        case study::Promise::no_misses:
            return "no misses";
        case study::Promise::no_false_hits:
            return "no false hits";
        case study::Promise::both_sides:
            return "yes and no are right";
        case study::Promise::exact:
            return "exact";
        case study::Promise::interval:
            return "the interval holds the truth";
        default:
            return "none";
    }
}

std::vector<NextDigit> next_digits(const Ladder& ladder) {
    const std::vector<bool> beaten = study::dominated(ladder.rungs);
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < ladder.rungs.size(); ++i) {
        if (ladder.rungs[i].error && !beaten[i]) front.push_back(i);
    }
    std::ranges::stable_sort(front, {},
                             [&](std::size_t i) { return ladder.rungs[i].time.median_s; });
    std::vector<NextDigit> steps;
    for (std::size_t k = 1; k < front.size(); ++k) {
        const Rung& from = ladder.rungs[front[k - 1]];
        const Rung& to = ladder.rungs[front[k]];
        if (*to.error >= *from.error || from.time.median_s <= 0) continue;
        const double time = to.time.median_s / from.time.median_s;
        const double error =
            *to.error > 0 ? *from.error / *to.error : std::numeric_limits<double>::infinity();
        // If the error hardly shrinks, its price per digit means nothing.
        const bool has_price = std::isfinite(error) && error >= kLeastPriced;
        const double a_digit = has_price ? std::pow(time, 1 / std::log10(error))
                                         : std::numeric_limits<double>::quiet_NaN();
        steps.push_back({front[k - 1], front[k], time, error, a_digit});
    }
    return steps;
}

std::vector<std::vector<std::string>> ladder_table(const Ladder& ladder) {
    const Columns columns = columns_of(ladder);
    std::vector<std::vector<std::string>> table = {head_of(columns)};
    for (const Rung& rung : ladder.rungs) table.push_back(row_of(rung, columns));
    return table;
}

std::vector<std::vector<std::string>> next_digit_table(const std::vector<Ladder>& ladders) {
    std::vector<std::vector<std::string>> table = {{"step", "time", "error", "per digit"}};
    for (const Ladder& ladder : ladders) {
        for (const NextDigit& step : next_digits(ladder)) {
            const bool ends = !std::isfinite(step.error);
            table.push_back(
                {ladder.name + ": " + ladder.rungs[step.from].name + " -> " +
                     ladder.rungs[step.to].name,
                 "x " + in_three_digits(step.time),
                 ends ? "no error left" : "/ " + in_three_digits(step.error),
                 std::isnan(step.time_a_digit) ? "" : "x " + in_three_digits(step.time_a_digit)});
        }
    }
    return table;
}

std::vector<std::vector<std::string>> study_facts(const study::AccuracyStudy& study) {
    const study::Machine& machine = study.machine;
    std::string clock = "the exact query against itself takes " + fixed(study.self.ratio, 3) +
                        " times as long (" + fixed(study.self.low, 3) + ".." +
                        fixed(study.self.high, 3) + ")";
    if (!study.self.holds_one()) clock += ": this machine is too busy for reliable times";
    const double larger = std::max(study.a.diagonal, study.b.diagonal);
    const double smaller = std::min(study.a.diagonal, study.b.diagonal);
    constexpr double kAlike = 10;
    std::string sizes =
        "diagonals " + in_six_digits(study.a.diagonal) + " and " + in_six_digits(study.b.diagonal);
    if (larger > kAlike * smaller) {
        sizes += ": they differ by a factor of " + in_three_digits(larger / smaller) +
                 ". Are both in the same unit? (--unit)";
    }
    return {{"sizes", sizes},
            {"poses", strata_text(study.set) + "; seed " + std::to_string(study.set.seed) +
                          "; shares refer to " + in_six_digits(study.set.diagonal) +
                          ", the smaller diagonal"},
            {"truth", "exact for the transformed vertices (E1); at " + std::to_string(study.rigid) +
                          " of " + std::to_string(study.set.poses.size()) +
                          " poses, proved exact for the rotation too (E3)"},
            {"machine", machine.processor + ", kernels " + machine.kernels + ", " +
                            machine.compiler + ", " + machine.build + "; one thread, " +
                            std::to_string(study.timing.rounds) + " rounds"},
            {"clock", clock}};
}

/// Returns one line instead of a table: the cost of exact answers, and a cheaper way that is nearly
/// right.
std::string recommendation(const study::AccuracyStudy& study) {
    const auto geometry = std::ranges::find(study.ladders, "geometry", &Ladder::name);
    if (geometry == study.ladders.end() || geometry->rungs.empty()) {
        return "In short: run the ladder 'geometry' to see what exact answers cost.";
    }
    constexpr double kNearlyRight = 0.01;
    const Rung& exact = geometry->rungs.back();
    const Rung* cheaper = nullptr;
    for (const Rung& rung : geometry->rungs) {
        const bool is_right = rung.error && *rung.error <= kNearlyRight;
        if (!is_right || rung.time.median_s >= exact.time.median_s) continue;
        if (!cheaper || rung.time.median_s < cheaper->time.median_s) cheaper = &rung;
    }
    const std::string cost = "In short: exact answers take " + in_time(exact.time.median_s);
    if (cheaper == nullptr) {
        return cost +
               ". No faster method errs at less than 1 % of the poses, so use exact queries.";
    }
    return cost + "; " + cheaper->name + " takes " + in_time(cheaper->time.median_s) +
           " and errs at " + in_three_digits(100 * *cheaper->error) + " % of the poses.";
}

std::string accuracy_text(const AccuracyReport& report) {
    std::string text = printable(report.input) + " (" + std::to_string(report.study.a.triangles) +
                       " triangles) against " + printable(report.input_b) + " (" +
                       std::to_string(report.study.b.triangles) + ")\n";
    for (const auto& fact : study_facts(report.study)) {
        text += "  " + fact[0] + ": " + fact[1] + "\n";
    }
    for (const Ladder& ladder : report.study.ladders) text += ladder_text(ladder);
    text += "\nwhat the next digit costs, along the Pareto front\n" +
            aligned(next_digit_table(report.study.ladders));
    text += "\n" + recommendation(report.study) + "\n";
    text += "\n" + in_time(report.study.seconds) + " in total\n";
    for (const std::string& sentence : report.study.broken) {
        text += "BROKEN PROMISE: " + sentence + "\n";
    }
    return text;
}

std::string accuracy_csv(const AccuracyReport& report) {
    const study::AccuracyStudy& study = report.study;
    const std::string of_all = study_cells(report);
    std::string text =
        "ladder,rung,promise,median_s,p95_s,p999_s,spread_s,low_s,high_s,cases,asked,build_s,bytes,"
        "touched_bytes,error,error_low,error_high,misses,false_hits,e3_misses,e3_hits,"
        "e3_false_hits,e3_apart,e3_undecided,recall,recall_low,recall_high,precision,"
        "precision_low,precision_high,distance_worst,distance_median,interval_holds,outer,inner,"
        "displacement,degenerate,dominated";
    for (const char* name : study::kStratumNames) {
        text += std::string(",") + name + "_s," + name + "_misses," + name + "_hits," + name +
                "_false_hits," + name + "_apart," + name + "_unknown";
    }
    text += ",model_a,model_b,seed,processor,compiler,kernels,rounds\n";
    for (const Ladder& ladder : study.ladders) {
        const std::vector<bool> beaten = study::dominated(ladder.rungs);
        for (std::size_t i = 0; i < ladder.rungs.size(); ++i) {
            text += csv_row(ladder.name, ladder.rungs[i], beaten[i]) + of_all;
        }
    }
    return text;
}

}  // namespace cdprep::report
