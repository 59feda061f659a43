// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/accuracy_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "page/page_parts.h"
#include "page/svg_parts.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {
namespace {

using study::Ladder;
using study::Rung;

// The following lengths are in units of the chart.
constexpr double kLeft = 84;
constexpr double kRight = 24;
constexpr double kTop = 16;
constexpr double kPlotHeight = 380;
constexpr double kFloor = 44;    ///< the height of the strip for errors of 0
constexpr double kBelow = 56;    ///< the height of the axis' numbers and name
constexpr double kLetter = 6.3;  ///< the approximate width of a letter of 11 units
constexpr double kLine = 13;

struct Box {
    double left;
    double top;
    double right;
    double bottom;

    [[nodiscard]] bool meets(const Box& other) const {
        return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
    }
};

/// Returns the colour number of a rung. Rungs of one kind share a colour.
std::size_t family_of(const std::string& name) {
    if (name.ends_with("parts")) return 1;
    if (name.starts_with("tetra-tree")) return 2;
    if (name.starts_with("octree")) return 3;
    if (name.starts_with("float")) return 4;
    if (name.ends_with("diagonals")) return 2;
    if (name.ends_with("%")) return 1;
    if (name.starts_with("double")) return 5;
    if (name.find("exact") != std::string::npos) return 6;
    return 0;
}

std::string family_class(const std::string& name) {
    std::string look(1, 'f');
    look += std::to_string(family_of(name));
    return look;
}

/// A logarithmic axis.
class Axis {
public:
    Axis(double low, double high, double from, double to) : from_(from), to_(to) {
        low_ = std::log10(low);
        high_ = std::log10(high);
        if (high_ - low_ < 0.5) {
            const double middle = 0.5 * (low_ + high_);
            low_ = middle - 0.25;
            high_ = middle + 0.25;
        }
    }

    [[nodiscard]] double at(double value) const {
        const double share = (std::log10(value) - low_) / (high_ - low_);
        return from_ + std::clamp(share, 0.0, 1.0) * (to_ - from_);
    }

    /// Returns powers of ten: with other values in between if they are few, and without some of
    /// them if they are many.
    [[nodiscard]] std::vector<double> ticks() const {
        std::vector<double> ticks;
        const std::vector<double> digits = digits_between();
        const int step = high_ - low_ > 8 ? 3 : 1;
        for (int power = static_cast<int>(std::floor(low_)); power <= high_ + 1; ++power) {
            if (power % step != 0) continue;
            for (const double digit : digits) {
                const double log = std::log10(digit) + power;
                if (log >= low_ - 1e-9 && log <= high_ + 1e-9) ticks.push_back(std::pow(10, log));
            }
        }
        return ticks;
    }

private:
    [[nodiscard]] std::vector<double> digits_between() const {
        if (high_ - low_ < 0.8) return {1, 1.5, 2, 3, 4, 5, 7};
        if (high_ - low_ < 3.2) return {1, 2, 5};
        return {1};
    }

    double low_;
    double high_;
    double from_;
    double to_;
};

struct Point {
    std::size_t rung;
    std::string name;
    double x;
    double x_low;
    double x_high;
    double y;
    double y_low;
    double y_high;
    bool hollow;
};

/// A chart of time against a quantity that should be small.
class Pareto {
public:
    Pareto(std::size_t ladder, std::string y_name, std::vector<Point> points)
        : ladder_(ladder),
          y_name_(std::move(y_name)),
          points_(std::move(points)),
          x_(make_x()),
          y_(make_y()) {}

    [[nodiscard]] std::string body() {
        std::string text = frame();
        text += front();
        for (const Point& point : points_) text += bars(point);
        for (const Point& point : points_) place(point);
        for (const Point& point : points_) text += mark(point);
        for (const Point& point : points_) text += label(point);
        return text;
    }

private:
    static constexpr double kBottom = kTop + kPlotHeight;

