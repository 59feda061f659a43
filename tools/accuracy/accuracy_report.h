// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/accuracy.h"

namespace cdprep::report {

/// The result of `cdprep accuracy`.
struct AccuracyReport {
    std::string input;    ///< A
    std::string input_b;  ///< B
    std::string version;  ///< of the program
    study::AccuracyStudy study;
    int exit = 0;
    std::optional<std::string> error;  ///< the message, when the study failed
};

/// One step along a ladder's front: the ratios between two consecutive rungs that are not
/// dominated in time and error.
struct NextDigit {
    std::size_t from;     ///< rung
    std::size_t to;       ///< rung
    double time;          ///< time of `to` divided by time of `from`
    double error;         ///< error of `from` divided by error of `to`; infinite if the latter is 0
    double time_a_digit;  ///< factor of time for a tenth of the error; NaN if `error` is infinite
                          ///< or close to 1
};

/// Returns the steps along the front, by ascending time. The front ends at the rungs whose error is
/// 0.
[[nodiscard]] std::vector<NextDigit> next_digits(const study::Ladder& ladder);

/// Returns text tables: every rung of every ladder, and the cost of the next digit.
[[nodiscard]] std::string accuracy_text(const AccuracyReport& report);

/// Returns one JSON object with all measurements: poses, rungs, times and answers by pose. Every
/// number in the text and the charts follows from it.
[[nodiscard]] std::string accuracy_json(const AccuracyReport& report);

/// Returns a header line and a line for each rung, for spreadsheets. The last cells of each line
/// hold the facts that all rungs share.
[[nodiscard]] std::string accuracy_csv(const AccuracyReport& report);

/// Returns the table of a ladder in words: a header row, and a row for each rung.
[[nodiscard]] std::vector<std::vector<std::string>> ladder_table(const study::Ladder& ladder);

/// Returns the steps along the front in words: a header row, and a row for each step.
[[nodiscard]] std::vector<std::vector<std::string>> next_digit_table(
    const std::vector<study::Ladder>& ladders);

/// Returns facts about a study as pairs of a name and a text: poses, truth, machine, clock.
[[nodiscard]] std::vector<std::vector<std::string>> study_facts(const study::AccuracyStudy& study);

/// Returns one complete HTML page with the charts and the tables. The charts show details on
/// hovering. The page loads nothing from the network; its Content-Security-Policy forbids it too.
[[nodiscard]] std::string accuracy_page(const AccuracyReport& report);

/// Returns the part of accuracy_json() that the page shows, for a script element.
[[nodiscard]] std::string accuracy_page_data(const AccuracyReport& report);

/// Returns the name of a promise: "exact", "no misses", ...
[[nodiscard]] const char* promise_name(study::Promise promise) noexcept;

/// Returns seconds in a suitable unit: "12.3 us".
[[nodiscard]] std::string in_time(double seconds);

}  // namespace cdprep::report
