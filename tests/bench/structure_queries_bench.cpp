// SPDX-License-Identifier: MIT
// How fast octrees, adaptive octrees and tetra-trees answer "do they touch?" and "which
// triangles overlap?", beside the hierarchy of boxes. For each pair of models, each kind of
// pose (light, deep) and each setting all contenders ask the whole set in turns, and that
// several times; the time of a pose is the median of its rounds, that of a set the median of
// its poses. One thread.
//
// Usage: structure_queries_bench BAKES POSES ROUNDS SETTING... [-- PAIR...]
// BAKES holds NAME.cdp.h5, baked with --normalize; POSES holds A-B.pose files of 12 numbers
// a line, line i of kind i mod 3 (light, deep, near). SETTING is
// STRUCTURE:LEVEL:THRESHOLD[:DESCENT[:TEST]] with octree, adaptive, surface (adaptive by
// surface area), tetra or hashed; larger, a_first, b_first or both, or of
// hashed sorted, modulus or mixed; gd or ft. A + behind the
// structure gives its nodes boxes. Structures are built here. PAIR is A-B; without, all files of
// POSES are taken.
//
// Prints a CSV table: microseconds, `times` the median by the hierarchy's; then what a
// question took in the mean: boxes against boxes, leaf cells against leaf cells, BVH leaves
// against BVH leaves.
#include <chrono>
#include <cstring>
#include <optional>

#include "bench_input.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/cells.h"
#include "cdprep/cells/overlap_through.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"

namespace cdprep {
namespace {

constexpr std::size_t kMostPairs = 1U << 22;
constexpr std::size_t kKinds = 3;
constexpr std::array<const char*, 2> kKind = {"light", "deep"};

struct Setting {
    std::string name;  ///< as it was given
    std::string structure = "bvh";
    bool boxes = false;
    std::uint32_t level = 0;
    std::uint32_t threshold = 1;
    StructureOptions through;
};

std::vector<std::string> parts(const std::string& text) {
    std::vector<std::string> result(1);
    for (const char c : text) {
        if (c == ':') {
            result.emplace_back();
        } else {
            result.back() += c;
        }
    }
    return result;
}

Setting setting_of(const std::string& text) {
    Setting setting;
    setting.name = text;
    std::vector<std::string> part = parts(text);
    if (part.size() < 3) stop(text + " is not of the form STRUCTURE:LEVEL:THRESHOLD.");
    setting.boxes = part[0].ends_with('+');
    if (setting.boxes) part[0].pop_back();
    setting.structure = part[0];
    setting.level = static_cast<std::uint32_t>(std::stoul(part[1]));
    setting.threshold = static_cast<std::uint32_t>(std::stoul(part[2]));
    StructureOptions& through = setting.through;
    through.structure = part[0] == "octree"   ? Structure::octree
                        : part[0] == "tetra"  ? Structure::tetra_tree
                        : part[0] == "hashed" ? Structure::hashed_octree
                                              : Structure::adaptive_octree;
    if (part.size() > 3) {
        through.descent = part[3] == "a_first"   ? Descent::a_first
                          : part[3] == "b_first" ? Descent::b_first
                          : part[3] == "both"    ? Descent::both
                                                 : Descent::larger;
        through.search = part[3] == "modulus" ? CellSearch::modulus
                         : part[3] == "mixed" ? CellSearch::mixed
                                              : CellSearch::sorted;
    }
    if (part.size() > 4 && part[4] == "ft") through.leaf_test = LeafTest::feito_torres;
    return setting;
}

test::AlignedBytes file_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) stop(path.string() + " cannot be read.");
    test::AlignedBytes bytes(std::filesystem::file_size(path));
    file.read(reinterpret_cast<char*>(bytes.span().data()),
              static_cast<std::streamsize>(bytes.span().size()));
    return bytes;
}

test::OpenModel with_structure(const test::AlignedBytes& bytes, const Setting& setting) {
    const std::optional<build::Frame> boxes_in =
        setting.boxes ? std::optional(build::Frame{}) : std::nullopt;
    if (setting.structure == "bvh") return test::open_tiny(test::AlignedBytes(bytes.span()));
    if (setting.structure == "tetra") {
        return test::open_tiny(test::with_tetra_tree(
            bytes, {.level = setting.level,
                    .threshold = setting.threshold,
                    .bounding = setting.boxes ? format::TetraBounding::boxes
                                              : format::TetraBounding::caps}));
    }
    if (setting.structure == "octree" || setting.structure == "hashed") {
        return test::open_tiny(test::with_octree(bytes, {.level = setting.level,
                                                         .threshold = setting.threshold,
                                                         .hashed = setting.structure == "hashed",
                                                         .boxes_in = boxes_in}));
    }
    const auto rule = setting.structure == "surface" ? format::SplitRule::surface_area
                                                     : format::SplitRule::median;
    return test::open_tiny(test::with_adaptive_octree(bytes, {.level = setting.level,
                                                              .threshold = setting.threshold,
                                                              .rule = rule,
                                                              .boxes_in = boxes_in}));
}

