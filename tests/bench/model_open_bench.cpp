// SPDX-License-Identifier: MIT
// How long a baked file takes to open, warm: with the full check, with the check
// of what a collision needs, and trusted. Prints a CSV table of medians and
// quartiles in microseconds, and the full check's rate in bytes of file size.
//
// Usage: model_open_bench FILE... [-r ROUNDS]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <vector>

#include "cdprep/model.h"

namespace cdprep {
namespace {

/// What a model with exact leaves needs; bytes and GB/s are of the whole file.
constexpr SectionSet kCollide = {SectionId::bvh_nodes, SectionId::bvh_leaves,
                                 SectionId::oriented_nodes, SectionId::degenerate_bits};

struct Way {
    const char* name;
    std::function<Result<Model>(const char*)> open;
};

const std::vector<Way>& ways() {
    static const std::vector<Way> all = {
        {"model_open/all_sections", [](const char* path) { return Model::open(path); }},
        {"model_open/collide", [](const char* path) { return Model::open(path, kCollide); }},
        {"model_open/trusted", [](const char* path) { return Model::open_trusted(path); }},
    };
    return all;
}

/// Microseconds of one opening and closing; the file's size goes to `bytes`.
double timed(const Way& way, const char* path, double& bytes) {
    const auto begun = std::chrono::steady_clock::now();
    {
        const Result<Model> opened = way.open(path);
        if (!opened) {
            std::fprintf(stderr, "%s\n", opened.error().message.c_str());
            std::exit(3);
        }
        bytes = static_cast<double>(opened.value().header().file_size);
    }
    const std::chrono::duration<double, std::micro> taken =
        std::chrono::steady_clock::now() - begun;
    return taken.count();
}

void measure(const char* path, int rounds) {
    std::vector<std::vector<double>> us(ways().size());
    double bytes = 0;
    for (int round = 0; round < rounds; ++round) {  // the ways take turns
        for (std::size_t i = 0; i < us.size(); ++i) us[i].push_back(timed(ways()[i], path, bytes));
    }
    for (std::size_t i = 0; i < us.size(); ++i) {
        std::sort(us[i].begin(), us[i].end());
        const auto quantile = [&](double share) {
            return us[i][static_cast<std::size_t>(share * static_cast<double>(us[i].size() - 1))];
        };
        std::printf("%s,%s,%.0f,%d,%.1f,%.1f,%.1f,%.3f\n", ways()[i].name, path, bytes, rounds,
                    quantile(0.5), quantile(0.25), quantile(0.75), bytes / quantile(0.5) / 1e3);
    }
}

}  // namespace
}  // namespace cdprep

int main(int argc, char** argv) {
    int rounds = 50;
    std::vector<const char*> files;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "-r") == 0 && i + 1 < argc) {
            rounds = std::max(1, std::atoi(argv[++i]));
        } else {
            files.push_back(argv[i]);
        }
    }
    if (files.empty()) {
        std::fprintf(stderr, "Usage: model_open_bench FILE... [-r ROUNDS]\n");
        return 2;
    }
    std::printf("benchmark,file,bytes,rounds,median_us,quartile_1_us,quartile_3_us,GB_per_s\n");
    for (const char* file : files) cdprep::measure(file, rounds);
    return 0;
}
