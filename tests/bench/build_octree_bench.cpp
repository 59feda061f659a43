// SPDX-License-Identifier: MIT
// How fast octrees are built, and what they are like.
//
// Usage: build_octree_bench BAKES [ROUNDS]
// BAKES holds NAME.cdp.h5: their triangles, in tree order, as a bake hands them over. Every
// setting and number of threads takes its turn, ROUNDS times (5); times are medians, with
// the spread of the middle half of the rounds. Processor time, and what of it is spent
// outside of what threads share, tell the same on a machine where others take a part. Prints
// two CSV tables: times, tables for finding cells included, and figures, beside those that were
// published for `paper` settings: 512 leaf cells. Of the dragon's bytes it is known that they
// cannot be right: there are more references than that.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>

#include "bench_input.h"
#include "cdprep/cells/build_octree.h"
#include "cdprep/cells/octree_figures.h"
#include "crew.h"
#include "support/more_sections.h"

namespace cdprep {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Setting {
    const char* name;
    std::uint32_t level;
    std::uint32_t threshold;
};
constexpr std::array<Setting, 4> kSettings = {
    {{"paper", 3, 1}, {"middle", 5, 32}, {"fine", 7, 16}, {"finest", 9, 8}}};

/// What Table 2 prints.
struct Published {
    const char* model;
    double seconds;
    double mebibytes;
};
constexpr std::array<Published, 6> kPublished = {{{"horse", 0.496, 0.0399},
                                                  {"skull", 4.329, 0.261},
                                                  {"bunny", 8.744, 0.3254},
                                                  {"armadillo", 44.579, 1.6549},
                                                  {"dragon", 104.68, 2.1975},
                                                  {"buddha", 138.542, 4.8717}}};
constexpr double kMebibyte = 1 << 20;

/// Processor time of the whole program, seconds: other programs do not count.
double processor_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// A crew, and the processor time that was spent in what it was given.
struct TimedCrew {
    explicit TimedCrew(std::size_t threads) : crew(threads) {}
    void operator()(std::size_t count, Task task) {
        const double begun = processor_seconds();
        crew(count, task);
        seconds += processor_seconds() - begun;
    }

    Crew crew;
    double seconds = 0;
};

/// One way of building, and how long it took each time.
struct Way {
    Setting setting;
    std::size_t threads;
    std::unique_ptr<TimedCrew> crew;
    std::vector<double> seconds = {};
    std::vector<double> processor = {};
    std::vector<double> alone = {};  ///< processor time of what is not shared out
};

void build_once(const test::BuilderInput& input, Way& way) {
    way.crew->seconds = 0;
    const double processor = processor_seconds();
    const Clock::time_point begun = Clock::now();
    const build::Octree octree = build::build_octree(input.positions, input.triangles,
                                                     {.parallel_for = *way.crew,
                                                      .level = way.setting.level,
                                                      .threshold = way.setting.threshold});
    way.seconds.push_back(std::chrono::duration<double>(Clock::now() - begun).count());
    way.processor.push_back(processor_seconds() - processor);
    way.alone.push_back(way.processor.back() - way.crew->seconds);
    if (octree.nodes.empty()) stop("There is nothing to build over.");
}

void time_builds(const std::string& name, const test::BuilderInput& input, int rounds) {
    std::vector<Way> ways;
    for (const Setting& setting : kSettings) {
        for (const std::size_t threads : {1U, 2U, 4U}) {
            ways.push_back({setting, threads, std::make_unique<TimedCrew>(threads)});
        }
    }
    for (int round = 0; round < rounds; ++round) {
        for (Way& way : ways) build_once(input, way);
    }
    for (std::size_t i = 0; i < ways.size(); ++i) {
        const Way& way = ways[i];
        const double seconds = median(way.seconds);
        std::printf("%s,%zu,%s,%u,%u,%zu,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f\n", name.c_str(),
                    input.triangles.size(), way.setting.name, way.setting.level,
                    way.setting.threshold, way.threads, 1e3 * seconds, 1e3 * spread(way.seconds),
                    1e-6 * static_cast<double>(input.triangles.size()) / seconds,
                    median(ways[i - i % 3].seconds) / seconds, 1e3 * median(way.processor),
                    1e3 * median(way.alone));
    }
    std::fflush(stdout);
}

void print_figures(const Published& published, const test::BuilderInput& input) {
    for (const Setting& setting : kSettings) {
        const build::Octree octree =
            build::build_octree(input.positions, input.triangles,
                                {.level = setting.level, .threshold = setting.threshold});
        const OctreeFigures figures = octree_figures(octree, input.triangles.size());
        const auto mebibytes = [](std::uint64_t bytes) {
            return static_cast<double>(bytes) / kMebibyte;
        };
        std::printf(
            "%s,%zu,%s,%u,%u,%llu,%llu,%llu,%.4f,%.4f,%llu,%.4f,%.4f,%.4f,%.4f", published.model,
            input.triangles.size(), setting.name, setting.level, setting.threshold,
            static_cast<unsigned long long>(figures.nodes),
            static_cast<unsigned long long>(figures.leaves),
            static_cast<unsigned long long>(figures.empty_children),
            static_cast<double>(figures.references) / static_cast<double>(input.triangles.size()),
            static_cast<double>(figures.shared) / static_cast<double>(input.triangles.size()),
            static_cast<unsigned long long>(figures.largest_leaf),
            mebibytes(seed_formula_bytes(figures, EmptyChildren::counted)),
            mebibytes(seed_formula_bytes(figures, EmptyChildren::left_out)),
            mebibytes(figures.bytes), mebibytes(figures.table_bytes));
        if (&setting == kSettings.data()) {
            std::printf(",%.4f,%.3f\n", published.mebibytes, published.seconds);
        } else {
            std::printf(",,\n");
        }
    }
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    using namespace cdprep;
    if (count < 2) {
        std::fprintf(stderr, "usage: %s BAKES [ROUNDS]\n", arguments[0]);
        return 2;
    }
    const int rounds = count > 2 ? std::max(1, std::atoi(arguments[2])) : 5;
    std::vector<test::BuilderInput> inputs;
    for (const Published& published : kPublished) {
        const fs::path path = fs::path(arguments[1]) / (std::string(published.model) + ".cdp.h5");
        inputs.push_back(test::builder_input(open_or_stop(path)));
    }
    std::printf(
        "model,triangles,setting,level,threshold,threads,median_ms,spread_ms,"
        "million_triangles_per_s,times_one_thread,processor_ms,of_it_alone_ms\n");
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        time_builds(kPublished[i].model, inputs[i], rounds);
    }
    std::printf(
        "\nmodel,triangles,setting,level,threshold,nodes,leaves,empty_children,"
        "references_per_triangle,shared_per_triangle,largest_leaf,seed_formula_mib,"
        "seed_formula_mib_without_empty,real_mib,of_it_tables_mib,published_mib,published_s\n");
    for (std::size_t i = 0; i < inputs.size(); ++i) print_figures(kPublished[i], inputs[i]);
    return 0;
}
