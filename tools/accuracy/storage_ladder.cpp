// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/ladders.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <deque>
#include <numeric>

#include "accuracy/bounding_shapes.h"
#include "accuracy/bytes_read.h"
#include "cdprep/pairs.h"
#include "mesh/degenerate.h"

namespace cdprep::study {
namespace {

struct Way {
    const char* name;
    const char* how;
    unsigned bits;  ///< of a coordinate on a grid; 0: none
    double bytes;   ///< of a vertex
};

constexpr std::array<Way, 5> kWays = {{
    {"16-bit grid",
     "6 bytes per vertex, on a grid of 2^16 planes per axis in the model's bounding cube", 16, 6},
    {"21-bit grid", "8 bytes per vertex", 21, 8},
    {"24-bit grid", "9 bytes per vertex", 24, 9},
    {"float", "12 bytes per vertex", 0, 12},
    {"double", "24 bytes per vertex", 0, 24},
}};

mesh::Mesh in_floats(mesh::Mesh mesh) {
    for (Double3& p : mesh.positions) {
        const auto x = static_cast<float>(p.x);
        const auto y = static_cast<float>(p.y);
        const auto z = static_cast<float>(p.z);
        p = {x, y, z};
    }
    mesh.single_precision = true;
    return mesh;
}

mesh::Mesh stored(const mesh::Mesh& mesh, const Way& way) {
    if (way.bits > 0) return on_grid(mesh, way.bits);
    return way.bytes == 12 ? in_floats(mesh) : mesh;
}

double moved_by(const mesh::Mesh& from, const mesh::Mesh& to) {
    double most = 0;
    for (std::size_t i = 0; i < from.positions.size(); ++i) {
        const Double3& p = from.positions[i];
        const Double3& q = to.positions[i];
        most = std::max(most, std::hypot(p.x - q.x, p.y - q.y, p.z - q.z));
    }
    return most;
}

std::size_t degenerate_count(const mesh::Mesh& mesh, ParallelFor run) {
    const auto bits = mesh::find_degenerate(mesh, run);
    return std::accumulate(bits.begin(), bits.end(), std::size_t{0},
                           [](std::size_t sum, std::uint64_t word) {
                               return sum + static_cast<std::size_t>(std::popcount(word));
                           });
}

using Pairs = std::vector<TrianglePair>;

Pairs pairs_of(const MemoryModel& a, const MemoryModel& b, const Pose& pose, Workspace& workspace) {
    Pairs pairs;
    const auto keep = [&](const TrianglePair& pair) {
        pairs.push_back(pair);
        return true;
    };
    visit_overlaps({a.model, b.model, Placement::b_moves(pose)}, workspace, keep);
    std::ranges::sort(pairs);
    return pairs;
}

struct Stored {
    Rung rung;
    MemoryModel a;
    MemoryModel b;
};

class Ways {
public:
    explicit Ways(const Climb& climb) : climb_(climb) {}

    void add(const Way& way) {
        const mesh::Mesh mesh_a = stored(climb_.mesh_a, way);
        const mesh::Mesh mesh_b = stored(climb_.mesh_b, way);
        const MemoryParts parts = {.bounds = build::BvhBounds::oriented};
        auto a = make_memory_model(mesh_a, parts, climb_.parallel_for);
        auto b = make_memory_model(mesh_b, parts, climb_.parallel_for);
        if (!a || !b) return;
        Rung rung;
        rung.name = way.name;
        rung.how = way.how;
        rung.displacement =
            std::max(moved_by(climb_.mesh_a, mesh_a), moved_by(climb_.mesh_b, mesh_b)) /
            climb_.set.diagonal;
        // No point of a triangle moves more than its corners, in either direction.
        rung.outer = rung.inner = rung.displacement;
        rung.promise = *rung.displacement == 0 ? Promise::exact : Promise::none;
        const std::size_t before = degenerate_count(climb_.mesh_a, climb_.parallel_for) +
                                   degenerate_count(climb_.mesh_b, climb_.parallel_for);
        const std::size_t after = degenerate_count(mesh_a, climb_.parallel_for) +
                                  degenerate_count(mesh_b, climb_.parallel_for);
        rung.degenerate = after > before ? after - before : 0;
        rung.build_s = a.value().seconds.tree + b.value().seconds.tree;
        rung.bytes = static_cast<std::uint64_t>(
            way.bytes * static_cast<double>(mesh_a.positions.size() + mesh_b.positions.size()));
        all_.push_back({std::move(rung), std::move(a).value(), std::move(b).value()});
    }

