// SPDX-License-Identifier: GPL-3.0-or-later
#include "enclose.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <vector>

#include "mesh/topology.h"
#include "mesh/weld.h"
#include "output_path.h"
#include "write/hulls_file.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// As exporters for engines name what is convex.
bool is_tagged_convex(const std::string& path) {
    const std::string name = path.substr(path.find_last_of('/') + 1);
    constexpr std::array<const char*, 4> kEndings = {"-convcol", "-convcolonly", "-convex",
                                                     "_convex"};
    return name.starts_with("UCX_") ||
           std::any_of(kEndings.begin(), kEndings.end(),
                       [&](const char* ending) { return name.ends_with(ending); });
}

/// Per triangle its node; none where there is one at most.
std::vector<std::uint32_t> nodes_of(const mesh::TriangleSoup& soup) {
    std::vector<std::uint32_t> node_of;
    if (soup.instances.empty()) return node_of;
    node_of.assign(soup.triangles.size(), 0);
    for (std::uint32_t i = 0; i < soup.instances.size(); ++i) {
        const format::Instance& instance = soup.instances[i];
        std::fill_n(node_of.begin() + instance.first_triangle, instance.triangle_count, i);
    }
    return node_of;
}

std::optional<Error> find_bad_output(const fs::path& input, const fs::path& output) {
    if (output.empty()) return std::nullopt;
    if (auto error = find_replaced_input(input, output)) return error;
    if (write::hulls_format_of(output)) return std::nullopt;
    return Error{ErrorCode::bad_argument,
                 output.string() +
                     ": the extension names no format that pieces can be written "
                     "in; it must be .obj, .glb, .urdf, .sdf, .mjcf or .xml."};
}

Result<std::size_t> write_pieces(const fs::path& output,
                                 const std::vector<convex::ApproximatePiece>& pieces,
                                 double metres_per_unit) {
    std::vector<write::HullArrays> hulls;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const convex::ConvexHull& hull = pieces[i].hull;
        hulls.push_back({"piece_" + std::to_string(i), hull.points, hull.facets, hull.dimension});
    }
    return write::write_hulls(output, *write::hulls_format_of(output), hulls, metres_per_unit);
}

}  // namespace

Result<report::ApproximateReport> enclose(const fs::path& input, const EncloseOptions& options,
                                          const Threads& threads) {
    if (const auto error = find_bad_output(input, options.output)) return *error;
    const Result<mesh::TriangleSoup> loaded = load_soup(input, options.load);
    if (!loaded) return loaded.error();
    const mesh::TriangleSoup& soup = loaded.value();
    const mesh::Mesh mesh = mesh::weld(soup, {options.load.weld_distance}).mesh;

    const Clock::time_point begin = Clock::now();
    const std::vector<std::uint32_t> node_of = nodes_of(soup);
    std::vector<std::uint8_t> is_convex_node;
    report::ApproximateReport report;
    for (const format::Instance& instance : soup.instances) {
        report.node_names.push_back(soup.instance_names[instance.name]);
        is_convex_node.push_back(is_tagged_convex(report.node_names.back()) ? 1 : 0);
    }
    convex::ApproximateOptions how;
    how.max_error = options.max_error;
    how.parts = options.parts;
    if (options.max_parts)
        how.parts = std::min(options.parts.value_or(*options.max_parts), *options.max_parts);
    how.max_vertices = options.max_vertices;
    how.work = options.work;
    how.reference = options.to_surface ? convex::Reference::surface : convex::Reference::solid;
    how.merge_components = options.merge_components;
    how.node_of = node_of;
    how.convex_node = is_convex_node;
    how.parallel_for = threads.parallel_for();
    report.result = convex::find_approximate_pieces(mesh, how);
    report.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    report.input = input.string();
    report.output = options.output.string();
    report.max_error = options.max_error;
    report.parts = how.parts;
    report.triangles = mesh.triangles.size();
    report.to_surface = options.to_surface;
    report.has_table = options.has_table;
    mesh::Box box;
    for (const mesh::Double3& p : mesh.positions) box.add(p);
    report.diagonal = mesh.positions.empty() ? 0 : box.diagonal();
    for (const format::Component& component : mesh::find_topology(mesh).components) {
        if ((component.flags & format::component_closed) == 0) ++report.open_components;
    }
    if (options.output.empty()) return report;
    const Result<std::size_t> left_out =
        write_pieces(options.output, report.result.pieces, soup.metres_per_unit);
    if (!left_out) return left_out.error();
    report.left_out = left_out.value();
    return report;
}

}  // namespace cdprep::cli