    static Axis axis_over(std::vector<double> values, double from, double to) {
        std::erase_if(values, [](double value) { return !(value > 0) || !std::isfinite(value); });
        if (values.empty()) values = {1};
        const auto [low, high] = std::ranges::minmax(values);
        const double room = std::max(1.5, std::pow(high / low, 0.05));  // for marks and names
        return {low / room, high * room, from, to};
    }
    [[nodiscard]] Axis make_x() const {
        std::vector<double> values;
        for (const Point& p : points_) values.insert(values.end(), {p.x, p.x_low, p.x_high});
        return axis_over(values, kLeft, kChartWidth - kRight);
    }
    [[nodiscard]] Axis make_y() const {
        std::vector<double> values;
        for (const Point& p : points_) {
            values.push_back(p.y);
            values.push_back(p.y_high);
            if (p.y > 0) values.push_back(p.y_low);
        }
        return axis_over(values, kBottom - kFloor, kTop);
    }
    [[nodiscard]] double height_of(double y) const {
        return y > 0 ? y_.at(y) : kBottom - kFloor / 2;
    }

    [[nodiscard]] std::string frame() const {
        std::string text = "<rect x=\"" + units(kLeft) + "\" y=\"" + units(kBottom - kFloor) +
                           "\" width=\"" + units(kChartWidth - kRight - kLeft) + "\" height=\"" +
                           units(kFloor) + "\" class=\"floor\"/>\n";
        for (const double tick : x_.ticks()) {
            text += line(x_.at(tick), kTop, x_.at(tick), kBottom, "grid");
            text += words(x_.at(tick), kBottom + 18, "middle", "tick", in_time(tick));
        }
        for (const double tick : y_.ticks()) {
            text += line(kLeft, y_.at(tick), kChartWidth - kRight, y_.at(tick), "grid");
            text +=
                words(kLeft - 8, y_.at(tick) + 4, "end", "tick", in_six_digits(100 * tick) + " %");
        }
        text += words(kLeft - 8, kBottom - kFloor / 2 + 4, "end", "tick", "0: exact");
        text += line(kLeft, kBottom, kChartWidth - kRight, kBottom, "axis");
        text += line(kLeft, kTop, kLeft, kBottom, "axis");
        text += words((kLeft + kChartWidth - kRight) / 2, kBottom + 42, "middle", "name",
                      "time of a query, median of the cases");
        text += "<text transform=\"translate(16 " + units((kTop + kBottom) / 2) +
                ") rotate(-90)\" text-anchor=\"middle\" class=\"name\">" + escaped(y_name_) +
                "</text>\n";
        return text;
    }

    /// Returns the staircase along the rungs that are not dominated.
    [[nodiscard]] std::string front() const {
        std::vector<Point> best;
        for (const Point& point : points_) {
            if (!point.hollow) best.push_back(point);
        }
        std::ranges::stable_sort(best, {}, &Point::x);
        std::string path;
        for (std::size_t i = 0; i < best.size(); ++i) {
            const std::string x = units(x_.at(best[i].x));
            const std::string y = units(height_of(best[i].y));
            path.append(i == 0 ? "M" : "H").append(x).append(i == 0 ? " " : "V").append(y);
        }
        return best.size() < 2 ? "" : "<path d=\"" + path + "\" class=\"front\"/>\n";
    }

    [[nodiscard]] std::string bars(const Point& p) const {
        const std::string look = "bar " + family_class(p.name);
        std::string text;
        if (p.x_high > p.x_low && p.x_low > 0) {
            text += line(x_.at(p.x_low), height_of(p.y), x_.at(p.x_high), height_of(p.y), look);
        }
        if (p.y_high > p.y_low) {
            text += line(x_.at(p.x), height_of(p.y_low), x_.at(p.x), height_of(p.y_high), look);
        }
        return text;
    }

    [[nodiscard]] std::string mark(const Point& p) const {
        return "<circle cx=\"" + units(x_.at(p.x)) + "\" cy=\"" + units(height_of(p.y)) +
               "\" r=\"5.5\" tabindex=\"0\" role=\"img\" aria-label=\"" + escaped(p.name) +
               "\" class=\"point " + family_class(p.name) + (p.hollow ? " hollow" : "") +
               "\" data-ladder=\"" + std::to_string(ladder_) + "\" data-rung=\"" +
               std::to_string(p.rung) + "\"><title>" + escaped(p.name) + "</title></circle>\n";
    }

