// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cdprep/result.h"
#include "command_line/exit_codes.h"

#include "command_line/command_line.h"

namespace cdprep::cli {

[[nodiscard]] Exit exit_for(ErrorCode code);

/// Prints "cdprep COMMAND: MESSAGE" on stderr and returns the error's exit code.
Exit fail(const char* command, const Error& error);
/// Reports all errors. Returns the exit code of the last one.
Exit fail_all(const char* command, const std::vector<Error>& errors);
/// Reports sentences that have one code.
Exit fail_all(const char* command, const std::vector<std::string>& sentences, ErrorCode code);

/// The report of a failed run: the input, the exit code and the message.
template <class Report>
[[nodiscard]] Report failed(const std::filesystem::path& input, const Error& error) {
    Report report;
    report.input = input.string();
    report.exit = static_cast<int>(exit_for(error.code));
    report.error = error.message;
    return report;
}

/// Options that commands share, each with one wording. The variables that they write must
/// outlive the command.
void add_input(const Command& command, std::filesystem::path& input);
void add_normalize(const Command& command, bool& normalize);
void add_weld(const Command& command, double& distance);
void add_max_pairs(const Command& command, std::uint64_t& pairs);
void add_jobs(const Command& command, std::size_t& threads);
void add_report_format(const Command& command, std::string& format);  ///< text or json
void add_timings(const Command& command, bool& timings);
void add_progress(const Command& command, std::string& progress);

/// Each function adds its subcommand. The callback stores the exit code of the run in `exit`.
void add_accuracy(const Command& app, Exit& exit);
void add_bake(const Command& app, Exit& exit);
void add_compare(const Command& app, Exit& exit);
void add_decompose(const Command& app, Exit& exit);
void add_explain(const Command& app, Exit& exit);
void add_export(const Command& app, Exit& exit);
void add_hull(const Command& app, Exit& exit);
void add_info(const Command& app, Exit& exit);
void add_query(const Command& app, Exit& exit);
void add_reindex(const Command& app, Exit& exit);
void add_repair(const Command& app, Exit& exit);
void add_simulate(const Command& app, Exit& exit);
void add_validate(const Command& app, Exit& exit);

}  // namespace cdprep::cli
