// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "query/clash_search.h"

namespace cdprep::report {

/// The work on some pairs of objects.
struct ClashCounts {
    std::uint64_t queried = 0;
    std::uint64_t clashes = 0;
    std::uint64_t undecided = 0;  ///< solids: one may contain the other, but nothing proves it
    double seconds = 0;           ///< that the queries took, on all threads together

    void add(const ClashCounts& other) noexcept;
};

/// The summary of a search for clashes.
struct ClashSummary {
    std::string scene;
    std::uint64_t objects = 0;  ///< that a pair of layers asks for
    std::uint64_t models = 0;   ///< of these objects
    std::uint64_t possible = 0;
    std::uint64_t candidates = 0;
    double largest = 0;   ///< the largest tolerance or max_distance of a pair of layers
    double rounding = 0;  ///< AssemblyScene::rounding
    ClashCounts counts;
};

/// Words a search for clashes: a line for each, in the members of the single query, then the
/// summary. The text and JSON are made step by step.
class ClashReport {
public:
    /// `effect` is overlap, within or distance.
    ClashReport(Ask effect, AnswerFormat format);

    /// Returns the text that begins the report.
    [[nodiscard]] std::string begin() const;
    /// Returns the line of a clash. It begins with what separates it from the line before it.
    [[nodiscard]] std::string line(const std::string& a, const std::string& b,
                                   const cli::ClashAnswer& answer) const;
    /// Returns lines as they follow the text before them.
    [[nodiscard]] std::string next(std::string lines);
    /// Returns the text that ends the report.
    [[nodiscard]] std::string finish(const ClashSummary& summary) const;

private:
    [[nodiscard]] std::string summary_json(const ClashSummary& summary) const;
    [[nodiscard]] std::string summary_text(const ClashSummary& summary) const;
    [[nodiscard]] const char* limit_name() const noexcept;

    Ask effect_;
    AnswerFormat format_;
    bool is_first_ = true;
};

}  // namespace cdprep::report
