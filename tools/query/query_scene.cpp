// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/query_scene.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/progress.h"
#include "cli/report_output.h"
#include "cli/signals.h"
#include "command_line/command_line.h"
#include "query/clash_report.h"
#include "query/object_pairs.h"
#include "scene_file/read_scene.h"
#include "text/printable.h"

namespace cdprep::cli {
namespace {

using scenes::AskedPair;
using scenes::SceneFile;

/// The candidates that one task asks. Their lists wait in memory for their turn.
constexpr std::size_t kChunk = 32;

/// The candidates of one task, asked.
struct Chunk {
    std::string lines;
    report::ClashCounts counts;
};

/// One run of the command.
class Run {
public:
    Run(const SceneArguments& arguments, const SceneQuestion& question, ReportOutput& output,
        ProgressStyle style)
        : arguments_(arguments),
          question_(question),
          output_(output),
          style_(style),
          threads_(arguments.threads),
          report_(question.question.effect, question.format) {}

    Exit run() {
        if (const auto exit = read()) return *exit;
        if (const auto error = choose_pairs()) return fail("query", *error);
        scenes::drop_effect(scene(), Ask::response);  // bodies are asked where they begin
        // First without models: nothing is baked for a plan that does not exist.
        Plan::Compiled compiled = scenes::compile_scene(scene(), {});
        if (!compiled.plan) return fail_all("query", compiled.refusals, ErrorCode::bad_argument);
        if (const auto exit = load(*compiled.plan)) return *exit;
        Result<std::vector<PlacedObject>> objects = objects_of(scene(), *compiled.plan, models_);
        if (!objects) return fail("query", objects.error());
        objects_ = std::move(objects).value();
        set_default_reach();
        compiled = scenes::compile_scene(scene(), {});
        for (std::string& refusal : scenes::model_refusals(scene(), models_)) {
            compiled.refusals.push_back(std::move(refusal));
        }
        if (!compiled.refusals.empty()) {
            return fail_all("query", compiled.refusals, ErrorCode::bad_argument);
        }
        const Result<Done> done = search(*compiled.plan);
        return done ? Exit::success : fail("query", done.error());
    }

private:
    [[nodiscard]] SceneFile& scene() noexcept {
        return assembly_ ? assembly_->scene : scene_;
    }
    [[nodiscard]] Ask effect() const noexcept {
        return question_.question.effect;
    }

    /// Returns the exit code of a failure.
    std::optional<Exit> read() {
        if (scenes::is_assembly(arguments_.scene)) {
            import::ImportOptions options = arguments_.import.options();
            options.parallel_for = threads_.parallel_for();
            Result<scenes::AssemblyScene> read = scenes::read_assembly(arguments_.scene, options);
            if (!read) return fail("query", read.error());
            assembly_.emplace(std::move(read).value());
            return std::nullopt;
        }
        scenes::SceneReading reading = scenes::read_scene(arguments_.scene);
        if (!reading.scene) return fail_all("query", reading.errors, ErrorCode::unreadable);
        scene_ = std::move(*reading.scene);
        for (const scenes::FileObject& object : scene_.objects) {
            if (object.change == scenes::kUnchanged) continue;
            return fail("query", {ErrorCode::bad_argument,
                                  scene_.name + ": object '" + object.name +
                                      "' deforms or tears, but query --scene supports only rigid "
                                      "objects. Use cdprep simulate."});
        }
        return std::nullopt;
    }

    // --- What the layers request ---------------------------------------------------------

    /// Makes every pair of layers that states what is asked ask for the effect of the command, and
    /// nothing else. Without pairs in the file, every layer asks about every other and itself.
    std::optional<Error> choose_pairs() {
        std::vector<AskedPair>& pairs = scene().pairs;
        if (!scene().has_pairs) {
            const auto layers = static_cast<std::uint32_t>(scene().layers.size());
            for (std::uint32_t a = 0; a < layers; ++a) {
                for (std::uint32_t b = a; b < layers; ++b) {
                    pairs.push_back({.asked = {.a = a, .b = b}});
                }
            }
        }
        std::size_t chosen = 0, silent = 0;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            // The plan drops a pair without effects.
            if (scene().has_pairs && pairs[i].asked.effects == Ask::nothing) continue;
            LayerPair asked = {.a = pairs[i].asked.a, .b = pairs[i].asked.b};
            if (has_tolerance(pairs[i].asked)) {
                choose(i, pairs[i].asked, asked);
                ++chosen;
            } else {
                ++silent;
            }
            pairs[i] = {.asked = asked};
        }
        if (silent == 0) return std::nullopt;
        if (chosen == 0) return no_tolerance();
        std::cerr << "cdprep query: " << report::printable(scene().name) << ": " << silent << " of "
                  << silent + chosen << " pairs of layers " << (silent == 1 ? "states" : "state")
                  << " no tolerance, and " << (silent == 1 ? "is" : "are")
                  << " not queried. Give --tolerance to query all.\n";
        return std::nullopt;
    }

