// SPDX-License-Identifier: MIT
// Encloses meshes in as many convex parts as CoACD makes of them at its threshold of 0.05,
// and prints by how much they stick out: bounds, in per cent of the diagonal.
// Usage: approximate_parts_bench [--threads N | --modelled N] {[--to-surface] FILE PARTS}...
// --modelled takes one thread, and its processor time; for each set of tasks, what N threads
// would take that each begin the next task when they are free. For machines with other work.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <vector>

#include "cli/program_threads.h"
#include "decompose/enclose/approximate_parts.h"
#include "import/import_file.h"
#include "mesh/point_tree.h"
#include "mesh/weld.h"

namespace {

using namespace cdprep;
using Clock = std::chrono::steady_clock;

double processor_seconds() {
    return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

/// Runs tasks here, and adds up what more threads would have saved.
class Modelled {
public:
    explicit Modelled(std::size_t threads) : threads_(threads) {}

    /// Tasks that hand out tasks themselves are taken to find threads for them.
    void operator()(std::size_t count, Task task) {
        std::vector<double> busy(threads_, 0);
        double longest = 0;
        const double saved_before = std::exchange(saved_, 0);
        bool hands_out = false;
        const double begin = processor_seconds();
        for (std::size_t i = 0; i < count; ++i) {
            const double before = processor_seconds();
            task(i);
            const double took = processor_seconds() - before;
            *std::min_element(busy.begin(), busy.end()) += took;
            hands_out = hands_out || saved_ > 0;
            longest = std::max(longest, took - std::exchange(saved_, 0));
        }
        const double all = processor_seconds() - begin;
        const double shared = all / static_cast<double>(threads_);
        const double needed =
            hands_out ? std::max(shared, longest) : *std::max_element(busy.begin(), busy.end());
        saved_ = saved_before + all - needed;
    }
    [[nodiscard]] double take_saved() {
        return std::exchange(saved_, 0);
    }

private:
    std::size_t threads_;
    double saved_ = 0;
};

void measure(const char* path, std::size_t parts, bool to_surface, const cli::Threads& threads,
             Modelled* modelled) {
    const auto soup = import::import_file(path, {});
    if (!soup) {
        std::fprintf(stderr, "%s\n", soup.error().message.c_str());
        std::exit(2);
    }
    const mesh::Mesh mesh = mesh::weld(soup.value()).mesh;
    mesh::Box box;
    for (const mesh::Double3& p : mesh.positions) box.add(p);
    convex::ApproximateOptions options;
    options.max_parts = parts;
    options.reference = to_surface ? convex::Reference::surface : convex::Reference::solid;
    options.parallel_for = modelled != nullptr ? ParallelFor(*modelled) : threads.parallel_for();
    const Clock::time_point begin = Clock::now();
    const double processor_begin = processor_seconds();
    const convex::ApproximateParts found = convex::find_approximate_parts(mesh, options);
    const double used = processor_seconds() - processor_begin;
    const double seconds = modelled != nullptr
                               ? used - modelled->take_saved()
                               : std::chrono::duration<double>(Clock::now() - begin).count();
    std::printf("%s,%zu,%zu,%zu,%.3f,%.3f,%.2f,%.2f,%d\n", path, mesh.triangles.size(), parts,
                found.parts.size(), 100 * found.outer_lower / box.diagonal(),
                100 * found.outer_error / box.diagonal(), seconds, used,
                found.ran_out_of_work ? 1 : 0);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    std::size_t count = 0;
    std::unique_ptr<Modelled> modelled;
    bool to_surface = false;
    std::printf(
        "mesh,triangles,parts_allowed,parts,least_percent,most_percent,seconds,"
        "processor_seconds,out_of_work\n");
    for (int i = 1; i + 1 < argc; ++i) {
        if (std::strcmp(argv[i], "--to-surface") == 0) {
            to_surface = true;
        } else if (std::strcmp(argv[i], "--threads") == 0) {
            count = std::strtoul(argv[++i], nullptr, 10);
        } else if (std::strcmp(argv[i], "--modelled") == 0) {
            modelled = std::make_unique<Modelled>(std::strtoul(argv[++i], nullptr, 10));
        } else {
            const cli::Threads threads(modelled ? 1 : count);
            measure(argv[i], std::strtoul(argv[i + 1], nullptr, 10), to_surface, threads,
                    modelled.get());
            to_surface = false;
            ++i;
        }
    }
    return 0;
}
