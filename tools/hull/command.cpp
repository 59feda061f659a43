// SPDX-License-Identifier: GPL-3.0-or-later
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
#include "cli/signals.h"
#include "command_line/command_line.h"
#include "command_line/command_page.h"
#include "hull/enclosing_hull.h"
#include "hull/hull_report.h"
#include "hull/mesh_hulls.h"
#include "mesh/weld.h"
#include "write/mesh_file.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLinesShown = 20;  ///< lines for hulls, in text

const std::map<std::string, convex::HullScope> kScopes = {
    {"whole", convex::HullScope::whole},
    {"component", convex::HullScope::component},
    {"node", convex::HullScope::node},
};

struct Arguments {
    fs::path input;
    fs::path output;
    std::string scope = "whole";
    std::uint32_t max_vertices = 0;
    std::string format = "text";
    std::size_t threads = 0;
    bool without_colliders = false;
    ImportArguments import;
};

/// Returns the name of a hull. In an OBJ file a name is one word.
std::string name_of(const mesh::TriangleSoup& soup, convex::HullScope scope, std::size_t number) {
    if (scope == convex::HullScope::component) return "component_" + std::to_string(number);
    if (scope == convex::HullScope::whole || soup.instances.empty()) return "hull";
    std::string name = soup.instance_names[soup.instances[number].name];
    for (char& letter : name) {
        if (static_cast<unsigned char>(letter) <= ' ') letter = '_';
    }
    return name.empty() ? "node_" + std::to_string(number) : name;
}

/// All hulls as one mesh.
struct HullMesh {
    std::vector<format::Double3> positions;
    std::vector<format::Triangle> triangles;
    std::vector<write::NamedPart> parts;
    bool single_precision = true;

    void add(const convex::ConvexHull& hull, const std::string& name, bool single) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        parts.push_back({name, triangles.size()});
        positions.insert(positions.end(), hull.points.begin(), hull.points.end());
        for (const auto& [a, b, c] : hull.facets) {
            triangles.push_back({{first + a, first + b, first + c}});
        }
        single_precision = single_precision && single;
    }
};

report::HullFigures figures_of(const convex::MeshHull& found, const std::string& name) {
    const convex::ConvexHull& hull = found.hull;
    const bool is_exact = hull.dimension < 0 || !hull.numbers.empty();
    return {
        name,     hull.dimension, hull.points.size(), hull.facets.size(), hull.groups.size() - 1,
        is_exact, found.distance};
}

Result<report::HullReport> find_hulls(const Arguments& arguments) {
    const Result<write::MeshFormat> format = mesh_output(arguments.input, arguments.output);
    if (!format) return format.error();
    const Threads threads(arguments.threads);
    LoadOptions load;
    load.without_colliders = arguments.without_colliders;
    load.tell = [&](const std::string& sentences) {
        std::cerr << "cdprep hull: " << arguments.input.string() << ": " << sentences << '\n';
    };
    load.import = arguments.import.options({arguments.output});
    load.import.parallel_for = threads.parallel_for();
    const Result<mesh::TriangleSoup> loaded = load_soup(arguments.input, load);
    if (!loaded) return loaded.error();
    const mesh::TriangleSoup& soup = loaded.value();
    const mesh::Mesh mesh = mesh::weld(soup).mesh;

    const convex::HullScope scope = kScopes.at(arguments.scope);
    const Clock::time_point begin = Clock::now();
    const auto hulls = convex::find_mesh_hulls(mesh, soup.instances,
                                               {.scope = scope,
                                                .max_vertices = arguments.max_vertices,
                                                .parallel_for = threads.parallel_for()});
    report::HullReport report;
    report.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    if (!hulls) return report::hull_beyond_range(arguments.input.string(), "--max-vertices");
    if (is_interrupted()) return interrupted(arguments.input);
    report.input = arguments.input.string();
    report.output = arguments.output.string();
    report.scope = arguments.scope;
    report.triangles = mesh.triangles.size();
    report.vertices = mesh.positions.size();
    HullMesh output;
    for (std::size_t i = 0; i < hulls->size(); ++i) {
        report.hulls.push_back(figures_of((*hulls)[i], name_of(soup, scope, i)));
        const report::HullFigures& figures = report.hulls.back();
        output.add((*hulls)[i].hull, figures.name, soup.single_precision && figures.exact);
    }
    const Result<Done> written =
        write_mesh(arguments.output, format.value(),
                   {output.positions, output.triangles, output.single_precision, output.parts});
    if (!written) return written.error();
    return report;
}

Exit run(const Arguments& arguments) {
    const Result<report::HullReport> found = find_hulls(arguments);
    const bool is_json = arguments.format == "json";
    if (!found) {
        if (is_json) {
            report_stream(arguments.output)
                << report::hull_json(failed<report::HullReport>(arguments.input, found.error()));
        }
        return fail("hull", found.error());
    }
    report_stream(arguments.output) << (is_json ? report::hull_json(found.value())
                                                : report::hull_text(found.value(), kLinesShown));
    return Exit::success;
}

}  // namespace

void add_hull(const Command& app, Exit& exit) {
    auto arguments = std::make_shared<Arguments>();
    const Command command = app.add_command("hull", "Compute the convex hull of a mesh");
    command.set_notes(
        "The hull is exact: its points are vertices of the mesh, and no vertex lies outside. With "
        "--max-vertices, it encloses the exact hull. A proven bound on the distance is reported. "
        "Points, segments and polygons have hulls too.",
        {"cdprep hull scan.ply -o hull.obj",
         "cdprep hull robot.glb -o hulls.obj --per node --max-vertices 64"});
    add_input(command, arguments->input);
    command
        .add_option("-o,--output", arguments->output,
                    "The hulls: .obj with a group for each, or .ply, .stl or .off")
        .type_name("FILE")
        .required()
        .group("Output");
    command
        .add_option("--max-vertices", arguments->max_vertices,
                    "Maximum number of vertices; the hull then encloses the exact hull")
        .check(whole_from(convex::kFewestEnclosingVertices, format::kMaxTriangles))
        .group("Hull");
    command
        .add_option("--per", arguments->scope,
                    "One hull for the whole mesh, each component (triangles that share vertices) "
                    "or each node of the file")
        .type_name("SCOPE")
        .check(one_of({"whole", "component", "node"}))
        .show_default()
        .group("Hull");
    add_report_format(command, arguments->format);
    add_jobs(command, arguments->threads);
    add_import_arguments(command, arguments->import);
    add_without_colliders(command, arguments->without_colliders);
    command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace cdprep::cli
