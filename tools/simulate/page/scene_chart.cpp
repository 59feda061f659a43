// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/page/scene_chart.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "page/page_parts.h"
#include "page/svg_parts.h"
#include "text/json_layout.h"
#include "text/number_text.h"
#include "text/printable.h"

namespace cdprep::report {
namespace {

// Lengths in units of the chart.
constexpr double kLeft = 76;
constexpr double kRight = kSceneChartWidth - 20;
constexpr double kBottom = kSceneChartHeight - 48;
constexpr double kKeyWidth = 191;  ///< room for the longest name in the page's letters
constexpr double kKeyHeight = 19;
constexpr std::size_t kKeyColumns = 4;
constexpr int kTicks = 6;

/// Returns the mean seconds of the stages before one, and of it, in a frame of a span.
double stacked(const TimelineSpan& span, std::size_t stages) {
    double sum = 0;
    for (std::size_t i = 0; i < stages; ++i) sum += span.seconds[i];
    return sum / static_cast<double>(span.frames);
}

/// Returns the least of 1, 2 and 5 times a power of ten that is not less.
double round_step(double value) {
    const double power = std::pow(10, std::floor(std::log10(value)));
    for (const double digit : {1.0, 2.0, 5.0}) {
        if (digit * power >= value * (1 - 1e-9)) return digit * power;
    }
    return 10 * power;
}

class TimeChart {
public:
    TimeChart(const SceneTimeline& timeline, double step_s)
        : timeline_(timeline), spans_(timeline.spans()), step_s_(step_s) {
        for (const TimelineSpan& span : spans_) {
            frames_ += static_cast<double>(span.frames);
            most_ = std::max(most_, span.longest);
        }
        if (!(most_ > 0)) most_ = 1e-6;
        if (frames_ == 0) frames_ = 1;
        const std::size_t key_rows = (timeline.stages().size() + kKeyColumns - 1) / kKeyColumns;
        top_ += kKeyHeight * static_cast<double>(key_rows);
    }

    [[nodiscard]] std::string body() const {
        std::string text = axes();
        for (std::size_t stage = timeline_.stages().size(); stage > 0; --stage) {
            text += area(stage);
        }
        if (timeline_.frames_per_span() > 1) text += longest_line();
        return text + key();
    }

private:
    [[nodiscard]] double x_of(double frame) const {
        return kLeft + (kRight - kLeft) * frame / frames_;
    }
    [[nodiscard]] double y_of(double seconds) const {
        return kBottom - (kBottom - top_) * seconds / most_;
    }

    [[nodiscard]] std::string axes() const {
        std::string text;
        const double step = round_step(most_ / kTicks);
        for (int i = 0; i * step <= most_ * (1 + 1e-9); ++i) {
            const double y = y_of(i * step);
            text += line(kLeft, y, kRight, y, i == 0 ? "axis" : "grid");
            text += words(kLeft - 8, y + 4, "end", "tick", in_six_digits(i * step * 1e6));
        }
        const double frame_step = std::max(1.0, round_step(frames_ / kTicks));
        for (int i = 0; i * frame_step <= frames_; ++i) {
            const double x = x_of(i * frame_step);
            text += line(x, kBottom, x, kBottom + 5, "axis");
            text += words(x, kBottom + 18, "middle", "tick", in_six_digits(i * frame_step));
        }
        text += words((kLeft + kRight) / 2, kBottom + 38, "middle", "name",
                      "frame, one each " + in_six_digits(step_s_) + " s");
        text += "<text transform=\"translate(16 " + units((top_ + kBottom) / 2) +
                ") rotate(-90)\" text-anchor=\"middle\" class=\"name\">us a frame</text>\n";
        return text;
    }

    /// Returns the steps of a curve over the spans.
    template <class Value>
    [[nodiscard]] std::string steps(const Value& value, const char* first) const {
        std::string path;
        double frame = 0;
        for (const TimelineSpan& span : spans_) {
            const std::string y = units(y_of(value(span)));
            path += (path.empty() ? first : "L") + units(x_of(frame)) + " " + y;
            frame += static_cast<double>(span.frames);
            path += "H" + units(x_of(frame));
        }
        return path;
    }

