// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <new>
#include <optional>

#include "bake/pipeline.h"
#include "cli/colliders.h"
#include "cli/command.h"
#include "cli/import_arguments.h"
#include "cli/output_path.h"
#include "cli/progress.h"
#include "cli/signals.h"
#include "command_line/command_line.h"
#include "command_line/command_page.h"
#include "repair/repair.h"
#include "text/bounds_name.h"
#include "text/printable.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
    std::vector<fs::path> inputs;
    fs::path output;
    fs::path output_folder;
    std::string effects = kDefaultEffects;
    std::string format = "text";
    std::string progress = "auto";
    std::string bounds = "auto";
    std::size_t threads = 0;
    bool timings = false;
    bool dry_run = false;
    ImportArguments import;
    bool with_colliders = false;
    StructureArguments structures;
    BakeOptions options;
};

/// Returns the path that the arguments give, or else NAME.cdp.h5 beside the input.
fs::path output_for(const Arguments& arguments, const fs::path& input) {
    if (!arguments.output.empty()) return arguments.output;
    fs::path name = input.filename();
    name.replace_extension(".cdp.h5");
    if (!arguments.output_folder.empty()) return arguments.output_folder / name;
    return input.parent_path() / name;
}

/// Returns an output path for each input. Fails if two inputs have the same output, or if an output
/// would replace an input.
Result<std::vector<fs::path>> outputs_for(const Arguments& arguments) {
    std::map<fs::path, fs::path> input_of;
    UsedFiles used;
    for (const fs::path& input : arguments.inputs) used.add_input(input);
    std::vector<fs::path> outputs;
    if (arguments.output == "-") {
        return Error{
            ErrorCode::bad_argument,
            "-o -: a baked model is binary and is not written to standard output. Give a file "
            "name."};
    }
    for (const fs::path& input : arguments.inputs) {
        const fs::path output = output_for(arguments, input);
        const auto [at, is_new] = input_of.try_emplace(named_file(output), input);
        if (!is_new) {
            return Error{ErrorCode::bad_argument,
                         at->second.string() + " and " + input.string() +
                             " would both be written to " + output.string() +
                             ". Bake them in two calls, into different folders."};
        }
        if (const Result<Done> added = used.add_output(output); !added) return added.error();
        outputs.push_back(output);
    }
    return outputs;
}

/// Returns what is left without colliders, for the provenance: a file may have very many.
std::string part_without(const std::vector<std::string>& colliders) {
    constexpr std::size_t kMostNames = 8;
    std::string part;
    for (std::size_t i = 0; i < std::min(colliders.size(), kMostNames); ++i) {
        part += (i == 0 ? "without " : ", ") + colliders[i];
    }
    if (colliders.size() <= kMostNames) return part;
    return part + " and " + std::to_string(colliders.size() - kMostNames) + " more";
}

/// Bakes one file without its colliders, unless the arguments keep them.
Result<report::BakeReport> bake_shown(const fs::path& input, const fs::path& output,
                                      const Arguments& arguments, const Threads& threads,
                                      const std::function<void(const char*)>& begins) {
    if (arguments.with_colliders) {
        return bake(input, output, arguments.options, threads, begins);
    }
    BakeOptions options = arguments.options;
    std::vector<std::string> colliders;
    options.read = [&](const fs::path& path, const import::ImportOptions& limits) {
        Result<mesh::TriangleSoup> soup = import::import_file(path, limits);
        if (soup) colliders = leave_out_colliders(*soup);
        options.part = part_without(colliders);
        return soup;
    };
    Result<report::BakeReport> baked = bake(input, output, options, threads, begins);
    if (baked && !colliders.empty()) {
        baked->remarks.insert(baked->remarks.begin(), left_out_text(colliders));
    }
    return baked;
}

/// Bakes one file. Returns exceptions as errors.
Result<report::BakeReport> bake_one(const fs::path& input, const fs::path& output,
                                    const Arguments& arguments, const Threads& threads,
                                    const std::function<void(const char*)>& begins) {
    try {
        return bake_shown(input, output, arguments, threads, begins);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::over_budget,
                     input.string() + ": needs more memory than the machine has."};
    } catch (const std::exception& error) {
        return Error{ErrorCode::internal,
                     input.string() + ": internal error: " + error.what() + ". Please report it."};
    }
}

