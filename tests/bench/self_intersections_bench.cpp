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
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "bench_input.h"
#include "cgal_surface.h"
#include "cli/program_threads.h"
#include "crossings/self_intersections.h"
#include "import/import_file.h"
#include "mesh/weld.h"

namespace cdprep {
namespace {

using Pair = CgalSurface::Pair;

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
    const auto surface = CgalSurface::of(mesh.positions, mesh.triangles);
    const cli::Threads team(threads);
    std::vector<double> cgal, one, several;
    std::vector<Pair> pairs;
    bool same = true;
    for (int round = 0; round < rounds; ++round) {
        pairs = timed(one, [&] { return our_pairs(mesh, serial_for); });
        same &= timed(several, [&] { return our_pairs(mesh, team.parallel_for()); }) == pairs;
        if (surface) same &= timed(cgal, [&] { return surface->self_intersections(); }) == pairs;
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
