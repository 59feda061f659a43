// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/command_page.h"
#include "repair/repair.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <vector>

#include "cli/command.h"
#include "cli/import_arguments.h"
#include "cli/load_mesh.h"
#include "cli/output_path.h"
#include "cli/program_threads.h"
#include "cli/signals.h"
#include "command_line/command_line.h"
#include "import/import_file.h"
#include "repair/repair_goal.h"
#include "repair/repair_report.h"
#include "text/nearest_word.h"
#include "write/mesh_file.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kMostSeconds = 300;       ///< default of --time
constexpr std::size_t kRefusalsShown = 5;  ///< per step, in text

struct Arguments {
    fs::path input;
    fs::path output;
    std::string preset = "safe";
    std::string steps;
    std::string format = "text";
    std::size_t threads = 0;
    ImportArguments import;
    mesh::RepairOptions options;
};

std::vector<std::string> step_names() {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < mesh::kRepairStepCount; ++i) {
        names.emplace_back(mesh::name_of(static_cast<mesh::RepairStep>(i)));
    }
    return names;
}

Error unknown_step(const std::string& name) {
    std::string list;
    for (const std::string& known : step_names()) list += (list.empty() ? "" : ", ") + known;
    return {ErrorCode::bad_argument, "--steps: unknown step '" + name + "'. Choose from " + list +
                                         "." + report::suggestion(name, step_names())};
}

/// Parses a list such as "weld,orient" into exactly those steps.
Result<mesh::RepairSteps> parse_steps(const std::string& list) {
    mesh::RepairSteps steps;
    std::istringstream names(list);
    for (std::string name; std::getline(names, name, ',');) {
        const auto step = mesh::find_repair_step(name);
        if (!step) return unknown_step(name);
        steps.set(static_cast<std::size_t>(*step));
    }
    return steps;
}

/// Returns the options for the arguments, or an error for invalid arguments.
Result<mesh::RepairOptions> options_of(const Arguments& arguments) {
    mesh::RepairOptions options = arguments.options;
    if (arguments.steps.empty()) {
        options.steps = *mesh::find_repair_preset(arguments.preset);
    } else {
        const Result<mesh::RepairSteps> steps = parse_steps(arguments.steps);
        if (!steps) return steps.error();
        options.steps = steps.value();
    }
    if (options.least_triangles > 0) {
        options.steps.set(static_cast<std::size_t>(mesh::RepairStep::drop_components));
    }
    return options;
}

/// Returns an error for an option that no step uses: the user expected an effect.
std::optional<Error> find_idle_option(const Command& command, const Arguments& arguments,
                                      const mesh::RepairSteps& steps) {
    using mesh::RepairStep;
    struct Use {
        const char* option;
        std::vector<RepairStep> steps;  ///< each of them uses it
        const char* presets;            ///< so do these
    };
    const std::array<Use, 4> uses = {{
        {"--weld", {RepairStep::weld}, "safe, closed or solid"},
        {"--seam-width",
         {RepairStep::stitch_seams, RepairStep::resolve_t_junctions},
         "closed or solid"},
        {"--hole-size", {RepairStep::fill_holes}, "closed or solid"},
        {"--time", {RepairStep::resolve_self_intersections}, "solid"},
    }};
    const auto runs = [&](RepairStep step) { return steps.test(static_cast<std::size_t>(step)); };
    for (const Use& use : uses) {
        if (command.count(use.option) == 0) continue;
        if (std::any_of(use.steps.begin(), use.steps.end(), runs)) continue;
        std::string names;
        for (const RepairStep step : use.steps) {
            names += (names.empty() ? "" : " or ") + std::string(mesh::name_of(step));
        }
        return Error{
            ErrorCode::bad_argument,
            use.option +
                (arguments.steps.empty() ? " has no effect with the preset " + arguments.preset +
                                               ": choose --preset " + use.presets
                                         : " has no effect: add " + names + " to --steps") +
                ", or remove the option."};
    }
    return std::nullopt;
}

/// Copies the report of the repair. Judges whether the preset reached its goal, and whether the
/// output has new crossings.
void judge(const Arguments& arguments, const mesh::TriangleSoup& input,
           const mesh::Repaired& repaired, const mesh::SearchOptions& search,
           report::RepairFileReport& report) {
    report.repair = repaired.report;
    const bool has_preset = arguments.steps.empty();
    report.crossing_before = mesh::find_self_crossing(input, search);
    report.crossing_after = mesh::find_output_crossing(input, repaired.mesh, search);
    if (has_preset) {
        report.missed = mesh::missed_goal(arguments.preset, repaired.report.after,
                                          *report.crossing_before, *report.crossing_after);
        report.goal = report.missed.empty();
    } else {
        report.missed = mesh::worse_crossing(*report.crossing_before, *report.crossing_after);
    }
    if (repaired.mesh.triangles.empty() && !input.triangles.empty()) {
        report.missed = "the output has no triangles, but the input has " +
                        std::to_string(input.triangles.size());
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        report.repair.input_to_output = {kInfinity, kInfinity};
    }
    if (!report.missed.empty()) report.exit = static_cast<int>(Exit::findings);
}