report::BakeReport failed_bake(const fs::path& input, const fs::path& output, const Error& error) {
    auto report = failed<report::BakeReport>(input, error);
    report.output = output.string();
    return report;
}

void print(const report::BakeReport& report, const Arguments& arguments) {
    if (report.error) {
        std::cerr << "cdprep bake: " << report::printable(*report.error) << '\n';
    } else if (arguments.format == "text") {
        std::cout << report::bake_text(
            report, arguments.timings ? report::Timings::show : report::Timings::hide);
    }
}

Exit bake_all(const Arguments& arguments, const std::vector<fs::path>& outputs,
              ProgressStyle style) {
    const Threads threads(arguments.threads);
    Progress progress(style, arguments.inputs.size());
    std::vector<report::BakeReport> reports;
    Exit worst = Exit::success;
    for (std::size_t i = 0; i < outputs.size() && !is_interrupted(); ++i) {
        const fs::path& input = arguments.inputs[i];
        const Result<report::BakeReport> baked = bake_one(
            input, outputs[i], arguments, threads,
            [&](const char* stage) { progress.show(i, input.filename().string() + ": " + stage); });
        progress.clear();
        reports.push_back(baked ? baked.value() : failed_bake(input, outputs[i], baked.error()));
        if (baked) {
            print(reports.back(), arguments);
        } else {
            fail("bake", baked.error());
        }
        worst = std::max(worst, static_cast<Exit>(reports.back().exit));
    }
    if (arguments.format == "json") std::cout << report::bake_json(reports);
    std::cout.flush();
    return is_interrupted() ? Exit::interrupted : worst;
}

/// Returns an error for an option without effect: the user expected one.
std::optional<Error> find_idle_option(const Command& command, const Effects& effects) {
    const bool has_pieces = effects.sections.contains(format::SectionId::pieces);
    if (command.count("--piece-tolerance") == 0 || has_pieces) return std::nullopt;
    return Error{ErrorCode::bad_argument,
                 "--piece-tolerance has no effect: add pieces, contacts or response to --effects, "
                 "or remove the option."};
}

/// Returns the bounds with this name in kBoundsNames, or the best for `effects` if it is "auto".
/// The command line admits no other name.
build::BvhBounds bounds_named(const std::string& name, const Effects& effects) {
    const auto* at =
        std::find_if(report::kBoundsNames.begin(), report::kBoundsNames.end(),
                     [&](const report::BoundsName& known) { return name == known.name; });
    return at == report::kBoundsNames.end() ? bounds_for(effects) : at->bounds;
}

Exit run(const Command& command, Arguments& arguments) {
    const Result<Effects> effects = parse_effects(arguments.effects);
    if (!effects) return fail("bake", effects.error());
    if (const auto error = find_idle_option(command, *effects)) return fail("bake", *error);
    arguments.structures.is_preset_given = command.count("--structure-preset") > 0;
    const Result<StructureChoice> structures =
        choose_structures(arguments.structures, effects.value());
    if (!structures) return fail("bake", structures.error());
    const Result<std::vector<fs::path>> outputs = outputs_for(arguments);
    if (!outputs) return fail("bake", outputs.error());
    if (arguments.dry_run) {
        for (std::size_t i = 0; i < outputs->size(); ++i) {
            std::cout << report::printable(arguments.inputs[i].string()) << " would become "
                      << report::printable((*outputs)[i].string()) << '\n';
        }
        return Exit::success;
    }
    if (!arguments.output_folder.empty()) {
        std::error_code error;
        fs::create_directories(arguments.output_folder, error);
        if (error) {
            return fail("bake", {ErrorCode::unwritable,
                                 arguments.output_folder.string() +
                                     ": cannot be created: " + error.message() + "."});
        }
    }
    arguments.options.effects = effects.value();
    arguments.options.structures = structures.value();
    arguments.options.bounds = bounds_named(arguments.bounds, effects.value());
    arguments.options.import = arguments.import.options(outputs.value());
    return bake_all(arguments, outputs.value(), parse_progress(arguments.progress));
}