    /// Returns whether a pair of the file or the command line states the tolerance of `within`.
    /// Other effects need none.
    [[nodiscard]] bool has_tolerance(const LayerPair& file) const {
        return effect() != Ask::within || question_.tolerance ||
               contains(file.effects, Ask::within);
    }

    [[nodiscard]] Error no_tolerance() {
        return {ErrorCode::bad_argument,
                scene().name +
                    (scene().has_pairs ? ": no pair of layers states a tolerance."
                                       : ": the scene states no tolerance.") +
                    " Give --tolerance."};
    }

    /// Takes from the file what the command line leaves open.
    void choose(std::size_t number, const LayerPair& file, LayerPair& asked) {
        const Body body = question_.body.value_or(file.body);
        asked.effects = effect();
        switch (effect()) {
            case Ask::within:
                asked.tolerance = question_.tolerance.value_or(file.tolerance);
                break;
            case Ask::distance:
                asked.body = body;
                if (question_.max_distance || contains(file.effects, Ask::distance)) {
                    asked.max_distance = question_.max_distance.value_or(file.max_distance);
                } else {
                    by_default_.push_back(number);
                }
                break;
            default:
                asked.overlap = question_.overlap.value_or(file.overlap);
                asked.body = body;
                // Of solids, collide() decides whether one contains the other.
                if (body == Body::solid) asked.effects = Ask::overlap | Ask::collide;
        }
    }

    void set_default_reach() {
        if (by_default_.empty()) return;
        const double reach = kDefaultReach * size_of(objects_);
        for (const std::size_t number : by_default_)
            scene().pairs[number].asked.max_distance = reach;
    }

    /// Returns the exit code of a failure.
    std::optional<Exit> load(const Plan& plan) {
        scenes::LoadOptions options;
        options.cache = arguments_.cache;
        options.import = arguments_.import.options();
        options.import.parallel_for = threads_.parallel_for();
        options.assembly = assembly_ ? &*assembly_ : nullptr;
        scenes::LoadedModels loaded = scenes::load_models(
            scene(), scenes::needs_of_models(scene(), scenes::asks_of_layers(plan)),
            std::move(options), style_, threads_);
        if (!loaded.errors.empty()) return fail_all("query", loaded.errors);
        models_ = std::move(loaded.models);
        for (const std::string& line : scenes::import_lines(scene(), models_)) {
            std::cerr << "cdprep query: " << line << '\n';
        }
        return std::nullopt;
    }

    // --- The search --------------------------------------------------------------------

    Result<Done> search(const Plan& plan) {
        const Result<ObjectPairs> pairs = ObjectPairs::find(objects_, plan);
        if (!pairs) return Error{pairs.error().code, scene().name + ": " + pairs.error().message};
        const std::size_t count = pairs->candidates().size();
        Progress progress(style_, count);
        progress.show(0, "pairs");
        Result<Done> written = output_.append(report_.begin());
        report::ClashCounts counts;
        std::size_t asked = 0;
        threads_.run_in_order((count + kChunk - 1) / kChunk, [&](std::size_t i) {
            const std::size_t first = i * kChunk, size = std::min(kChunk, count - first);
            Chunk chunk = ask(*pairs, pairs->candidates().subspan(first, size));
            return std::function<void()>([&, size, chunk = std::move(chunk)] {
                if (is_interrupted() || !written) return;
                written = output_.append(report_.next(chunk.lines));
                counts.add(chunk.counts);
                const std::size_t percent = 100 * asked / count;
                asked += size;
                // Plain progress takes a line each time.
                if (100 * asked / count > percent) progress.show(asked, "pairs");
            });
        });
        progress.clear();
        if (!written) return written;
        if (is_interrupted()) return stopped(asked, count);
        written = output_.append(report_.finish(summary(plan, *pairs, counts)));
        return written ? output_.finish() : written;
    }

