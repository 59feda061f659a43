// SPDX-License-Identifier: MIT
// Cuts surfaces into convex pieces: seconds, bytes and pieces, the columns of Table 3 of the
// paper on SWIFT++, and beside them SWIFT++'s own figures where it accepts the model (its
// fewest pieces of three orders, its seconds of the cresting one, another machine's run).
// Bytes are those of the four sections that a bake keeps. Medians of
// five runs, of the growing orders one run.
// Usage: surface_pieces_bench [--threads N] [--tolerance T] FOLDER [MODEL...]
//   FOLDER: with skull.ply, bunny.ply and so on; T in parts of the diagonal.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "bench_input.h"
#include "cli/program_threads.h"
#include "decompose/surface/piece_arrays.h"
#include "import/import_file.h"
#include "mesh/normalize.h"
#include "mesh/weld.h"

namespace {

namespace convex = cdprep::convex;
using Clock = std::chrono::steady_clock;

struct Peer {
    const char* model;
    std::size_t pieces;
    double seconds;
};
constexpr std::array<Peer, 6> kPeers = {{{"horse", 0, 0},
                                         {"skull", 11300, 0.90},
                                         {"bunny", 16537, 1.69},
                                         {"armadillo", 25997, 2.49},
                                         {"buddha", 34361, 2.46},
                                         {"dragon", 0, 0}}};
constexpr std::array<const char*, 4> kOrders = {"greedy", "depth-first", "breadth-first",
                                                "cresting"};

cdprep::mesh::Mesh load(const std::filesystem::path& path) {
    auto imported = cdprep::import::import_file(path);
    if (!imported) cdprep::stop(imported.error().message);
    cdprep::mesh::TriangleSoup soup = std::move(imported).value();
    cdprep::mesh::normalize(soup);
    return cdprep::mesh::weld(soup).mesh;
}

std::size_t bytes_of(const convex::PieceArrays& arrays) {
    return arrays.pieces.size() * sizeof arrays.pieces[0] +
           (arrays.triangles.size() + arrays.vertices.size()) * sizeof(std::uint32_t) +
           arrays.facets.size() * sizeof arrays.facets[0];
}

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

void run(const cdprep::mesh::Mesh& mesh, const Peer& peer, convex::PieceOrder order,
         double tolerance, cdprep::ParallelFor parallel_for) {
    const int runs = order == convex::PieceOrder::greedy ? 5 : 1;
    std::vector<double> cut, hulls;
    convex::SurfacePieces pieces;
    std::size_t bytes = 0;
    for (int i = 0; i < runs; ++i) {
        Clock::time_point begin = Clock::now();
        pieces = convex::find_surface_pieces(
            mesh, {.order = order, .tolerance = tolerance, .parallel_for = parallel_for});
        cut.push_back(seconds_since(begin));
        begin = Clock::now();
        bytes = bytes_of(convex::make_piece_arrays(mesh, pieces, parallel_for));
        hulls.push_back(seconds_since(begin));
    }
    const auto contained =
        std::count_if(pieces.pieces.begin(), pieces.pieces.end(),
                      [](const convex::SurfacePiece& piece) { return piece.contained; });
    double error = 0;
    for (const convex::SurfacePiece& piece : pieces.pieces) {
        error = std::max(error, piece.outer_error);
    }
    const std::size_t count = pieces.pieces.size();
    std::printf("%s,%s,%g,%zu,%zu,%.4f,%td,%.3g,%.3f,%.3f,%.3f,%zu,%.1f,", peer.model,
                kOrders[static_cast<std::size_t>(order)], tolerance, mesh.triangles.size(), count,
                static_cast<double>(count) / static_cast<double>(mesh.triangles.size()), contained,
                error, cdprep::median(cut), cdprep::spread(cut), cdprep::median(hulls), bytes,
                static_cast<double>(bytes) / static_cast<double>(mesh.triangles.size()));
    if (peer.pieces == 0) {
        std::printf("refused,\n");
    } else {
        std::printf("%zu,%.2f\n", peer.pieces, peer.seconds);
    }
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    std::size_t threads = 0;
    double tolerance = 0;
    const auto option = [&](const std::string& name) -> std::string {
        const auto at = std::find(words.begin(), words.end(), name);
        if (at == words.end() || at + 1 == words.end()) return "0";
        const std::string value = at[1];
        words.erase(at, at + 2);
        return value;
    };
    threads = std::stoul(option("--threads"));
    tolerance = std::stod(option("--tolerance"));
    if (words.empty())
        cdprep::stop("surface_pieces_bench [--threads N] [--tolerance T] FOLDER [MODEL...]");
    const cdprep::cli::Threads pool(threads);
    std::printf(
        "model,order,tolerance,triangles,pieces,pieces_per_triangle,contained,outer_error,"
        "seconds,spread,hull_seconds,bytes,bytes_per_triangle,swift_pieces,swift_seconds\n");
    for (const Peer& peer : kPeers) {
        const bool chosen = words.size() == 1 ||
                            std::find(words.begin() + 1, words.end(), peer.model) != words.end();
        if (!chosen) continue;
        const cdprep::mesh::Mesh mesh =
            load(std::filesystem::path(words[0]) / (std::string(peer.model) + ".ply"));
        for (std::size_t order = 0; order < kOrders.size(); ++order) {
            // Growing takes its time on the largest, and a tolerance is for merging.
            constexpr std::size_t kMostGrown = 200000;
            if (order > 0 && (mesh.triangles.size() > kMostGrown || tolerance > 0)) continue;
            run(mesh, peer, static_cast<convex::PieceOrder>(order), tolerance, pool.parallel_for());
        }
    }
    return 0;
}
