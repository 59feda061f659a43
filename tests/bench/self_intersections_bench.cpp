// SPDX-License-Identifier: GPL-3.0-or-later
// Self-intersections of a mesh, beside CGAL's: find_self_intersections() on one thread and
// on several, its hierarchy included, and CGAL's sequential self_intersections() on the
// same welded mesh as a Surface_mesh, its building not included. They take turns; the
// figure is the median of the rounds.
//
// Usage: self_intersections_bench ROUNDS THREADS MESH...
//
// Prints a CSV table; `times` is CGAL's median by ours, the spreads are those of the middle
// half of the rounds. Ends with 1 when the pairs are not the same. Of a mesh that CGAL
// cannot hold, more than two triangles at an edge or two against each other, ours alone.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench_input.h"
#include "cli/program_threads.h"
#include "crossings/self_intersections.h"
#include "import/import_file.h"
#include "mesh/weld.h"

namespace cdprep {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Pair = std::array<std::uint32_t, 2>;

/// The mesh as CGAL has it, without triangles that repeat a corner.
struct Surface {
    SurfaceMesh mesh;
    std::vector<std::uint32_t> number;  ///< of each face, in ours
};

std::optional<Surface> surface_of(const mesh::Mesh& mesh) {
    Surface surface;
    for (const Double3& p : mesh.positions) surface.mesh.add_vertex({p.x, p.y, p.z});
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& v = mesh.triangles[i].vertex;
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
        using Vertex = SurfaceMesh::Vertex_index;
        const auto face = surface.mesh.add_face(Vertex(v[0]), Vertex(v[1]), Vertex(v[2]));
        if (face == SurfaceMesh::null_face()) return std::nullopt;
        surface.number.push_back(i);
    }
    return surface;
}

/// Without what CGAL says of triangles of zero area.
std::vector<Pair> cgals_pairs(const Surface& surface) {
    std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> found;
    CGAL::Polygon_mesh_processing::self_intersections(surface.mesh, std::back_inserter(found));
    std::vector<Pair> pairs;
    for (const auto& [f, g] : found) {
        if (f == g) continue;
        const auto [a, b] = std::minmax({surface.number[f], surface.number[g]});
        pairs.push_back({a, b});
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

std::vector<Pair> our_pairs(const mesh::Mesh& mesh, ParallelFor parallel_for) {
    std::vector<Pair> pairs;
    for (const auto& meeting : mesh::find_self_intersections(mesh, parallel_for)) {
        pairs.push_back({meeting.a, meeting.b});
    }
    return pairs;
}

/// Adds a run's milliseconds; returns what it returned.
template <class Run>
auto timed(std::vector<double>& times, Run&& run) {
    const auto begun = std::chrono::steady_clock::now();
    auto result = run();
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - begun;
    times.push_back(taken.count());
    return result;
}

/// Returns whether all agree.
bool compare(const std::filesystem::path& path, int rounds, std::size_t threads) {
    auto soup = import::import_file(path);
    if (!soup) stop(soup.error().message);
    const mesh::Mesh mesh = mesh::weld(soup.value()).mesh;
    const std::optional<Surface> surface = surface_of(mesh);
    const cli::Threads team(threads);
    std::vector<double> cgal, one, several;
    std::vector<Pair> pairs;
    bool same = true;
    for (int round = 0; round < rounds; ++round) {
        pairs = timed(one, [&] { return our_pairs(mesh, serial_for); });
        same &= timed(several, [&] { return our_pairs(mesh, team.parallel_for()); }) == pairs;
        if (surface) same &= timed(cgal, [&] { return cgals_pairs(*surface); }) == pairs;
    }
    std::printf("%s,%zu,%zu,%s,", path.filename().c_str(), mesh.triangles.size(), pairs.size(),
                same ? "yes" : "NO");
    if (surface) {
        std::printf("%.1f,%.1f,", median(cgal), spread(cgal));
    } else {
        std::printf(",,");
    }
    std::printf("%.1f,%.1f,%.1f,%.1f,", median(one), spread(one), median(several), spread(several));
    if (surface) {
        std::printf("%.2f,%.2f\n", median(cgal) / median(one), median(cgal) / median(several));
    } else {
        std::printf(",\n");
    }
    std::fflush(stdout);
    return same;
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    if (count < 4) cdprep::stop("usage: self_intersections_bench ROUNDS THREADS MESH...");
    const int threads = std::atoi(arguments[2]);
    std::printf(
        "mesh,triangles,pairs,same,cgal_ms,spread,one_ms,spread,%d_ms,spread,"
        "times_one,times_%d\n",
        threads, threads);
    bool same = true;
    for (int i = 3; i < count; ++i) {
        same &= cdprep::compare(arguments[i], std::atoi(arguments[1]),
                                static_cast<std::size_t>(threads));
    }
    return same ? 0 : 1;
}