    /// Returns the area below the first stages. Those of fewer stages are drawn over it.
    [[nodiscard]] std::string area(std::size_t stages) const {
        const std::string name = escaped(timeline_.stages()[stages - 1]);
        const auto height = [&](const TimelineSpan& span) { return stacked(span, stages); };
        return "<path class=\"stage s" + std::to_string((stages - 1) % kColours.size()) +
               "\" d=\"M" + units(kLeft) + " " + units(kBottom) + steps(height, "L") + "V" +
               units(kBottom) + "Z\"><title>" + name + "</title></path>\n";
    }

    [[nodiscard]] std::string longest_line() const {
        const auto height = [](const TimelineSpan& span) { return span.longest; };
        return "<path class=\"longest\" d=\"" + steps(height, "M") + "\"/>\n";
    }

    [[nodiscard]] std::string key() const {
        std::string text;
        for (std::size_t i = 0; i < timeline_.stages().size(); ++i) {
            const std::size_t row = i / kKeyColumns, column = i % kKeyColumns;
            const double x = kLeft + kKeyWidth * static_cast<double>(column);
            const double y = 2 + kKeyHeight * static_cast<double>(row);
            text += "<rect x=\"" + units(x) + "\" y=\"" + units(y) +
                    "\" width=\"12\" height=\"12\" class=\"stage s" +
                    std::to_string(i % kColours.size()) + "\"/>\n" +
                    words(x + 18, y + 10, "start", "tick", timeline_.stages()[i]);
        }
        return text;
    }

public:
    // The colours of Okabe and Ito are distinguishable with any colour vision. A plan with more
    // than four effects takes others, too.
    static constexpr std::array<const char*, 11> kColours = {
        "#0072b2", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#56b4e9",
        "#555555", "#f0e442", "#8f5bb5", "#a6761d", "#1b1b1b"};

private:
    const SceneTimeline& timeline_;
    const std::vector<TimelineSpan>& spans_;
    double step_s_;
    double frames_ = 0;
    double most_ = 0;
    double top_ = 8;  ///< of the curves: the key is above
};

}  // namespace

std::string scene_chart(const SceneTimeline& timeline, double step_s) {
    return TimeChart(timeline, step_s).body();
}

std::string scene_chart_words(const SceneTimeline& timeline) {
    const std::uint64_t frames = timeline.frames_per_span();
    if (frames == 1) return "Microseconds of each frame, by stage.";
    return "Microseconds a frame, by stage: the mean of each " + std::to_string(frames) +
           " frames. The line is the longest of these frames.";
}

std::string scene_chart_style() {
    std::string style =
        ".grid{stroke:#8a94a333;stroke-width:1}.axis{stroke:#7c8796;stroke-width:1}"
        ".tick{font-size:11px;fill:#3a434f}.name{font-size:12px;fill:#59626f}"
        ".longest{fill:none;stroke:#7c8796;stroke-width:1}";
    for (std::size_t i = 0; i < TimeChart::kColours.size(); ++i) {
        style += ".s" + std::to_string(i) + "{fill:" + TimeChart::kColours[i] + "}";
    }
    return style;
}

std::string scene_svg(const SceneTimeline& timeline, const std::string& scene, double step_s) {
    constexpr int kHead = 60;
    const std::string width = std::to_string(kSceneChartWidth);
    const std::string height = std::to_string(kSceneChartHeight + kHead);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
           "\" viewBox=\"0 0 " + width + " " + height +
           "\" font-family=\"system-ui,'DejaVu Sans',sans-serif\">\n<style>" + scene_chart_style() +
           ".title{font-size:15px;font-weight:600;fill:#1a1f27}</style>\n"
           "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
           words(20, 28, "start", "title", "Time of a frame: " + printable(valid_utf8(scene))) +
           words(20, 48, "start", "name", scene_chart_words(timeline)) +
           "<g transform=\"translate(0 " + std::to_string(kHead) + ")\">\n" +
           scene_chart(timeline, step_s) + "</g>\n</svg>\n";
}

}  // namespace cdprep::report
