// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "cdprep/plan.h"
#include "query/answer_report.h"
#include "query/triangle_lists.h"

namespace cdprep::cli {

/// What is asked of each pair of objects, besides what its layers say.
struct ClashQuestion {
    Ask effect = Ask::overlap;    ///< overlap, within or distance
    bool counts_pairs = false;    ///< of within: counts the triangle pairs; overlap always does
    bool lists_pairs = false;     ///< lists them
    bool lists_segments = false;  ///< of overlap: lists them with their segments
    Degenerate degenerate = Degenerate::keep;
    double relative_error = 0;  ///< of distance, as DistanceOptions
    double absolute_error = 0;
};

using ClashAnswer = std::variant<report::PairAnswer, report::WithinAnswer, report::DistanceAnswer>;

/// Asks pairs of objects, one after the other.
class ClashAsker {
public:
    explicit ClashAsker(const ClashQuestion& question) : question_(question) {}

    /// Returns the answer about a pair that clashes or may clash: that of a single query. Its lists
    /// stay until the next call.
    [[nodiscard]] std::optional<ClashAnswer> ask(const Pair& pair, const LayerPair& asked);

private:
    [[nodiscard]] std::optional<ClashAnswer> overlap(const Pair& pair);
    [[nodiscard]] std::optional<ClashAnswer> within(const Pair& pair, double tolerance);
    [[nodiscard]] std::optional<ClashAnswer> distance(const Pair& pair, double max_distance);

    ClashQuestion question_;
    Workspace workspace_;
    TriangleLists lists_;
};

}  // namespace cdprep::cli
