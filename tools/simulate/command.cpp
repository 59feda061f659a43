// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/import_arguments.h"
#include "cli/output_path.h"
#include "cli/progress.h"
#include "cli/report_output.h"
#include "cli/signals.h"
#include "command_line/command_line.h"
#include "scene_file/effect_words.h"
#include "scene_file/gltf_scene.h"
#include "scene_file/load_models.h"
#include "scene_file/read_scene.h"
#include "simulate/effect_costs.h"
#include "simulate/page/page_output.h"
#include "simulate/recording_output.h"
#include "simulate/run/effect_counts.h"
#include "simulate/run/plan_report.h"
#include "simulate/run/simulation.h"
#include "simulate/simulation_report.h"
#include "text/number_text.h"
#include "text/printable.h"

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
    fs::path record;
    std::vector<std::string> drop;
    std::string format;  ///< empty: text for a plan, ndjson for frames
    std::string progress = "auto";
    std::optional<std::uint64_t> frames;
    std::optional<double> until_s;
    std::size_t threads = 0;
    bool plan = false;
    bool cost = false;
    ImportArguments import;
};

std::vector<fs::path> outputs_of(const Arguments& arguments) {
    return {arguments.output == "-" ? fs::path() : arguments.output, arguments.record,
            arguments.html, arguments.svg};
}

/// Returns the files that a scene refers to, and its own.
std::vector<fs::path> inputs_of(const scenes::SceneFile& scene,
                                const scenes::AssemblyScene* assembly) {
    const fs::path file = scene.name;
    std::vector<fs::path> inputs = scene.models;
    inputs.push_back(file);
    if (assembly != nullptr) {
        for (const mesh::InputFile& other : assembly->file.other_files()) {
            inputs.push_back(file.parent_path() / other.name);
        }
    }
    for (const scenes::Change& change : scene.changes) {
        const auto* stream = change.deform ? std::get_if<scenes::Stream>(&*change.deform) : nullptr;
        if (stream != nullptr) inputs.push_back(stream->file);
    }
    return inputs;
}

/// One run of the command.
class Run {
public:
    Run(const Arguments& arguments, ReportOutput& output, PageOutput& page, ProgressStyle style)
        : arguments_(arguments),
          output_(output),
          page_(page),
          style_(style),
          threads_(arguments.threads),
          import_(arguments.import.options(outputs_of(arguments))) {
        import_.parallel_for = threads_.parallel_for();
        import_.find_conflict = [this, find = import_.find_conflict](const fs::path& file) {
            std::optional<Error> conflict = find(file);
            if (conflict) has_conflict_ = true;
            return conflict;
        };
    }

