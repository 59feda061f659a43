// SPDX-License-Identifier: MIT
// T and B: which triangles of two meshes overlap, asked of the hierarchy with every kind of
// bounds, of every structure, on several threads, of hulls, and through the C face. The truth
// is known by hand or by the definition in exact numbers.
#include <algorithm>
#include <utility>

#include "accuracy/asked_models.h"
#include "accuracy/hard_cases.h"
#include "accuracy/in_mode.h"
#include "accuracy/mesh_variants.h"
#include "support/brute_force.h"
#include "support/exact_pairs.h"
#include "support/hard_triangles.h"
#include "support/run_threads.h"
#include "support/small_hull.h"
#include "support/waiting_leaves.h"

#include "cdprep/advanced/convex_penetration.h"
#include "cdprep/cells.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/pairs.h"
#include "cdprep/parallel.h"
#ifdef CDPREP_HAVE_TOOLS
#include "cell_searches/literal_octree.h"
#endif

namespace cdprep::test {
namespace {

using Pairs = std::vector<TrianglePair>;

/// What must be said.
struct Truth {
    Pairs closed;
    Pairs proper;
    bool is_nested = false;
};

constexpr std::array kDescents = {Descent::larger, Descent::a_first, Descent::b_first,
                                  Descent::both};
constexpr std::array kSearches = {CellSearch::sorted, CellSearch::modulus, CellSearch::mixed};
constexpr std::array kSearchNames = {"sorted", "modulus", "mixed"};

std::string counted(const Pairs& found, const Pairs& expected) {
    return std::to_string(found.size()) + " pairs for " + std::to_string(expected.size());
}

/// Asks about one variant of one case.
class Asker {
public:
    Asker(Scoreboard& board, const std::string& id) : board_(board), id_(id) {}

    void ask(const MeshVariant& variant, const Truth& truth) {
        const std::size_t turn = turn_++;
        a_ = &a_model_.emplace(variant.a, turn);
        b_ = &b_model_.emplace(variant.b, turn);
        variant_ = &variant;
        ask_hierarchy(truth);
        ask_tolerances(truth);
        ask_trees(truth, turn);
        ask_hashed(truth, turn);
        if (turn % 4 == 0) ask_threads(truth, 1 + turn / 4 % kMostThreads);
        if (turn % 4 == 2) ask_c_face(truth);
    }

private:
    static constexpr std::size_t kMostThreads = 16;

    template <class Told>
    void expect(const std::string& strategy, bool is_right, Told&& told) {
        board_.of(id_, strategy).expect(is_right, [&] {
            return id_ + ": " + variant_->name + ": " + told();
        });
    }
    void expect(const std::string& strategy, bool is_right) {
        expect(strategy, is_right, [] { return "yes for no, or no for yes"; });
    }
    void expect_pairs(const std::string& strategy, const Pairs& found, const Pairs& expected) {
        expect(strategy, found == expected, [&] { return counted(found, expected); });
    }

    void ask_hierarchy(const Truth& truth) {
        const std::string name = std::string("bvh/") + a_->bounds();
        const Model &a = a_->model(), &b = b_->model();
        const Placement& placement = variant_->placement;
        const auto overlapping = [&](const Pairs& expected, const PairOptions& options) {
            return listed(expected, [&](std::span<TrianglePair> pairs) {
                return in_mode([&] {
                    return overlaps({a, b, placement, options}, workspace_, pairs);
                });
            });
        };
        expect_pairs(name, overlapping(truth.closed, {}), truth.closed);
        expect_pairs(name, overlapping(truth.proper, {.overlap = Overlap::proper}), truth.proper);
        PairCache cache;
        for (int i = 0; i < 2; ++i) {
            const Collision found = in_mode([&] {
                return collide({a, b, placement, {}, &cache}, workspace_);
            });
            expect(name, (found.hit == Answer::yes) == !truth.closed.empty());
        }
        if (truth.is_nested) {
            const Collision solid = in_mode([&] {
                return collide({a, b, placement, {.body = Body::solid}}, workspace_);
            });
            expect(name, solid.hit == Answer::yes && solid.containment.answer == Answer::yes);
        }
    }

    /// Within 0 of each other are those that touch.
    void ask_tolerances(const Truth& truth) {
        const std::string name = "within 0/" + std::string(a_->bounds());
        const Model &a = a_->model(), &b = b_->model();
        const Pairs near = listed(truth.closed, [&](std::span<TrianglePair> pairs) {
            return in_mode([&] {
                return pairs_within({a, b, variant_->placement}, 0, workspace_, pairs);
            });
        });
        expect_pairs(name, near, truth.closed);
        expect(name, in_mode([&] {
                         return within({a, b, variant_->placement}, 0, workspace_);
                     }) != truth.closed.empty());
    }

