// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/import_arguments.h"
#include "cli/output_path.h"
#include "cli/report_output.h"
#include "cli/signals.h"
#include "command_line/command_line.h"
#include "command_line/command_page.h"
#include "compare/comparison_page.h"
#include "compare/comparison_report.h"
#include "compare/pair_poses.h"
#include "compare/run_comparison.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostPoses = 10'000;
constexpr std::size_t kMostRounds = 1'000;

const std::map<std::string, PairChoice> kPairs = {
    {"fitting", PairChoice::fitting}, {"paper", PairChoice::paper}, {"all", PairChoice::all}};
const std::map<std::string, bool TableChoice::*> kTables = {{"1", &TableChoice::features},
                                                            {"2", &TableChoice::spatial},
                                                            {"3", &TableChoice::preparation},
                                                            {"4", &TableChoice::pairs},
                                                            {"talk", &TableChoice::talk}};

struct Arguments {
    std::vector<fs::path> inputs;
    fs::path output;
    fs::path poses;  ///< a folder to write them to, or empty
    std::vector<std::string> tables;
    std::string pairs = "fitting";
    std::string format = "text";
    std::string progress = "auto";
    ImportArguments import;
    ComparisonOptions options;
};

TableChoice chosen_tables(const std::vector<std::string>& names) {
    if (names.empty()) return {};
    TableChoice tables = {false, false, false, false, false};
    for (const std::string& name : names) tables.*kTables.at(name) = true;
    return tables;
}

std::string report_in(const std::string& format, const report::ComparisonReport& report) {
    if (format == "json") return report::comparison_json(report);
    if (format == "html") return report::comparison_page(report.comparison);
    if (format == "csv") return report::comparison_csv(report.comparison);
    return report::comparison_text(report.comparison);
}

/// Returns the exit code. A failed promise of an exact strategy is an internal error.
Exit exit_of(const study::Comparison& comparison) {
    const bool is_wrong = std::ranges::any_of(comparison.checks, [](const study::Check& check) {
        return check.is_promise && check.verdict == study::Verdict::fails;
    });
    return is_wrong ? Exit::internal : Exit::success;
}

/// Reports why there is no result, also as JSON if that was requested.
Exit failed_with(const Arguments& arguments, const Error& error) {
    if (arguments.format == "json" && arguments.output.empty()) {
        std::cout << report::comparison_json(
            failed<report::ComparisonReport>(arguments.inputs.front(), error));
    }
    return fail("compare", error);
}

/// Returns an error if the folder for poses is the one that they are read from.
std::optional<Error> find_replaced_poses(const Arguments& arguments) {
    std::error_code missing;
    if (!fs::equivalent(arguments.poses, arguments.options.poses, missing)) return std::nullopt;
    return Error{ErrorCode::bad_argument, "--save-poses: " + arguments.poses.string() +
                                              " has the poses that are read. Choose another "
                                              "folder."};
}

Exit run(Arguments& arguments) {
    if (const auto error = find_replaced_poses(arguments)) return fail("compare", *error);
    UsedFiles used;
    for (const fs::path& input : arguments.inputs) used.add_input(input);
    std::error_code unreadable;
    for (const auto& entry : fs::directory_iterator(arguments.options.poses, unreadable)) {
        used.add_input(entry.path());
    }
    const Result<Done> added = used.add_output(arguments.output);
    if (!added) return fail("compare", added.error());
    Result<ReportOutput> output = ReportOutput::open(arguments.output);
    if (!output) return fail("compare", output.error());

    ComparisonOptions& options = arguments.options;
    options.tables = chosen_tables(arguments.tables);
    options.pairs = kPairs.at(arguments.pairs);
    options.import = arguments.import.options({arguments.output});
    const Threads threads(options.threads);
    Result<study::Comparison> compared = compare_models(arguments.inputs, settled(options), threads,
                                                        parse_progress(arguments.progress));
    if (!compared) return failed_with(arguments, compared.error());

    report::ComparisonReport report;
    report.comparison = std::move(compared).value();
    const Exit exit = exit_of(report.comparison);
    report.exit = static_cast<int>(exit);
    Result<Done> written = output.value().append(report_in(arguments.format, report));
    if (written) written = output.value().finish();
    if (written && !arguments.poses.empty()) {
        written = write_pair_poses(arguments.poses, report.comparison, used);
    }
    if (!written) return fail("compare", written.error());
    if (exit != Exit::success) {
        std::cerr << "cdprep compare: a promise was broken; the report says which. Please report "
                     "it.\n";
    }
    return exit;
}

