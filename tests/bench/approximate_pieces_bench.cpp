// SPDX-License-Identifier: MIT
// Encloses meshes in as many convex pieces as CoACD makes of them at its threshold of 0.05,
// and prints by how much they stick out: bounds, in per cent of the diagonal.
// Usage: approximate_pieces_bench [--threads N] {[--to-surface] FILE PARTS}...
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "cdprep/parallel.h"
#include "convex/approximate_pieces.h"
#include "import/import_file.h"
#include "mesh/point_tree.h"
#include "mesh/weld.h"

namespace {

using namespace cdprep;
using Clock = std::chrono::steady_clock;

void measure(const char* path, std::size_t parts, bool to_surface, const cli::Threads& threads) {
    const auto soup = import::import_file(path, {});
    if (!soup) {
        std::fprintf(stderr, "%s\n", soup.error().message.c_str());
        std::exit(2);
    }
    const mesh::Mesh mesh = mesh::weld(soup.value()).mesh;
    mesh::Box box;
    for (const mesh::Double3& p : mesh.positions) box.add(p);
    convex::ApproximateOptions options;
    options.parts = parts;
    options.reference = to_surface ? convex::Reference::surface : convex::Reference::solid;
    options.parallel_for = threads.parallel_for();
    const Clock::time_point begin = Clock::now();
    const convex::ApproximatePieces found = convex::find_approximate_pieces(mesh, options);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    std::printf("%s,%zu,%zu,%zu,%.3f,%.3f,%.2f,%d\n", path, mesh.triangles.size(), parts,
                found.pieces.size(), 100 * found.outer_lower / box.diagonal(),
                100 * found.outer_error / box.diagonal(), seconds, found.ran_out_of_work ? 1 : 0);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    std::size_t count = 0;
    bool to_surface = false;
    std::printf(
        "mesh,triangles,parts_allowed,parts,least_percent,most_percent,seconds,out_of_work\n");
    for (int i = 1; i + 1 < argc; ++i) {
        if (std::strcmp(argv[i], "--to-surface") == 0) {
            to_surface = true;
        } else if (std::strcmp(argv[i], "--threads") == 0) {
            count = std::strtoul(argv[++i], nullptr, 10);
        } else {
            const cli::Threads threads(count);
            measure(argv[i], std::strtoul(argv[i + 1], nullptr, 10), to_surface, threads);
            to_surface = false;
            ++i;
        }
    }
    return 0;
}
