// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>

#include "cli/command.h"
#include "cli/output_path.h"
#include "cli/program_threads.h"
#include "command_line/command_line.h"
#include "command_line/command_page.h"
#include "export/engine.h"
#include "export/export_model.h"
#include "text/printable.h"

namespace cdprep::cli {
namespace {

struct Arguments {
    std::filesystem::path file;
    std::string engine;
    std::string format = "text";
    std::size_t threads = 0;
    ExportOptions options;
};

/// Returns true for names with '/' between them, of letters, digits, '_', '-' and '.'.
bool is_package(const std::string& text) {
    const bool is_plain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 ||
               std::string_view("_-./").find(static_cast<char>(c)) != std::string_view::npos;
    });
    return is_plain && !text.empty() && text.front() != '/' && text.back() != '/' &&
           text.find("//") == std::string::npos && text.find("..") == std::string::npos;
}

/// Returns an error for an option without effect: the user expected one.
std::optional<Error> find_idle_option(const Command& command, const EngineForm& form) {
    const auto idle = [&](const char* option, const std::string& why) {
        return Error{ErrorCode::bad_argument,
                     std::string(option) + ": " + why + " Remove the option."};
    };
    const std::string name = form.name;
    if (command.count("--floating") > 0 && form.engine != Engine::mujoco) {
        return idle("--floating", "only MJCF files (--for mujoco) have a joint to the world.");
    }
    if (command.count("--package") > 0 && form.engine != Engine::urdf) {
        return idle("--package", "only URDF files (--for urdf) name meshes in a package.");
    }
    if (command.count("--density") > 0 && !form.has_mass) {
        return idle("--density", "the file for " + name + " has no mass in kilograms.");
    }
    if (command.count("--no-visual") > 0 && !form.can_omit_visual) {
        return idle("--no-visual", form.engine == Engine::unreal
                                       ? "Unreal attaches parts to the visual mesh."
                                       : "the file for " + name + " never has a visual mesh.");
    }
    if (command.count("--strict") > 0 && !is_in_metres(form)) {
        return idle("--strict", "the file for " + name + " needs no unit.");
    }
    return std::nullopt;
}

Result<report::ExportReport> export_file(const Command& command, const Arguments& arguments) {
    const EngineForm& form = *find_engine(arguments.engine);
    if (const auto error = find_idle_option(command, form)) return *error;
    const std::string& package = arguments.options.package;
    if (command.count("--package") > 0 && !is_package(package)) {
        return Error{ErrorCode::bad_argument,
                     "--package '" + package +
                         "' is neither a package such as my_robot nor a folder in a package, such "
                         "as my_robot/meshes."};
    }
    const auto output = output_for(form, arguments.file, arguments.options.output);
    if (!output) return output.error();
    ExportOptions options = arguments.options;
    options.output = output.value();
    const Threads threads(arguments.threads);
    return export_model(arguments.file, form, options, threads);
}

Exit run(const Command& command, const Arguments& arguments) {
    const Result<report::ExportReport> exported = export_file(command, arguments);
    const bool is_json = arguments.format == "json";
    std::ostream& out = report_stream(arguments.options.output);
    if (!exported) {
        if (is_json) {
            out << report::export_json(
                failed<report::ExportReport>(arguments.file, exported.error()));
        }
        return fail("export", exported.error());
    }
    const report::ExportReport& report = exported.value();
    if (report.error) {
        if (is_json) out << report::export_json(report);
        std::cerr << "cdprep export: " << report::printable(*report.error) << '\n';
        return static_cast<Exit>(report.exit);
    }
    out << (is_json ? report::export_json(report) : report::export_text(report));
    const std::string warning = report::unit_warning(report);
    if (!warning.empty()) std::cerr << "cdprep export: " << report::printable(warning) << '\n';
    return Exit::success;
}

void add_content_options(const Command& command, ExportOptions& options) {
    const char* const content = "Content";
    command
        .add_flag("--floating", options.is_floating,
                  "For mujoco: add a free joint. Without one, the body is fixed to the world")
        .group(content);
    command
        .add_option("--package", options.package,
                    "For urdf: name meshes as package://NAME/FILE, as ROS does. NAME may have "
                    "folders, as in my_robot/meshes")
        .type_name("NAME")
        .group(content);
    command
        .add_option("--density", options.density,
                    "For mujoco, gazebo and urdf: density for the mass, in kg per cubic metre")
        .check(above_zero())
        .show_default()
        .group(content);
    command
        .add_flag("!--no-visual", options.has_visual,
                  "Write the colliders alone, without the mesh itself. Not for unreal or json")
        .group(content);
    command
        .add_flag("--keep-points", options.keeps_points,
                  "Write every point of the colliders, also those that engines ignore")
        .group(content);
    command
        .add_flag("--strict", options.strict,
                  "Refuse to write a file in metres if the model has no unit (exit 1)")
        .group(content);
}

}  // namespace

void add_export(const Command& app, Exit& exit) {
    auto arguments = std::make_shared<Arguments>();
    const Command command = app.add_command("export", "Write colliders for a physics engine");
    command.set_notes(
        "The file must be baked with --structures hull, and with --parts or --max-error for convex "
        "parts. Without parts, the collider is the convex hull of the model.\n\n"
        "godot: a GLB with nodes NAME_00-convcolonly. unreal: a GLB with nodes UCX_NAME_00. unity: "
        "a GLB with the parts below a node named colliders. mujoco: MJCF. gazebo: SDF. urdf: URDF. "
        "All these also have the mesh itself, MJCF only if it encloses a volume. json: points, "
        "triangles and mass, for loaders of other engines.\n\n"
        "Unity reads GLB by a package such as glTFast. Unity makes no colliders by itself: add a "
        "convex MeshCollider to each node below colliders. A URDF names its meshes by paths "
        "relative to itself. ROS tools expect --package, or file:// before the paths.\n\n"
        "All but json are in metres. They are rotated to the engine's up axis if the model states "
        "its up axis. Points that hull builders of engines ignore are dropped. Other points move "
        "out by at most the reported error, so that the colliders still enclose the mesh. A GLB "
        "rounds corners to floats; the report says by how much.",
        {"cdprep bake chair.glb --structures hull --parts 16",
         "cdprep export chair.cdp.h5 --for godot -o game/chair.glb",
         "cdprep export robot.cdp.h5 --for mujoco --floating -o robot.xml"});
    command.add_option("file", arguments->file, "A baked file (.cdp.h5)").required();
    command.add_option("--for", arguments->engine, "The engine that reads the output")
        .type_name("ENGINE")
        .check(one_of(engine_names()))
        .required()
        .group("Output");
    command
        .add_option("-o,--output", arguments->options.output,
                    "The output, or a folder for it. Meshes of URDF, SDF and MJCF go beside the "
                    "output. Default: NAME.glb, .xml, .sdf, .urdf or .json beside NAME.cdp.h5; "
                    "such a file is not replaced if it exists")
        .type_name("PATH")
        .group("Output");
    add_content_options(command, arguments->options);
    add_report_format(command, arguments->format);
    add_jobs(command, arguments->threads);
    command.callback([command, arguments, &exit] { exit = run(command, *arguments); });
}

}  // namespace cdprep::cli
