// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>

#include "cli/colliders.h"
#include "cli/command.h"
#include "cli/import_arguments.h"
#include "cli/load_mesh.h"
#include "cli/output_path.h"
#include "cli/program_threads.h"
#include "cli/progress.h"
#include "cli/signals.h"
#include "command_line/command_line.h"
#include "command_line/command_page.h"
#include "decompose/enclose/enclose.h"
#include "decompose/surface/pieces_report.h"
#include "decompose/surface/surface_pieces.h"
#include "hull/enclosing_hull.h"
#include "text/printable.h"
#include "write/hulls_file.h"
#include "write/pieces_file.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

const std::map<std::string, convex::PieceOrder> kOrders = {
    {"greedy", convex::PieceOrder::greedy},
    {"depth-first", convex::PieceOrder::depth_first},
    {"breadth-first", convex::PieceOrder::breadth_first},
    {"cresting", convex::PieceOrder::cresting},
};

struct Arguments {
    fs::path input;
    fs::path output;
    bool exact = false;
    std::string order = "greedy";
    double tolerance = 0;
    bool table = false;
    std::string format = "text";
    std::string progress = "auto";
    std::size_t threads = 0;
    ImportArguments import;
    LoadOptions load;
    EncloseOptions enclose;
};

/// Fails before any input is read if the output cannot be written.
std::optional<Error> find_bad_output(const Arguments& arguments) {
    if (arguments.output.empty()) return std::nullopt;
    if (auto error = find_replaced_input(arguments.input, arguments.output)) return error;
    const auto format = write::mesh_format_of(arguments.output);
    if (format == write::MeshFormat::obj || format == write::MeshFormat::ply) return std::nullopt;
    return Error{ErrorCode::bad_argument,
                 arguments.output.string() + ": pieces can be written as .obj or .ply only."};
}

LoadOptions load_options(const Arguments& arguments, const Threads& threads, Progress& progress) {
    LoadOptions load = arguments.load;
    load.tell = [&](const std::string& sentences) {
        progress.clear();
        std::cerr << "cdprep decompose: " << arguments.input.string() << ": " << sentences << '\n';
    };
    load.import = arguments.import.options({arguments.output});
    load.import.parallel_for = threads.parallel_for();
    return load;
}

Result<report::SurfacePiecesReport> decompose(const Arguments& arguments, Progress& progress) {
    if (const auto error = find_bad_output(arguments)) return *error;
    const Threads threads(arguments.threads);
    progress.show(0, arguments.input.filename().string() + ": import");
    const Result<mesh::Mesh> mesh =
        load_mesh(arguments.input, load_options(arguments, threads, progress));
    if (!mesh) return mesh.error();
    if (is_interrupted()) return interrupted(arguments.input);

    progress.show(0, arguments.input.filename().string() + ": decompose");
    const Clock::time_point begin = Clock::now();
    report::SurfacePiecesReport report;
    report.order = kOrders.at(arguments.order);
    report.tolerance = arguments.tolerance;
    report.pieces =
        convex::find_surface_pieces(mesh.value(), {.order = report.order,
                                                   .tolerance = arguments.tolerance,
                                                   .parallel_for = threads.parallel_for(),
                                                   .stop = is_interrupted});
    report.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    if (is_interrupted()) return interrupted(arguments.input);
    report.input = arguments.input.string();
    report.output = arguments.output.string();
    report.has_table = arguments.table;
    if (arguments.output.empty()) return report;

    progress.show(0, arguments.input.filename().string() + ": write");
    const Result<Done> written = write::write_pieces(
        arguments.output,
        {mesh.value().positions, mesh.value().triangles, mesh.value().single_precision},
        {report.pieces.triangles, report.pieces.first});
    if (!written) return written.error();
    return report;
}

/// Encloses the mesh in parts, within an error or up to a number of parts.
Exit run_enclose(const Arguments& arguments, Progress& progress) {
    const Threads threads(arguments.threads);
    EncloseOptions options = arguments.enclose;
    options.output = arguments.output;
    options.load = load_options(arguments, threads, progress);
    options.has_table = arguments.table;
    Result<report::ApproximateReport> found = enclose(arguments.input, options, threads, progress);
    progress.clear();
    const bool is_json = arguments.format == "json";
    if (!found) {
        if (is_json) {
            std::cout << report::approximate_json(
                failed<report::ApproximateReport>(arguments.input, found.error()));
        }
        return fail("decompose", found.error());
    }
    if (found->error) {
        if (is_json) std::cout << report::approximate_json(*found);
        std::cerr << "cdprep decompose: " << report::printable(*found->error) << '\n';
        return static_cast<Exit>(found->exit);
    }
    const bool is_as_asked = found.value().result.is_as_asked;
    if (!is_as_asked) found.value().exit = static_cast<int>(Exit::findings);
    std::cout << (is_json ? report::approximate_json(found.value())
                          : report::approximate_text(found.value()));
    const std::string warning = report::unit_warning(*found);
    if (!warning.empty()) std::cerr << "cdprep decompose: " << report::printable(warning) << '\n';
    return is_as_asked ? Exit::success : Exit::findings;
}

