// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "cli/colliders.h"
#include "cli/colour.h"
#include "cli/command.h"
#include "cli/import_arguments.h"
#include "cli/input_list.h"
#include "cli/output_path.h"
#include "cli/progress.h"
#include "cli/report_output.h"
#include "cli/signals.h"
#include "command_line/command_line.h"
#include "command_line/command_page.h"
#include "text/printable.h"
#include "validate/validation.h"
#include "validate/validation_page.h"
#include "validate/validation_writer.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;
using report::ValidationFormat;

constexpr std::size_t kTextPlaces = 3;       ///< a person reads the first ones
constexpr std::size_t kServicePlaces = 100;  ///< services that show SARIF or JUnit cut long lists
constexpr std::uint64_t kMostPlaces = 100'000'000;

const std::map<std::string, ValidationFormat> kFormats = {{"text", ValidationFormat::text},
                                                          {"json", ValidationFormat::json},
                                                          {"ndjson", ValidationFormat::ndjson},
                                                          {"sarif", ValidationFormat::sarif},
                                                          {"junit", ValidationFormat::junit}};

struct ValidateArguments {
    std::vector<std::string> inputs;
    std::string files_from;
    fs::path output;
    fs::path html;
    fs::path baseline;
    std::string format = "text";
    std::string progress = "auto";
    std::string colour = "auto";
    std::vector<std::string> rules;
    std::vector<std::string> fail_on;
    std::optional<std::size_t> max_issues;
    std::size_t threads = 0;
    bool null = false;
    bool no_crossings = false;
    ImportArguments import;
    bool with_colliders = false;
    ValidationOptions options;
};

Result<std::vector<Input>> inputs_for(const ValidateArguments& arguments) {
    if (arguments.inputs.empty() && arguments.files_from.empty()) {
        return Error{ErrorCode::bad_argument,
                     "no input. Name files, folders or patterns, or a list with --files-from."};
    }
    std::vector<Input> inputs = list_inputs(arguments.inputs);
    if (arguments.files_from.empty()) return inputs;
    const Result<std::vector<std::string>> listed =
        read_file_list(arguments.files_from, arguments.null ? ListEnd::nul : ListEnd::line);
    if (!listed) return listed.error();
    add_inputs(inputs, listed.value());
    return inputs;
}

/// Fails if an output would replace a file that is read, or another output.
Result<Done> check_output(const ValidateArguments& arguments, const std::vector<Input>& inputs) {
    if (arguments.output.empty() && arguments.html.empty()) return Done{};
    UsedFiles used;
    for (const Input& input : inputs) used.add_input(input.path);
    used.add_input(arguments.baseline);
    if (arguments.files_from != "-") used.add_input(arguments.files_from);
    if (Result<Done> added = used.add_output(arguments.output); !added) return added;
    return used.add_output(arguments.html);
}

Result<report::Baseline> read_baseline(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string text;
    std::getline(file, text, '\0');  // JSON has no zero byte; unlike an iterator, it never throws
    if (!file.is_open() || file.bad()) {
        return Error{ErrorCode::unreadable, path.string() + ": the baseline cannot be read."};
    }
    return report::Baseline::parse(text, path.string());
}

/// One run: validates files in parallel and reports them in their order.
class Run {
public:
    Run(const ValidationOptions& options, ValidationFormat format, ReportOutput output,
        std::optional<ValidationPage> page, Progress& progress)
        : options_(options),
          writer_(format, options.run),
          shows_errors_(format == ValidationFormat::text && !output.is_file() &&
                        ::isatty(STDOUT_FILENO) != 0),
          output_(std::move(output)),
          page_(std::move(page)),
          progress_(progress) {}

    Exit all(const std::vector<Input>& inputs, const Threads& threads) {
        deliver(writer_.head());
        // A report on standard output is a whole document even if the work is abandoned.
        const LastWords words([this] {
            give_up();
            return std::string();
        });
        threads.run_in_order(inputs.size(), [&](std::size_t i) -> std::function<void()> {
            if (is_over()) return [] {};
            auto validation = std::make_shared<Validation>(
                validate(inputs[i], options_, threads, [&](const char* stage) {
                    show(report::printable(inputs[i].path.filename().string()) + ": " + stage);
                }));
            if (!page_) validation->soup = {};  // before it waits for its turn
            return [this, validation] { take(*validation); };
        });
        return finish();
    }

private:
    [[nodiscard]] bool is_over() const {
        return is_interrupted() || is_stuck_;
    }

    void show(const std::string& what) {
        const std::lock_guard lock(progress_mutex_);
        progress_.show(done_, what);
    }