    /// All that a question lists. It is asked once where as many fit as are expected; at some
    /// turns there is no room at first, and it may only count.
    template <class Question>
    [[nodiscard]] Pairs listed(const Pairs& expected, Question&& question) const {
        constexpr std::size_t kCountedFirst = 5;  // prime to the descents
        Pairs pairs(turn_ % kCountedFirst == 0 ? 0 : expected.size());
        const std::size_t count = question(pairs);
        const bool all_fit = count <= pairs.size();
        pairs.resize(count);
        if (!all_fit) pairs.resize(question(pairs));
        return pairs;
    }

    void expect_through(const std::string& strategy, const StructureOptions& options,
                        const Pairs& expected, const PairOptions& overlap = {}) {
        expect_pairs(strategy, through(options, expected, overlap), expected);
    }
    [[nodiscard]] Pairs through(const StructureOptions& options, const Pairs& expected,
                                const PairOptions& overlap = {}) {
        return listed(expected, [&](std::span<TrianglePair> pairs) {
            return in_mode([&] {
                return overlaps_through({a_->model(), b_->model(), variant_->placement, overlap},
                                        options, workspace_, pairs);
            });
        });
    }

    void ask_trees(const Truth& truth, std::size_t turn) {
        const Descent descent = kDescents[turn % kDescents.size()];
        const std::string boxes = turn % 2 == 1 ? "/boxes" : "/plain";
        for (const auto& [structure, name] : {std::pair(Structure::octree, "octree"),
                                              std::pair(Structure::adaptive_octree, "adaptive"),
                                              std::pair(Structure::tetra_tree, "tetra-tree"),
                                              std::pair(Structure::pieces, "pieces")}) {
            const std::string strategy =
                structure == Structure::pieces ? "pieces/scattered" : name + boxes;
            StructureOptions options = {.structure = structure, .descent = descent};
            expect(strategy, in_mode([&] {
                                 return any_overlap_through(
                                     {a_->model(), b_->model(), variant_->placement}, options,
                                     workspace_);
                             }) == !truth.closed.empty());
            expect_through(strategy, options, truth.closed);
            expect_through(strategy, options, truth.proper, {.overlap = Overlap::proper});
            if (turn % 3 != 0) continue;
            options.leaf_test = LeafTest::feito_torres;
            expect_through(strategy, options, truth.closed);
        }
    }

    void ask_hashed(const Truth& truth, std::size_t turn) {
        const std::size_t search = turn % kSearches.size();
        expect_through(std::string("hashed/") + kSearchNames[search],
                       {.structure = Structure::hashed_octree, .search = kSearches[search]},
                       truth.closed);
#ifdef CDPREP_HAVE_TOOLS
        ask_literally(truth);
#endif
    }

#ifdef CDPREP_HAVE_TOOLS
    /// The talk's search misses some; it may not make up any.
    void ask_literally(const Truth& truth) {
        Pairs found;
        const auto keep = [&](const TrianglePair& pair) {
            found.push_back(pair);
            return true;
        };
        (void)in_mode([&] {
            return study::visit_literal_overlaps(a_->model(), b_->model(), variant_->placement, {},
                                                 keep);
        });
        std::sort(found.begin(), found.end());
        expect("literal/talk",
               std::includes(truth.closed.begin(), truth.closed.end(), found.begin(), found.end()),
               [&] { return counted(found, truth.closed); });
        board_.of(id_, "literal/talk").missed += truth.closed.size() - found.size();
    }
#endif

    void ask_threads(const Truth& truth, std::size_t threads) {
        std::vector<Workspace>& workers = workers_of();
        Pairs pairs(truth.closed.size());
        const std::size_t count = in_mode([&] {
            return split_overlaps({a_->model(), b_->model(), variant_->placement},
                                  std::span(workers).first(threads), run_threads, pairs);
        });
        pairs.resize(std::min(count, pairs.size()));
        expect("threads/1 to 16", count == truth.closed.size() && pairs == truth.closed,
               [&] { return counted(pairs, truth.closed); });
    }
    static std::vector<Workspace>& workers_of() {
        static std::vector<Workspace> workers(kMostThreads);
        return workers;
    }

    void ask_c_face(const Truth& truth) {
        const CModel a(a_->bytes()), b(b_->bytes());
        const cdprep_pair pair = in_c(a, b, variant_->placement);
        std::vector<cdprep_overlap> found(truth.closed.size());
        cdprep_overlap_list list = {found.data(), found.size(), 0};
        const int code = cdprep_overlaps(&pair, c_workspace_.get(), &list, nullptr);
        Pairs pairs;
        for (const auto& overlap : found) pairs.push_back({overlap.a, overlap.b});
        expect("C face", code == CDPREP_OK && list.count == pairs.size() && pairs == truth.closed,
               [&] { return std::to_string(list.count) + " pairs"; });
        cdprep_collision collision{};
        (void)cdprep_collide(&pair, c_workspace_.get(), &collision, nullptr);
        expect("C face", collision.hit == (truth.closed.empty() ? CDPREP_NO : CDPREP_YES));
    }