bool is_enclosing(const Arguments& arguments) {
    const EncloseOptions& enclosed = arguments.enclose;
    return enclosed.max_error || enclosed.parts || enclosed.max_parts;
}

/// Returns an error for an option that the output's format has no use for. Another error tells of
/// an output that has no format.
std::optional<Error> find_idle_in_output(const Command& command, const Arguments& arguments) {
    const auto format = write::hulls_format_of(arguments.output);
    if (!format && !arguments.output.empty()) return std::nullopt;
    struct Use {
        const char* option;
        bool is_used;
        const char* users;
    };
    const bool has_mass = format && write::has_mass(*format);
    const bool has_meshes = format && write::has_mesh_files(*format);
    const std::array<Use, 3> uses = {{
        {"--density", has_mass, ".urdf, .sdf, .mjcf and .xml have a mass"},
        {"--no-visual", has_meshes, ".urdf and .sdf have a visual mesh"},
        {"--strict", has_mass, ".urdf, .sdf, .mjcf and .xml need a unit"},
    }};
    for (const Use& use : uses) {
        if (use.is_used || command.count(use.option) == 0) continue;
        return Error{ErrorCode::bad_argument, std::string(use.option) + " has no effect: only " +
                                                  use.users + ". Remove the option, or write " +
                                                  "such a file with -o."};
    }
    return std::nullopt;
}

/// Returns an error for an option without effect: the user expected one.
std::optional<Error> find_idle_option(const Command& command, const Arguments& arguments) {
    constexpr std::array<const char*, 2> kOfSurface = {"--tolerance", "--order"};
    constexpr std::array<const char*, 7> kOfEnclosing = {
        "--max-vertices", "--work",      "--to-surface", "--merge-components",
        "--density",      "--no-visual", "--strict"};
    const auto find_given = [&](std::span<const char* const> names) -> const char* {
        const auto at = std::find_if(names.begin(), names.end(),
                                     [&](const char* name) { return command.count(name) > 0; });
        return at == names.end() ? nullptr : *at;
    };
    const bool encloses = is_enclosing(arguments);
    const char* idle = encloses ? find_given(kOfSurface) : find_given(kOfEnclosing);
    if (idle == nullptr) return encloses ? find_idle_in_output(command, arguments) : std::nullopt;
    return Error{
        ErrorCode::bad_argument,
        idle + std::string(encloses ? " applies to pieces of the surface: remove it, or remove "
                                      "--max-error, --parts and --max-parts."
                                    : " applies to parts that enclose the mesh: add "
                                      "--max-error, --parts or --max-parts.")};
}

Exit run(const Command& command, const Arguments& arguments) {
    if (const auto error = find_idle_option(command, arguments)) return fail("decompose", *error);
    Progress progress(parse_progress(arguments.progress), 1);
    if (is_enclosing(arguments)) return run_enclose(arguments, progress);
    const Result<report::SurfacePiecesReport> found = decompose(arguments, progress);
    progress.clear();
    const bool is_json = arguments.format == "json";
    if (!found) {
        if (is_json) {
            std::cout << report::pieces_json(
                failed<report::SurfacePiecesReport>(arguments.input, found.error()));
        }
        return fail("decompose", found.error());
    }
    std::cout << (is_json ? report::pieces_json(found.value())
                          : report::pieces_text(found.value()));
    return Exit::success;
}

/// Returns --exact, which excludes the enclosing parts.
const Option add_surface_options(const Command& command, Arguments& arguments) {
    const char* const surface = "Pieces of the surface";
    const Option exact =
        command
            .add_flag("--exact", arguments.exact,
                      "Cut the surface into pieces that lie on their hulls exactly. This is the "
                      "default")
            .group(surface);
    command
        .add_option("--tolerance", arguments.tolerance,
                    "Largest permitted height of a piece's vertices above the planes of its "
                    "triangles, in model units. A proven bound on the heights that occur is "
                    "reported")
        .type_name("DISTANCE")
        .check(zero_or_more())
        .excludes(exact)
        .group(surface);
    command
        .add_option("--order", arguments.order,
                    "Algorithm. greedy merges patches and gives the fewest pieces; the others grow "
                    "patches")
        .type_name("ORDER")
        .check(one_of({"greedy", "depth-first", "breadth-first", "cresting"}))
        .show_default()
        .group(surface);
    return exact;
}