    Exit run() {
        if (const auto failed = read()) return *failed;
        const Result<Done> apart = check_outputs(
            inputs_of(scene_, assembly_ ? &*assembly_ : nullptr), outputs_of(arguments_));
        if (!apart) return fail("simulate", apart.error());
        if (!scene_.has_pairs) {
            return fail(
                "simulate",
                {ErrorCode::unreadable,
                 scene_.name + ": the key 'pairs' is missing. It lists the effects to compute."});
        }
        if (const Result<Done> dropped = drop(); !dropped) {
            return fail("simulate", dropped.error());
        }
        // Nothing is baked for a plan that does not exist, or for too many frames.
        const Result<std::uint64_t> frames = arguments_.plan ? 0 : frame_count();
        if (!frames) return fail("simulate", frames.error());
        // The parts of baked files decide the rungs.
        std::vector<ModelUse> parts;
        if (!assembly_) parts = scenes::uses_of_parts(scene_);
        Plan::Compiled compiled = scenes::compile_scene(scene_, limits(), parts);
        const std::vector<Error> errors = load(compiled.plan);
        std::vector<std::string> refusals = std::move(compiled.refusals);
        add(refusals, scenes::model_refusals(scene_, models_));
        if (!replay_) add(refusals, scenes::response_refusals(scene_, models_));
        if (!refusals.empty() || !errors.empty()) return refuse(refusals, errors);
        std::vector<std::string> names;
        compiled = scenes::compile_scene(scene_, limits(), scenes::uses_of(scene_, models_, names));
        if (!compiled.plan) return refuse(compiled.refusals);
        return arguments_.plan ? show_plan(*compiled.plan) : simulate(*compiled.plan, *frames);
    }

private:
    /// Reads the scene file, or a recording of one. Returns the exit code if that fails.
    std::optional<Exit> read() {
        fs::path file = arguments_.scene;
        if (scenes::Recording::is_one(file)) {
            auto opened = scenes::Recording::open(file);
            if (!opened) return fail("simulate", opened.error());
            replay_.emplace(std::move(opened).value());
            const Result<Done> set = replay_->set_import(import_);
            if (!set) return fail("simulate", set.error());
            file = replay_->folder() / fs::path(replay_->scene_name()).filename();
        }
        folder_ = replay_ ? replay_->folder() : file.parent_path();
        if (scenes::is_assembly(file)) {
            if (const auto failed = read_gltf(shortened(file))) return failed;
        } else {
            scenes::SceneReading reading =
                replay_ ? scenes::parse_scene(replay_->scene_name(), replay_->scene_text(), folder_)
                        : scenes::read_scene(file);
            if (!reading.scene) {
                if (replay_) tell_recording(reading.errors);
                return fail_all("simulate", reading.errors, ErrorCode::unreadable);
            }
            scene_ = std::move(*reading.scene);
        }
        if (replay_) stop_motions();
        return std::nullopt;
    }

    /// Says that the errors are about the scene in a recording, which is found nowhere else.
    void tell_recording(std::vector<std::string>& errors) const {
        for (std::string& error : errors) {
            error.insert(0, arguments_.scene.string() + ": the recorded scene: ");
        }
        errors.push_back(arguments_.scene.string() +
                         ": paths of models are relative to the folder of the recording. Move the "
                         "models with it.");
    }

    /// Meshes are in the file, so a replay reads it again.
    std::optional<Exit> read_gltf(const fs::path& file) {
        scenes::GltfReading reading = scenes::read_gltf_scene(file, import_);
        if (!reading.assembly) return fail_all("simulate", reading.errors);
        for (const std::string& finding : reading.findings) {
            std::cerr << "cdprep simulate: " << report::printable(finding) << '\n';
        }
        assembly_ = std::move(reading.assembly);
        scene_ = std::move(assembly_->scene);
        if (replay_ && replay_->scene_text() != scene_.text) {
            return fail(
                "simulate",
                {ErrorCode::unreadable,
                 scene_.name +
                     ": the file has changed since it was recorded. Record the scene again."});
        }
        return std::nullopt;
    }

    /// Poses come from the recording alone.
    void stop_motions() {
        for (scenes::Motion& motion : scene_.motions) {
            if (const Result<Pose> start = motion.at(0, {})) motion = scenes::Motion::fixed(*start);
        }
    }

    Result<Done> drop() {
        for (const std::string& word : arguments_.drop) {
            const Ask effect = scenes::effect_of(word);
            const bool is_asked = std::ranges::any_of(scene_.pairs, [&](const auto& pair) {
                return contains(pair.asked.effects, effect);
            });
            if (!is_asked) {
                return Error{ErrorCode::bad_argument,
                             scene_.name + ": --drop " + word + ": no pair of layers requests it."};
            }
            scenes::drop_effect(scene_, effect);
        }
        return Done{};
    }

    static void add(std::vector<std::string>& all, std::vector<std::string> more) {
        std::ranges::move(more, std::back_inserter(all));
    }

    [[nodiscard]] SceneLimits limits() const {
        return scenes::first_limits(scene_, thread_count());
    }

