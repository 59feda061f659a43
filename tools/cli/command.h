// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "cdprep/result.h"

namespace cdprep::cli {

/// What the process returns; scripts rely on the numbers.
enum class Exit : int {
    success = 0,
    findings = 1,
    usage = 2,
    unreadable = 3,
    unwritable = 4,
    over_budget = 5,
    internal = 6,
    interrupted = 130,
};

[[nodiscard]] Exit exit_for(ErrorCode code);

/// Prints "cdprep COMMAND: SENTENCE" on stderr; returns the exit code for it.
Exit fail(const char* command, const Error& error);

/// The report of a run that failed: what went in, the exit code, the sentence.
template <class Report>
[[nodiscard]] Report failed(const std::filesystem::path& input, const Error& error) {
    Report report;
    report.input = input.string();
    report.exit = static_cast<int>(exit_for(error.code));
    report.error = error.message;
    return report;
}

/// Options that commands share, each in one wording. What they store into lives as long as
/// the command.
void add_input(CLI::App& command, std::filesystem::path& input);
void add_normalize(CLI::App& command, bool& normalize);
void add_weld(CLI::App& command, double& distance);
void add_max_pairs(CLI::App& command, std::uint64_t& pairs);
void add_jobs(CLI::App& command, std::size_t& threads);
void add_report_format(CLI::App& command, std::string& format);  ///< text or json
void add_progress(CLI::App& command, std::string& progress);

/// Each adds its subcommand; its callback stores how it went in `exit`.
void add_accuracy(CLI::App& app, Exit& exit);
void add_bake(CLI::App& app, Exit& exit);
void add_compare(CLI::App& app, Exit& exit);
void add_decompose(CLI::App& app, Exit& exit);
void add_explain(CLI::App& app, Exit& exit);
void add_hull(CLI::App& app, Exit& exit);
void add_info(CLI::App& app, Exit& exit);
void add_query(CLI::App& app, Exit& exit);
void add_reindex(CLI::App& app, Exit& exit);
void add_repair(CLI::App& app, Exit& exit);
void add_validate(CLI::App& app, Exit& exit);

}  // namespace cdprep::cli
