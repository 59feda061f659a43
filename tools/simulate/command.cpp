// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command.h"

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/import_arguments.h"
#include "cli/progress.h"
#include "cli/report_output.h"
#include "cli/signals.h"
#include "command_line/command_line.h"
#include "scene_file/load_models.h"
#include "scene_file/read_scene.h"
#include "simulate/page_output.h"
#include "simulate/plan_report.h"
#include "simulate/simulation.h"
#include "simulate/simulation_report.h"
#include "text/number_text.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostFrames = 1'000'000'000;

struct Arguments {
    fs::path scene;
    fs::path output;
    fs::path cache;
    fs::path html;
    fs::path svg;
    std::string format;  ///< empty: text for a plan, ndjson for frames
    std::string progress = "auto";
    std::optional<std::uint64_t> frames;
    std::size_t threads = 0;
    bool plan = false;
    ImportArguments import;
};

/// Prints sentences and returns their exit code.
Exit fail_all(const std::vector<std::string>& sentences, ErrorCode code) {
    for (const std::string& sentence : sentences) fail("simulate", {code, sentence});
    return exit_for(code);
}

/// One run of the command.
class Run {
public:
    Run(const Arguments& arguments, ReportOutput& output, PageOutput& page, ProgressStyle style)
        : arguments_(arguments),
          output_(output),
          page_(page),
          style_(style),
          threads_(arguments.threads) {}

    Exit run() {
        scenes::SceneReading reading = scenes::read_scene(arguments_.scene);
        if (!reading.scene) return fail_all(reading.errors, ErrorCode::unreadable);
        scene_ = std::move(*reading.scene);
        if (!scene_.has_pairs) {
            return fail("simulate", {ErrorCode::unreadable,
                                     scene_.name + ": the key 'pairs' is missing. It says what to "
                                                   "compute."});
        }
        // First without models: nothing is baked for a plan that does not exist.
        Plan::Compiled compiled = scenes::compile_scene(scene_, limits());
        if (!compiled.plan) return refuse(compiled.refusals);
        if (const auto failed = load(*compiled.plan)) return *failed;
        std::vector<std::string> names;
        compiled = scenes::compile_scene(scene_, limits(), scenes::uses_of(scene_, models_, names));
        if (!compiled.plan) return refuse(compiled.refusals);
        return arguments_.plan ? show_plan(*compiled.plan) : simulate(*compiled.plan);
    }

private:
    [[nodiscard]] SceneLimits limits() const {
        return {.objects = static_cast<std::uint32_t>(scene_.objects.size()),
                .pairs = scene_.most_pairs.value_or(1)};
    }

    [[nodiscard]] Result<std::uint64_t> frame_count() const {
        if (arguments_.frames) return *arguments_.frames;
        const double frames = std::round(scene_.duration_s / scene_.step_s);
        if (!(frames >= 1)) return std::uint64_t{1};
        if (frames <= kMostFrames) return static_cast<std::uint64_t>(frames);
        return Error{ErrorCode::bad_argument,
                     scene_.name + ": duration_s / step_s is " + report::number_text(frames) +
                         " frames; at most " + std::to_string(kMostFrames) +
                         " are possible. Change the two, or choose --frames."};
    }

    [[nodiscard]] std::uint32_t thread_count() const {
        if (arguments_.threads > 0) return static_cast<std::uint32_t>(arguments_.threads);
        return std::max(1U, std::thread::hardware_concurrency());
    }

    Exit refuse(const std::vector<std::string>& refusals) {
        const Exit exit = exit_for(ErrorCode::bad_argument);
        if (arguments_.plan && arguments_.format == "json") {
            const std::string json =
                report::refused_json(scene_.name, static_cast<int>(exit), refusals);
            if (const Exit written = finish(json); written != Exit::success) return written;
        }
        return fail_all(refusals, ErrorCode::bad_argument);
    }

    /// Returns the exit code if models cannot be loaded.
    std::optional<Exit> load(const Plan& plan) {
        Progress progress(style_, scene_.models.size());
        scenes::LoadOptions options;
        options.cache = arguments_.cache;
        options.import = arguments_.import.options();
        options.import.parallel_for = threads_.parallel_for();
        options.begins = [&](std::size_t done, const std::string& what) {
            progress.show(done, what);
        };
        scenes::LoadedModels loaded = scenes::load_models(scene_, plan, options, threads_);
        progress.clear();
        for (const Error& error : loaded.errors) fail("simulate", error);
        // The last one, which may have ended the loading.
        if (!loaded.errors.empty()) return exit_for(loaded.errors.back().code);
        models_ = std::move(loaded.models);
        return std::nullopt;
    }

    Exit show_plan(const Plan& plan) {
        const auto changing = scenes::make_changing_models(scene_, plan, models_);
        if (!changing) return fail("simulate", changing.error());
        return finish(arguments_.format == "json"
                          ? report::plan_json(scene_, plan, models_, *changing)
                          : report::plan_text(scene_, plan, models_, *changing));
    }

