// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/enclose.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/output_path.h"
#include "cli/signals.h"
#include "decompose/enclose/body_mass.h"
#include "decompose/enclose/mesh_nodes.h"
#include "mesh/topology.h"
#include "mesh/turn_up.h"
#include "mesh/weld.h"
#include "write/hulls_file.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::optional<Error> find_bad_output(const fs::path& input, const EncloseOptions& options) {
    const fs::path& output = options.output;
    if (output.empty()) return std::nullopt;
    if (auto error = find_replaced_input(input, output)) return error;
    const auto format = write::hulls_format_of(output);
    if (!format) {
        return Error{ErrorCode::bad_argument,
                     output.string() +
                         ": parts can be written as .obj, .glb, .urdf, .sdf, .mjcf or .xml only."};
    }
    if (write::may_replace(output, *format, input)) {
        return Error{ErrorCode::bad_argument,
                     input.string() + ": has the name of a mesh file that " + output.string() +
                         " would write. Choose another output."};
    }
    // Of the parts, their number is not known yet.
    if (auto error = write::find_foreign_mesh(output, *format, "part_0")) return error;
    if (!options.has_visual) return std::nullopt;
    return write::find_foreign_mesh(output, *format, "visual");
}

/// Thrown by a task after a signal: a search has no other early exit.
struct Stopped {};

convex::ApproximateOptions search_options(const EncloseOptions& options) {
    convex::ApproximateOptions how;
    how.max_error = options.max_error;
    how.max_parts = options.parts;
    if (options.max_parts) {
        how.max_parts = std::min(options.parts.value_or(*options.max_parts), *options.max_parts);
    }
    how.max_vertices = options.max_vertices;
    how.work = options.work;
    how.reference = options.to_surface ? convex::Reference::surface : convex::Reference::solid;
    how.merge_components = options.merge_components;
    return how;
}

bool is_for_simulators(const fs::path& output) {
    return !output.empty() && write::has_mass(*write::hulls_format_of(output));
}

std::string unknown_unit(const fs::path& input, const EncloseOptions& options) {
    const bool is_normalized = options.load.normalize;
    return input.string() +
           (is_normalized ? ": has no unit after --normalize, which "
                          : ": states no unit, which ") +
           options.output.string() +
           (is_normalized ? " needs. Leave out --normalize."
                          : " needs. Give --unit mm, cm, m, in or ft.");
}

/// Adds the rounding of the written corners to the errors of the parts. They may then miss the
/// request.
void add_rounding(double rounding, report::ApproximateReport& report) {
    report.rounding = rounding;
    if (rounding == 0) return;
    const auto above = [&](double bound) {
        constexpr double kUp = 1 + 1e-15;  // above the rounding of the sum
        return kUp * (bound + rounding);
    };
    convex::ApproximateParts& result = report.result;
    for (convex::ApproximatePart& part : result.parts) part.error.upper = above(part.error.upper);
    result.outer_error = above(result.outer_error);
    result.outer_lower = std::max(0.0, result.outer_lower - rounding);
    result.inner_error = rounding;
    if (!result.is_as_asked || !report.max_error) return;
    report.is_missed_by_rounding = result.outer_error > *report.max_error;
    result.is_as_asked = !report.is_missed_by_rounding;
}

/// Writes the parts. For simulators, also writes the mass and the visual mesh, in metres, +z up.
Result<Done> write_parts(mesh::Mesh mesh, bool is_balanced, const EncloseOptions& options,
                         const Threads& threads, report::ApproximateReport& report) {
    std::vector<convex::ConvexHull> hulls;
    for (const convex::ApproximatePart& part : report.result.parts) hulls.push_back(part.hull);
    const write::HullsFormat format = *write::hulls_format_of(options.output);
    write::HullsFileOptions how;
    how.metres_per_unit = report.metres_per_unit;
    if (write::has_mass(format)) {
        mesh::turn_up(mesh.positions, report.up_axis, format::UpAxis::z);
        for (convex::ConvexHull& hull : hulls) {
            mesh::turn_up(hull.points, report.up_axis, format::UpAxis::z);
        }
        const auto weighed = weigh(mesh, hulls,
                                   {.is_balanced = is_balanced && !options.to_surface,
                                    .density = options.density,
                                    .metres_per_unit = report.metres_per_unit,
                                    .parallel_for = threads.parallel_for()});
        if (weighed) {
            how.mass = weighed->body;
            report.mass = weighed->body.mass;
            report.mass_of = weighed->of;
        }
    }
    if (options.has_visual && write::has_mesh_files(format)) {
        how.visual = {mesh.positions, mesh.triangles, mesh.single_precision};
    }
    std::vector<write::HullArrays> written;
    for (std::size_t i = 0; i < hulls.size(); ++i) {
        written.push_back(
            {"part_" + std::to_string(i), hulls[i].points, hulls[i].facets, hulls[i].dimension});
    }
    const Result<write::WrittenHulls> done =
        write::write_hulls(options.output, format, written, how);
    if (!done) return done.error();
    report.left_out = done->left_out;
    add_rounding(done->rounding, report);
    return Done{};
}

}  // namespace

