// SPDX-License-Identifier: MIT
// The talk's algorithm on pairs of models: how many of the overlapping pairs it finds when it
// is taken to the letter, how small its potentially colliding sets are, and how long it takes,
// literal and repaired, beside the hierarchy of boxes. All three ask each pose in turns, and
// that several times; the time of a pose is the median of its rounds, that of a set the
// median of its poses. One thread.
//
// Usage: hashed_recall_bench BAKES POSES LEVEL THRESHOLD ROUNDS [SEARCH [MISSED [PAIR...]]]
// BAKES holds NAME.cdp.h5, baked with --normalize; POSES holds A-B.pose files of 12 numbers a
// line, line i of kind i mod 3 (light, deep, near). Octrees of that level and threshold are
// built here. SEARCH is sorted, modulus or mixed. MISSED is where the pair that the literal
// form misses by most is written as JSON, for missed_pair.py, or "-". PAIR is A-B; without,
// all files of POSES are taken.
//
// Prints a CSV table, means over a set's poses. pairs: that overlap; found: of them by the
// literal form; recall: the share. cs_a, cs_b: triangles of A and of B in those pairs;
// literal_cs_a, literal_cs_b: in those found. Triangles of B: all_b; box_b: that touch A's
// axis-aligned box; cluster_b: in clusters of 64 triangles that A's oriented box does not clip;
// slab_b: in those of these that groups_in_slabs() keeps; leaf_b: in leaves of the
// hierarchy that A's oriented box does not clip; pcs_b: triangles that it does not clip; held_b: of
// the model with fewer triangles, in leaves with boxes that meet cells of the other (repaired).
// listed: triangles of A that the literal form's cells list (its PCS_A, added up), and the repaired
// form's. lost: pairs that the clusters, slabs or leaves of A and B do not keep; stops if there is
// one. Microseconds.
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>

#include "bench_input.h"
#include "cdprep/cells/octree_search.h"
#include "cell_searches/literal_octree.h"
#include "cells/octree_codes.h"
#include "compare/pruning.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "walk/contact_pairs.h"

#include "cdprep/cells.h"
#include "cdprep/cells/overlap_through.h"

namespace cdprep {
namespace {

constexpr std::array<const char*, 3> kKinds = {"light", "deep", "near"};
enum class Contender : std::uint8_t { bvh, repaired, literal };
constexpr std::array<Contender, 3> kContenders = {Contender::bvh, Contender::repaired,
                                                  Contender::literal};

test::OpenModel open_with_octree(const std::filesystem::path& path,
                                 const build::OctreeOptions& options) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) stop(path.string() + " cannot be read.");
    test::AlignedBytes bytes(static_cast<std::size_t>(file.tellg()));
    file.seekg(0);
    file.read(reinterpret_cast<char*>(bytes.span().data()),
              static_cast<std::streamsize>(bytes.span().size()));
    return test::open_tiny(test::with_octree(bytes, options));
}

/// Sums over the poses of a set.
struct Row {
    study::Pruning sum;
    std::array<std::vector<double>, 3> us;  ///< of the contenders, by pose
};

/// A pair that the literal form misses.
struct Missed {
    double size = 0;  ///< the longest edge of B's triangle
    std::string pair;
    Pose a_from_b;
    std::uint32_t at_a = 0;  ///< tree order
    std::uint32_t at_b = 0;
};

class Study {
public:
    Study(const Model& a, const Model& b, CellSearch search) : a_(a), b_(b), search_(search) {}

    void ask(const Pose& pose, int rounds, Row& row);

    /// The pairs that the last question's literal form missed.
    [[nodiscard]] const std::vector<TrianglePair>& missed() const {
        return missed_;
    }

private:
    std::size_t count(Contender contender, const Placement& placement) {
        if (contender == Contender::bvh) return overlaps({a_, b_, placement}, workspace_, {});
        if (contender == Contender::repaired) {
            return overlaps_through({a_, b_, placement},
                                    {.structure = Structure::hashed_octree, .search = search_},
                                    workspace_, {});
        }
        std::size_t pairs = 0;
        const auto keep = [&](const TrianglePair&) { return ++pairs > 0; };
        study::visit_literal_overlaps(a_, b_, placement, {.search = search_}, keep);
        return pairs;
    }
    void time(const Placement& placement, int rounds, Row& row);

    const Model& a_;
    const Model& b_;
    CellSearch search_;
    Workspace workspace_{cells()};
    std::vector<TrianglePair> missed_;
};

void Study::time(const Placement& placement, int rounds, Row& row) {
    std::array<std::vector<double>, kContenders.size()> us;
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t c = 0; c < kContenders.size(); ++c) {
            const auto begun = std::chrono::steady_clock::now();
            count(kContenders[c], placement);
            const std::chrono::duration<double, std::micro> taken =
                std::chrono::steady_clock::now() - begun;
            us[c].push_back(taken.count());
        }
    }
    for (std::size_t c = 0; c < kContenders.size(); ++c) row.us[c].push_back(median(us[c]));
}