    Exit simulate(const Plan& plan) {
        const Result<std::uint64_t> counted = frame_count();
        if (!counted) return fail("simulate", counted.error());
        const std::uint64_t frames = *counted;
        auto simulation =
            scenes::Simulation::make(scene_, models_, thread_count(), threads_.parallel_for());
        if (!simulation) return fail("simulate", simulation.error());
        report::SimulationReport report(scene_, plan, event_format());
        page_.begin(scene_, models_, frames);
        Progress progress(style_, frames);
        Result<Done> done = output_.append(report.begin());
        for (std::uint64_t frame = 0; frame < frames && done; ++frame) {
            if (is_interrupted()) done = stopped(frame, frames);
            progress.show(frame, "frame");
            if (done) done = simulation->step(frame);
            if (done) done = output_.append(report.add_frame(frame, *simulation));
            if (done) done = page_.add_frame(frame, *simulation);
        }
        if (done) done = page_.finish(*simulation);
        progress.clear();
        if (!done) return fail("simulate", done.error());
        return finish(report.finish(*simulation));
    }

    [[nodiscard]] Error stopped(std::uint64_t frame, std::uint64_t frames) const {
        return {ErrorCode::interrupted, scene_.name + ": stopped after " + std::to_string(frame) +
                                            " of " + std::to_string(frames) +
                                            " frames; the output is incomplete."};
    }

    [[nodiscard]] report::EventFormat event_format() const {
        if (arguments_.format == "text") return report::EventFormat::text;
        return arguments_.format == "json" ? report::EventFormat::json
                                           : report::EventFormat::ndjson;
    }

    /// Writes the end of the output.
    Exit finish(const std::string& text) {
        Result<Done> written = output_.append(text);
        if (written) written = output_.finish();
        return written ? Exit::success : fail("simulate", written.error());
    }

    const Arguments& arguments_;
    ReportOutput& output_;
    PageOutput& page_;
    ProgressStyle style_;
    const Threads threads_;
    scenes::SceneFile scene_;
    std::vector<scenes::SceneModel> models_;
};

Exit run(const Arguments& arguments) {
    const Result<ProgressStyle> style = parse_progress(arguments.progress);
    if (!style) return fail("simulate", style.error());
    if (arguments.plan && arguments.format == "ndjson") {
        return fail("simulate", {ErrorCode::bad_argument,
                                 "--format ndjson is for events, and --plan computes none. Choose "
                                 "text or json."});
    }
    Result<ReportOutput> output = ReportOutput::open(arguments.output);
    if (!output) return fail("simulate", output.error());
    Result<PageOutput> page =
        PageOutput::open(arguments.html, arguments.svg, {arguments.scene, arguments.output});
    if (!page) return fail("simulate", page.error());
    return Run(arguments, *output, *page, *style).run();
}

void add_page_options(const Command& command, Arguments& arguments, const Option& plan) {
    command
        .add_option("--html", arguments.html,
                    "Also write one HTML page that plays the frames: touching triangles, contacts, "
                    "events, times and the plan. It opens offline")
        .type_name("FILE")
        .excludes(plan)
        .group("Report");
    command
        .add_option("--svg", arguments.svg,
                    "Also write a chart of the time of the frames, by stage")
        .type_name("FILE")
        .excludes(plan)
        .group("Report");
}

void add_report_options(const Command& command, Arguments& arguments) {
    command
        .add_option("-o,--output", arguments.output,
                    "File for the report; it appears when it is complete. Default: standard output")
        .type_name("FILE")
        .group("Report");
    command
        .add_option("--format", arguments.format,
                    "Format of the report. text: the work of each effect. ndjson: a line for each "
                    "event, then one with the summary. json: the same as one object. Default: text "
                    "with --plan, else ndjson")
        .type_name("FORMAT")
        .check(one_of({"text", "json", "ndjson"}))
        .group("Report");
}

}  // namespace

void add_simulate(const Command& app, Exit& exit) {
    auto arguments = std::make_shared<Arguments>();
    const Command command =
        app.add_command("simulate", "Compute what the objects of a scene ask about each other");
    command.set_notes(
        "A scene file is JSON: objects with models, layers, poses and motions, and for pairs of "
        "layers the effects to compute. Objects of layers that are not paired are never looked "
        "at. Events do not depend on the number of threads. Motions may deform and tear models: "
        "a shear, a twist, a vertex stream (PC2), or a cut along a plane.",
        {"cdprep simulate samples/scenes/crates.json --plan",
         "cdprep simulate samples/scenes/crates.json --frames 100",
         "cdprep simulate samples/scenes/cut.json --format text",
         "cdprep simulate samples/scenes/crates.json -o events.ndjson --html crates.html"});
    command.add_option("scene", arguments->scene, "A scene file (JSON)").required();
    const Option plan =
        command
            .add_flag("--plan", arguments->plan,
                      "Print what would be computed and which sections of the models that reads, "
                      "and exit. All reasons against a plan are listed (exit 2)")
            .group("Simulation");
    command
        .add_option("--frames", arguments->frames,
                    "Number of frames; the first is at time 0. Default: duration_s / step_s of "
                    "the scene, at least 1")
        .type_name("N")
        .check(whole_from(1, kMostFrames))
        .excludes(plan)
        .group("Simulation");
    command
        .add_option("--cache", arguments->cache,
                    "Folder for baked files of the meshes that the scene names. It is made if "
                    "there is none. Default: bake into memory")
        .type_name("FOLDER")
        .group("Simulation");
    add_report_options(command, *arguments);
    add_page_options(command, *arguments, plan);
    add_jobs(command, arguments->threads);
    add_progress(command, arguments->progress);
    add_import_arguments(command, arguments->import);
    command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace cdprep::cli