    [[nodiscard]] Result<std::uint64_t> frame_count() const {
        Result<std::uint64_t> asked = asked_frames();
        if (!asked || !replay_) return asked;
        return std::min(*asked, replay_->frames());
    }

    [[nodiscard]] Result<std::uint64_t> asked_frames() const {
        if (arguments_.frames) return *arguments_.frames;
        if (arguments_.until_s) return frames_of(frames_until(*arguments_.until_s), "--until");
        if (replay_) return kMostFrames;
        return frames_of(std::max(std::round(scene_.duration_s / scene_.step_s), 1.0),
                         "duration_s");
    }

    /// Returns how many frames have at most this time, however their times are rounded.
    [[nodiscard]] double frames_until(double time_s) const {
        constexpr double kRounding = 1e-9;
        const double steps = time_s / scene_.step_s;
        const double nearest = std::round(steps);
        const bool is_whole = std::abs(steps - nearest) <= kRounding * nearest;
        return (is_whole ? nearest : std::floor(steps)) + 1;
    }

    [[nodiscard]] Result<std::uint64_t> frames_of(double frames, const char* what) const {
        if (frames <= kMostFrames) return static_cast<std::uint64_t>(frames);
        const std::string found = std::isfinite(frames) ? report::number_text(frames) : "too many";
        return Error{ErrorCode::bad_argument,
                     scene_.name + ": " + what + " / step_s is " + found + " frames; at most " +
                         std::to_string(kMostFrames) + " are supported. Set --frames."};
    }

    [[nodiscard]] std::uint32_t thread_count() const {
        if (arguments_.threads > 0) return static_cast<std::uint32_t>(arguments_.threads);
        return std::max(1U, std::thread::hardware_concurrency());
    }

    /// Reports all reasons at once. The errors of files come last, and decide the exit code.
    Exit refuse(std::vector<std::string> refusals, const std::vector<Error>& errors = {}) {
        const bool is_json = arguments_.plan && arguments_.format == "json";
        std::vector<Error> all;
        all.reserve(refusals.size() + errors.size());
        for (const std::string& refusal : refusals) {
            all.push_back({ErrorCode::bad_argument, refusal});
        }
        all.insert(all.end(), errors.begin(), errors.end());
        if (is_json && !has_conflict_) {
            for (const Error& error : errors) refusals.push_back(error.message);
            const auto exit = static_cast<int>(exit_for(all.back().code));
            const std::string json = report::refused_json(scene_.name, exit, refusals);
            if (const Exit written = finish(json); written != Exit::success) return written;
        }
        return fail_all("simulate", all);
    }

    /// Opens the models. Without a plan, it opens baked files for the pairs of layers that are
    /// valid, and bakes nothing.
    std::vector<Error> load(const std::optional<Plan>& plan) {
        scenes::LoadOptions options;
        options.cache = arguments_.cache;
        options.import = import_;
        options.assembly = assembly_ ? &*assembly_ : nullptr;
        options.bakes = plan.has_value();
        const auto asks = plan ? scenes::asks_of_layers(*plan) : scenes::asks_of_layers(scene_);
        scenes::LoadedModels loaded = scenes::load_models(
            scene_, scenes::needs_of_models(scene_, asks), std::move(options), style_, threads_);
        models_ = std::move(loaded.models);
        for (const std::string& line : scenes::import_lines(scene_, models_)) {
            std::cerr << "cdprep simulate: " << line << '\n';
        }
        return std::move(loaded.errors);
    }

    Exit show_plan(const Plan& plan) {
        const auto changing = scenes::make_changing_models(scene_, plan, models_);
        if (!changing) return fail("simulate", changing.error());
        return finish(arguments_.format == "json"
                          ? report::plan_json(scene_, plan, models_, *changing)
                          : report::plan_text(scene_, plan, models_, *changing));
    }