    void place(const Point& p) {
        const double x = x_.at(p.x);
        const double y = height_of(p.y);
        taken_.push_back({x - 6, y - 6, x + 6, y + 6});
    }

    /// Returns the label beside its point if there is room, else "". The HTML page shows the name
    /// on hovering.
    [[nodiscard]] std::string label(const Point& p) {
        const double x = x_.at(p.x);
        const double y = height_of(p.y);
        const double wide = kLetter * static_cast<double>(p.name.size());
        struct Try {
            double x;
            double y;
            const char* anchor;
        };
        // Places off the bars come first. The bars pass through the point along both axes.
        const std::array<Try, 8> tries = {{{x + 7, y - 7, "start"},
                                           {x + 7, y + 15, "start"},
                                           {x - 7, y - 7, "end"},
                                           {x - 7, y + 15, "end"},
                                           {x + 9, y + 4, "start"},
                                           {x - 9, y + 4, "end"},
                                           {x, y - 10, "middle"},
                                           {x, y + 19, "middle"}}};
        for (const Try& at : tries) {
            double left = at.x;
            if (at.anchor == std::string("end")) left -= wide;
            if (at.anchor == std::string("middle")) left -= wide / 2;
            const Box box{left, at.y - kLine + 3, left + wide, at.y + 3};
            const bool is_out = box.left < kLeft || box.right > kChartWidth - 4 || box.top < 2 ||
                                box.bottom > kBottom - 1;
            const auto meets = [&](const Box& other) { return box.meets(other); };
            if (is_out || std::ranges::any_of(taken_, meets)) continue;
            taken_.push_back(box);
            return words(at.x, at.y, at.anchor, "label", p.name);
        }
        return "";
    }

    std::size_t ladder_;
    std::string y_name_;
    std::vector<Point> points_;
    Axis x_;
    Axis y_;
    std::vector<Box> taken_;
};

/// A chart of time by stratum: one line per rung.
class StrataChart {
public:
    StrataChart(std::size_t ladder, const std::vector<Rung>& rungs,
                const std::vector<std::size_t>& shown)
        : ladder_(ladder),
          rungs_(rungs),
          shown_(shown),
          columns_(used_strata()),
          times_(all_times()) {}

    /// Returns the content of the chart, or "" if nothing was timed.
    [[nodiscard]] std::string body() const {
        if (times_.empty()) return "";
        const auto [low, high] = std::ranges::minmax(times_);
        const Axis y(low / 1.5, high * 1.5, kBottom, kTop);
        std::string text = axes(y);
        std::vector<End> ends;
        for (const std::size_t r : shown_) text += rung_line(r, y, ends);
        return text + names(std::move(ends));
    }

private:
    /// The right end of a rung's line.
    struct End {
        std::size_t rung;
        double y;
    };

    static constexpr double kNames = 150;  ///< the width of the names, to the right
    static constexpr double kBottom = kTop + kPlotHeight;
    static constexpr double kWide = kChartWidth - kRight - kNames - kLeft;

    /// Returns the strata in which a shown rung was timed, from far to deep.
    [[nodiscard]] std::vector<std::size_t> used_strata() const {
        constexpr std::array<std::size_t, study::kStrata> kOrder = {4, 3, 2, 1, 0};
        std::vector<std::size_t> used;
        for (const std::size_t s : kOrder) {
            const bool has_any = std::ranges::any_of(
                shown_, [&](std::size_t r) { return rungs_[r].strata[s].median_s > 0; });
            if (has_any) used.push_back(s);
        }
        return used;
    }

    [[nodiscard]] std::vector<double> all_times() const {
        std::vector<double> times;
        for (const std::size_t r : shown_) {
            for (const std::size_t s : columns_) {
                const double seconds = rungs_[r].strata[s].median_s;
                if (seconds > 0) times.push_back(seconds);
            }
        }
        return times;
    }

    [[nodiscard]] double x_of(std::size_t column) const {
        return kLeft +
               kWide * (static_cast<double>(column) + 0.5) / static_cast<double>(columns_.size());
    }

