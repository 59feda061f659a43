// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "cdprep/result.h"
#include "manuals/exit_codes.h"

namespace cdprep::cli {

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
void add_timings(CLI::App& command, bool& timings);
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
