// SPDX-License-Identifier: MIT
// How fast hierarchies are built and refitted, and how fast a tree of each kind
// answers.
//
// Usage: build_bvh_bench BAKES [ROUNDS [POSES [PAIR...]]]
// BAKES holds NAME.cdp.h5: their triangles are built anew, in the order of their
// source. POSES holds A-B.pose files as pair_queries_bench reads them. Every way of
// building takes its turn, ROUNDS times (5); figures are medians, with the
// spread of the middle half of the rounds. "rebuilt" builds into the arrays of the round
// before, "refitted" keeps their order. Prints two CSV tables: builds, and what queries
// take by the way the two trees were built.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench_input.h"
#include "cdprep/advanced/build_bvh.h"
#include "cdprep/advanced/refit_bvh.h"
#include "cdprep/pairs.h"
#include "crew.h"
#include "support/tiny_baker.h"

namespace cdprep {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// A mesh in the numbering of its source.
struct SourceMesh {
    std::vector<Double3> positions;
    std::vector<format::Triangle> triangles;
};

SourceMesh source_mesh(const fs::path& path) {
    auto opened = Model::open(path);
    if (!opened) stop(opened.error().message);
    const Model& model = opened.value();
    SourceMesh mesh;
    std::vector<Double3> points(model.mesh().positions_f64.begin(),
                                model.mesh().positions_f64.end());
    for (const Float3& p : model.mesh().positions_f32) points.push_back({p.x, p.y, p.z});
    // Vertices stand in the order of their source's numbers.
    std::vector<std::uint32_t> by_source(points.size());
    for (std::uint32_t i = 0; i < by_source.size(); ++i) by_source[i] = i;
    const auto source = model.source().vertex;
    std::sort(by_source.begin(), by_source.end(),
              [&](std::uint32_t a, std::uint32_t b) { return source[a] < source[b]; });
    std::vector<std::uint32_t> new_number(points.size());
    for (std::uint32_t i = 0; i < by_source.size(); ++i) {
        new_number[by_source[i]] = i;
        mesh.positions.push_back(points[by_source[i]]);
    }
    mesh.triangles.resize(model.mesh().triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        format::Triangle triangle = model.mesh().triangles[i];
        for (std::uint32_t& vertex : triangle.vertex) vertex = new_number[vertex];
        mesh.triangles[model.source().triangle[i]] = triangle;
    }
    return mesh;
}

template <class T>
test::TinySection section(SectionId id, const std::vector<T>& elements) {
    const auto bytes = std::as_bytes(std::span(elements));
    return {id, {bytes.begin(), bytes.end()}};
}

/// A model with this hierarchy, and the bytes that it lives in.
struct OpenModel {
    test::AlignedBytes bytes;
    Model model;
};

/// Only what overlaps() and collide() read.
OpenModel open_model(const SourceMesh& mesh, const build::Bvh& bvh) {
    std::vector<Float3> points;
    for (const Double3& p : mesh.positions) {
        points.push_back(
            {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    std::vector<format::Triangle> triangles;
    for (const std::uint32_t source : bvh.order) triangles.push_back(mesh.triangles[source]);
    format::FileHeader facts{};
    facts.vertex_count = static_cast<std::uint32_t>(points.size());
    facts.triangle_count = static_cast<std::uint32_t>(triangles.size());
    if (bvh.exact_leaves) facts.flags |= format::model_exact_leaves;
    facts.frame_origin = bvh.frame.origin;
    facts.frame_exponent = bvh.frame.exponent;
    std::vector<test::TinySection> sections = {
        section(SectionId::positions_f32, points), section(SectionId::triangles, triangles),
        section(SectionId::source_triangle, bvh.order), section(SectionId::bvh_nodes, bvh.nodes),
        section(SectionId::bvh_leaves, bvh.leaves)};
    if (!bvh.oriented_nodes.empty()) {
        sections.push_back(section(SectionId::oriented_nodes, bvh.oriented_nodes));
    }
    test::AlignedBytes bytes = test::assemble(facts, sections);
    auto opened = Model::open(std::as_const(bytes).span());
    if (!opened) stop(opened.error().message);
    return {std::move(bytes), std::move(opened).value()};
}

/// A way to come to a hierarchy, from one that is there.
struct Way {
    std::string name;
    std::function<void(const SourceMesh&, build::Bvh&)> make;
    std::vector<double> seconds = {};
    double cost = 0;
};

/// What is done with how many threads, oriented boxes or not.
void add_ways(const std::string& setting, const build::BvhOptions& options,
              std::vector<Way>& ways) {
    build::BvhOptions fast = options;
    fast.quality = build::Quality::fast;
    ways.push_back({"best," + setting, [options](const SourceMesh& mesh, build::Bvh& bvh) {
                        bvh = build_bvh(mesh.positions, mesh.triangles, options);
                    }});
    ways.push_back({"fast," + setting, [fast](const SourceMesh& mesh, build::Bvh& bvh) {
                        bvh = build_bvh(mesh.positions, mesh.triangles, fast);
                    }});
    ways.push_back({"fast rebuilt," + setting, [fast](const SourceMesh& mesh, build::Bvh& bvh) {
                        rebuild_bvh(bvh, mesh.positions, mesh.triangles, fast);
                    }});
    ways.push_back({"fast refitted," + setting, [fast](const SourceMesh& mesh, build::Bvh& bvh) {
                        refit_bvh(bvh, mesh.positions, mesh.triangles, fast);
                    }});
}

void time_builds(const std::string& name, const SourceMesh& mesh, int rounds) {
    std::vector<std::unique_ptr<Crew>> crews;
    std::vector<Way> ways;
    for (const std::size_t threads : {1U, 2U, 4U}) {
        crews.push_back(std::make_unique<Crew>(threads));
        for (const bool oriented : {true, false}) {
            add_ways((oriented ? "yes," : "no,") + std::to_string(threads),
                     {.parallel_for = *crews.back(),
                      .bounds = oriented ? build::BvhBounds::oriented : build::BvhBounds::aligned},
                     ways);
        }
    }
    build::Bvh bvh;
    for (int round = 0; round < rounds; ++round) {
        for (Way& way : ways) {
            way.make(mesh, bvh);  // warms up
            const Clock::time_point begun = Clock::now();
            way.make(mesh, bvh);
            way.seconds.push_back(std::chrono::duration<double>(Clock::now() - begun).count());
            way.cost = surface_cost(bvh);
        }
    }
    for (const Way& way : ways) {
        const double seconds = median(way.seconds);
        std::printf("%s,%zu,%s,%.1f,%.1f,%.2f,%.3f\n", name.c_str(), mesh.triangles.size(),
                    way.name.c_str(), 1e3 * seconds, 1e3 * spread(way.seconds),
                    1e-6 * static_cast<double>(mesh.triangles.size()) / seconds, way.cost);
    }
    std::fflush(stdout);
}

/// A way of building that queries are timed on.
struct Tree {
    const char* name;
    build::BvhOptions options;
};
const std::array<Tree, 4> kTrees = {{
    {"best", {}},
    {"fast", {.quality = build::Quality::fast}},
    {"best without oriented boxes", {.bounds = build::BvhBounds::aligned}},
    {"fast without oriented boxes",
     {.bounds = build::BvhBounds::aligned, .quality = build::Quality::fast}},
}};

/// Microseconds that each pose took, the least of the rounds.
std::vector<double> time_poses(const std::vector<Pose>& poses, int rounds,
                               const std::function<void(const Placement&)>& ask) {
    std::vector<double> us(poses.size(), 1e300);
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const Clock::time_point begun = Clock::now();
            ask(Placement::b_moves(poses[i]));
            const std::chrono::duration<double, std::micro> taken = Clock::now() - begun;
            us[i] = std::min(us[i], taken.count());
        }
    }
    return us;
}

void time_queries(const std::string& pair, const SourceMesh& a, const SourceMesh& b,
                  const std::vector<Pose>& all, int rounds) {
    constexpr std::array<const char*, 2> kKinds = {"light", "deep"};
    Workspace workspace;
    std::vector<TrianglePair> found(std::size_t{1} << 22);
    std::vector<OpenModel> models_a, models_b;
    for (const Tree& tree : kTrees) {
        models_a.push_back(open_model(a, build_bvh(a.positions, a.triangles, tree.options)));
        models_b.push_back(open_model(b, build_bvh(b.positions, b.triangles, tree.options)));
    }
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
        std::vector<Pose> poses;
        for (std::size_t i = kind; i < all.size(); i += 3) poses.push_back(all[i]);
        for (const bool overlap : {true, false}) {
            std::array<std::vector<double>, kTrees.size()> totals;
            for (int round = 0; round < rounds; ++round) {
                for (std::size_t tree = 0; tree < kTrees.size(); ++tree) {
                    const Model& model_a = models_a[tree].model;
                    const Model& model_b = models_b[tree].model;
                    const auto us = time_poses(poses, 3, [&](const Placement& placement) {
                        if (overlap) {
                            (void)overlaps({model_a, model_b, placement}, workspace, found);
                        } else {
                            (void)collide({model_a, model_b, placement}, workspace);
                        }
                    });
                    totals[tree].push_back(median(us));
                }
            }
            for (std::size_t tree = 0; tree < kTrees.size(); ++tree) {
                std::printf("%s,%s/%s,%s,%.2f,%.2f,%.2f\n", pair.c_str(),
                            overlap ? "overlap" : "collide", kKinds[kind], kTrees[tree].name,
                            median(totals[tree]), spread(totals[tree]),
                            median(totals[tree]) / median(totals[0]));
            }
            std::fflush(stdout);
        }
    }
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    using namespace cdprep;
    if (count < 2) {
        std::fprintf(stderr, "usage: %s BAKES [ROUNDS [POSES [PAIR...]]]\n", arguments[0]);
        return 2;
    }
    const fs::path bakes = arguments[1];
    const auto mesh = [&](const std::string& name) {
        return source_mesh(bakes / (name + ".cdp.h5"));
    };
    const int rounds = count > 2 ? std::max(1, std::atoi(arguments[2])) : 5;
    std::printf(
        "model,triangles,mode,oriented,threads,median_ms,spread_ms,million_triangles_per_s,"
        "surface_cost\n");
    for (const char* name : {"dragon", "armadillo"}) time_builds(name, mesh(name), rounds);
    if (count < 4) return 0;
    const fs::path poses = arguments[3];
    std::vector<std::string> pairs(arguments + std::min(count, 4), arguments + count);
    if (pairs.empty()) pairs = {"dragon-armadillo", "armadillo-bunny", "buddha-horse"};
    std::printf("\npair,question,tree,median_us,spread_us,times_best\n");
    for (const std::string& pair : pairs) {
        const std::size_t dash = pair.find('-');
        if (dash == std::string::npos) stop("'" + pair + "' is not two names with a dash between");
        time_queries(pair, mesh(pair.substr(0, dash)), mesh(pair.substr(dash + 1)),
                     read_poses(poses / (pair + ".pose")), rounds);
    }
}