    Exit simulate(const Plan& plan, std::uint64_t frames) {
        if (arguments_.cost) {
            const Result<Done> fits = scenes::check_cost_room(scene_, frames);
            if (!fits) return fail("simulate", fits.error());
        }
        const auto bodies = replay_ ? scenes::BodyPoses::given : scenes::BodyPoses::computed;
        auto simulation = scenes::Simulation::make(scene_, models_, thread_count(),
                                                   threads_.parallel_for(), bodies);
        if (!simulation) return fail("simulate", simulation.error());
        // Without an effect, models may be baked with fewer sections.
        if (replay_ && arguments_.drop.empty()) {
            const Result<Done> same = replay_->check_models(scene_, models_);
            if (!same) return fail("simulate", same.error());
        }
        report::SimulationReport report(scene_, plan, event_format(), frames);
        page_.begin(scene_, models_, frames);
        Progress progress(style_, frames);
        const Result<Done> done = run_frames(frames, *simulation, report, progress);
        std::optional<Error> stop;
        if (done && arguments_.cost) {
            stop = measure_costs(frames, progress, [&] { write_end(report, *simulation, {}); });
        }
        progress.clear();
        if (!done) return fail("simulate", done.error());
        const Exit exit = write_end(report, *simulation, costs_);
        for (const std::string& warning : report.warnings(assembly_.has_value())) {
            std::cerr << "cdprep simulate: " << warning << '\n';
        }
        return stop && exit == Exit::success ? fail("simulate", *stop) : exit;
    }

    /// Computes the frames, and writes all but the end of the outputs.
    Result<Done> run_frames(std::uint64_t frames, scenes::Simulation& simulation,
                            report::SimulationReport& report, Progress& progress) {
        std::atomic<std::uint64_t> at = 0;  // the frame in progress
        const LastWords words([&] { return sentence_of(stopped("within frame ", at, frames)); });
        Result<Done> done = output_.append(report.begin());
        if (done) done = begin_recording();
        for (std::uint64_t frame = 0; frame < frames && done; ++frame) {
            if (is_interrupted()) done = stopped("before frame ", frame, frames);
            at = frame;
            progress.advance(frame, "frame");
            if (done) done = compute(frame, simulation);
            if (done) done = output_.append(report.add_frame(frame, simulation));
            if (done && record_) done = record_->add_frame(frame, simulation);
            if (done) done = page_.add_frame(frame, simulation);
        }
        // What was recorded before an interrupt or an error can be replayed.
        const Result<Done> kept = record_ ? record_->finish() : Done{};
        return done ? kept : done;
    }

    /// Writes the end of the outputs, after the last frame.
    Exit write_end(report::SimulationReport& report, const scenes::Simulation& simulation,
                   std::span<const report::EffectCost> costs) {
        report.set_costs(costs);
        const Result<Done> written = page_.finish(simulation, costs);
        return written ? finish(report.finish(simulation)) : fail("simulate", written.error());
    }

    Result<Done> compute(std::uint64_t frame, scenes::Simulation& simulation) {
        if (!replay_) return simulation.step(frame);
        const auto recorded = replay_->next(scene_.objects.size());
        if (!recorded) return recorded.error();
        if (Result<Done> done = simulation.step(frame, recorded->poses); !done) return done;
        // Without an effect, the results are others.
        if (!arguments_.drop.empty()) return Done{};
        return replay_->check_state(*recorded, simulation.scene());
    }

    Result<Done> begin_recording() {
        if (arguments_.record.empty()) return Done{};
        auto opened = RecordingOutput::open(
            arguments_.record,
            {scene_, path_between(arguments_.record.parent_path(), folder_), import_}, models_);
        if (!opened) return opened.error();
        record_ = std::move(opened).value();
        return Done{};
    }

    /// The way from one folder to another.
    static fs::path path_between(const fs::path& from, const fs::path& to) {
        const fs::path here = ".";
        return fs::proximate(to.empty() ? here : to, from.empty() ? here : from);
    }

