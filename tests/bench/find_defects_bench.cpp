// SPDX-License-Identifier: MIT
// What finding defects takes, stage by stage, on one thread: the median of ROUNDS, and the
// spread of their middle half. The stages are those of find_defects(), asked one by one;
// `all but crossings` and `all` are find_defects() as a whole.
//
// Usage: find_defects_bench ROUNDS MESH...
//
// Prints a CSV table; times are milliseconds.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "bench_input.h"
#include "import/import_file.h"
#include "validate/defects/boundary.h"
#include "validate/defects/edge_flaws.h"
#include "validate/defects/find_defects.h"
#include "validate/defects/sound_mesh.h"
#include "validate/defects/surface_measures.h"

namespace cdprep::mesh {
namespace {

/// Milliseconds by stage, in the order in which they ran first.
class Times {
public:
    template <class Stage>
    auto take(const std::string& stage, Stage&& run) {
        const auto begun = std::chrono::steady_clock::now();
        auto result = run();
        const std::chrono::duration<double, std::milli> taken =
            std::chrono::steady_clock::now() - begun;
        if (!times_.contains(stage)) order_.push_back(stage);
        times_[stage].push_back(taken.count());
        return result;
    }

    void print(const std::string& mesh) const {
        for (const std::string& stage : order_) {
            const std::vector<double>& times = times_.at(stage);
            std::printf("%s,%s,%.2f,%.2f\n", mesh.c_str(), stage.c_str(), median(times),
                        median(times, 0.75) - median(times, 0.25));
        }
    }

private:
    std::vector<std::string> order_;
    std::map<std::string, std::vector<double>> times_;
};

void run_stages(const TriangleSoup& soup, Times& times) {
    FindingList findings(DefectOptions{}.max_places);
    DefectCounts counts;
    const SoundMesh sound =
        times.take("join and sieve", [&] { return find_sound_mesh(soup, findings, counts); });
    const ComponentNumbers components =
        times.take("components", [&] { return number_components(sound.mesh); });
    const Stars stars = times.take("stars", [&] { return collect_stars(sound.mesh); });
    EdgeFlaws flaws = times.take("edges and fans", [&] { return find_edge_flaws(stars); });
    times.take("boundary", [&] {
        const Boundary boundary = find_boundary(sound.mesh, std::move(flaws.boundary));
        list_boundary(soup, sound, boundary, findings);
        find_t_junctions(soup, sound, boundary, {}, findings, counts);
        return boundary.edge.size();
    });
    times.take("areas and volumes", [&] {
        return measure_surface(sound, components, std::vector<bool>(components.count, false),
                               findings, counts);
    });
}

void run(const std::string& path, int rounds) {
    const auto soup = import::import_file(path);
    if (!soup) stop(soup.error().message);
    Times times;
    for (int round = 0; round < rounds; ++round) {
        run_stages(soup.value(), times);
        times.take("all but crossings",
                   [&] { return find_defects(soup.value(), {.crossings = false}); });
        times.take("all", [&] { return find_defects(soup.value()); });
    }
    times.print(path.substr(path.rfind('/') + 1));
}

}  // namespace
}  // namespace cdprep::mesh

int main(int count, char** arguments) {
    if (count < 3) {
        std::fprintf(stderr, "usage: %s ROUNDS MESH...\n", arguments[0]);
        return 2;
    }
    std::printf("mesh,stage,median_ms,spread_ms\n");
    for (int i = 2; i < count; ++i) {
        cdprep::mesh::run(arguments[i], std::max(1, std::atoi(arguments[1])));
    }
}
