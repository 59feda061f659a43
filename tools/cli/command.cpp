// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command.h"

#include <iostream>

#include "cli/signals.h"
#include "command_line/command_line.h"
#include "text/printable.h"

namespace cdprep::cli {
namespace {

constexpr int kMostThreads = 4096;
constexpr std::uint64_t kMostPairs = 1'000'000'000'000;  ///< a week of work

}  // namespace

Exit exit_for(ErrorCode code) {
    return static_cast<Exit>(code);
}

Exit fail(const char* command, const Error& error) {
    if (error.code == ErrorCode::interrupted) end_by_itself();
    if (is_output_closed()) return Exit::interrupted;
    std::cerr << "cdprep " << command << ": " << report::printable(error.message) << '\n';
    return exit_for(error.code);
}

Exit fail_all(const char* command, const std::vector<Error>& errors) {
    Exit last = Exit::success;
    for (const Error& error : errors) last = fail(command, error);
    return last;
}

Exit fail_all(const char* command, const std::vector<std::string>& sentences, ErrorCode code) {
    std::vector<Error> errors;
    errors.reserve(sentences.size());
    for (const std::string& sentence : sentences) errors.push_back({code, sentence});
    return fail_all(command, errors);
}

void add_input(const Command& command, std::filesystem::path& input) {
    command.add_option("input", input, "A mesh file: OBJ, STL, PLY, OFF, glTF, 3MF and others")
        .required();
}

void add_normalize(const Command& command, bool& normalize) {
    command
        .add_flag("--normalize", normalize,
                  "Scale to a box of diagonal 1, centred at 0. The model then has no unit")
        .group("Mesh");
}

void add_weld(const Command& command, double& distance) {
    command
        .add_option("--weld", distance,
                    "Merge vertices within this distance of each other, in model units")
        .type_name("DISTANCE")
        .check(zero_or_more())
        .show_default()
        .group("Mesh");
}

void add_max_pairs(const Command& command, std::uint64_t& pairs) {
    command
        .add_option("--max-pairs", pairs,
                    "Stop the search for crossing triangles after N pairs that meet. The report "
                    "then says that its counts are lower bounds. A million such pairs take about "
                    "0.6 s")
        .check(whole_from(1, kMostPairs))
        .show_default()
        .group("Limits");
}

void add_jobs(const Command& command, std::size_t& threads) {
    command.add_option("-j,--jobs", threads, "Number of threads. Default: 0, one per processor")
        .check(whole_from(0, kMostThreads))
        .group("General");
}

void add_report_format(const Command& command, std::string& format) {
    command.add_option("--format", format, "Format of the report")
        .type_name("FORMAT")
        .check(one_of({"text", "json"}))
        .show_default()
        .group("Report");
}

void add_timings(const Command& command, bool& timings) {
    command.add_flag("--timings", timings, "Report the time of each stage").group("Report");
}

void add_progress(const Command& command, std::string& progress) {
    command
        .add_option("--progress", progress,
                    "Progress on stderr. auto: a bar on a terminal, otherwise none. bar: one line "
                    "that is redrawn. plain: lines of text. none: no progress")
        .type_name("STYLE")
        .check(one_of({"auto", "bar", "plain", "none"}))
        .show_default()
        .group("General");
}

}  // namespace cdprep::cli
