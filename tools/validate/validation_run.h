// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "validate/rule_settings.h"
#include "validate/validation_report.h"

namespace cdprep::report {

/// The data that all reports of one run share.
struct ValidationRun {
    std::string tool_version;
    RuleSettings rules;
    std::string baseline;          ///< name of the baseline; empty without one
    std::filesystem::path folder;  ///< absolute; references are relative to it
    std::size_t max_places = 0;    ///< listed per finding, and of the components
    double weld_distance = 0;      ///< model units
    double seam_width = 0;         ///< model units
    bool crossings = true;
    std::uint64_t max_pairs = mesh::kDefaultMaxPairs;  ///< limit that ends the search for pairs
    bool coloured = false;                             ///< text with terminal colour codes
    bool timings = false;  ///< report the time of each file; if false, equal runs write equal bytes
};

/// Sums over the files of a run. With a baseline, only new findings count.
struct ValidationTotals {
    std::uint64_t files = 0;
    std::uint64_t failed = 0;      ///< because of their findings
    std::uint64_t unreadable = 0;  ///< including those that the baseline knows
    std::uint64_t errors = 0;
    std::uint64_t warnings = 0;
    std::uint64_t notes = 0;
    std::uint64_t known = 0;  ///< findings and unreadable files that the baseline contains
    int exit = 0;             ///< the highest one
    bool interrupted = false;

    void add(const ValidationReport& report);
};

}  // namespace cdprep::report