    [[nodiscard]] std::string axes(const Axis& y) const {
        std::string text;
        for (const double tick : y.ticks()) {
            text += line(kLeft, y.at(tick), kLeft + kWide, y.at(tick), "grid");
            text += words(kLeft - 8, y.at(tick) + 4, "end", "tick", in_time(tick));
        }
        for (std::size_t column = 0; column < columns_.size(); ++column) {
            text += words(x_of(column), kBottom + 18, "middle", "tick",
                          study::kStratumNames[columns_[column]]);
        }
        text += line(kLeft, kBottom, kLeft + kWide, kBottom, "axis");
        return text + words(kLeft + kWide / 2, kBottom + 42, "middle", "name",
                            "poses, from far apart to deep penetration");
    }

    [[nodiscard]] std::string rung_line(std::size_t r, const Axis& y,
                                        std::vector<End>& ends) const {
        std::string path;
        std::string marks;
        double last = kBottom;
        const std::string family = family_class(rungs_[r].name);
        for (std::size_t column = 0; column < columns_.size(); ++column) {
            const double seconds = rungs_[r].strata[columns_[column]].median_s;
            if (!(seconds > 0)) continue;
            last = y.at(seconds);
            path += path.empty() ? "M" : "L";
            path += units(x_of(column)) + " " + units(last);
            marks += "<circle cx=\"" + units(x_of(column)) + "\" cy=\"" + units(last) +
                     "\" r=\"4\" tabindex=\"0\" class=\"point " + family + "\" data-ladder=\"" +
                     std::to_string(ladder_) + "\" data-rung=\"" + std::to_string(r) +
                     "\"><title>" + escaped(rungs_[r].name) + "</title></circle>\n";
        }
        ends.push_back({r, last});
        return "<path d=\"" + path + "\" class=\"trend " + family + "\"/>\n" + marks;
    }

    /// Returns the names of the rungs in the order of the lines' ends, without overlaps.
    [[nodiscard]] std::string names(std::vector<End> ends) const {
        std::ranges::sort(ends, {}, &End::y);
        std::string text;
        double free = kTop;
        for (const End& end : ends) {
            const double at = std::max(end.y, free);
            free = at + kLine;
            text += line(x_of(columns_.size() - 1) + 5, end.y, kLeft + kWide + 6, at, "leader");
            text += words(kLeft + kWide + 10, at + 4, "start", "label", rungs_[end.rung].name);
        }
        return text;
    }