    /// Returns the error that stopped it. Then the report lacks only the costs. If a signal does
    /// not wait for the end of a frame, `write_end` is called, on another thread.
    std::optional<Error> measure_costs(std::uint64_t frames, Progress& progress,
                                       const std::function<void()>& write_end) {
        const Error is_stopped = {ErrorCode::interrupted,
                                  scene_.name +
                                      ": stopped during the measurements of --cost. The output has "
                                      "no costs but is otherwise complete."};
        const LastWords words([&] {
            write_end();
            return sentence_of(is_stopped);
        });
        scenes::CostOptions options;
        options.frames = frames;
        options.threads = thread_count();
        options.parallel_for = threads_.parallel_for();
        options.begins = [&](std::uint64_t done, std::uint64_t all) -> Result<Done> {
            if (is_interrupted()) return is_stopped;
            progress.advance(frames * done / all, "cost");
            return Done{};
        };
        auto costs = scenes::measure_costs(scene_, models_, options);
        if (!costs) {
            end_by_itself();  // the end of the output may take longer than an interrupt
            return costs.error();
        }
        costs_ = std::move(costs).value();
        return std::nullopt;
    }

    [[nodiscard]] Error stopped(const char* where, std::uint64_t frame,
                                std::uint64_t frames) const {
        return {ErrorCode::interrupted, scene_.name + ": stopped " + where + std::to_string(frame) +
                                            " of " + std::to_string(frames) +
                                            "; the output is incomplete."};
    }

    /// Returns what fail() prints.
    static std::string sentence_of(const Error& error) {
        return "cdprep simulate: " + report::printable(error.message);
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
    import::ImportOptions import_;            ///< of a replay: those of the recording
    std::atomic<bool> has_conflict_ = false;  ///< a model refers to an output
    scenes::SceneFile scene_;
    std::optional<scenes::AssemblyScene> assembly_;  ///< of a glTF file, without its scene
    fs::path folder_;                                ///< of the scene file
    std::vector<scenes::SceneModel> models_;
    std::optional<scenes::Recording> replay_;  ///< the scene is one
    std::unique_ptr<RecordingOutput> record_;  ///< null: nothing is recorded
    std::vector<report::EffectCost> costs_;    ///< of --cost
};

Exit run(const Arguments& arguments) {
    if (arguments.plan && arguments.format == "ndjson") {
        return fail("simulate", {ErrorCode::bad_argument,
                                 "--plan computes no events, so it does not support --format "
                                 "ndjson. Use text or json."});
    }
    if (arguments.cost && scenes::Recording::is_one(arguments.scene)) {
        return fail(
            "simulate",
            {ErrorCode::bad_argument,
             "--cost simulates the scene several times. Give the scene file, not a recording."});
    }
    const Result<Done> apart = check_outputs({arguments.scene}, outputs_of(arguments));
    if (!apart) return fail("simulate", apart.error());
    Result<ReportOutput> output = ReportOutput::open(arguments.output);
    if (!output) return fail("simulate", output.error());
    Result<PageOutput> page = PageOutput::open(arguments.html, arguments.svg);
    if (!page) return fail("simulate", page.error());
    return Run(arguments, *output, *page, parse_progress(arguments.progress)).run();
}

std::vector<std::string> effect_words() {
    std::vector<std::string> words;
    words.reserve(report::kSimulatedEffects.size());
    for (const Ask effect : report::kSimulatedEffects) {
        words.push_back(scenes::effect_name(effect));
    }
    return words;
}

void add_study_options(const Command& command, Arguments& arguments, const Option& plan) {
    command
        .add_option("--drop", arguments.drop,
                    "Leave out an effect of all pairs of layers. May be given more than once")
        .type_name("EFFECT")
        .check(one_of(effect_words()))
        .group("Simulation");
    command
        .add_flag(
            "--cost", arguments.cost,
            "Also run the scene without each of its effects, in 5 rounds, and report the time that "
            "this saves")
        .excludes(plan)
        .group("Simulation");
    command
        .add_option(
            "--record", arguments.record,
            "Also write a recording: the scene, and the poses and events of each frame. `cdprep "
            "simulate FILE` replays it with the same import options, and compares the results. "
            "After an interrupt or an error, the recording has all complete frames")
        .type_name("FILE")
        .excludes(plan)
        .group("Report");
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
                    "event, then one with the summary. json: all this in one object. Default: text "
                    "with --plan, else ndjson")
        .type_name("FORMAT")
        .check(one_of({"text", "json", "ndjson"}))
        .group("Report");
}

