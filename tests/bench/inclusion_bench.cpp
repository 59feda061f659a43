// SPDX-License-Identifier: MIT
// How long a question takes whether a point is inside, through each structure. Prints a
// CSV table of nanoseconds a point, median and quartiles of rounds that take turns, and
// how many triangles are looked at.
//
// The structures are built over the file's triangles, all of one level and threshold.
//
// Usage: inclusion_bench FILE... [-l LEVEL] [-t THRESHOLD] [-r ROUNDS]
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "bench_input.h"
#include "support/every_structure.h"

#include "cdprep/advanced/query_counts.h"
#include "cdprep/cells.h"
#include "cdprep/points.h"

namespace cdprep {
namespace {

using Points = std::vector<format::Double3>;

constexpr std::size_t kPoints = 10'000;

/// In the model's box.
Points uniform_points(const test::BuilderInput& model) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> part(0, 1);
    format::Double3 lower = model.positions.front(), upper = lower;
    for (const format::Double3& p : model.positions) {
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    }
    Points points;
    for (std::size_t i = 0; i < kPoints; ++i) {
        const double x = part(random), y = part(random), z = part(random);
        points.push_back({lower.x + x * (upper.x - lower.x), lower.y + y * (upper.y - lower.y),
                          lower.z + z * (upper.z - lower.z)});
    }
    return points;
}

/// On triangles, up to rounding.
Points surface_points(const test::BuilderInput& model) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> part(0, 1);
    Points points;
    for (std::size_t i = 0; i < kPoints; ++i) {
        const format::Triangle& t = model.triangles[random() % model.triangles.size()];
        const format::Double3 &a = model.positions[t.vertex[0]], &b = model.positions[t.vertex[1]],
                              &c = model.positions[t.vertex[2]];
        const double u = part(random), v = (1 - u) * part(random);
        points.push_back({a.x + u * (b.x - a.x) + v * (c.x - a.x),
                          a.y + u * (b.y - a.y) + v * (c.y - a.y),
                          a.z + u * (b.z - a.z) + v * (c.z - a.z)});
    }
    return points;
}

/// Nanoseconds a point; what was found is added to `inside`, so that it is not skipped.
double timed(Structure structure, const Model& model, const Points& points, Workspace& workspace,
             std::size_t& inside) {
    const auto begun = std::chrono::steady_clock::now();
    for (const format::Double3& p : points) {
        const Inclusion found = points_inside(model, p, workspace, structure);
        inside += found.answer == Answer::yes ? 1 : 0;
    }
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - begun;
    return taken.count() / static_cast<double>(points.size());
}

void measure(const std::string& name, const Model& model, const Points& points, int rounds) {
    Workspace workspace(cells());
    std::array<std::vector<double>, test::kStructures.size()> ns;
    std::array<QueryCounts, test::kStructures.size()> counts;
    std::array<std::size_t, test::kStructures.size()> inside{};
    for (std::size_t s = 0; s < ns.size(); ++s) {
        workspace.count_into(&counts[s]);
        (void)timed(test::kStructures[s], model, points, workspace, inside[s]);
    }
    workspace.count_into(nullptr);
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t s = 0; s < ns.size(); ++s) {
            ns[s].push_back(timed(test::kStructures[s], model, points, workspace, inside[s]));
        }
    }
    for (std::size_t s = 0; s < ns.size(); ++s) {
        if (inside[s] != inside[0]) stop(name + ": the structures differ.");
        std::printf(
            "%s/%s,%.0f,%.0f,%.1f,%zu\n", name.c_str(), test::name_of(test::kStructures[s]).c_str(),
            median(ns[s]), spread(ns[s]),
            static_cast<double>(counts[s].ray_triangles) / static_cast<double>(points.size()),
            points.size());
    }
}

void measure_file(const char* path, const test::Division& division, int rounds) {
    std::ifstream in(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    if (bytes.empty()) stop(std::string(path) + " cannot be read.");
    const test::AlignedBytes file(std::as_bytes(std::span(bytes)));
    const test::OpenModel open = test::open_tiny(test::with_every_structure(file, division));
    if (!open.model.is_balanced()) stop(std::string(path) + " is unbalanced: nothing is inside.");
    const test::BuilderInput input = test::builder_input(open.model);
    const std::string stem = std::filesystem::path(path).stem().stem().string();
    measure("inclusion/uniform/" + stem, open.model, uniform_points(input), rounds);
    measure("inclusion/on_surface/" + stem, open.model, surface_points(input), rounds);
}

}  // namespace
}  // namespace cdprep

int main(int argc, char** argv) {
    std::vector<const char*> files;
    cdprep::test::Division division = {.level = 5, .threshold = 16};
    int rounds = 9;
    for (int i = 1; i < argc; ++i) {
        const bool has_value = i + 1 < argc;
        if (has_value && std::strcmp(argv[i], "-l") == 0) {
            division.level = static_cast<std::uint32_t>(std::atoi(argv[++i]));
        } else if (has_value && std::strcmp(argv[i], "-t") == 0) {
            division.threshold = static_cast<std::uint32_t>(std::atoi(argv[++i]));
        } else if (has_value && std::strcmp(argv[i], "-r") == 0) {
            rounds = std::atoi(argv[++i]);
        } else {
            files.push_back(argv[i]);
        }
    }
    if (files.empty() || rounds < 1) {
        std::fprintf(stderr,
                     "Usage: inclusion_bench FILE... [-l LEVEL] [-t THRESHOLD] "
                     "[-r ROUNDS]\n");
        return 2;
    }
    std::printf("question,ns_median,ns_spread,triangles,points\n");
    for (const char* file : files) cdprep::measure_file(file, division, rounds);
}