    std::size_t ladder_;
    const std::vector<Rung>& rungs_;
    const std::vector<std::size_t>& shown_;
    std::vector<std::size_t> columns_;
    std::vector<double> times_;
};

constexpr int kBarHeight = 30;

/// Returns a bar for each rung: the median, and a line to the 95th percentile of the cases.
std::string bars_body(std::size_t ladder, const std::vector<Rung>& rungs) {
    constexpr double kNames = 150;
    std::vector<double> values;
    for (const Rung& rung : rungs) {
        values.insert(values.end(), {rung.time.median_s, rung.time.p95_s});
    }
    std::erase_if(values, [](double value) { return !(value > 0); });
    if (values.empty()) return "";
    const auto [low, high] = std::ranges::minmax(values);
    const double bottom = kTop + kBarHeight * static_cast<double>(rungs.size());
    const Axis x(low / 3, high * 1.5, kNames, kChartWidth - kRight - 60);
    std::string text;
    for (const double tick : x.ticks()) {
        text += line(x.at(tick), kTop, x.at(tick), bottom, "grid");
        text += words(x.at(tick), bottom + 18, "middle", "tick", in_time(tick));
    }
    for (std::size_t i = 0; i < rungs.size(); ++i) {
        const Rung& rung = rungs[i];
        const double y = kTop + kBarHeight * static_cast<double>(i) + 5;
        const std::string family = rung.name.ends_with("coherent") ? "f3"
                                   : rung.name.ends_with("warm")   ? "f1"
                                                                   : "f2";
        text += "<rect x=\"" + units(kNames) + "\" y=\"" + units(y) + "\" width=\"" +
                units(std::max(1.0, x.at(rung.time.median_s) - kNames)) +
                "\" height=\"20\" tabindex=\"0\" class=\"block " + family + "\" data-ladder=\"" +
                std::to_string(ladder) + "\" data-rung=\"" + std::to_string(i) + "\"><title>" +
                escaped(rung.name) + "</title></rect>\n";
        text += line(x.at(rung.time.median_s), y + 10, x.at(rung.time.p95_s), y + 10, "whisker");
        text += words(kNames - 8, y + 14, "end", "label", rung.name);
        text += words(x.at(std::max(rung.time.median_s, rung.time.p95_s)) + 6, y + 14, "start",
                      "label", in_time(rung.time.median_s));
    }
    text += words((kNames + kChartWidth) / 2, bottom + 42, "middle", "name",
                  "time of a query: median of the frames, and 95th percentile");
    return text;
}

std::vector<Point> points_by_error(const Ladder& ladder) {
    const std::vector<bool> beaten = study::dominated(ladder.rungs);
    std::vector<Point> points;
    for (std::size_t i = 0; i < ladder.rungs.size(); ++i) {
        const Rung& rung = ladder.rungs[i];
        if (!rung.error || rung.time.cases == 0) continue;
        points.push_back({i, rung.name, rung.time.median_s, rung.time.low_s, rung.time.high_s,
                          *rung.error, rung.error_low, rung.error_high, beaten[i]});
    }
    return points;
}

std::vector<Point> points_by_shape(const Ladder& ladder) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < ladder.rungs.size(); ++i) {
        const Rung& rung = ladder.rungs[i];
        // A rung with moved vertices is no shape, and its displacement is close to its error.
        if (!rung.outer || rung.displacement || rung.time.cases == 0) continue;
        points.push_back({i, rung.name, rung.time.median_s, rung.time.low_s, rung.time.high_s,
                          *rung.outer, *rung.outer, *rung.outer, false});
    }
    for (Point& point : points) {
        point.hollow = std::ranges::any_of(points, [&](const Point& other) {
            return (other.x <= point.x && other.y < point.y) ||
                   (other.x < point.x && other.y <= point.y);
        });
    }
    return points;
}

std::vector<std::size_t> rungs_of_front(const Ladder& ladder) {
    const std::vector<bool> beaten = study::dominated(ladder.rungs);
    std::vector<std::size_t> shown;
    for (std::size_t i = 0; i < ladder.rungs.size(); ++i) {
        if (ladder.rungs[i].time.cases == 0) continue;
        if (!beaten[i] || ladder.rungs[i].promise == study::Promise::exact) shown.push_back(i);
    }
    return shown;
}

constexpr int kParetoHeight = static_cast<int>(kTop + kPlotHeight + kBelow);

std::string explanation_of(const Ladder& ladder) {
    const bool has_distances = std::ranges::any_of(
        ladder.rungs, [](const Rung& rung) { return rung.distance.has_value(); });
    return "Error: " + ladder.error + ". Hollow: not on the Pareto front. Bars: 95 % confidence" +
           (has_distances ? " of the time; errors range from the median to the greatest." : ".");
}

void add_charts(std::size_t number, const Ladder& ladder, std::vector<Chart>& charts) {
    if (ladder.rungs.empty()) return;
    if (ladder.name == "coherence") {
        const int height =
            static_cast<int>(kTop + kBelow) + kBarHeight * static_cast<int>(ladder.rungs.size());
        charts.push_back({"coherence: time", "All answers are the same; only the times differ.",
                          height, bars_body(number, ladder.rungs)});
        return;
    }
    charts.push_back({ladder.name + ": time against error", explanation_of(ladder), kParetoHeight,
                      Pareto(number, "error", points_by_error(ladder)).body()});
    const std::vector<Point> shapes = points_by_shape(ladder);
    if (shapes.size() > 1) {
        charts.push_back({ladder.name + ": time against outer error",
                          "Outer error, proved: no point of a shape is farther from the solid than "
                          "this share of the diagonal.",
                          kParetoHeight, Pareto(number, "outer error", shapes).body()});
    }
    if (!ladder.cases.starts_with("pose")) return;
    charts.push_back({ladder.name + ": time against gap",
                      "The Pareto front and the exact rung; medians of each stratum.",
                      kParetoHeight,
                      StrataChart(number, ladder.rungs, rungs_of_front(ladder)).body()});
}