void add_notes(const Command& command) {
    command.set_notes(
        "A scene file is JSON. It lists objects with models, layers, poses and motions. For pairs "
        "of layers, it lists the effects to compute. Objects whose layer is in no pair are never "
        "examined. Events do not depend on the number of threads. Motions may deform and tear "
        "models: a shear, a twist, a vertex stream (PC2), or a cut along a plane. With response, "
        "bodies fall, push each other and come to rest. Events name the objects that push. A frame "
        "then has 4 substeps, and the solver 50 iterations in each. `dynamics` of the scene "
        "changes these numbers. A glTF file with the extension KHR_physics_rigid_bodies is a scene "
        "too. Collision filters become layers, and motions become bodies. Triggers report which "
        "colliders start and stop colliding with them. The geometry of a collider is the mesh of "
        "its node. Messages on standard error list the parts of the file that are ignored. They "
        "also list assumed values that the file does not state.",
        {"cdprep simulate samples/scenes/crates.json --plan",
         "cdprep simulate samples/scenes/crates.json --frames 100",
         "cdprep simulate samples/scenes/cut.json --format text",
         "cdprep simulate samples/scenes/pile.json --html pile.html",
         "cdprep simulate samples/scenes/crates.json -o events.ndjson --html crates.html",
         "cdprep simulate samples/scenes/crates.json --format text --cost",
         "cdprep simulate samples/scenes/dominoes.gltf --until 3 --html dominoes.html"});
}

}  // namespace

void add_simulate(const Command& app, Exit& exit) {
    auto arguments = std::make_shared<Arguments>();
    const Command command = app.add_command(
        "simulate", "Run the queries between the objects of a scene, frame by frame");
    add_notes(command);
    command
        .add_option("scene", arguments->scene,
                    "A scene file (JSON), a glTF file, or a recording of either")
        .required();
    const Option plan = command
                            .add_flag("--plan", arguments->plan,
                                      "Print what would be computed and what not, and exit. Lists "
                                      "the sections that are read, and the memory of the scene. If "
                                      "the plan is invalid, all reasons are listed (exit 2)")
                            .group("Simulation");
    const Option frames =
        command
            .add_option("--frames", arguments->frames,
                        "Number of frames; the first is at time 0. Default: duration_s / step_s of "
                        "the scene, at least 1; for a recording, all its frames")
            .type_name("N")
            .check(whole_from(1, kMostFrames))
            .excludes(plan)
            .group("Simulation");
    command
        .add_option("--until", arguments->until_s,
                    "Compute the frames up to and including this time, instead of --frames")
        .type_name("SECONDS")
        .check(zero_or_more("seconds"))
        .excludes(frames)
        .excludes(plan)
        .group("Simulation");
    command
        .add_option("--cache", arguments->cache,
                    "Folder for baked files of the scene's meshes. It is created if it does not "
                    "exist. Default: bake into memory")
        .type_name("FOLDER")
        .group("Simulation");
    add_study_options(command, *arguments, plan);
    add_report_options(command, *arguments);
    add_page_options(command, *arguments, plan);
    add_jobs(command, arguments->threads);
    add_progress(command, arguments->progress);
    add_import_arguments(command, arguments->import);
    command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace cdprep::cli