void add_enclosing_options(const Command& command, EncloseOptions& enclosed, const Option exact) {
    const char* const enclosing = "Enclosing parts";
    command
        .add_option("--max-error", enclosed.max_error,
                    "Use as few parts as the search can find. They stick out of the solid by at "
                    "most this distance, in model units")
        .type_name("DISTANCE")
        .check(zero_or_more())
        .excludes(exact)
        .group(enclosing);
    command
        .add_option("--parts", enclosed.parts,
                    "Use at most N parts, and minimize the distance by which they stick out")
        .check(whole_from(1))
        .excludes(exact)
        .group(enclosing);
    command
        .add_option("--max-parts", enclosed.max_parts,
                    "Maximum number of parts, such as an engine's limit; takes precedence over "
                    "--max-error")
        .check(whole_from(1))
        .excludes(exact)
        .group(enclosing);
    command
        .add_option("--max-vertices", enclosed.max_vertices,
                    "Maximum number of vertices per part, such as an engine's limit")
        .check(whole_from(convex::kFewestEnclosingVertices, 1U << 30U))
        .group(enclosing);
    command
        .add_option("--work", enclosed.work,
                    "Search budget, in steps of about 10 ns; a smaller budget gives a looser fit")
        .check(whole_from(0))
        .show_default()
        .group(enclosing);
    command
        .add_flag("--to-surface", enclosed.to_surface,
                  "Measure how far parts stick out of the surface, not of the solid: for sheets "
                  "and hollow bodies")
        .group(enclosing);
    command
        .add_flag("--merge-components", enclosed.merge_components,
                  "Let a part enclose several components and nodes")
        .group(enclosing);
}

void add_physics_options(const Command& command, EncloseOptions& enclosed) {
    const char* const physics = "Robot and physics files";
    command.add_option("--density", enclosed.density, "Density for masses, in kg per cubic metre")
        .check(above_zero())
        .show_default()
        .group(physics);
    command
        .add_flag("!--no-visual", enclosed.has_visual,
                  "Leave the visual mesh out of .urdf and .sdf")
        .group(physics);
    command
        .add_flag("--strict", enclosed.strict,
                  "Refuse .urdf, .sdf, .mjcf and .xml of a mesh without a unit (exit 1)")
        .group(physics);
}

}  // namespace

void add_decompose(const Command& app, Exit& exit) {
    auto arguments = std::make_shared<Arguments>();
    const Command command =
        app.add_command("decompose", "Decompose a mesh into convex pieces or parts");
    command.set_notes(
        "By default, the command cuts the surface into pieces that lie on their own convex hulls: "
        "exactly, or within --tolerance. This works for every mesh. No piece crosses a boundary, a "
        "non-manifold edge, or an edge with triangles of opposite windings. Names of nodes have no "
        "effect.\n\n"
        "With --max-error, --parts or --max-parts, the command encloses the solid in few convex "
        "parts instead. A proven bound on the distance by which they stick out is reported. "
        "Components and nodes stay separate, unless --merge-components is given. A node named "
        "UCX_..., ...-convcolonly, ...-convcol, ...-convex or ..._convex is replaced by its convex "
        "hull. Other groups that 'cdprep bake' would leave out stay separate even if they are "
        "unbalanced.\n\n"
        "If the request cannot be met, the best result is written and the exit code is 1.",
        {"cdprep decompose part.obj -o pieces.ply",
         "cdprep decompose robot.obj -o robot.urdf --max-error 0.5 --unit mm",
         "cdprep decompose chair.glb -o parts.glb --parts 16 --max-vertices 64"});
    add_input(command, arguments->input);
    command
        .add_option("-o,--output", arguments->output,
                    "The pieces: .obj with a group for each, or .ply with colours. Enclosing "
                    "parts: .obj, .glb, .mjcf, .xml, or .urdf or .sdf with one mesh file per "
                    "part")
        .type_name("FILE")
        .group("Output");
    const Option exact = add_surface_options(command, *arguments);
    add_enclosing_options(command, arguments->enclose, exact);
    add_physics_options(command, arguments->enclose);
    command
        .add_flag("--table", arguments->table,
                  "Report every piece or part. Parts are listed with their nodes")
        .group("Report");
    add_report_format(command, arguments->format);
    add_normalize(command, arguments->load.normalize);
    add_weld(command, arguments->load.weld_distance);
    add_jobs(command, arguments->threads);
    add_progress(command, arguments->progress);
    add_import_arguments(command, arguments->import);
    add_without_colliders(command, arguments->load.without_colliders);
    command.callback([command, arguments, &exit] { exit = run(command, *arguments); });
}

}  // namespace cdprep::cli
