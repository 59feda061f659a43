// SPDX-License-Identifier: MIT
// Repairs files by preset, and beside it by CGAL's functions called plainly: A repairs the
// soup, orients it, stitches, duplicates non-manifold vertices and orients outwards; B
// removes degenerate faces and fills every hole too. Prints one CSV row a file and way.
// Usage: repair_bench FILE...
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

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "import/import_file.h"
#include "mesh/repair.h"
#include "mesh/stored_verdict.h"

namespace {

namespace mesh = cdprep::mesh;
namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

void print(const std::string& file, const char* way, const mesh::StoredVerdict& found,
           std::size_t triangles, double seconds) {
    const auto has = [&](cdprep::format::VerdictFacts fact) {
        return (found.verdict.facts & fact) != 0 ? 1 : 0;
    };
    std::printf("%s,%s,%d,%d,%d,%zu,%.3f\n", file.c_str(), way, has(cdprep::format::verdict_closed),
                has(cdprep::format::verdict_two_manifold), has(cdprep::format::verdict_oriented),
                triangles, seconds);
    std::fflush(stdout);
}

mesh::StoredVerdict verdict_of(const SurfaceMesh& surface) {
    std::vector<mesh::Double3> positions(surface.number_of_vertices());
    std::vector<mesh::Triangle> triangles;
    for (const auto vertex : surface.vertices()) {
        const auto& p = surface.point(vertex);
        positions[vertex] = {p.x(), p.y(), p.z()};
    }
    for (const auto face : surface.faces()) {
        mesh::Triangle triangle{};
        std::size_t k = 0;
        for (const auto vertex : vertices_around_face(surface.halfedge(face), surface)) {
            if (k < 3) triangle.vertex[k++] = vertex;
        }
        triangles.push_back(triangle);
    }
    return mesh::find_stored_verdict(positions, triangles);
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

/// CGAL asserts on some meshes: then there is no result.
void time_cgal(const std::string& file, const mesh::TriangleSoup& soup, bool fills) {
    const char* way = fills ? "cgal_b" : "cgal_a";
    const Clock::time_point begin = Clock::now();
    try {
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
        const double seconds = seconds_since(begin);
        print(file, way, verdict_of(surface), surface.number_of_faces(), seconds);
    } catch (const std::exception& error) {
        std::printf("%s,%s,failed,,,,%.3f\n", file.c_str(), way, seconds_since(begin));
    }
}

void time_ours(const std::string& file, const mesh::TriangleSoup& soup, const char* preset) {
    mesh::RepairOptions options;
    options.steps = *mesh::find_repair_preset(preset);
    const Clock::time_point begin = Clock::now();
    const mesh::Repaired repaired = mesh::repair(soup, options);
    print(file, preset, repaired.report.after, repaired.mesh.triangles.size(),
          seconds_since(begin));
}

}  // namespace

int main(int argc, char** argv) {
    std::printf("file,way,closed,two_manifold,oriented,triangles,seconds\n");
    for (int i = 1; i < argc; ++i) {
        const std::string name = std::filesystem::path(argv[i]).filename().string();
        const auto soup = cdprep::import::import_file(argv[i]);
        if (!soup) {
            std::fprintf(stderr, "%s\n", soup.error().message.c_str());
            continue;
        }
        time_ours(name, soup.value(), "safe");
        time_cgal(name, soup.value(), false);
        time_ours(name, soup.value(), "closed");
        time_cgal(name, soup.value(), true);
    }
    return 0;
}