/// Adds the options for the content and the path of the baked file.
void add_output_options(const Command& command, Arguments& arguments) {
    const Option output =
        command
            .add_option("-o,--output", arguments.output,
                        "The baked file. Default: the input's name, ending in .cdp.h5")
            .type_name("FILE")
            .group("Output");
    command.add_option("--output-dir", arguments.output_folder, "The folder of the baked files")
        .type_name("FOLDER")
        .excludes(output)
        .group("Output");
    command
        .add_option("--effects", arguments.effects,
                    "Comma-separated effects to bake for. all: every effect, and every structure")
        .type_name("LIST")
        .check(list_of(effect_words()))
        .show_default()
        .group("Output");
    command
        .add_flag("--strict", arguments.options.strict,
                  "Refuse a mesh with warnings or errors of 'cdprep validate', or with an "
                  "unfinished search for crossing triangles (exit 1)")
        .group("Output");
    command.add_flag("--dry-run", arguments.dry_run, "Print the names of the outputs and exit")
        .group("Output");
}

void add_mesh_options(const Command& command, BakeOptions& options) {
    add_normalize(command, options.normalize);
    add_weld(command, options.weld_distance);
    command
        .add_option("--repair", options.repair,
                    "Repair first, as 'cdprep repair --preset' does. Source numbers are then those "
                    "of the repaired mesh; the file maps them to the input's")
        .type_name("PRESET")
        .check(one_of({mesh::kRepairPresets.begin(), mesh::kRepairPresets.end()}))
        .group("Mesh");
    command
        .add_option("--piece-tolerance", options.piece_tolerance,
                    "For --effects pieces, contacts and response: maximum height of a piece's "
                    "vertices above the planes of its triangles. In model units; 0: exact")
        .type_name("DISTANCE")
        .check(zero_or_more())
        .show_default()
        .group("Mesh");
    add_max_pairs(command, options.max_pairs);
}

}  // namespace

void add_bake(const Command& app, Exit& exit) {
    auto arguments = std::make_shared<Arguments>();
    const Command command = app.add_command("bake", "Convert mesh files to baked files");
    command.set_notes(
        "The same input, options and version give the same sections, byte for byte. --bounds and "
        "--structures change the speed of queries about meshes, not the answers. There are two "
        "exceptions. If models touch, 'distance' may name another pair of triangles that touch. "
        "With --structures hull, 'contacts' may find shorter ways out of solids. Answers about "
        "hulls depend on --hull-vertices. Answers about scenes that permit a max_error may depend "
        "on --parts and --max-error.\n\n"
        "If --parts or --max-error cannot be met, the best result is written and the exit code is "
        "1.\n\n"
        "Colliders of engines are left out, and the report lists them. They are nodes and groups "
        "named UCX_..., UBX_..., USP_..., UCP_..., ...-colonly or ...-convcolonly, and all nodes "
        "below one named colliders. Triangles and vertices are then numbered without them. "
        "'validate' leaves them out too; other commands and scene files keep them.",
        {"cdprep bake arm.glb", "cdprep bake *.obj --output-dir baked --effects all",
         "cdprep bake scan.ply --repair solid --unit mm"});
    command
        .add_option("input", arguments->inputs,
                    "Mesh files: OBJ, STL, PLY, OFF, glTF, 3MF and others")
        .required();
    add_output_options(command, *arguments);
    add_mesh_options(command, arguments->options);
    command
        .add_option("--bounds", arguments->bounds,
                    "Bounding volumes to store in addition to axis-aligned boxes. aabb: none. obb: "
                    "oriented boxes. pss, lss, rss: spheres swept over a point, a line, a "
                    "rectangle. auto: obb+rss with any of the effects distance, within, contacts, "
                    "response, continuous and haptic; else obb")
        .type_name("BOUNDS")
        .check(one_of({"aabb", "obb", "pss", "lss", "rss", "obb+rss", "auto"}))
        .show_default()
        .group("Structures");
    add_structure_options(command, arguments->structures);
    add_report_format(command, arguments->format);
    add_timings(command, arguments->timings);
    add_jobs(command, arguments->threads);
    add_progress(command, arguments->progress);
    add_import_arguments(command, arguments->import);
    add_with_colliders(command, arguments->with_colliders);
    command.callback([command, arguments, &exit] { exit = run(command, *arguments); });
}

}  // namespace cdprep::cli