    Scoreboard& board_;
    std::string id_;
    std::size_t turn_ = 0;
    std::optional<AskedModel> a_model_;
    std::optional<AskedModel> b_model_;
    const AskedModel* a_ = nullptr;
    const AskedModel* b_ = nullptr;
    const MeshVariant* variant_ = nullptr;
    Workspace workspace_{cells()};
    CWorkspace c_workspace_;
};

TestMesh mesh_of(const Corners& t) {
    return {{t[0], t[1], t[2]}, {{{0, 1, 2}}}};
}

/// A triangle is convex: hulls have to say the same, and how far those are apart that do not
/// touch is not 0.
void ask_as_hulls(const HardPair& pair, Scoreboard& board, const std::string& change) {
    const SmallHull a(pair.a, Edges::none), b(pair.b, Edges::none);
    const Placement still = Placement::b_moves(Pose());
    const auto told = [&] { return pair.id + ": " + change; };
    const auto distance = in_mode([&] { return convex_distance(a.view(), b.view(), still); });
    Tally& tally = board.of(pair.id, "hulls/GJK");
    tally.expect(in_mode([&] { return convex_collide(a.view(), b.view(), still); }) == pair.closed,
                 told);
    tally.expect((distance->upper == 0) == pair.closed, told);
    board.of(pair.id, "hulls/EPA")
        .expect(in_mode([&] {
                    return convex_penetration(a.view(), b.view(), still);
                }).has_value() == pair.closed,
                told);
}

/// The predicates alone, without boxes.
void ask_predicates(const HardPair& pair, Scoreboard& board, const std::string& change) {
    const auto told = [&] { return pair.id + ": " + change; };
    const TriangleContact kind = classify_contact(pair.a, pair.b);
    Tally& signs = board.of(pair.id, "predicate/signs");
    signs.expect(triangles_touch(pair.a, pair.b) == pair.closed, told);
    signs.expect((kind != TriangleContact::disjoint) == pair.closed, told);
    signs.expect((kind == TriangleContact::cross || kind == TriangleContact::coplanar_overlap) ==
                     pair.proper,
                 told);
    board.of(pair.id, "predicate/segments")
        .expect(triangles_touch_by_segments(pair.a, pair.b) == pair.closed, told);
}

/// None is singular. Coordinates come to have as many bits as doubles hold, which is more than
/// machine integers decide, and no axis keeps its zeros.
constexpr std::array<std::array<double, 9>, 3> kMatrices = {
    {{134'217'757, 71'303'171, -100'663'319, 67'108'879, -134'217'689, 83'886'091, 92'274'701,
      109'051'909, 125'829'133},
     {201, -77, 131, 59, 173, -211, -145, 99, 237},
     {1'048'583, 786'433, -524'309, -917'519, 655'373, 983'063, 458'761, -851'981, 720'899}}};

/// The same pair under all relabellings and turns, scaled, sheared, and away from the origin.
std::vector<std::pair<std::string, HardPair>> variants_of(const HardPair& pair, bool full) {
    std::vector<std::pair<std::string, HardPair>> all;
    for (std::size_t i = 0; i < kRelabellings; ++i) {
        all.emplace_back("relabelling " + std::to_string(i), relabelled(pair, i));
    }
    for (std::size_t i = 0; i < kAxisTurns; ++i) {
        all.emplace_back("turn " + std::to_string(i), turned(relabelled(pair, 11 * i % 72), i));
        if (!full) continue;
        for (std::size_t label = 1; label < kRelabellings; ++label) {
            all.emplace_back("turn and relabelling", turned(relabelled(pair, label), i));
        }
    }
    std::size_t label = 5;
    for (const int exponent : {-1060, -300, -40, -20, 20, 40, 300, 900}) {
        if (const auto changed = scaled(pair, exponent)) {
            all.emplace_back("times 2^" + std::to_string(exponent),
                             relabelled(*changed, label += 7));
        }
    }
    for (const auto& matrix : kMatrices) {
        if (const auto changed = mapped(pair, matrix)) {
            all.emplace_back("sheared", relabelled(*changed, label += 7));
            all.emplace_back("sheared and turned", turned(*changed, label));
        }
    }
    for (const double shift : {0x1p20, -0x1p20, 0x1p40}) {
        if (const auto changed = shifted(pair, shift)) {
            all.emplace_back("plus " + std::to_string(shift), relabelled(*changed, label += 7));
        }
    }
    return all;
}

/// T15, T17, T18 and T20 are ways to place the others.
std::string family_of(const std::string& change, const std::string& id) {
    if (change == "plus " + std::to_string(0x1p40)) return "T15, " + id;
    if (change == "times 2^-1060") return "T17, " + id;
    if (change == "times 2^300" || change == "times 2^900") return "T18, " + id;
    if (change.starts_with("relabelling")) return "T20, " + id;
    return id;
}

/// Each pair in each of its guises, named for its family.
template <class Ask>
void for_all_triangles(const HardCaseOptions& options, Ask&& ask) {
    for (const HardPair& pair : hard_triangles()) {
        for (const auto& [change, other] : variants_of(pair, options.size == CaseSize::full)) {
            HardPair named = other;
            named.id = family_of(change, pair.id);
            if (options.wants(named.id)) ask(named, change);
        }
    }
}

void score_triangles(const HardCaseOptions& options, Scoreboard& board) {
    for_all_triangles(options, [&](const HardPair& pair, const std::string& change) {
        ask_as_hulls(pair, board, change);
    });
    std::map<std::string, Asker> askers;
    for (const HardPair& pair : hard_triangles()) {
        const Pairs one = {{0, 0}};
        const Truth truth = {pair.closed ? one : Pairs{}, pair.proper ? one : Pairs{}};
        for (const auto& [change, other] : variants_of(pair, false)) {
            const std::string id = family_of(change, pair.id);
            if (!options.wants(id)) continue;
            const MeshVariant variant = {change, mesh_of(other.a), mesh_of(other.b),
                                         Placement::b_moves(Pose())};
            askers.try_emplace(id, board, id).first->second.ask(variant, truth);
        }
    }
}

/// Too many pairs to list: they are counted.
void score_count(const HardMeshes& hard, Scoreboard& board) {
    const AskedModel a(hard.a, 1), b(hard.b, 1);
    Workspace workspace(cells());
    const std::size_t count = in_mode([&] {
        return overlaps({a.model(), b.model(), hard.placement}, workspace, {});
    });
    board.of(hard.id, "bvh/oriented").expect(count == *hard.count, [&] {
        return hard.id + ": " + std::to_string(count) + " pairs";
    });
}

/// F02: a leaf that was put together gave way to another while a pair that waited for its test
/// pointed to it, where a batch was tested amid a pair of leaves. How many are tested at once
/// must not matter.
void score_waiting_leaves(const HardCaseOptions& options, Scoreboard& board) {
    Workspace workspace(cells());
    for (const std::uint32_t seed : {64U, 65U, 66U}) {
        const WaitingLeaves leaves =
            waiting_leaves(seed, options.size == CaseSize::full ? 30'000 : 3'000);
        const Pairs expected = pairs_in_leaves(leaves, 1, workspace);
        for (const std::size_t views :
             {kernels::kLeafBatch, kernels::kLeafBatch - 1, std::size_t{5}}) {
            const Pairs found = pairs_in_leaves(leaves, views, workspace);
            board.of("F02", "pieces/scattered").expect(found == expected, [&] {
                return "F02 seed " + std::to_string(seed) + ": " + counted(found, expected);
            });
        }
    }
}

}  // namespace

void score_predicates(const HardCaseOptions& options, Scoreboard& board) {
    for_all_triangles(options, [&](const HardPair& pair, const std::string& change) {
        ask_predicates(pair, board, change);
    });
}

void score_overlaps(const HardCaseOptions& options, Scoreboard& board) {
    score_triangles(options, board);
    if (options.wants("F02")) score_waiting_leaves(options, board);
    for (const HardMeshes& hard : hard_meshes(options.size)) {
        if (!options.wants(hard.id)) continue;
        if (hard.count && !hard.closed) {
            score_count(hard, board);
            continue;
        }
        Truth truth = {{}, {}, hard.is_nested};
        if (hard.closed) {
            truth.closed = *hard.closed;
            truth.proper = *hard.proper;
        } else {
            ExactPairs pairs = exact_pairs(hard.a, hard.b, hard.placement);
            truth.closed = std::move(pairs.closed);
            truth.proper = std::move(pairs.proper);
        }
        constexpr std::size_t kMany = 200;
        const bool few = hard.a.triangles.size() + hard.b.triangles.size() > kMany;
        // In the short form large meshes are asked in every other guise, and the many placements in
        // which libraries fail in every fifth.
        const bool full = options.size == CaseSize::full;
        const std::size_t step = full ? 1 : hard.id.starts_with("F01") ? 5 : few ? 2 : 1;
        Asker asker(board, hard.id);
        const std::vector<MeshVariant> variants =
            mesh_variants(hard.a, hard.b, hard.placement, few);
        for (std::size_t i = 0; i < variants.size(); i += step) {
            const MeshVariant& variant = variants[i];
            asker.ask(variant,
                      {variant.told(truth.closed), variant.told(truth.proper), truth.is_nested});
        }
    }
}

}  // namespace cdprep::test