    [[nodiscard]] std::deque<Stored>& all() {
        return all_;
    }

    [[nodiscard]] bool hits(const Stored& way, std::size_t pose) {
        return collide(
                   {way.a.model, way.b.model, Placement::b_moves(climb_.set.poses[pose].a_from_b)},
                   workspace_)
                   .hit == Answer::yes;
    }

    [[nodiscard]] double bytes_read(const Stored& way) {
        return mean_bytes_read(way.a.model, way.b.model, workspace_, climb_.set.poses.size(),
                               [&](std::size_t i) { static_cast<void>(hits(way, i)); });
    }

    void judge(Stored& way, Broken& broken) {
        std::vector<PairCounts>& counts = way.rung.pair_counts;
        for (std::size_t i = 0; i < climb_.set.poses.size() && !climb_.must_stop(); ++i) {
            way.rung.answers.push_back(hits(way, i) ? Answer::yes : Answer::no);
            const Pose& pose = climb_.set.poses[i].a_from_b;
            const Pairs truth = pairs_of(climb_.a, climb_.b, pose, workspace_);
            const Pairs found = pairs_of(way.a, way.b, pose, workspace_);
            Pairs both;
            std::ranges::set_intersection(truth, found, std::back_inserter(both));
            counts.push_back({truth.size(), found.size(), both.size()});
        }
        if (climb_.must_stop()) return;
        const PairErrors errors = pair_errors(counts);
        way.rung.pairs = errors;
        judge_answers("storage", climb_.set, way.rung, broken);
        judge_pairs("storage", way.rung, broken);
        // Few collision answers change. The number of changed pairs is more informative.
        keep_error(errors.wrong, way.rung);
    }

private:
    const Climb& climb_;
    Workspace workspace_;
    std::deque<Stored> all_;
};

}  // namespace

mesh::Mesh on_grid(const mesh::Mesh& mesh, unsigned bits) {
    mesh::Mesh result = mesh;
    if (mesh.positions.empty()) return result;
    const BoundingBox box = aligned_box(mesh);
    const double half = std::max({box.half.x, box.half.y, box.half.z});
    const double steps = std::ldexp(1.0, static_cast<int>(bits)) - 1;
    const double step = 2 * half / steps;
    if (!(step > 0)) return result;
    const auto snap = [&](double x, double middle) {
        const double low = middle - half;
        return low + std::clamp(std::round((x - low) / step), 0.0, steps) * step;
    };
    for (Double3& p : result.positions) {
        p = {snap(p.x, box.centre.x), snap(p.y, box.centre.y), snap(p.z, box.centre.z)};
    }
    result.single_precision = false;
    return result;
}

bool fits_float(const mesh::Mesh& mesh) noexcept {
    constexpr double kMost = 0x1p120;
    return std::ranges::all_of(mesh.positions, [](const Double3& p) {
        return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) <= kMost;
    });
}

Ladder climb_storage(const Climb& climb, Broken& broken) {
    Ladder ladder;
    ladder.name = "storage";
    ladder.question = "which triangles touch, when vertices are stored with fewer bits";
    ladder.error = "missing and extra pairs, as a share of the pairs in either set";
    ladder.cases = "pose";
    Ways ways(climb);
    for (const Way& way : kWays) {
        climb.begins(std::string("storage: ") + way.name);
        if (way.bytes == 12 && !(fits_float(climb.mesh_a) && fits_float(climb.mesh_b))) {
            ladder.left_out.emplace_back("float: coordinates are outside the range of float.");
            continue;
        }
        ways.add(way);
        if (climb.must_stop()) return ladder;
    }
    climb.begins("storage: queries");
    std::vector<Question> questions;
    for (Stored& way : ways.all()) {
        ways.judge(way, broken);
        way.rung.touched = ways.bytes_read(way);
        questions.push_back(
            question_of([&ways, &way](std::size_t i) { return ways.hits(way, i) ? 1 : 0; }));
    }
    if (climb.must_stop()) return ladder;
    const auto timings = time_questions(climb.set.poses.size(), questions, climb.timing);
    if (climb.must_stop()) return ladder;
    std::size_t number = 0;
    for (Stored& way : ways.all()) {
        keep_time(climb.set, timings[number++], way.rung);
        ladder.rungs.push_back(std::move(way.rung));
    }
    return ladder;
}

}  // namespace cdprep::study