    void take(Validation& validation) {
        const report::ValidationReport& report = validation.report;
        const std::lock_guard lock(progress_mutex_);
        if (is_over()) return;
        progress_.clear();
        ++done_;
        if (validation.has_conflict) has_conflict_ = true;
        if (report.error && !report.known_error && !shows_errors_) {
            std::cerr << "cdprep validate: " << report::printable(*report.error) << '\n';
        }
        deliver(writer_.add(report));
        if (page_) page_->add(std::move(validation));
    }

    void deliver(const std::string& text) {
        if (is_stuck_) return;
        if (const Result<Done> done = output_.append(text); !done) stop(done.error());
    }

    void stop(const Error& error) {
        stuck_ = fail("validate", error);
        is_stuck_ = true;
    }

    /// Ends a report that is written during the run. Whoever writes it now may hold the lock for a
    /// moment, or for good where nobody reads the output.
    void give_up() {
        const std::unique_lock lock(progress_mutex_, std::chrono::milliseconds(50));
        if (!lock || is_ended_ || output_.is_file()) return;
        is_ended_ = true;  // the command may get as far as its own end before the program ends
        writer_.set_interrupted(static_cast<int>(Exit::interrupted));
        deliver(writer_.tail());
        static_cast<void>(output_.finish());
    }

    Exit finish() {
        const std::lock_guard lock(progress_mutex_);
        if (is_ended_) return Exit::interrupted;
        is_ended_ = true;
        const bool interrupted = is_interrupted();
        if (interrupted) writer_.set_interrupted(static_cast<int>(Exit::interrupted));
        deliver(writer_.tail());
        const auto exit = static_cast<Exit>(writer_.totals().exit);
        const bool is_abandoned = interrupted || has_conflict_;
        if (!is_stuck_ && !(is_abandoned && output_.is_file())) {
            if (const Result<Done> done = output_.finish(); !done) stop(done.error());
        }
        if (!is_stuck_ && !is_abandoned && page_) {
            if (const Result<Done> done = page_->finish(); !done) stop(done.error());
        }
        return std::max(exit, stuck_);
    }

    const ValidationOptions& options_;
    report::ValidationWriter writer_;
    bool shows_errors_;  ///< the report shows errors on the terminal; stderr would repeat them
    ReportOutput output_;
    std::optional<ValidationPage> page_;
    Progress& progress_;
    std::timed_mutex progress_mutex_;
    std::size_t done_ = 0;
    bool is_ended_ = false;
    bool has_conflict_ = false;  ///< an input refers to an output, so that no file may appear
    std::atomic<bool> is_stuck_ = false;  ///< the output accepts no more text
    Exit stuck_ = Exit::success;
};

std::size_t default_places(ValidationFormat format) {
    switch (format) {
        case ValidationFormat::text:
            return kTextPlaces;
        case ValidationFormat::sarif:
        case ValidationFormat::junit:
            return kServicePlaces;
        default:
            return mesh::DefectOptions{}.max_places;
    }
}

/// Checks the arguments and fills the options, without reading any file.
Result<Done> settle(ValidateArguments& arguments) {
    const auto rules = report::RuleSettings::parse(arguments.rules, arguments.fail_on);
    if (!rules) return rules.error();
    mesh::DefectOptions& defects = arguments.options.defects;
    defects.crossings = !arguments.no_crossings;
    report::ValidationRun& run = arguments.options.run;
    run.tool_version = CDPREP_VERSION;
    run.rules = rules.value();
    run.baseline = arguments.baseline.string();
    run.folder = fs::current_path();
    run.max_places = arguments.max_issues.value_or(default_places(kFormats.at(arguments.format)));
    // A page marks places in the mesh, even if the report lists only a few.
    arguments.options.kept_places =
        arguments.html.empty() || arguments.max_issues
            ? run.max_places
            : std::max(run.max_places, mesh::DefectOptions{}.max_places);
    run.weld_distance = defects.weld_distance;
    run.seam_width = defects.seam_width;
    run.crossings = defects.crossings;
    run.coloured = arguments.output.empty() && is_coloured(arguments.colour);
    run.max_pairs = defects.max_pairs;
    arguments.options.import = arguments.import.options({arguments.output, arguments.html});
    arguments.options.leaves_out_colliders = !arguments.with_colliders;
    return Done{};
}

