// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "validate/rule_settings.h"
#include "validate/validation_report.h"

namespace cdprep::report {

/// What all reports of one run share.
struct ValidationRun {
    std::string tool_version;
    RuleSettings rules;
    std::string baseline;          ///< its name; empty without one
    std::filesystem::path folder;  ///< absolute; references are relative to it
    std::size_t max_places = 0;    ///< listed of each finding, and of the components
    double weld_distance = 0;      ///< model units
    double seam_width = 0;         ///< model units
    bool crossings = true;
    std::uint64_t max_pairs = mesh::kDefaultMaxPairs;  ///< pairs that end the search for more
    bool coloured = false;                             ///< text, by the codes of terminals
    bool timings = false;  ///< show how long each file took; without, equal runs write equal bytes
};

/// Sums over the files of a run. With a baseline, findings are the new ones.
struct ValidationTotals {
    std::uint64_t files = 0;
    std::uint64_t failed = 0;      ///< by what was found
    std::uint64_t unreadable = 0;  ///< those that the baseline knows so among them
    std::uint64_t errors = 0;
    std::uint64_t warnings = 0;
    std::uint64_t notes = 0;
    std::uint64_t known = 0;  ///< findings and unreadable files that the baseline has too
    int exit = 0;             ///< the highest
    bool interrupted = false;

    void add(const ValidationReport& report);
};

}  // namespace cdprep::report
