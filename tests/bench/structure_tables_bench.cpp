// SPDX-License-Identifier: MIT
// The published table of spatial decompositions, measured anew: how long each takes to
// build, how large it is, and what it is like.
//
// Usage: structure_tables_bench [ROUNDS [CSV]]
// Reads the test models (support/seed_mesh.h). Equal positions are merged, triangles that
// then repeat a corner dropped, the rest brought into tree order, as a bake does; every
// structure is built from the very same arrays, whose hash is printed. Each way of building
// takes its turn, ROUNDS times (5), on one thread and on all; seconds are medians. Prints a
// table for people, what the published figures imply, and whether what was published
// about their order holds; writes all figures to CSV, if named.
//
// Settings: `paper`, 512 leaf cells each; `nearest`, the level and threshold that come nearest
// to the published size; `tuned`.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <thread>
#include <tuple>

#include "bench_input.h"
#include "cdprep/build_adaptive_octree.h"
#include "cdprep/build_bvh.h"
#include "cdprep/build_octree.h"
#include "cdprep/build_tetra_tree.h"
#include "cdprep/format/checksum.h"
#include "cdprep/octree_figures.h"
#include "cdprep/structure_presets.h"
#include "cdprep/tetra_figures.h"
#include "crew.h"
#include "support/seed_mesh.h"