Exit run(ValidateArguments& arguments) {
    const Result<Done> settled = settle(arguments);
    if (!settled) return fail("validate", settled.error());
    const Result<std::vector<Input>> inputs = inputs_for(arguments);
    if (!inputs) return fail("validate", inputs.error());
    const Result<Done> checked = check_output(arguments, inputs.value());
    if (!checked) return fail("validate", checked.error());
    std::optional<report::Baseline> baseline;
    if (!arguments.baseline.empty()) {
        Result<report::Baseline> known = read_baseline(arguments.baseline);
        if (!known) return fail("validate", known.error());
        baseline = std::move(known).value();
        arguments.options.baseline = &*baseline;
    }
    Result<ReportOutput> output = ReportOutput::open(arguments.output);
    if (!output) return fail("validate", output.error());
    std::optional<ValidationPage> page;
    if (!arguments.html.empty()) {
        Result<ValidationPage> opened = ValidationPage::open(arguments.html);
        if (!opened) return fail("validate", opened.error());
        page.emplace(std::move(opened).value());
    }
    const Threads threads(arguments.threads);
    Progress progress(parse_progress(arguments.progress), inputs.value().size());
    return Run(arguments.options, kFormats.at(arguments.format), std::move(output).value(),
               std::move(page), progress)
        .all(inputs.value(), threads);
}

void add_judging_options(const Command& command, ValidateArguments& arguments) {
    const char* const group = "Rules";
    command
        .add_option("--fail-on", arguments.fail_on,
                    "Exit with 1 for findings of this severity or a higher one (note, warning, "
                    "error), or of this rule. May be repeated. Default: error")
        .type_name("SEVERITY")
        .one_value_each()
        .group(group);
    command
        .add_option("--rule", arguments.rules,
                    "RULE=SEVERITY: set the severity of a rule, by id or name: off, note, warn, "
                    "warning or error. May be repeated. 'cdprep explain' lists the rules")
        .type_name("SETTING")
        .one_value_each()
        .group(group);
    command
        .add_option("--baseline", arguments.baseline,
                    "An earlier report, written with --format json. Only findings not in it are "
                    "listed and count for --fail-on")
        .type_name("FILE")
        .group(group);
    command
        .add_option("--max-issues", arguments.max_issues,
                    "Maximum number of listed places per rule and file; counts are not limited. "
                    "Default: 3 for text, 100 for sarif and junit, else 1000")
        .check(whole_from(0, kMostPlaces))
        .group("Report");
    command
        .add_option("--weld", arguments.options.defects.weld_distance,
                    "Report distinct vertices within this distance of each other, in model units; "
                    "0: do not search")
        .type_name("DISTANCE")
        .check(zero_or_more())
        .show_default()
        .group(group);
    command
        .add_option("--seam-width,--seam", arguments.options.defects.seam_width,
                    "Report boundaries within this distance of each other, in model units; 0: do "
                    "not search")
        .type_name("DISTANCE")
        .check(zero_or_more())
        .show_default()
        .group(group);
    add_max_pairs(command, arguments.options.defects.max_pairs);
    command
        .add_flag("--no-crossings", arguments.no_crossings,
                  "Skip rules CDP0403 and CDP0501 to CDP0503; the verdict states this")
        .group(group);
}

}  // namespace

void add_validate(const Command& app, Exit& exit) {
    auto arguments = std::make_shared<ValidateArguments>();
    const Command command = app.add_command("validate", "Report defects of meshes");
    command.set_notes(
        "Triangles and vertices are numbered from 0, as in the file. Without --fail-on, the exit "
        "code is 1 if an error is found.\n\n"
        "Nodes and groups that are colliders of an engine are left out, as by 'cdprep bake'. "
        "Triangles and vertices are then numbered without them.",
        {"cdprep validate model.obj", "cdprep validate assets --format sarif -o meshes.sarif",
         "git diff --name-only -z main | cdprep validate --files-from - -0",
         "cdprep validate scan.ply --html scan.html"});
    command
        .add_option("input", arguments->inputs,
                    "Mesh files, folders, or patterns such as 'assets/**/*.obj'")
        .type_name("PATTERN");
    const Option list = command
                            .add_option("--files-from", arguments->files_from,
                                        "Read inputs from a file, one per line; -: standard input")
                            .type_name("FILE")
                            .group("Inputs from a list");
    command.add_flag("-0,--null", arguments->null, "Entries of the list end with NUL, not newline")
        .needs(list)
        .group("Inputs from a list");
    command.add_option("--format", arguments->format, "Format of the report")
        .type_name("FORMAT")
        .check(one_of({"text", "json", "ndjson", "sarif", "junit"}))
        .show_default()
        .group("Report");
    command.add_option("-o,--output", arguments->output, "The report. Default: standard output")
        .type_name("FILE")
        .group("Report");
    command
        .add_option("--html", arguments->html,
                    "Also write one HTML page that draws the meshes and their defects; this keeps "
                    "all meshes in memory")
        .type_name("FILE")
        .group("Report");
    add_judging_options(command, *arguments);
    add_timings(command, arguments->options.run.timings);
    add_jobs(command, arguments->threads);
    add_progress(command, arguments->progress);
    add_colour(command, arguments->colour);
    add_import_arguments(command, arguments->import);
    add_with_colliders(command, arguments->with_colliders);
    command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace cdprep::cli
