// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "repair/repair.h"
#include "repair/repair_goal.h"

namespace cdprep::report {

/// The result of repairing one file.
struct RepairFileReport {
    std::string input;
    std::string output;
    mesh::RepairReport repair;
    std::uint64_t triangles = 0;
    std::uint64_t vertices = 0;
    std::vector<mesh::Origin> triangle_origin;  ///< of each output triangle
    std::vector<mesh::Origin> vertex_origin;
    std::optional<mesh::SelfCrossing> crossing_before;  ///< of the input, if computed
    std::optional<mesh::SelfCrossing> crossing_after;   ///< of the output
    std::optional<bool> goal;  ///< the output keeps the preset's promise; nothing without a preset
    std::string missed;        ///< the goals that were not reached, in words
    double seconds = 0;
    int exit = 0;                      ///< exit code for this file
    std::optional<std::string> error;  ///< the message, if it failed
};

/// Returns one screen of text: verdicts, the changes of each step, and the refusals. Lists at
/// most `most_refusals` refusals per step in words.
[[nodiscard]] std::string repair_text(const RepairFileReport& report, std::size_t most_refusals);

/// Returns one JSON object with every change by number, which repair.schema.json describes.
/// "triangle_source" and "vertex_source" have an entry for each output triangle and vertex, -1 for
/// those that a step made. An infinite distance is null, and so is a value that was not requested.
[[nodiscard]] std::string repair_json(const RepairFileReport& report);

/// Returns the summary that a baked file keeps, as info.schema.json describes it: one object with
/// the counts of changes, step by step, without lists.
[[nodiscard]] std::string repair_summary_json(const mesh::RepairReport& repair);

}  // namespace cdprep::report
