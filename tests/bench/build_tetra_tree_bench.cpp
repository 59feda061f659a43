// SPDX-License-Identifier: MIT
// How fast tetra-trees are built, and what they are like.
//
// Usage: build_tetra_tree_bench BAKES [ROUNDS]
// BAKES holds NAME.cdp.h5: their triangles, in tree order, as a bake hands them over. Every
// setting and number of threads takes its turn, ROUNDS times (5), and the octree of `paper`
// settings beside them, without the tables that find cells; times are medians, with the
// spread of the middle half of the rounds. Prints two CSV tables: seconds, and figures,
// beside those that were published for `paper` settings: 512 leaf cones.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "bench_input.h"
#include "cdprep/cells/build_octree.h"
#include "cdprep/cells/tetra_figures.h"
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
constexpr Setting kOctree = {"paper octree", 3, 1};

/// What Table 2 prints.
struct Published {
    const char* model;
    double seconds;
    double mebibytes;
};
constexpr std::array<Published, 6> kPublished = {{{"horse", 0.427, 0.0351},
                                                  {"skull", 2.49, 0.2608},
                                                  {"bunny", 4.544, 0.4211},
                                                  {"armadillo", 28.184, 2.0322},
                                                  {"dragon", 70.25, 4.8031},
                                                  {"buddha", 84.704, 5.5607}}};

/// One way of building, and how long it took each time.
struct Way {
    Setting setting;
    std::size_t threads;
    std::unique_ptr<Crew> crew;
    std::vector<double> seconds = {};
};

std::size_t build(const test::BuilderInput& input, Way& way) {
    if (way.setting.name == kOctree.name) {
        return build::build_octree(input.positions, input.triangles,
                                   {.parallel_for = *way.crew,
                                    .level = way.setting.level,
                                    .threshold = way.setting.threshold,
                                    .hashed = false})
            .nodes.size();
    }
    return build::build_tetra_tree(input.positions, input.triangles,
                                   {.parallel_for = *way.crew,
                                    .level = way.setting.level,
                                    .threshold = way.setting.threshold})
        .nodes.size();
}

double time_build(const test::BuilderInput& input, Way& way) {
    const Clock::time_point begun = Clock::now();
    const std::size_t nodes = build(input, way);
    const double seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    if (nodes == 0) stop("There is nothing to build over.");
    return seconds;
}

void time_builds(const std::string& name, const test::BuilderInput& input, int rounds) {
    std::vector<Way> ways;
    const auto add = [&](const Setting& setting) {
        for (const std::size_t threads : {1U, 2U, 4U}) {
            ways.push_back({setting, threads, std::make_unique<Crew>(threads)});
        }
    };
    for (const Setting& setting : kSettings) add(setting);
    add(kOctree);
    for (int round = -1; round < rounds; ++round) {  // the first warms up
        for (Way& way : ways) {
            const double seconds = time_build(input, way);
            if (round >= 0) way.seconds.push_back(seconds);
        }
    }
    for (std::size_t i = 0; i < ways.size(); ++i) {
        const Way& way = ways[i];
        const double seconds = median(way.seconds);
        std::printf("%s,%zu,%s,%u,%u,%zu,%.2f,%.2f,%.2f,%.2f\n", name.c_str(),
                    input.triangles.size(), way.setting.name, way.setting.level,
                    way.setting.threshold, way.threads, 1e3 * seconds, 1e3 * spread(way.seconds),
                    1e-6 * static_cast<double>(input.triangles.size()) / seconds,
                    median(ways[i - i % 3].seconds) / seconds);
    }
    std::fflush(stdout);
}

void print_figures(const Published& published, const test::BuilderInput& input) {
    for (const Setting& setting : kSettings) {
        const build::TetraTree tree =
            build::build_tetra_tree(input.positions, input.triangles,
                                    {.level = setting.level, .threshold = setting.threshold});
        const TetraFigures figures = tetra_figures(tree, input.positions, input.triangles);
        const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
        const auto mebibytes = [](std::uint64_t bytes) {
            return static_cast<double>(bytes) / (1 << 20);
        };
        const auto per_triangle = [&](std::uint64_t n) {
            return static_cast<double>(n) / static_cast<double>(input.triangles.size());
        };
        std::printf("%s,%zu,%s,%u,%u,%llu,%llu,%llu,%.4f,%.4f,%.6f,%llu,%.2f,%llu,%s,%.4f,%.4f",
                    published.model, input.triangles.size(), setting.name, setting.level,
                    setting.threshold, number(figures.nodes), number(figures.leaves),
                    number(figures.empty_cones), per_triangle(figures.references),
                    per_triangle(figures.shared), per_triangle(figures.in_many),
                    number(figures.largest_leaf), figures.mean_layers, number(figures.most_layers),
                    figures.centre_inside ? "yes" : "no", mebibytes(seed_formula_bytes(figures)),
                    mebibytes(figures.bytes));
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
        "million_triangles_per_s,times_one_thread\n");
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        time_builds(kPublished[i].model, inputs[i], rounds);
    }
    std::printf(
        "\nmodel,triangles,setting,level,threshold,nodes,leaves,empty_cones,"
        "references_per_triangle,shared_per_triangle,in_many_per_triangle,largest_leaf,"
        "mean_layers,most_layers,centre_inside,seed_formula_mib,real_mib,published_mib,"
        "published_s\n");
    for (std::size_t i = 0; i < inputs.size(); ++i) print_figures(kPublished[i], inputs[i]);
    return 0;
}