Result<report::RepairFileReport> repair_file(const Arguments& arguments,
                                             mesh::RepairOptions options) {
    const Result<write::MeshFormat> format = mesh_output(arguments.input, arguments.output);
    if (!format) return format.error();
    const Clock::time_point begin = Clock::now();
    const Threads threads(arguments.threads);
    options.parallel_for = threads.parallel_for();
    options.interrupted = is_interrupted;
    import::ImportOptions limits = arguments.import.options({arguments.output});
    limits.parallel_for = threads.parallel_for();
    const Result<mesh::TriangleSoup> soup = import::import_file(arguments.input, limits);
    if (!soup) return soup.error();
    for (const std::string& remark : soup->remarks) {
        std::cerr << "cdprep repair: " << arguments.input.string() << ": " << remark << '\n';
    }
    if (const auto error = find_wide_weld(arguments.input, *soup, options.weld_distance)) {
        return *error;
    }
    const mesh::Repaired repaired = mesh::repair(soup.value(), options);
    report::RepairFileReport report;
    const mesh::SearchOptions search = {
        {options.max_pairs, mesh::default_steps(repaired.mesh.triangles.size())},
        is_interrupted,
        options.parallel_for};
    if (!is_interrupted()) judge(arguments, soup.value(), repaired, search, report);
    if (is_interrupted()) return interrupted(arguments.input);
    const Result<Done> written = write_mesh(
        arguments.output, format.value(),
        {repaired.mesh.positions, repaired.mesh.triangles, repaired.mesh.single_precision});
    if (!written) return written.error();

    report.input = arguments.input.string();
    report.output = arguments.output.string();
    report.triangles = repaired.mesh.triangles.size();
    report.vertices = repaired.mesh.positions.size();
    report.triangle_origin = repaired.mesh.triangle_origin;
    report.vertex_origin = repaired.mesh.vertex_origin;
    report.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return report;
}

Exit run(const Command& command, const Arguments& arguments) {
    const Result<mesh::RepairOptions> options = options_of(arguments);
    if (!options) return fail("repair", options.error());
    if (const auto error = find_idle_option(command, arguments, options->steps)) {
        return fail("repair", *error);
    }
    const Result<report::RepairFileReport> repaired = repair_file(arguments, options.value());
    if (!repaired) {
        if (arguments.format == "json") {
            auto report = failed<report::RepairFileReport>(arguments.input, repaired.error());
            report.output = arguments.output.string();
            report_stream(arguments.output) << report::repair_json(report);
        }
        return fail("repair", repaired.error());
    }
    report_stream(arguments.output)
        << (arguments.format == "json" ? report::repair_json(repaired.value())
                                       : report::repair_text(repaired.value(), kRefusalsShown));
    if (repaired.value().missed.empty()) return Exit::success;
    std::cerr << "cdprep repair: " << repaired.value().output << ": " << repaired.value().missed
              << ".\n";
    return Exit::findings;
}

/// Adds the options for the goal or the steps, and for their limits.
void add_goal_options(const Command& command, Arguments& arguments) {
    const char* const group = "Repair";
    const Option preset =
        command
            .add_option("--preset", arguments.preset,
                        "Goal. safe: 2-manifold and oriented, no vertex moves; closed: also "
                        "without holes; solid: also without crossings")
            .type_name("PRESET")
            .check(one_of({mesh::kRepairPresets.begin(), mesh::kRepairPresets.end()}))
            .show_default()
            .group(group);
    command
        .add_option(
            "--steps", arguments.steps,
            "Comma-separated steps, instead of a preset. They run in the order below, "
            "until nothing changes. drop-bad-numbers also runs if a coordinate is not finite")
        .type_name("LIST")
        .check(list_of(step_names()))
        .excludes(preset)
        .group(group);
    command
        .add_option("--seam-width,--seam", arguments.options.seam_width,
                    "For the presets closed and solid: join boundaries within this distance of "
                    "each other, in model units. Default: 0")
        .type_name("DISTANCE")
        .check(zero_or_more())
        .group(group);
    command
        .add_option("--hole-size", arguments.options.hole_size,
                    "For the presets closed and solid: close holes whose bounding box has at most "
                    "this diagonal, in model units. Default: no limit")
        .type_name("DISTANCE")
        .check(zero_or_more())
        .group(group);
    command
        .add_option("--drop-components", arguments.options.least_triangles,
                    "Drop components with fewer than N triangles")
        .check(whole_from(0))
        .group(group);
    command
        .add_option(
            "--time", arguments.options.seconds,
            "For the preset solid: time limit for removing crossings, from the start of the "
            "repair. The report counts those that remain")
        .type_name("SECONDS")
        .check(zero_or_more("seconds"))
        .show_default()
        .group("Limits");
}

}  // namespace

void add_repair(const Command& app, Exit& exit) {
    auto arguments = std::make_shared<Arguments>();
    arguments->options.seconds = kMostSeconds;
    const Command command = app.add_command("repair", "Repair a mesh and account for every change");
    command.set_notes(
        "The exit code is 1 if the output misses the goal, is empty or has more crossings than the "
        "input. The output is written even then. The test for 2-manifold uses the output's vertex "
        "numbers. 'cdprep validate' first merges vertices with equal positions, so it may report "
        "vertices that the repair split.",
        {"cdprep repair scan.ply -o fixed.ply --preset solid",
         "cdprep repair part.obj -o part.stl --preset closed --seam-width 0.01"});
    add_input(command, arguments->input);
    command
        .add_option("-o,--output", arguments->output, "The repaired mesh: .obj, .ply, .stl or .off")
        .type_name("FILE")
        .required()
        .group("Output");
    add_goal_options(command, *arguments);
    add_weld(command, arguments->options.weld_distance);
    add_max_pairs(command, arguments->options.max_pairs);
    add_report_format(command, arguments->format);
    add_jobs(command, arguments->threads);
    add_import_arguments(command, arguments->import);
    command.callback([command, arguments, &exit] { exit = run(command, *arguments); });
}

}  // namespace cdprep::cli