    [[nodiscard]] Chunk ask(const ObjectPairs& pairs, std::span<const BoxPair> candidates) const {
        Chunk chunk;
        ClashAsker asker(question_.question);
        for (const BoxPair& candidate : candidates) {
            if (is_interrupted() || is_output_closed()) return chunk;
            if (!pairs.may_meet(candidate)) continue;
            const auto begin = std::chrono::steady_clock::now();
            const auto answer = asker.ask(pairs.pair(candidate), pairs.asked(candidate));
            const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
            chunk.counts.seconds += taken.count();
            ++chunk.counts.queried;
            if (!answer) continue;
            const auto* overlap = std::get_if<report::PairAnswer>(&*answer);
            const bool is_decided = overlap == nullptr || overlap->hit;
            ++(is_decided ? chunk.counts.clashes : chunk.counts.undecided);
            chunk.lines += report_.line(name(candidate.a), name(candidate.b), *answer);
        }
        return chunk;
    }

    [[nodiscard]] const std::string& name(std::uint32_t object) const {
        const SceneFile& scene = assembly_ ? assembly_->scene : scene_;
        return scene.objects[objects_[object].number].name;
    }

    [[nodiscard]] Error stopped(std::size_t asked, std::size_t count) {
        return {ErrorCode::interrupted, scene().name + ": stopped after " + std::to_string(asked) +
                                            " of " + std::to_string(count) +
                                            " candidates; the output is incomplete."};
    }

    [[nodiscard]] report::ClashSummary summary(const Plan& plan, const ObjectPairs& pairs,
                                               const report::ClashCounts& counts) {
        report::ClashSummary summary;
        summary.scene = scene().name;
        summary.objects = objects_.size();
        for (const scenes::SceneModel& model : models_) summary.models += model.model ? 1 : 0;
        summary.possible = pairs.possible();
        summary.candidates = pairs.candidates().size();
        for (const LayerPair& pair : plan.pairs()) {
            summary.largest = std::max({summary.largest, pair.tolerance, pair.max_distance});
        }
        summary.rounding = assembly_ ? assembly_->rounding : 0;
        summary.counts = counts;
        return summary;
    }

    const SceneArguments& arguments_;
    const SceneQuestion& question_;
    ReportOutput& output_;
    ProgressStyle style_;
    const Threads threads_;
    report::ClashReport report_;
    SceneFile scene_;
    std::optional<scenes::AssemblyScene> assembly_;  ///< instead of scene_
    std::vector<std::size_t> by_default_;            ///< pairs without a stated max_distance
    std::vector<scenes::SceneModel> models_;
    std::vector<PlacedObject> objects_;
};

}  // namespace

void add_scene(const Command& command, SceneArguments& arguments) {
    command
        .add_option("--scene", arguments.scene,
                    "Instead of two models, query the pairs of objects of a scene file (JSON) or "
                    "glTF file, at time 0. Prints a line for each clash, then a summary")
        .type_name("SCENE")
        .group("Scene");
    command
        .add_option(
            "--cache", arguments.cache,
            "Folder for baked files of the meshes of a scene. It is created if it does not exist. "
            "Default: bake into memory")
        .type_name("FOLDER")
        .group("Scene");
    add_jobs(command, arguments.threads);
    add_progress(command, arguments.progress);
    add_import_arguments(command, arguments.import);
}

std::optional<Error> find_idle_for_scene(const Command& command, bool has_scene) {
    constexpr std::array kForTwoModels = {"a",           "b",         "--poses",     "--pose",
                                          "--pose-a",    "--pose-b",  "--placement", "--structure",
                                          "--leaf-test", "--descent", "--search",    "--repeat",
                                          "--timings",   "--counts"};
    constexpr std::array kForScenes = {"--cache",         "--jobs",        "--progress",
                                       "--import-memory", "--import-time", "--import-file-size",
                                       "--unit",          "--up-axis",     "--allow-empty"};
    const std::span<const char* const> idle =
        has_scene ? std::span<const char* const>(kForTwoModels) : kForScenes;
    for (const char* option : idle) {
        if (command.count(option) == 0) continue;
        return Error{ErrorCode::bad_argument,
                     std::string(option) + (has_scene ? " has no meaning with --scene."
                                                      : " has no meaning without --scene.")};
    }
    return std::nullopt;
}

Exit run_scene(const SceneArguments& arguments, const SceneQuestion& question) {
    Result<ReportOutput> output = ReportOutput::open({});
    if (!output) return fail("query", output.error());
    return Run(arguments, question, *output, parse_progress(arguments.progress)).run();
}

}  // namespace cdprep::cli
