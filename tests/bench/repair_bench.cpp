// SPDX-License-Identifier: MIT
// Repairs files by preset, and beside it by CGAL's functions called plainly: A repairs the
// soup, orients it, stitches, duplicates non-manifold vertices and orients outwards; B
// removes degenerate faces and fills every hole too. Prints one CSV row a file and way.
// Usage: repair_bench [--way WAY] [--write FOLDER] FILE...
//   --way: safe, cgal_a, closed, cgal_b, solid, or as_read: nothing is done. Otherwise the
//   first four. --write: each result as FOLDER/FILE.WAY.ply.
// Or: repair_bench --distance FILE RESULT: how far each surface is from the other, as the
// lower and upper bound from FILE to RESULT and back. For results of any program.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "import/import_file.h"
#include "repair/moved_distance.h"
#include "repair/repair.h"
#include "repair/stored_verdict.h"
#include "write/mesh_file.h"

namespace {

namespace fs = std::filesystem;
namespace mesh = cdprep::mesh;
namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

void print(const std::string& file, const std::string& way, const mesh::StoredVerdict& found,
           std::size_t triangles, double seconds) {
    const auto has = [&](cdprep::format::VerdictFacts fact) {
        return (found.verdict.facts & fact) != 0 ? 1 : 0;
    };
    std::printf("%s,%s,%d,%d,%d,%zu,%.3f\n", file.c_str(), way.c_str(),
                has(cdprep::format::verdict_closed), has(cdprep::format::verdict_two_manifold),
                has(cdprep::format::verdict_oriented), triangles, seconds);
    std::fflush(stdout);
}

mesh::RepairMesh mesh_of(const SurfaceMesh& surface, bool single_precision) {
    mesh::RepairMesh result;
    result.single_precision = single_precision;  // no way makes points
    result.positions.resize(surface.number_of_vertices());
    for (const auto vertex : surface.vertices()) {
        const auto& p = surface.point(vertex);
        result.positions[vertex] = {p.x(), p.y(), p.z()};
    }
    for (const auto face : surface.faces()) {
        mesh::Triangle triangle{};
        std::size_t k = 0;
        for (const auto vertex : vertices_around_face(surface.halfedge(face), surface)) {
            if (k < 3) triangle.vertex[k++] = vertex;
        }
        result.triangles.push_back(triangle);
    }
    return result;
}

void fill_all(SurfaceMesh& surface) {
    pmp::remove_degenerate_faces(surface);
    std::vector<SurfaceMesh::Halfedge_index> borders;
    pmp::extract_boundary_cycles(surface, std::back_inserter(borders));
    for (const auto border : borders) {
        std::vector<SurfaceMesh::Face_index> made;
        pmp::triangulate_hole(surface, border, std::back_inserter(made));
    }
    surface.collect_garbage();
}

mesh::RepairMesh repair_by_cgal(const mesh::TriangleSoup& soup, bool fills) {
    std::vector<Kernel::Point_3> points;
    std::vector<std::vector<std::size_t>> polygons;
    for (const auto& p : soup.positions) points.emplace_back(p.x, p.y, p.z);
    for (const auto& t : soup.triangles) {
        polygons.push_back({t.vertex[0], t.vertex[1], t.vertex[2]});
    }
    pmp::repair_polygon_soup(points, polygons);
    pmp::orient_polygon_soup(points, polygons);
    SurfaceMesh surface;
    pmp::polygon_soup_to_polygon_mesh(points, polygons, surface);
    pmp::stitch_borders(surface);
    pmp::duplicate_non_manifold_vertices(surface);
    pmp::remove_isolated_vertices(surface);
    if (CGAL::is_closed(surface)) pmp::orient_to_bound_a_volume(surface);
    if (fills) fill_all(surface);
    surface.collect_garbage();
    return mesh_of(surface, soup.single_precision);
}

mesh::RepairMesh repair_by(const std::string& way, const mesh::TriangleSoup& soup) {
    if (way == "as_read") return {soup.positions, soup.triangles, {}, {}, soup.single_precision};
    if (way == "cgal_a" || way == "cgal_b") return repair_by_cgal(soup, way == "cgal_b");
    mesh::RepairOptions options;
    options.steps = mesh::find_repair_preset(way).value();
    return mesh::repair(soup, options).mesh;
}

void write(const fs::path& folder, const std::string& file, const std::string& way,
           const mesh::RepairMesh& result) {
    const fs::path path = folder / (file + "." + way + ".ply");
    const auto written = cdprep::write::write_mesh_file(
        path, cdprep::write::MeshFormat::ply,
        {result.positions, result.triangles, result.single_precision});
    if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
}

/// CGAL asserts on some meshes: then there is no result.
void time_way(const std::string& file, const mesh::TriangleSoup& soup, const std::string& way,
              const fs::path& folder) {
    const Clock::time_point begin = Clock::now();
    try {
        const mesh::RepairMesh result = repair_by(way, soup);
        const double seconds = seconds_since(begin);
        print(file, way, mesh::find_stored_verdict(result.positions, result.triangles),
              result.triangles.size(), seconds);
        if (!folder.empty()) write(folder, file, way, result);
    } catch (const std::exception& error) {
        std::printf("%s,%s,failed,,,,%.3f\n", file.c_str(), way.c_str(), seconds_since(begin));
    }
}

std::optional<mesh::TriangleSoup> read(const char* path) {
    auto soup = cdprep::import::import_file(path);
    if (soup) return std::move(soup).value();
    std::fprintf(stderr, "%s\n", soup.error().message.c_str());
    return std::nullopt;
}

std::tuple<double, double, double> key_of(const mesh::Double3& p) {
    return {p.x, p.y, p.z};
}

/// The corners of a triangle, the same for any order of them.
std::array<mesh::Double3, 3> corners_of(const mesh::TriangleSoup& soup, const mesh::Triangle& t) {
    std::array corners{soup.positions[t.vertex[0]], soup.positions[t.vertex[1]],
                       soup.positions[t.vertex[2]]};
    std::ranges::sort(corners, {}, key_of);
    return corners;
}

/// Names an input triangle with the same corners for each of the result, where there is one:
/// those are not away. Sound for the result of any program; others are measured.
std::vector<mesh::Origin> find_origins(const mesh::TriangleSoup& soup,
                                       const mesh::TriangleSoup& result) {
    const auto less = [](const auto& a, const auto& b) {
        return std::ranges::lexicographical_compare(a, b, {}, key_of, key_of);
    };
    std::map<std::array<mesh::Double3, 3>, std::uint32_t, decltype(less)> known(less);
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
        known.emplace(corners_of(soup, soup.triangles[t]), t);
    }
    std::vector<mesh::Origin> origins;
    for (const mesh::Triangle& t : result.triangles) {
        const auto same = known.find(corners_of(result, t));
        origins.push_back({same == known.end() ? mesh::kNone : same->second, std::nullopt});
    }
    return origins;
}

int print_distances(const char* file, const char* result_file) {
    const auto soup = read(file), result = read(result_file);
    if (!soup || !result) return 1;
    const mesh::MovedDistances moved =
        mesh::find_moved_distances(*soup, {result->positions,
                                           result->triangles,
                                           {},
                                           find_origins(*soup, *result),
                                           result->single_precision});
    std::printf("%.9g,%.9g,%.9g,%.9g\n", moved.input_to_output.lower, moved.input_to_output.upper,
                moved.output_to_input.lower, moved.output_to_input.upper);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::string> ways{"safe", "cgal_a", "closed", "cgal_b"};
    fs::path folder;
    if (argc == 4 && std::string(argv[1]) == "--distance") {
        return print_distances(argv[2], argv[3]);
    }
    std::printf("file,way,closed,two_manifold,oriented,triangles,seconds\n");
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--way" && i + 1 < argc) {
            ways = {argv[++i]};
        } else if (argument == "--write" && i + 1 < argc) {
            folder = argv[++i];
        } else if (const auto soup = read(argv[i])) {
            const std::string name = fs::path(argument).filename().string();
            for (const std::string& way : ways) time_way(name, *soup, way, folder);
        }
    }
    return 0;
}
