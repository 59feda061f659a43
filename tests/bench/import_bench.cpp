// SPDX-License-Identifier: MIT
// How fast mesh files become soups: a wavy grid of 1.1 million triangles in every
// format of our own readers, and as GLB, on 1 and on 4 threads. bytes_per_second
// is of the file. The files are made in a temporary folder and removed.
#include <benchmark/benchmark.h>
#include <stdlib.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "import/import_file.h"

namespace cdprep::import {
namespace {

constexpr std::uint32_t kSide = 746;  // vertices; 2 * 745 * 745 triangles

struct Grid {
    std::vector<std::array<float, 3>> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

Grid make_grid() {
    Grid grid;
    for (std::uint32_t i = 0; i < kSide; ++i) {
        for (std::uint32_t j = 0; j < kSide; ++j) {
            const auto x = static_cast<float>(i) / kSide - 0.5f;
            const auto y = static_cast<float>(j) / kSide - 0.5f;
            grid.points.push_back({x, y, 0.1f * std::sin(40 * x) * std::cos(30 * y)});
        }
    }
    for (std::uint32_t i = 0; i + 1 < kSide; ++i) {
        for (std::uint32_t j = 0; j + 1 < kSide; ++j) {
            const std::uint32_t a = i * kSide + j;
            grid.triangles.push_back({a, a + kSide, a + 1});
            grid.triangles.push_back({a + 1, a + kSide, a + kSide + 1});
        }
    }
    return grid;
}

template <class... Values>
void print(std::string& text, const char* format, Values... values) {
    std::array<char, 256> line{};
    const int length = std::snprintf(line.data(), line.size(), format, values...);
    text.append(line.data(), static_cast<std::size_t>(length));
}

template <class T>
void put(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string obj_text(const Grid& grid, const char* vertex_format) {
    std::string text;
    for (const auto& p : grid.points) print(text, vertex_format, p[0], p[1], p[2]);
    for (const auto& t : grid.triangles) {
        print(text, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    return text;
}

std::string rows(const Grid& grid) {
    std::string text;
    for (const auto& p : grid.points) print(text, "%.7g %.7g %.7g\n", p[0], p[1], p[2]);
    for (const auto& t : grid.triangles) print(text, "3 %u %u %u\n", t[0], t[1], t[2]);
    return text;
}

std::string off_text(const Grid& grid) {
    std::string text;
    print(text, "OFF\n%zu %zu 0\n", grid.points.size(), grid.triangles.size());
    return text + rows(grid);
}

std::string ply_header(const Grid& grid, const char* format) {
    std::string text;
    print(text,
          "ply\nformat %s 1.0\nelement vertex %zu\nproperty float x\nproperty float y\n"
          "property float z\nelement face %zu\nproperty list uchar int vertex_indices\n"
          "end_header\n",
          format, grid.points.size(), grid.triangles.size());
    return text;
}

std::string ply_binary(const Grid& grid) {
    std::string bytes = ply_header(grid, "binary_little_endian");
    for (const auto& p : grid.points) put(bytes, p);
    for (const auto& t : grid.triangles) {
        bytes += '\3';
        put(bytes, t);
    }
    return bytes;
}

std::string stl_binary(const Grid& grid) {
    std::string bytes(80, ' ');
    put(bytes, static_cast<std::uint32_t>(grid.triangles.size()));
    for (const auto& t : grid.triangles) {
        bytes.append(12, '\0');
        for (const std::uint32_t v : t) put(bytes, grid.points[v]);
        bytes.append(2, '\0');
    }
    return bytes;
}

std::string stl_text(const Grid& grid) {
    std::string text = "solid grid\n";
    for (const auto& t : grid.triangles) {
        text += "  facet normal 0 0 1\n    outer loop\n";
        for (const std::uint32_t v : t) {
            const auto& p = grid.points[v];
            print(text, "      vertex %e %e %e\n", p[0], p[1], p[2]);
        }
        text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid grid\n";
}

std::string glb(const Grid& grid) {
    const std::size_t points = grid.points.size() * 12;
    const std::size_t indices = grid.triangles.size() * 12;
    std::string json =
        R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)";
    print(json,
          R"("accessors":[{"bufferView":0,"componentType":5126,"count":%zu,"type":"VEC3"},)"
          R"({"bufferView":1,"componentType":5125,"count":%zu,"type":"SCALAR"}],)",
          grid.points.size(), 3 * grid.triangles.size());
    print(json,
          R"("bufferViews":[{"buffer":0,"byteLength":%zu},{"buffer":0,"byteOffset":%zu,)"
          R"("byteLength":%zu}],"buffers":[{"byteLength":%zu}]})",
          points, points, indices, points + indices);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string bytes = "glTF";
    put(bytes, std::uint32_t{2});
    put(bytes, static_cast<std::uint32_t>(28 + json.size() + points + indices));
    put(bytes, static_cast<std::uint32_t>(json.size()));
    bytes += "JSON" + json;
    put(bytes, static_cast<std::uint32_t>(points + indices));
    bytes.append("BIN\0", 4);
    for (const auto& p : grid.points) put(bytes, p);
    for (const auto& t : grid.triangles) put(bytes, t);
    return bytes;
}

/// The files, for as long as the program runs.
class Files {
public:
    Files() {
        std::string name = (std::filesystem::temp_directory_path() / "cdprep-XXXXXX").string();
        if (!::mkdtemp(name.data())) std::abort();
        folder_ = name;
        const Grid grid = make_grid();
        add("grid.obj", obj_text(grid, "v %.7g %.7g %.7g\n"));
        add("grid_17_digits.obj", obj_text(grid, "v %.17g %.17g %.17g\n"));
        add("grid.off", off_text(grid));
        add("grid_text.ply", ply_header(grid, "ascii") + rows(grid));
        add("grid_binary.ply", ply_binary(grid));
        add("grid_binary.stl", stl_binary(grid));
        add("grid_text.stl", stl_text(grid));
        add("grid.glb", glb(grid));
    }
    Files(const Files&) = delete;
    Files& operator=(const Files&) = delete;
    ~Files() {
        std::filesystem::remove_all(folder_);
    }

    [[nodiscard]] const std::vector<std::filesystem::path>& paths() const {
        return paths_;
    }

private:
    void add(const char* name, const std::string& bytes) {
        paths_.push_back(folder_ / name);
        std::ofstream(paths_.back(), std::ios::binary) << bytes;
    }

    std::filesystem::path folder_;
    std::vector<std::filesystem::path> paths_;
};

/// A parallel_for on so many threads; one is the caller's.
auto on_threads(int threads) {
    return [threads](std::size_t count, Task task) {
        if (threads == 1) return serial_for(count, task);
        std::atomic<std::size_t> next{0};
        std::vector<std::jthread> team;
        for (int t = 0; t < threads; ++t) {
            team.emplace_back([&] {
                for (std::size_t i = next++; i < count; i = next++) task(i);
            });
        }
    };
}

void import_again(benchmark::State& state, const std::filesystem::path& path, int threads) {
    const auto run = on_threads(threads);
    ImportOptions options;
    options.parallel_for = run;
    std::size_t triangles = 0;
    for ([[maybe_unused]] auto step : state) {
        const auto soup = import_file(path, options);
        if (!soup) state.SkipWithError(soup.error().message.c_str());
        if (soup) triangles = soup.value().triangles.size();
    }
    const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
    state.SetBytesProcessed(state.iterations() * bytes);
    state.counters["triangles"] = static_cast<double>(triangles);
    state.counters["file_MB"] = static_cast<double>(bytes) / 1e6;
}

}  // namespace
}  // namespace cdprep::import

int main(int count, char** arguments) {
    benchmark::Initialize(&count, arguments);
    const cdprep::import::Files files;
    for (const std::filesystem::path& path : files.paths()) {
        for (const int threads : {1, 4}) {
            const std::string name = "import/" + path.filename().string() + "/1.1M/" +
                                     std::to_string(threads) + "_threads";
            benchmark::RegisterBenchmark(name.c_str(), cdprep::import::import_again, path, threads)
                ->UseRealTime()
                ->Unit(benchmark::kMillisecond)
                ->MinTime(1.0);
        }
    }
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
