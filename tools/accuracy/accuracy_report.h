// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/accuracy.h"

namespace cdprep::report {

/// What `cdprep accuracy` gave.
struct AccuracyReport {
    std::string input;    ///< A
    std::string input_b;  ///< B
    std::string version;  ///< of the program
    study::AccuracyStudy study;
    int exit = 0;
    std::optional<std::string> error;  ///< the sentence, when it failed
};

/// One step along a ladder's front: of rungs that none beats in time and error, each against
/// the one before.
struct NextDigit {
    std::size_t from;     ///< rung
    std::size_t to;       ///< rung
    double time;          ///< so many times as long
    double error;         ///< the error is so many times as small; infinite where it ends
    double time_a_digit;  ///< times as long for a tenth of the error; NaN where it ends or hardly
                          ///< shrinks
};

/// The steps along the front, by rising time. Rungs whose error is 0 are its end.
[[nodiscard]] std::vector<NextDigit> next_digits(const study::Ladder& ladder);

/// Tables for a person: every rung of every ladder, and what the next digit costs.
[[nodiscard]] std::string accuracy_text(const AccuracyReport& report);

/// One object with everything that was measured: poses, rungs, times and answers by pose, so
/// that every number of the text and the charts can be derived again.
[[nodiscard]] std::string accuracy_json(const AccuracyReport& report);

/// A line for each rung, for spreadsheets. Lines about what all share begin with '#'.
[[nodiscard]] std::string accuracy_csv(const AccuracyReport& report);

/// The table of a ladder: a head, and a row for each rung, in words.
[[nodiscard]] std::vector<std::vector<std::string>> ladder_table(const study::Ladder& ladder);

/// The steps along the front in words: a head, and a row each.
[[nodiscard]] std::vector<std::vector<std::string>> next_digit_table(
    const std::vector<study::Ladder>& ladders);

/// Facts about a study, name by name: poses, truth, machine, clock.
[[nodiscard]] std::vector<std::vector<std::string>> study_facts(const study::AccuracyStudy& study);

/// One complete HTML page: the charts, which tell more where one points at them, and the
/// tables. It asks no network for anything, by its own Content-Security-Policy too.
[[nodiscard]] std::string accuracy_page(const AccuracyReport& report);

/// The object of accuracy_json() without what the page does not show, for a script element.
[[nodiscard]] std::string accuracy_page_data(const AccuracyReport& report);

/// "exact", "no misses", ...
[[nodiscard]] const char* promise_name(study::Promise promise) noexcept;

/// Seconds in a unit that fits: "12.3 us".
[[nodiscard]] std::string in_time(double seconds);

}  // namespace cdprep::report
