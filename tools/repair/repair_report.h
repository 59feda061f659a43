// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "repair/repair.h"
#include "repair/repair_goal.h"

namespace cdprep::report {

/// What repairing one file gave.
struct RepairFileReport {
    std::string input;
    std::string output;
    mesh::RepairReport repair;
    std::uint64_t triangles = 0;
    std::uint64_t vertices = 0;
    std::vector<mesh::Origin> triangle_origin;  ///< of each output triangle
    std::vector<mesh::Origin> vertex_origin;
    std::optional<mesh::SelfCrossing> crossing_before;  ///< of the input, where asked
    std::optional<mesh::SelfCrossing> crossing_after;   ///< of the output
    std::optional<bool> goal;  ///< the output is what the preset promises; nothing without preset
    std::string missed;        ///< what it lacks, in words
    double seconds = 0;
    int exit = 0;                      ///< exit code for this file
    std::optional<std::string> error;  ///< the sentence, when it failed
};

/// A screen for a person: verdicts, what each step changed, what it refused, at most
/// `most_refusals` of a step in words.
[[nodiscard]] std::string repair_text(const RepairFileReport& report, std::size_t most_refusals);

/// One object, with every change by number: "triangle_source" and "vertex_source" have an
/// entry for each of the output, -1 for those that a step made. A distance that is infinite
/// and what was not asked are null.
[[nodiscard]] std::string repair_json(const RepairFileReport& report);

/// What a baked file keeps: one object with the numbers of what was changed, step by step,
/// without lists.
[[nodiscard]] std::string repair_summary_json(const mesh::RepairReport& repair);

}  // namespace cdprep::report