class Contender {
public:
    Contender(const Setting& setting, const test::AlignedBytes& a, const test::AlignedBytes& b)
        : setting_(setting), a_(with_structure(a, setting)), b_(with_structure(b, setting)) {}

    [[nodiscard]] const Setting& setting() const {
        return setting_;
    }
    std::size_t ask(bool overlap, const Pose& pose, Workspace& workspace,
                    std::span<TrianglePair> pairs) const {
        const Placement placement = Placement::b_moves(pose);
        if (overlap) {
            return overlaps_through({a_.model, b_.model, placement}, setting_.through, workspace,
                                    pairs);
        }
        return any_overlap_through({a_.model, b_.model, placement}, setting_.through, workspace);
    }

private:
    Setting setting_;
    test::OpenModel a_;
    test::OpenModel b_;
};

double time_of(const Contender& contender, bool overlap, const Pose& pose, Workspace& workspace,
               std::span<TrianglePair> pairs, std::size_t expected) {
    const auto begin = std::chrono::steady_clock::now();
    const std::size_t count = contender.ask(overlap, pose, workspace, pairs);
    const auto end = std::chrono::steady_clock::now();
    if (count != expected) stop(contender.setting().name + " answers differently.");
    return std::chrono::duration<double, std::micro>(end - begin).count();
}

QueryCounts counts_of(const Contender& contender, bool overlap, const std::vector<Pose>& poses,
                      Workspace& workspace, std::span<TrianglePair> pairs) {
    QueryCounts counts;
    workspace.count_into(&counts);
    for (const Pose& pose : poses) contender.ask(overlap, pose, workspace, pairs);
    workspace.count_into(nullptr);
    return counts;
}

/// The hierarchy comes first of the contenders.
void compare(const std::string& pair, std::size_t kind, bool overlap, std::size_t rounds,
             const std::vector<Contender>& contenders, const std::vector<Pose>& poses) {
    Workspace workspace(cells());
    std::vector<TrianglePair> pairs(kMostPairs);
    std::vector<std::vector<double>> medians(contenders.size());
    for (const Pose& pose : poses) {
        const std::size_t expected = contenders[0].ask(overlap, pose, workspace, pairs);
        std::vector<std::vector<double>> times(contenders.size());
        for (std::size_t round = 0; round < rounds; ++round) {
            for (std::size_t i = 0; i < contenders.size(); ++i) {
                times[i].push_back(
                    time_of(contenders[i], overlap, pose, workspace, pairs, expected));
            }
        }
        for (std::size_t i = 0; i < contenders.size(); ++i) medians[i].push_back(median(times[i]));
    }
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        const QueryCounts counts = counts_of(contenders[i], overlap, poses, workspace, pairs);
        const std::size_t n = poses.size();
        std::printf("%s,%s,%s,%s,%.2f,%.2f,%.2f,%zu,%zu,%zu\n", pair.c_str(), kKind[kind],
                    overlap ? "overlap" : "collide", contenders[i].setting().name.c_str(),
                    median(medians[i]), median(medians[i], 0.95),
                    median(medians[i]) / median(medians[0]), std::size_t{counts.box_pairs} / n,
                    std::size_t{counts.cell_pairs} / n, std::size_t{counts.leaf_pairs} / n);
        std::fflush(stdout);
    }
}

int main_of(const std::vector<std::string>& arguments) {
    if (arguments.size() < 4) stop("Usage: see the head of structure_queries_bench.cpp.");
    const std::filesystem::path bakes = arguments[0];
    const std::filesystem::path folder = arguments[1];
    const std::size_t rounds = std::stoul(arguments[2]);
    const auto dashes = std::find(arguments.begin() + 3, arguments.end(), "--");
    std::vector<Setting> settings(1);
    settings[0].name = "bvh";
    for (auto at = arguments.begin() + 3; at != dashes; ++at) settings.push_back(setting_of(*at));
    std::vector<std::string> named;
    if (dashes != arguments.end()) named.assign(dashes + 1, arguments.end());
    std::printf("pair,poses,question,setting,median_us,p95_us,times,boxes,cells,leaves\n");
    for (const std::string& pair : pairs_or_all(named, folder)) {
        const std::size_t dash = pair.find('-');
        const auto a = file_bytes(bakes / (pair.substr(0, dash) + ".cdp.h5"));
        const auto b = file_bytes(bakes / (pair.substr(dash + 1) + ".cdp.h5"));
        std::vector<Contender> contenders;
        for (const Setting& setting : settings) contenders.emplace_back(setting, a, b);
        const std::vector<Pose> poses = read_poses(folder / (pair + ".pose"));
        for (std::size_t kind = 0; kind < kKind.size(); ++kind) {
            for (const bool overlap : {false, true}) {
                compare(pair, kind, overlap, rounds, contenders,
                        poses_of_kind(poses, kind, kKinds));
            }
        }
    }
    return 0;
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    return cdprep::main_of({arguments + 1, arguments + count});
}
