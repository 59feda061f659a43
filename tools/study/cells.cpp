// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/cells.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace cdprep::study {
namespace {

constexpr double kMebibyte = 1 << 20;

}  // namespace

Cell number(double value) {
    Cell cell;
    cell.value = value;
    return cell;
}

Cell word(std::string text) {
    Cell cell;
    cell.text = std::move(text);
    return cell;
}

Cell without(std::string reason) {
    Cell cell;
    cell.reason = std::move(reason);
    return cell;
}

Cell count_cell(std::uint64_t count) {
    return number(static_cast<double>(count));
}

Cell size_cell(double bytes) {
    return number(bytes / kMebibyte);
}

Cell seconds_cell(const Timing& timing) {
    Cell cell = number(timing.median_s);
    cell.details = {{"p95", timing.p95_s},
                    {"spread", timing.spread_s},
                    {"low", timing.low_s},
                    {"high", timing.high_s},
                    {"cases", static_cast<double>(timing.cases)},
                    {"rounds", static_cast<double>(timing.rounds)}};
    return cell;
}

Cell seconds_cell(double seconds) {
    Cell cell = number(seconds);
    cell.details = {{"cases", 1}, {"rounds", 1}};
    return cell;
}

std::string formatted(const char* form, double value) {
    std::array<char, 384> text{};
    std::snprintf(text.data(), text.size(), form, value);
    return text.data();
}

std::string hash_text(std::uint64_t hash) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
    return text.data();
}

std::string seconds_text(double seconds) {
    struct Scale {
        double unit;
        const char* name;
    };
    constexpr std::array<Scale, 4> kScales = {
        {{1, " s"}, {1e-3, " ms"}, {1e-6, " us"}, {1e-9, " ns"}}};
    for (const Scale& scale : kScales) {
        const double value = seconds / scale.unit;
        // A value that would print as 1000 of the smaller unit prints as 1 of this one.
        if (std::fabs(value) < 0.9995 && scale.unit > 1e-9) continue;
        const int digits = std::fabs(value) < 9.995 ? 2 : std::fabs(value) < 99.95 ? 1 : 0;
        std::array<char, 64> text{};
        std::snprintf(text.data(), text.size(), "%.*f%s", digits, value, scale.name);
        return text.data();
    }
    return "0 s";
}

}  // namespace cdprep::study