void Study::ask(const Pose& pose, int rounds, Row& row) {
    const Placement placement = Placement::b_moves(pose);
    const study::Pruning pruning = study::prune(a_, b_, pose, search_, workspace_, missed_);
    const std::size_t repaired = count(Contender::repaired, placement);
    if (static_cast<double>(repaired) != pruning.pairs) stop("The pairs differ.");
    if (pruning.lost > 0) stop("A step of pruning loses a pair.");
    row.sum += pruning;
    time(placement, rounds, row);
}

struct Mean {
    const char* name;
    double study::Pruning::*member;
};
constexpr std::array<Mean, 16> kMeans = {{
    {"pairs", &study::Pruning::pairs},
    {"found", &study::Pruning::found},
    {"cs_a", &study::Pruning::cs_a},
    {"cs_b", &study::Pruning::cs_b},
    {"literal_cs_a", &study::Pruning::literal_cs_a},
    {"literal_cs_b", &study::Pruning::literal_cs_b},
    {"all_b", &study::Pruning::all_b},
    {"box_b", &study::Pruning::box_b},
    {"cluster_b", &study::Pruning::cluster_b},
    {"slab_b", &study::Pruning::slab_b},
    {"leaf_b", &study::Pruning::leaf_b},
    {"pcs_b", &study::Pruning::pcs_b},
    {"held_b", &study::Pruning::held_b},
    {"listed_literal", &study::Pruning::listed_literal},
    {"listed_repaired", &study::Pruning::listed_repaired},
    {"lost", &study::Pruning::lost},
}};

void print(const std::string& pair, const char* kind, std::size_t poses, const Row& row) {
    std::printf("%s,%s,%zu", pair.c_str(), kind, poses);
    for (const Mean& mean : kMeans) {
        std::printf(",%.1f", row.sum.*mean.member / static_cast<double>(poses));
    }
    std::array<char, 16> recall = {'-'};
    if (row.sum.pairs > 0) {
        std::snprintf(recall.data(), recall.size(), "%.4f", row.sum.found / row.sum.pairs);
    }
    const double bvh = median(row.us[0]), repaired = median(row.us[1]), literal = median(row.us[2]);
    std::printf(",%s,%.2f,%.2f,%.2f,%.2f,%.2f\n", recall.data(), bvh, repaired, literal,
                repaired / bvh, literal / bvh);
    std::fflush(stdout);
}

double longest_edge(const Corners& t) {
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3& p = t[i];
        const Double3& q = t[(i + 1) % 3];
        longest = std::max(longest, std::hypot(p.x - q.x, p.y - q.y, p.z - q.z));
    }
    return longest;
}

/// From numbers of the imported file to the tree order.
std::vector<std::uint32_t> tree_numbers(const Model& model) {
    std::vector<std::uint32_t> numbers(model.triangle_count());
    for (std::uint32_t i = 0; i < numbers.size(); ++i) numbers[source_number(model, i)] = i;
    return numbers;
}

void keep_larger(const Study& study, const std::string& name, const Model& a, const Model& b,
                 const Pose& pose, Missed& kept) {
    if (study.missed().empty()) return;
    const auto tree_a = tree_numbers(a), tree_b = tree_numbers(b);
    const MovedModel moved(b, &pose);
    for (const TrianglePair& pair : study.missed()) {
        const double size = longest_edge(moved.corners(tree_b[pair.b]));
        if (size <= kept.size) continue;
        kept = {size, name, pose, tree_a[pair.a], tree_b[pair.b]};
    }
}

void write_point(std::FILE* file, const Double3& p, const char* after) {
    std::fprintf(file, "[%.17g, %.17g, %.17g]%s", p.x, p.y, p.z, after);
}
void write_corners(std::FILE* file, const char* name, const Corners& t, const char* after) {
    std::fprintf(file, "%s[", name);
    write_point(file, t[0], ", ");
    write_point(file, t[1], ", ");
    write_point(file, t[2], "]");
    std::fputs(after, file);
}
void write_box(std::FILE* file, const Box3& box, const char* after) {
    std::fputs("    [", file);
    write_point(file, box.lower, ", ");
    write_point(file, box.upper, "]");
    std::fputs(after, file);
}