namespace cdprep {
namespace {

using Clock = std::chrono::steady_clock;
using build::TreeLimits;
constexpr double kMebibyte = 1 << 20;

/// What was published of one structure over one model.
struct Published {
    double seconds;
    double mebibytes;
    const char* erratum;  ///< what cannot be right about it, or nothing
};

/// A row of the published table.
struct PublishedModel {
    const char* name;
    std::uint32_t triangles;
    Published tetra_tree;
    Published octree;
};
constexpr std::array<PublishedModel, 6> kPublished = {{
    {"Horse", 7172, {0.427, 0.0351, ""}, {0.496, 0.0399, ""}},
    {"Skull", 40000, {2.49, 0.2608, ""}, {4.329, 0.261, ""}},
    {"Bunny", 69451, {4.544, 0.4211, ""}, {8.744, 0.3254, ""}},
    {"Armadillo", 345944, {28.184, 2.0322, ""}, {44.579, 1.6549, ""}},
    {"Dragon",
     869928,
     {70.25, 4.8031, ""},
     {104.68, 2.1975, "erratum: less than 4 bytes a triangle"}},
    {"Buddha", 1085634, {84.704, 5.5607, ""}, {138.542, 4.8717, ""}},
}};

/// A model that stands for one of these, and how it came to be.
struct Source {
    const char* file;
    std::size_t published;
    const char* what;
};
constexpr std::array<Source, 9> kSources = {{
    {"horse", 0, "the published counts"},
    {"skull", 1, "the published counts"},
    {"bunny", 2, "the published counts"},
    {"armadillo_standin", 3, "stand-in: 99976 triangles subdivided, then reduced to the count"},
    {"armadillo", 3, "reduced original: 99976 triangles"},
    {"dragon_869928", 4, "the published count: the original rounded to 6 decimals"},
    {"dragon", 4, "the original: 871414 triangles"},
    {"buddha_standin", 5, "stand-in: 100000 triangles subdivided, then reduced to about the count"},
    {"buddha", 5, "reduced original: 100000 triangles"},
}};

/// A model as builders get it.
struct Input {
    std::vector<Double3> positions;
    std::vector<format::Triangle> triangles;
    build::Frame frame;
};

std::uint64_t hash_of(std::span<const Double3> positions,
                      std::span<const format::Triangle> triangles) {
    std::vector<std::byte> bytes;
    for (const auto part : {std::as_bytes(positions), std::as_bytes(triangles)}) {
        bytes.insert(bytes.end(), part.begin(), part.end());
    }
    return format::checksum(bytes);
}

/// Equal positions merged, triangles that repeat a corner left out.
test::TestMesh welded(const test::TestMesh& mesh) {
    test::TestMesh result;
    std::map<std::tuple<double, double, double>, std::uint32_t> number_at;
    std::vector<std::uint32_t> number;
    for (const Double3& p : mesh.positions) {
        const auto next = static_cast<std::uint32_t>(result.positions.size());
        const auto [place, is_new] = number_at.try_emplace({p.x, p.y, p.z}, next);
        if (is_new) result.positions.push_back(p);
        number.push_back(place->second);
    }
    for (format::Triangle triangle : mesh.triangles) {
        auto& [a, b, c] = triangle.vertex;
        a = number[a];
        b = number[b];
        c = number[c];
        if (a != b && b != c && c != a) result.triangles.push_back(triangle);
    }
    return result;
}

/// In tree order, vertices in the order of their first use.
Input in_tree_order(const test::TestMesh& mesh) {
    const build::Bvh bvh = build::build_bvh(mesh.positions, mesh.triangles);
    constexpr std::uint32_t kUnused = 0xffffffff;
    std::vector<std::uint32_t> number(mesh.positions.size(), kUnused);
    Input input;
    input.frame = bvh.frame;
    for (const std::uint32_t source : bvh.order) {
        format::Triangle triangle = mesh.triangles[source];
        for (std::uint32_t& vertex : triangle.vertex) {
            if (number[vertex] == kUnused) {
                number[vertex] = static_cast<std::uint32_t>(input.positions.size());
                input.positions.push_back(mesh.positions[vertex]);
            }
            vertex = number[vertex];
        }
        input.triangles.push_back(triangle);
    }
    return input;
}

/// What one build came to.
struct Figures {
    std::uint64_t nodes_all;  ///< with those that no triangle touches
    std::uint64_t nodes;      ///< without
    std::uint64_t leaves;
    std::uint64_t references;
    std::uint64_t largest_leaf;
    std::uint64_t formula_all;  ///< bytes by the published formula, over nodes_all
    std::uint64_t formula;      ///< over nodes
    std::uint64_t bytes;
    std::uint64_t hash;  ///< of what it was built from
};

Figures octree_row(const OctreeFigures& f) {
    return {f.nodes + f.empty_children,
            f.nodes,
            f.leaves,
            f.references,
            f.largest_leaf,
            seed_formula_bytes(f, EmptyChildren::counted),
            seed_formula_bytes(f, EmptyChildren::left_out),
            f.bytes,
            0};
}

Figures tetra_row(const TetraFigures& f) {
    TetraFigures stored = f;
    stored.empty_cones = 0;
    return {f.nodes + f.empty_cones,
            f.nodes,
            f.leaves,
            f.references,
            f.largest_leaf,
            seed_formula_bytes(f),
            seed_formula_bytes(stored),
            f.bytes,
            0};
}

enum class Kind : std::uint8_t {
    tetra_tree,
    octree,
    hashed_octree,
    adaptive_median,
    adaptive_area
};

constexpr std::array<const char*, 5> kKindNames = {"tetra-tree", "octree", "hashed octree",
                                                   "adaptive, median", "adaptive, area"};

/// Builds and describes; only the building is timed.
struct Built {
    Figures figures;
    double seconds;
};
template <class Build, class Describe>
Built timed(Build build, Describe describe) {
    const Clock::time_point begun = Clock::now();
    const auto tree = build();
    const double seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    return {describe(tree), seconds};
}

/// With the boxes that `tuned` has, or none.
Built build_once(const Input& input, Kind kind, const TreeLimits& limits, bool boxes,
                 ParallelFor parallel_for) {
    const auto boxes_in = boxes ? std::optional(input.frame) : std::nullopt;
    const std::span<const Double3> positions = input.positions;
    const std::span<const format::Triangle> triangles = input.triangles;
    const auto [level, threshold] = limits;
    Built built{};
    switch (kind) {
        case Kind::tetra_tree:
            built = timed(
                [&] {
                    return build::build_tetra_tree(positions, triangles,
                                                   {.parallel_for = parallel_for,
                                                    .level = level,
                                                    .threshold = threshold,
                                                    .bounding = boxes ? format::TetraBounding::boxes
                                                                      : format::TetraBounding::caps,
                                                    .frame_exponent = input.frame.exponent,
                                                    .frame_origin = input.frame.origin});
                },
                [&](const build::TetraTree& tree) {
                    return tetra_row(tetra_figures(tree, positions, triangles));
                });
            break;
        case Kind::octree:
        case Kind::hashed_octree:
            built = timed(
                [&] {
                    return build::build_octree(positions, triangles,
                                               {.parallel_for = parallel_for,
                                                .level = level,
                                                .threshold = threshold,
                                                .hashed = kind == Kind::hashed_octree,
                                                .boxes_in = boxes_in});
                },
                [&](const build::Octree& tree) {
                    return octree_row(octree_figures(tree, triangles.size()));
                });
            break;
        case Kind::adaptive_median:
        case Kind::adaptive_area:
            built = timed(
                [&] {
                    return build::build_adaptive_octree(
                        positions, triangles,
                        {.parallel_for = parallel_for,
                         .level = level,
                         .threshold = threshold,
                         .rule = kind == Kind::adaptive_median ? format::SplitRule::median
                                                               : format::SplitRule::surface_area,
                         .boxes_in = boxes_in});
                },
                [&](const build::AdaptiveOctree& tree) {
                    return octree_row(adaptive_octree_figures(tree, triangles.size()));
                });
            break;
    }
    built.figures.hash = hash_of(positions, triangles);
    return built;
}

/// One structure at one setting.
struct Row {
    std::string setting;
    Kind kind;
    TreeLimits limits;
    bool boxes = false;  ///< around what cells hold
    Figures figures = {};
    std::vector<double> seconds_one = {};
    std::vector<double> seconds_all = {};
};

TreeLimits limits_of(const build::StructurePreset& preset, Kind kind) {
    if (kind == Kind::tetra_tree) return preset.tetra_tree;
    if (kind == Kind::hashed_octree) return preset.hashed_octree;
    return kind == Kind::octree ? preset.octree : preset.adaptive_octree;
}

/// What was published of it; nothing where there is too little to compare: of a model whose
/// triangles are not about as many.
const Published* published_of(const PublishedModel& model, std::size_t triangles, Kind kind) {
    const double less = static_cast<double>(triangles) / model.triangles;
    if (less < 0.99 || less > 1.01) return nullptr;
    if (kind == Kind::tetra_tree) return &model.tetra_tree;
    return kind == Kind::octree ? &model.octree : nullptr;
}

/// The settings at which a structure comes nearest to the published size: the first level at
/// which it is as large, not less than that of `paper`, and there the nearest threshold of
/// powers of two.
TreeLimits nearest_limits(const Input& input, Kind kind, const Published& published,
                          ParallelFor parallel_for) {
    constexpr std::uint32_t kMostLevel = 8;
    const auto excess = [&](const TreeLimits& limits) {
        const Built built = build_once(input, kind, limits, false, parallel_for);
        return static_cast<double>(built.figures.formula_all) / kMebibyte - published.mebibytes;
    };
    TreeLimits limits = limits_of(build::kPaperPreset, kind);
    double at_limits = excess(limits);
    while (at_limits < 0 && limits.level < kMostLevel) {
        ++limits.level;
        at_limits = excess(limits);
    }
    TreeLimits best = limits;
    double least = std::fabs(at_limits);
    // Sizes fall with the threshold.
    while (at_limits > 0 && limits.threshold < input.triangles.size()) {
        limits.threshold *= 2;
        at_limits = excess(limits);
        if (std::fabs(at_limits) < least) {
            least = std::fabs(at_limits);
            best = limits;
        }
    }
    return best;
}

std::vector<Row> rows_of(const Input& input, const PublishedModel& published,
                         ParallelFor parallel_for) {
    std::vector<Row> rows;
    for (const Kind kind : {Kind::tetra_tree, Kind::octree, Kind::hashed_octree,
                            Kind::adaptive_median, Kind::adaptive_area}) {
        rows.push_back({"paper", kind, limits_of(build::kPaperPreset, kind)});
    }
    for (const Kind kind : {Kind::tetra_tree, Kind::octree}) {
        const Published* figures = published_of(published, input.triangles.size(), kind);
        // Nothing is tuned to an erratum.
        if (figures == nullptr || *figures->erratum != '\0') continue;
        rows.push_back({"nearest", kind, nearest_limits(input, kind, *figures, parallel_for)});
    }
    for (const Kind kind : {Kind::tetra_tree, Kind::octree, Kind::hashed_octree,
                            Kind::adaptive_median, Kind::adaptive_area}) {
        rows.push_back(
            {"tuned", kind, limits_of(build::kTunedPreset, kind), build::kTunedPreset.boxes});
    }
    return rows;
}

void time_rows(const Input& input, int rounds, Crew& crew, std::vector<Row>& rows) {
    for (int round = -1; round < rounds; ++round) {  // the first warms up
        for (Row& row : rows) {
            const Built one = build_once(input, row.kind, row.limits, row.boxes, serial_for);
            const Built all = build_once(input, row.kind, row.limits, row.boxes, crew);
            row.figures = one.figures;
            if (round < 0) continue;
            row.seconds_one.push_back(one.seconds);
            row.seconds_all.push_back(all.seconds);
        }
    }
}

/// Everything measured of one model.
struct Measured {
    Source source;
    std::size_t read_vertices, read_triangles;
    std::uint64_t read_hash;
    std::size_t vertices, triangles;
    std::vector<Row> rows;
};

Measured measure(const Source& source, int rounds, Crew& crew) {
    const auto read = test::seed_mesh_as_read(source.file);
    if (!read) stop(std::string("There is no test model ") + source.file + ".");
    const Input input = in_tree_order(welded(*read));
    Measured measured{source,
                      read->positions.size(),
                      read->triangles.size(),
                      hash_of(read->positions, read->triangles),
                      input.positions.size(),
                      input.triangles.size(),
                      {}};
    measured.rows = rows_of(input, kPublished[source.published], crew);
    time_rows(input, rounds, crew, measured.rows);
    return measured;
}

double mebibytes(std::uint64_t bytes) {
    return static_cast<double>(bytes) / kMebibyte;
}

/// Nodes at most that a tetra-tree of the published size can have, with one reference for
/// each of the published triangles.
double node_bound(const PublishedModel& model) {
    constexpr double kRoot = 340;
    constexpr double kNode = 88;
    const double bytes = model.tetra_tree.mebibytes * kMebibyte;
    return std::floor((bytes - kRoot - 4.0 * model.triangles) / kNode);
}

void print_text(const Measured& m) {
    const PublishedModel& published = kPublished[m.source.published];
    std::printf("\n%s, for %s: %s\n", m.source.file, published.name, m.source.what);
    std::printf("  read %zu vertices, %zu triangles, hash %016llx; built from %zu, %zu, %016llx\n",
                m.read_vertices, m.read_triangles, static_cast<unsigned long long>(m.read_hash),
                m.vertices, m.triangles, static_cast<unsigned long long>(m.rows[0].figures.hash));
    std::printf("  %-8s%-17s%6s%7s%9s%9s%7s%9s%9s%7s%8s%10s%10s%9s  %s\n", "setting", "structure",
                "level", "least", "1 thr, s", "all, s", "M/s", "nodes", "stored", "refs/t",
                "largest", "formula", "stored", "real", "paper");
    for (const Row& row : m.rows) {
        const double seconds = median(row.seconds_one);
        const Figures& f = row.figures;
        const auto count = static_cast<double>(m.triangles);
        std::printf("  %-8s%-17s%6u%7u%9.4f%9.4f%7.2f%9llu%9llu%7.3f%8llu%10.4f%10.4f%9.4f",
                    row.setting.c_str(), kKindNames[static_cast<std::size_t>(row.kind)],
                    row.limits.level, row.limits.threshold, seconds, median(row.seconds_all),
                    1e-6 * count / seconds, static_cast<unsigned long long>(f.nodes_all),
                    static_cast<unsigned long long>(f.nodes),
                    static_cast<double>(f.references) / count,
                    static_cast<unsigned long long>(f.largest_leaf), mebibytes(f.formula_all),
                    mebibytes(f.formula), mebibytes(f.bytes));
        const Published* paper = published_of(published, m.triangles, row.kind);
        if (paper != nullptr && row.setting != "tuned") {
            std::printf("  %.3f s, %.4f MiB; here 1/%.0f and %.2f times%s%s", paper->seconds,
                        paper->mebibytes, paper->seconds / seconds,
                        mebibytes(f.formula_all) / paper->mebibytes,
                        *paper->erratum != '\0' ? "; " : "", paper->erratum);
        }
        std::printf("\n");
    }
    std::fflush(stdout);
}

const Row& row_of(const Measured& m, const std::string& setting, Kind kind) {
    return *std::find_if(m.rows.begin(), m.rows.end(), [&](const Row& row) {
        return row.setting == setting && row.kind == kind;
    });
}

const char* yes_or_no(bool yes) {
    return yes ? "yes" : "no";
}

/// What the published figures imply, and whether it holds here.
void print_relations(const std::vector<Measured>& all) {
    std::printf(
        "\nThe published tetra-tree has at most so many nodes, were no triangle listed "
        "twice; ours, and at the settings nearest to its size\n");
    for (const Measured& m : all) {
        const PublishedModel& published = kPublished[m.source.published];
        if (published_of(published, m.triangles, Kind::tetra_tree) == nullptr) continue;
        const double bound = node_bound(published);
        const auto nodes = [&](const char* setting) {
            return row_of(m, setting, Kind::tetra_tree).figures.nodes_all;
        };
        std::printf(
            "  %-18s at most %6.0f; paper setting %4llu (within: %s), nearest %4llu "
            "(within: %s)\n",
            m.source.file, bound, static_cast<unsigned long long>(nodes("paper")),
            yes_or_no(static_cast<double>(nodes("paper")) <= bound),
            static_cast<unsigned long long>(nodes("nearest")),
            yes_or_no(static_cast<double>(nodes("nearest")) <= bound));
    }
    std::printf(
        "\nThe tetra-tree is built faster than the octree: published for every model; "
        "here, seconds of the octree by those of the tetra-tree\n");
    for (const Measured& m : all) {
        const PublishedModel& published = kPublished[m.source.published];
        std::printf("  %-18s published %.2f;", m.source.file,
                    published.octree.seconds / published.tetra_tree.seconds);
        for (const char* setting : {"paper", "tuned"}) {
            const Row& tetra = row_of(m, setting, Kind::tetra_tree);
            const Row& octree = row_of(m, setting, Kind::octree);
            const double one = median(octree.seconds_one) / median(tetra.seconds_one);
            const double many = median(octree.seconds_all) / median(tetra.seconds_all);
            std::printf(" %s %.2f on one thread (%s), %.2f on all (%s);", setting, one,
                        yes_or_no(one > 1), many, yes_or_no(many > 1));
        }
        std::printf("\n");
    }
    for (const Measured& m : all) {
        if (std::string(m.source.file) != "bunny") continue;
        const double tetra = mebibytes(row_of(m, "paper", Kind::tetra_tree).figures.formula_all);
        const double octree = mebibytes(row_of(m, "paper", Kind::octree).figures.formula_all);
        std::printf(
            "\nBunny, whose published mesh this is, at the paper's setting: tetra-tree %.4f "
            "MiB (0.37 to 0.43: %s), octree %.4f MiB (0.33 to 0.35: %s)\n",
            tetra, yes_or_no(tetra >= 0.37 && tetra <= 0.43), octree,
            yes_or_no(octree >= 0.33 && octree <= 0.35));
    }
    std::printf(
        "\nErrata of the published table\n"
        "  Dragon, octree: 2.1975 MiB is less than 4 bytes for each of 869928 triangles "
        "(3.32 MiB); it cannot be right, and nothing is tuned to it.\n"
        "  Dragon, Buddha: the sizes of PQP beside imply 871145 and 1087339 triangles, not 869928 "
        "and 1085634; the originals have 871414 and 1087716. Structures were built from "
        "different sets of triangles.\n"
        "  Tetra-tree: the root's parts add up to 628 bytes with 24 for a vertex; the 340 of the "
        "formula fit 12. The octree's root has floats, its nodes doubles.\n");
}

void write_csv(const std::string& path, const std::vector<Measured>& all, std::size_t threads) {
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (file == nullptr) stop(path + " cannot be written.");
    std::fprintf(file,
                 "file,published_as,what,vertices_read,triangles_read,hash_read,vertices,triangles,"
                 "hash_built_from,setting,structure,level,threshold,seconds_1,spread_1,seconds_%zu,"
                 "spread_%zu,million_triangles_per_s_1,nodes,nodes_stored,leaves,"
                 "references_per_triangle,largest_leaf,formula_mib,formula_mib_stored,real_bytes,"
                 "published_seconds,published_mib,times_as_fast,times_the_size,erratum\n",
                 threads, threads);
    for (const Measured& m : all) {
        const PublishedModel& model = kPublished[m.source.published];
        for (const Row& row : m.rows) {
            const Figures& f = row.figures;
            const double seconds = median(row.seconds_one);
            const auto count = static_cast<double>(m.triangles);
            std::fprintf(
                file,
                "%s,%s,\"%s\",%zu,%zu,%016llx,%zu,%zu,%016llx,%s,\"%s\",%u,%u,%.5f,%.5f,%.5f,%.5f,"
                "%.2f,%llu,%llu,%llu,%.4f,%llu,%.4f,%.4f,%llu,",
                m.source.file, model.name, m.source.what, m.read_vertices, m.read_triangles,
                static_cast<unsigned long long>(m.read_hash), m.vertices, m.triangles,
                static_cast<unsigned long long>(f.hash), row.setting.c_str(),
                kKindNames[static_cast<std::size_t>(row.kind)], row.limits.level,
                row.limits.threshold, seconds, spread(row.seconds_one), median(row.seconds_all),
                spread(row.seconds_all), 1e-6 * count / seconds,
                static_cast<unsigned long long>(f.nodes_all),
                static_cast<unsigned long long>(f.nodes), static_cast<unsigned long long>(f.leaves),
                static_cast<double>(f.references) / count,
                static_cast<unsigned long long>(f.largest_leaf), mebibytes(f.formula_all),
                mebibytes(f.formula), static_cast<unsigned long long>(f.bytes));
            const Published* paper = published_of(model, m.triangles, row.kind);
            if (paper == nullptr || row.setting == "tuned") {
                std::fprintf(file, ",,,,\n");
                continue;
            }
            std::fprintf(file, "%.3f,%.4f,%.1f,%.3f,%s\n", paper->seconds, paper->mebibytes,
                         paper->seconds / seconds, mebibytes(f.formula_all) / paper->mebibytes,
                         paper->erratum);
        }
    }
    std::fclose(file);
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    using namespace cdprep;
    const int rounds = count > 1 ? std::max(1, std::atoi(arguments[1])) : 5;
    const std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
    Crew crew(threads);
    std::printf(
        "Formula: 340 bytes for a tetra-tree's root, 88 for a cone; 72 for an octree's "
        "root, 80 for a node; 4 for a reference; MiB. First over all nodes, then over "
        "those that some triangle touches, which alone are stored. Real: MiB in the file. "
        "%d rounds, %zu threads.\n",
        rounds, threads);
    std::vector<Measured> all;
    for (const Source& source : kSources) {
        all.push_back(measure(source, rounds, crew));
        print_text(all.back());
    }
    print_relations(all);
    if (count > 2) write_csv(arguments[2], all, threads);
    return 0;
}