void add_study_options(const Command& command, Arguments& arguments) {
    ComparisonOptions& options = arguments.options;
    command
        .add_option("--pairs", arguments.pairs,
                    "Pairs of models in Table 4. paper: the pairs of the comparative study. all: "
                    "every pair of models. fitting: paper if all models are the study's, else all. "
                    "A single model is paired with itself")
        .type_name("PAIRS")
        .check(one_of({"fitting", "paper", "all"}))
        .show_default()
        .group("Study");
    command
        .add_flag("--quick", options.quick,
                  "Use few poses and one round. Unless --pairs is paper or all, also use few "
                  "pairs, with each model in at least one. Table 4 lacks 'hashed octree, literal', "
                  "a published search that misses pairs")
        .group("Study");
    command
        .add_option("--rounds", options.rounds,
                    "Maximum number of rounds of each measurement; slow ones have fewer. Default: "
                    "5; with --quick: 1")
        .check(whole_from(1, kMostRounds))
        .group("Study");
    command
        .add_option("--peers", options.peers,
                    "A program that answers the same queries with other libraries "
                    "(tests/bench/peers)")
        .type_name("FILE")
        .group("Study");
}

void add_pose_options(const Command& command, Arguments& arguments) {
    ComparisonOptions& options = arguments.options;
    const Option drawn =
        command
            .add_option("--per-stratum", options.per_stratum,
                        "Poses of a pair in each of five strata, from deep to far. Default: 20; "
                        "with --quick: 3")
            .check(whole_from(1, kMostPoses))
            .group("Poses");
    const Option seed = command.add_option("--seed", options.seed, "Seed of the poses")
                            .check(whole_from(0))
                            .show_default()
                            .group("Poses");
    command
        .add_option("--poses", options.poses,
                    "Read the poses of each pair from A-B.pose in this folder")
        .type_name("FOLDER")
        .check(existing_folder())
        .excludes(drawn)
        .excludes(seed)
        .group("Poses");
    command
        .add_option("--save-poses", arguments.poses,
                    "Write the poses into this folder, for other programs")
        .type_name("FOLDER")
        .group("Poses");
}

}  // namespace

void add_compare(const Command& app, Exit& exit) {
    auto arguments = std::make_shared<Arguments>();
    const Command command =
        app.add_command("compare", "Reproduce the tables of two published studies for mesh files");
    command.set_notes(
        "Tables 1 to 4 are those of 'A comparative study of implemented collision detection "
        "strategies' (authors and year unknown). Table 1 shows what each strategy can answer. "
        "Table 2 shows the cost of spatial decompositions, Table 3 that of hulls, hierarchies and "
        "convex pieces. Table 4 shows the times of collisions, overlapping triangles, distances, "
        "tolerances and contacts of each pair. Published figures are shown beside ours if a model "
        "has the published numbers of vertices and triangles. The table 'talk' shows the triangles "
        "that each step of pruning leaves. The search is that of 'Some techniques to speed up "
        "collision detection', a talk by Yalmar Ponce Atencio. All models are scaled to a diagonal "
        "of 1. The exit code is 6 when an exact strategy is wrong or a step of pruning loses a "
        "pair. It is also 6 when Table 1 lacks a published feature.",
        {"cdprep compare bunny.ply horse.ply --quick",
         "cdprep compare scans/*.ply --format html -o tables.html"});
    command
        .add_option("model", arguments->inputs,
                    "Mesh files: OBJ, STL, PLY, OFF, glTF, 3MF and others")
        .required();
    command.add_option("-o,--output", arguments->output, "The tables. Default: standard output")
        .type_name("FILE")
        .group("Report");
    command.add_option("--format", arguments->format, "Format of the tables")
        .type_name("FORMAT")
        .check(one_of({"text", "json", "csv", "html"}))
        .show_default()
        .group("Report");
    command.add_option("--tables", arguments->tables, "Comma-separated tables. Default: all")
        .type_name("LIST")
        .delimiter(',')
        .check(one_of({"1", "2", "3", "4", "talk"}))
        .group("Report");
    add_study_options(command, *arguments);
    add_pose_options(command, *arguments);
    add_jobs(command, arguments->options.threads);
    add_progress(command, arguments->progress);
    add_import_arguments(command, arguments->import);
    command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace cdprep::cli
