// SPDX-License-Identifier: MIT
// The exact convex hull beside qhull's and beside CGAL's alone, on the same points, by turns,
// on one thread: medians and the spread of the middle half, milliseconds. The ratio is the
// median of rounds. qhull is asked as it is by default, with triangles ("Qt"); without
// libqhull_r its columns are 0.
//
// Usage: hull_bench ROUNDS MESH...
//
// Prints a CSV table. Ends with 1 when extreme points differ from CGAL's.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "bench_input.h"
#include "hull/convex_hull.h"
#include "hull/cull_inside.h"
#include "import/import_file.h"

#ifdef CDPREP_HAVE_QHULL
extern "C" {
#include <libqhull_r/qhull_ra.h>
}
#endif

namespace cdprep::convex {
namespace {

using Points = std::vector<Double3>;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

template <class Work>
double milliseconds(Work&& work) {
    const auto begun = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun)
        .count();
}

/// Returns how many corners qhull finds.
std::size_t ask_qhull([[maybe_unused]] const Points& points) {
#ifdef CDPREP_HAVE_QHULL
    qhT qhull;
    qh_zero(&qhull, stderr);
    std::array<char, 9> command = {"qhull Qt"};
    // qhull does not write to its points, but does not say so.
    auto* const coordinates = const_cast<coordT*>(&points[0].x);
    if (qh_new_qhull(&qhull, 3, static_cast<int>(points.size()), coordinates, 0, command.data(),
                     nullptr, nullptr) != 0) {
        stop("qhull found no hull.");
    }
    const auto corners = static_cast<std::size_t>(qhull.num_vertices);
    qh_freeqhull(&qhull, !qh_ALL);
    int current = 0, total = 0;
    qh_memfreeshort(&qhull, &current, &total);
    return corners;
#else
    return 0;
#endif
}

CGAL::Surface_mesh<Kernel::Point_3> ask_cgal(const Points& points) {
    std::vector<Kernel::Point_3> converted;
    converted.reserve(points.size());
    for (const Double3& p : points) converted.emplace_back(p.x, p.y, p.z);
    CGAL::Surface_mesh<Kernel::Point_3> hull;
    CGAL::convex_hull_3(converted.begin(), converted.end(), hull);
    return hull;
}

using PointSet = std::set<std::array<double, 3>>;

bool same_corners(const ConvexHull& ours, const CGAL::Surface_mesh<Kernel::Point_3>& theirs) {
    PointSet a, b;
    for (const Double3& p : ours.points) a.insert({p.x, p.y, p.z});
    for (const auto vertex : theirs.vertices()) {
        const Kernel::Point_3& p = theirs.point(vertex);
        b.insert({p.x(), p.y(), p.z()});
    }
    return a == b;
}

bool run(const std::string& path, int rounds) {
    const auto soup = import::import_file(path);
    if (!soup) stop(soup.error().message);
    const Points& points = soup.value().positions;
    std::vector<double> ours, cull, qhull, cgal, ratio;
    ConvexHull hull;
    CGAL::Surface_mesh<Kernel::Point_3> theirs;
    std::size_t kept = 0, of_qhull = 0;
    for (int round = 0; round < rounds; ++round) {
        ours.push_back(milliseconds([&] { hull = convex_hull(points); }));
        qhull.push_back(milliseconds([&] { of_qhull = ask_qhull(points); }));
        cull.push_back(milliseconds([&] { kept = cull_inside(points, serial_for).size(); }));
        cgal.push_back(milliseconds([&] { theirs = ask_cgal(points); }));
        ratio.push_back(qhull.back() / ours.back());
    }
    const std::string name = path.substr(path.find_last_of('/') + 1);
    const bool same = same_corners(hull, theirs);
    std::printf("%s,%zu,%zu,%zu,%zu,%s,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f\n", name.c_str(),
                points.size(), kept, hull.points.size(), of_qhull, same ? "yes" : "no",
                median(ours), spread(ours), median(cull), median(qhull), spread(qhull),
                median(cgal), median(ratio));
    return same;
}

int run_all(int rounds, const std::vector<std::string>& paths) {
    std::printf(
        "mesh,points,not_culled,corners,qhull_corners,same_corners_as_cgal,ms,ms_spread,"
        "of_it_cull_ms,qhull_ms,qhull_ms_spread,cgal_ms,times_faster_than_qhull\n");
    bool all_same = true;
    for (const std::string& path : paths) all_same = run(path, rounds) && all_same;
    return all_same ? 0 : 1;
}

}  // namespace
}  // namespace cdprep::convex

int main(int argc, char** argv) {
    if (argc < 3) cdprep::stop("Usage: hull_bench ROUNDS MESH...");
    return cdprep::convex::run_all(std::atoi(argv[1]), {argv + 2, argv + argc});
}