std::optional<convex::ApproximateParts> search_parts(const mesh::Mesh& mesh,
                                                     convex::ApproximateOptions how,
                                                     const Threads& threads) {
    const auto run = [&](std::size_t count, Task task) {
        const auto unless_stopped = [&](std::size_t i) {
            if (is_interrupted()) throw Stopped{};
            task(i);
        };
        threads.parallel_for()(count, unless_stopped);
    };
    how.parallel_for = run;
    try {
        return convex::find_approximate_parts(mesh, how);
    } catch (const Stopped&) {
        return std::nullopt;
    }
}

Result<report::ApproximateReport> enclose(const fs::path& input, const EncloseOptions& options,
                                          const Threads& threads, Progress& progress) {
    if (const auto error = find_bad_output(input, options)) return *error;
    const std::string name = input.filename().string();
    progress.show(0, name + ": import");
    const Result<mesh::TriangleSoup> loaded = load_soup(input, options.load);
    if (!loaded) return loaded.error();
    const mesh::TriangleSoup& soup = loaded.value();
    const mesh::Mesh mesh = mesh::weld(soup, {options.load.weld_distance}).mesh;
    if (is_interrupted()) return interrupted(input);
    if (options.strict && is_for_simulators(options.output) && soup.metres_per_unit == 0) {
        report::ApproximateReport refused;
        refused.input = input.string();
        refused.error = unknown_unit(input, options);
        refused.exit = static_cast<int>(Exit::findings);
        return refused;
    }

    progress.show(0, name + ": enclose");
    const Clock::time_point begin = Clock::now();
    const MeshNodes nodes = find_nodes(soup, mesh);
    report::ApproximateReport report;
    report.node_names = nodes.names;
    convex::ApproximateOptions how = search_options(options);
    how.node_of = nodes.node_of;
    how.convex_node = nodes.is_convex;
    std::optional<convex::ApproximateParts> found = search_parts(mesh, how, threads);
    if (!found || is_interrupted()) return interrupted(input);
    report.result = std::move(*found);
    report.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    report.input = input.string();
    report.output = options.output.string();
    report.max_error = options.max_error;
    report.max_parts = how.max_parts;
    report.triangles = mesh.triangles.size();
    report.to_surface = options.to_surface;
    report.has_table = options.has_table;
    report.metres_per_unit = soup.metres_per_unit;
    report.is_normalized = options.load.normalize;
    report.up_axis = soup.up_axis;
    report.is_for_simulators = is_for_simulators(options.output);
    mesh::Box box;
    for (const mesh::Double3& p : mesh.positions) box.add(p);
    if (!mesh.positions.empty()) {
        report.diagonal = box.diagonal();
        report.size = {box.upper.x - box.lower.x, box.upper.y - box.lower.y,
                       box.upper.z - box.lower.z};
    }
    const mesh::Topology topology = mesh::find_topology(mesh);
    for (const format::Component& component : topology.components) {
        if ((component.flags & format::component_balanced) == 0) ++report.unbalanced_components;
    }
    if (options.output.empty()) return report;
    progress.show(0, name + ": write");
    const Result<Done> written = write_parts(mesh, topology.balanced, options, threads, report);
    if (!written) return written.error();
    return report;
}

}  // namespace cdprep::cli