/// The triangles of the pair, the cell around each corner of B's, the leaf cells that list
/// A's, and what of A's surface touches B's triangle or lies near.
void write_missed(const std::filesystem::path& path, const Missed& missed, const Model& a,
                  const Model& b, CellSearch search) {
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (file == nullptr) stop(path.string() + " cannot be written.");
    const MovedModel still(a, nullptr), moved(b, &missed.a_from_b);
    const Corners in_a = still.corners(missed.at_a), in_b = moved.corners(missed.at_b);
    std::fprintf(file, "{\"pair\": \"%s\",\n \"a\": %u, \"b\": %u,\n", missed.pair.c_str(),
                 source_number(a, missed.at_a), source_number(b, missed.at_b));
    write_corners(file, " \"triangle_a\": ", in_a, ",\n");
    write_corners(file, " \"triangle_b\": ", in_b, ",\n \"corner_cells\": [\n");
    const OctreeIndex index = octree_index(a);
    const format::OctreeGrid& grid = *a.octree().grid;
    for (std::size_t i = 0; i < 3; ++i) {
        // The leaf where there is one; an empty cell is shown as deep as the tree goes.
        const CellPlace cell = octree_cell(grid, in_b[i]);
        const std::uint32_t leaf = find_leaf(index, search, octree_code(cell));
        const std::uint32_t level =
            leaf == kNoNode ? index.deepest : level_of(index.nodes[leaf].key);
        const std::uint32_t shift = format::kOctreeBits - level;
        const CellPlace first = {cell[0] >> shift << shift, cell[1] >> shift << shift,
                                 cell[2] >> shift << shift};
        write_box(file, octree_box(grid, first, level), i == 2 ? "\n" : ",\n");
    }
    std::fputs(" ],\n \"listing_cells\": [\n", file);
    bool any = false;
    for (const std::uint32_t node : index.leaf_nodes) {
        const auto listed =
            a.octree().references.subspan(index.nodes[node].first, index.nodes[node].count);
        const bool lists = std::any_of(listed.begin(), listed.end(), [&](std::uint32_t r) {
            return (r & ~format::kSharedReference) == missed.at_a;
        });
        if (!lists) continue;
        if (any) std::fputs(",\n", file);
        any = true;
        const std::uint64_t key = index.nodes[node].key;
        write_box(file, octree_box(grid, octree_place(key), level_of(key)), "");
    }
    std::fputs("\n ],\n \"surface_a\": [\n", file);
    any = false;
    const double reach = 0.75 * missed.size;
    for (std::uint32_t i = 0; i < a.triangle_count(); ++i) {
        const Corners t = still.corners(i);
        if (std::hypot(t[0].x - in_a[0].x, t[0].y - in_a[0].y, t[0].z - in_a[0].z) > reach) {
            continue;
        }
        if (any) std::fputs(",\n", file);
        any = true;
        write_corners(file, "    ", t, "");
    }
    std::fputs("\n ]}\n", file);
    std::fclose(file);
}

struct Arguments {
    std::filesystem::path bakes, poses;
    build::OctreeOptions octree;
    int rounds;
    CellSearch search = CellSearch::sorted;
    std::filesystem::path missed = "-";
    std::vector<std::string> pairs = {};
};

CellSearch search_named(const char* name) {
    if (std::strcmp(name, "modulus") == 0) return CellSearch::modulus;
    if (std::strcmp(name, "mixed") == 0) return CellSearch::mixed;
    if (std::strcmp(name, "sorted") != 0)
        stop(std::string(name) + " is not a method to find a cell.");
    return CellSearch::sorted;
}

void run(const Arguments& arguments) {
    std::printf("pair,set,poses");
    for (const Mean& mean : kMeans) std::printf(",%s", mean.name);
    std::printf(",recall,bvh_us,repaired_us,literal_us,repaired_times,literal_times\n");
    std::map<std::string, test::OpenModel> models;
    const auto model = [&](const std::string& name) -> const Model& {
        auto at = models.find(name);
        if (at == models.end()) {
            const auto path = arguments.bakes / (name + ".cdp.h5");
            at = models.emplace(name, open_with_octree(path, arguments.octree)).first;
        }
        return at->second.model;
    };
    Missed missed;
    for (const std::string& pair : arguments.pairs) {
        const std::size_t dash = pair.find('-');
        if (dash == std::string::npos) stop("'" + pair + "' is not two names with a dash between");
        const Model& a = model(pair.substr(0, dash));
        const Model& b = model(pair.substr(dash + 1));
        const std::vector<Pose> all = read_poses(arguments.poses / (pair + ".pose"));
        Study study(a, b, arguments.search);
        for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
            const std::vector<Pose> poses = poses_of_kind(all, kind, kKinds.size());
            Row row;
            for (const Pose& pose : poses) {
                study.ask(pose, arguments.rounds, row);
                keep_larger(study, pair, a, b, pose, missed);
            }
            print(pair, kKinds[kind], poses.size(), row);
        }
    }
    if (arguments.missed == "-" || missed.size == 0) return;
    const std::size_t dash = missed.pair.find('-');
    write_missed(arguments.missed, missed, model(missed.pair.substr(0, dash)),
                 model(missed.pair.substr(dash + 1)), arguments.search);
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    if (count < 6) {
        std::fprintf(stderr,
                     "usage: %s BAKES POSES LEVEL THRESHOLD ROUNDS [SEARCH [MISSED [PAIR...]]]\n",
                     arguments[0]);
        return 2;
    }
    cdprep::Arguments asked{arguments[1], arguments[2], {}, std::max(1, std::atoi(arguments[5]))};
    asked.octree.level = static_cast<std::uint32_t>(std::atoi(arguments[3]));
    asked.octree.threshold = static_cast<std::uint32_t>(std::atoi(arguments[4]));
    if (count > 6) asked.search = cdprep::search_named(arguments[6]);
    if (count > 7) asked.missed = arguments[7];
    asked.pairs =
        cdprep::pairs_or_all({arguments + std::min(count, 8), arguments + count}, asked.poses);
    cdprep::run(asked);
}