/// Returns the file name without its folders, which may be long.
std::string file_name(const std::string& path) {
    return printable(std::filesystem::path(path).filename().string());
}

/// Splits the text at spaces into lines of at most `most` letters.
std::vector<std::string> lines_of(const std::string& text, std::size_t most) {
    std::vector<std::string> lines;
    std::size_t begin = 0;
    while (text.size() - begin > most) {
        const std::size_t space = text.rfind(' ', begin + most);
        if (space == std::string::npos || space <= begin) break;
        lines.push_back(text.substr(begin, space - begin));
        begin = space + 1;
    }
    lines.push_back(text.substr(begin));
    return lines;
}

}  // namespace

std::vector<Chart> accuracy_charts(const AccuracyReport& report) {
    std::vector<Chart> charts;
    for (std::size_t i = 0; i < report.study.ladders.size(); ++i) {
        add_charts(i, report.study.ladders[i], charts);
    }
    return charts;
}

std::string chart_style() {
    // The colours of Okabe and Ito are distinguishable with any colour vision.
    std::string style =
        ".grid{stroke:#dfe3e8;stroke-width:1}.axis{stroke:#59626f;stroke-width:1}"
        ".floor{fill:#f1f4f8}.tick,.label{font-size:11px;fill:#3a434f}"
        ".label{fill:#1a1f27;stroke:#fff;stroke-width:3;paint-order:stroke}.name{font-size:12px;"
        "fill:#59626f}"
        ".front{fill:none;stroke:#98a2b0;stroke-width:1.5;stroke-dasharray:5 4}"
        ".leader{stroke:#c3cad3;stroke-width:1}"
        ".trend{fill:none;stroke-width:2}.bar{stroke-width:1.5;opacity:.55}"
        ".whisker{stroke:#1a1f27;stroke-width:1.5}"
        ".point{stroke-width:2}.hollow{fill:#fff!important}";
    constexpr std::array<const char*, 7> kColours = {"#333333", "#0072b2", "#d55e00", "#009e73",
                                                     "#a0609a", "#b8860b", "#000000"};
    for (std::size_t i = 0; i < kColours.size(); ++i) {
        const std::string look = ".f" + std::to_string(i);
        const std::string colour = kColours[i];
        style.append(".point").append(look).append("{fill:").append(colour).append("}");
        style.append(look).append("{stroke:").append(colour).append("}.block").append(look);
        style.append("{fill:").append(colour).append(";stroke:none}");
    }
    return style;
}

std::string accuracy_svg(const AccuracyReport& report) {
    constexpr int kHead = 64;
    constexpr int kTitle = 54;
    constexpr int kLineHeight = 16;
    constexpr std::size_t kLetters = 135;
    int height = kHead;
    std::string body;
    const std::vector<Chart> charts = accuracy_charts(report);
    for (const Chart& chart : charts) {
        body += words(20, height + 20, "start", "title", chart.title);
        for (const std::string& line : lines_of(chart.explanation, kLetters)) {
            body += words(20, height + 38, "start", "name", line);
            height += kLineHeight;
        }
        height += kTitle - kLineHeight;
        body += "<g transform=\"translate(0 " + std::to_string(height) + ")\">\n" + chart.body +
                "</g>\n";
        height += chart.height + 16;
    }
    const study::AccuracyStudy& study = report.study;
    const std::string size = std::to_string(kChartWidth) + "\" height=\"" + std::to_string(height);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + size + "\" viewBox=\"0 0 " +
           std::to_string(kChartWidth) + " " + std::to_string(height) +
           "\" font-family=\"system-ui,'DejaVu Sans',sans-serif\">\n<style>" + chart_style() +
           ".title{font-size:15px;font-weight:600;fill:#1a1f27}</style>\n"
           "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
           words(20, 28, "start", "title",
                 "What accuracy costs in time: " + file_name(report.input) + " against " +
                     file_name(report.input_b)) +
           words(20, 48, "start", "name",
                 std::to_string(study.set.poses.size()) + " poses, seed " +
                     std::to_string(study.set.seed) + "; " + study.machine.processor +
                     ", kernels " + study.machine.kernels + ", one thread") +
           body + "</svg>\n";
}

}  // namespace cdprep::report
