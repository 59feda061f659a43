// SPDX-License-Identifier: MIT
// G: how far convex hulls are apart, and how deep in each other, by the search in double with
// and without edges to climb along, from any cache, by features, through the C face, and by
// the triangles of their surfaces. Truths are known by hand, by the definition in exact
// numbers, or proved for each answer.
#include <algorithm>
#include <cmath>
#include <utility>

#include "accuracy/asked_models.h"
#include "accuracy/exact_change.h"
#include "accuracy/hard_cases.h"
#include "accuracy/in_mode.h"
#include "support/exact_pairs.h"
#include "support/hard_hulls.h"
#include "support/small_hull.h"

#include "cdprep/advanced/convex_penetration.h"
#include "cdprep/pairs.h"

#ifdef CDPREP_HAVE_TOOLS
#include "unit/tools/feature_hull_of.h"
#endif

namespace cdprep::test {
namespace {

using Exact = SquaredLength<ExactNumber>;

/// Two sets of points as they are asked about.
struct HullVariant {
    std::string name;
    Points a;
    Points b;
    Placement placement = Placement::b_moves(Pose());
    int exponent = 0;

    [[nodiscard]] Points placed_a() const {
        return placement.a_is_moved() ? moved_points(a, placement.pose_a()) : a;
    }
    [[nodiscard]] Points placed_b() const {
        return placement.b_is_moved() ? moved_points(b, placement.pose_b()) : b;
    }
};

Points in_any_order(Points points, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::shuffle(points.begin(), points.end(), random);
    return points;
}

std::vector<HullVariant> variants_of(const HardHulls& hard, bool few) {
    const HullVariant as_placed = {"as placed", hard.a, hard.b, hard.placement};
    const Placement exchanged = Placement::world(hard.placement.pose_b(), hard.placement.pose_a());
    std::vector<HullVariant> all = {as_placed,
                                    {"swapped", in_any_order(hard.b, 1), hard.a, exchanged}};
    const Points at_a = as_placed.placed_a(), at_b = as_placed.placed_b();
    std::uint32_t number = 0;
    for (const ExactChange& change : exact_changes(few)) {
        const auto a = change(at_a), b = change(at_b);
        if (!a || !b) continue;
        HullVariant variant = {change.name, in_any_order(*a, ++number), *b};
        variant.exponent = change.exponent;
        if (number % 3 == 0) std::swap(variant.a, variant.b);
        all.push_back(std::move(variant));
    }
    return all;
}

/// How far any point of A is from any of B along an axis.
double size_of_difference(const Points& a, const Points& b) {
    double size = 0;
    for (const auto axis : {&Double3::x, &Double3::y, &Double3::z}) {
        const auto less = [axis](const Double3& p, const Double3& q) { return p.*axis < q.*axis; };
        const auto [a_low, a_high] = std::minmax_element(a.begin(), a.end(), less);
        const auto [b_low, b_high] = std::minmax_element(b.begin(), b.end(), less);
        size = std::max({size, *a_high.*axis - *b_low.*axis, *b_high.*axis - *a_low.*axis});
    }
    return size;
}

double largest_of(const Points& a, const Points& b) {
    double largest = 0;
    for (const Points* points : {&a, &b}) {
        for (const Double3& p : *points) {
            largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
        }
    }
    return largest;
}

/// Without rounding: the point is not in front of any facet.
bool holds(const SmallHull& hull, const Points& at, const Double3& p) {
    return std::all_of(hull.triangles().begin(), hull.triangles().end(), [&](const auto& t) {
        const auto from = [&](const Double3& q) { return ExactPoint<ExactNumber>{q.x, q.y, q.z}; };
        const ExactPoint<ExactNumber> u = minus(from(at[t[1]]), from(at[t[0]]));
        const ExactPoint<ExactNumber> v = minus(from(at[t[2]]), from(at[t[0]]));
        return dot(cross(u, v), minus(from(p), from(at[t[0]]))).sign() <= 0;
    });
}

/// Without rounding: two of their facets have a common point.
bool surfaces_meet(const SmallHull& a, const Points& at_a, const SmallHull& b, const Points& at_b) {
    for (const auto& s : a.triangles()) {
        for (const auto& t : b.triangles()) {
            if (exact_contact({at_a[s[0]], at_a[s[1]], at_a[s[2]]},
                              {at_b[t[0]], at_b[t[1]], at_b[t[2]]}) != TriangleContact::disjoint) {
                return true;
            }
        }
    }
    return false;
}

ConvexPoints without_edges(ConvexPoints hull) {
    hull.neighbour_begins = hull.neighbours = hull.starts = {};
    return hull;
}

class Asker {
    /// What is being asked.
    [[nodiscard]] auto told() const {
        return [this] { return hard_.id + ": " + variant_->name; };
    }

public:
    Asker(Scoreboard& board, const HardHulls& hard) : board_(board), hard_(hard) {
        if (!hard.is_large || hard.gap || hard.depth) truth_ = hull_truth(hard);
    }

    void ask(const HullVariant& variant) {
        variant_ = &variant;
        placed_a_ = variant.placed_a();
        placed_b_ = variant.placed_b();
        const SmallHull a(variant.a), b(variant.b);
        if (!truth_) return ask_with_proof(a, b);
        ask_search("GJK/climb", a.view(), b.view(), nullptr);
        ask_search("GJK/scan", without_edges(a.view()), without_edges(b.view()), nullptr);
        for (int i = 0; i < 3; ++i) {
            ConvexCache cache = nonsense(random_);
            ask_search("GJK/any cache", a.view(), b.view(), &cache);
        }
        ask_depth(a.view(), b.view());
        ask_tolerance(a.view(), b.view());
        ask_features();
        ask_surfaces(a, b);
        ask_c_face(a, b);
    }

private:
    [[nodiscard]] Tally& of(const std::string& strategy) {
        return board_.of(hard_.id, strategy);
    }
    [[nodiscard]] bool meet() const {
        return !truth_->distance;
    }
    /// Whether [lower, upper], which is of the variant's scale, holds the length.
    [[nodiscard]] bool is_held(double lower, double upper, const Exact& length) const {
        const int exponent = -variant_->exponent;
        return lower >= 0 && compare_length(std::ldexp(lower, exponent), length) <= 0 &&
               compare_length(std::ldexp(upper, exponent), length) >= 0;
    }
    [[nodiscard]] double promised_width(double upper) const {
        return 1e-12 * upper + 1e-14 * size_of_difference(placed_a_, placed_b_);
    }

    void expect_distance(Tally& tally, double lower, double upper) {
        if (meet()) {
            tally.expect(lower == 0 && upper == 0, told());
            return;
        }
        tally.expect(upper > 0 && is_held(lower, upper, *truth_->distance), told());
        tally.expect_narrow(upper - lower, promised_width(upper), told());
    }

    void ask_search(const std::string& strategy, const ConvexPoints& a, const ConvexPoints& b,
                    ConvexCache* cache) {
        Tally& tally = of(strategy);
        tally.expect(
            in_mode([&] { return convex_collide(a, b, variant_->placement, cache); }) == meet(),
            told());
        const auto found =
            in_mode([&] { return convex_distance(a, b, variant_->placement, {}, cache); });
        expect_distance(tally, found->lower, found->upper);
    }

    void expect_depth(Tally& tally, bool is_found, double lower, double upper) {
        tally.expect(is_found == meet(), told());
        if (!is_found || !meet() || !truth_->depth) return;
        tally.expect(is_held(lower, upper, *truth_->depth), told());
        constexpr std::size_t kFewEnough = 40;  // for the polytope to have all the corners it needs
        if (hard_.a.size() + hard_.b.size() > kFewEnough) return;
        tally.expect_narrow(upper - lower, 1e-12 * upper + 1e-13 * largest_of(placed_a_, placed_b_),
                            told());
    }

    void ask_depth(const ConvexPoints& a, const ConvexPoints& b) {
        const auto found = in_mode([&] { return convex_penetration(a, b, variant_->placement); });
        expect_depth(of("EPA/cold"), found.has_value(), found ? found->lower : 0,
                     found ? found->upper : 0);
    }

    /// A length is within itself to the last bit.
    void ask_tolerance(const ConvexPoints& a, const ConvexPoints& b) {
        Tally& tally = of("within");
        const auto is_within = [&](double length) {
            const double tolerance = std::ldexp(length, variant_->exponent);
            return in_mode([&] { return convex_within(a, b, variant_->placement, tolerance); });
        };
        tally.expect(is_within(0) == meet(), told());
        if (meet()) return;
        const long double squared = truth_->distance->numerator.approximation() /
                                    truth_->distance->denominator.approximation();
        const auto near = static_cast<double>(std::sqrt(squared));
        for (const double length : {near, std::nextafter(near, 0.0), std::nextafter(near, 1e300)}) {
            tally.expect(is_within(length) == (compare_length(length, *truth_->distance) >= 0),
                         told());
        }
    }

    void ask_features() {
#ifdef CDPREP_HAVE_TOOLS
        const SurfaceHull a(variant_->a), b(variant_->b);
        FeatureCache cache;
        for (int i = 0; i < 2; ++i) {
            const auto found = closest_features(a.view(), b.view(), variant_->placement, &cache);
            Tally& tally = of("features");
            tally.expect(found.has_value() != meet(), told());
            if (found && !meet()) expect_distance(tally, found->lower, found->upper);
        }
#endif
    }

    /// Of hulls with a surface: two surfaces that touch, or of which one lies in the other.
    void ask_surfaces(const SmallHull& a, const SmallHull& b) {
        if (a.triangles().empty() || b.triangles().empty()) return;
        const OpenModel model_a = open_tiny(mesh_of(a), {.double_precision = true});
        const OpenModel model_b = open_tiny(mesh_of(b), {.double_precision = true});
        Tally& tally = of("bvh");
        tally.expect(
            in_mode([&] {
                return collide(
                    {model_a.model, model_b.model, variant_->placement, {.body = Body::solid}},
                    workspace_);
            }).hit == (meet() ? Answer::yes : Answer::no),
            told());
        if (meet()) return;
        const auto found = in_mode([&] {
            return distance({model_a.model, model_b.model, variant_->placement}, workspace_);
        });
        tally.expect(
            found && found->upper > 0 && is_held(found->lower, found->upper, *truth_->distance),
            told());
    }
    static TestMesh mesh_of(const SmallHull& hull) {
        TestMesh mesh = {hull.points(), {}};
        for (const auto& t : hull.triangles()) mesh.triangles.push_back({t});
        return mesh;
    }

    void ask_c_face(const SmallHull& a, const SmallHull& b) {
        if (a.triangles().empty() || b.triangles().empty()) return;
        const AlignedBytes file_a = with_hulls(baked(a)), file_b = with_hulls(baked(b));
        const CModel model_a(file_a), model_b(file_b);
        cdprep_hull_pair pair;
        cdprep_hull_pair_init(&pair, sizeof pair);
        (void)cdprep_hull_find(model_a.get(), CDPREP_HULL_WHOLE, 0, &pair.a, nullptr);
        (void)cdprep_hull_find(model_b.get(), CDPREP_HULL_WHOLE, 0, &pair.b, nullptr);
        place(variant_->placement, pair);
        Tally& tally = of("C face");
        std::uint32_t hit = CDPREP_UNKNOWN;
        const int code = cdprep_hulls_collide(&pair, &hit, nullptr);
        tally.expect(code == CDPREP_OK && hit == (meet() ? CDPREP_YES : CDPREP_NO), told());
        cdprep_nearest between{};
        (void)cdprep_hulls_distance(&pair, nullptr, &between, nullptr);
        expect_distance(tally, between.lower, between.upper);
        cdprep_penetration depth{};
        (void)cdprep_hulls_penetration(&pair, nullptr, &depth, nullptr);
        expect_depth(tally, depth.found == CDPREP_YES, depth.lower, depth.upper);
    }
    static AlignedBytes baked(const SmallHull& hull) {
        const TestMesh mesh = mesh_of(hull);
        return bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true});
    }

    /// Who is said to be apart has a direction that separates, and who is not, a common point.
    void ask_with_proof(const SmallHull& a, const SmallHull& b) {
        const auto found =
            in_mode([&] { return convex_distance(a.view(), b.view(), variant_->placement); });
        const Placement& placement = variant_->placement;
        const Points at_a =
            placement.a_is_moved() ? moved_points(a.points(), placement.pose_a()) : a.points();
        const Points at_b =
            placement.b_is_moved() ? moved_points(b.points(), placement.pose_b()) : b.points();
        Tally& tally = of("GJK/climb");
        const bool meet = in_mode([&] { return convex_collide(a.view(), b.view(), placement); });
        tally.expect(meet == (found->upper == 0), told());
        of("EPA/cold")
            .expect(in_mode([&] {
                        return convex_penetration(a.view(), b.view(), placement);
                    }).has_value() == meet,
                    told());
        if (meet) {
            tally.expect(surfaces_meet(a, at_a, b, at_b) || holds(a, at_a, at_b[0]) ||
                             holds(b, at_b, at_a[0]),
                         told());
            return;
        }
        const Double3 &p = found->witness_a, &q = found->witness_b;
        const auto proof = proof_by({q.x - p.x, q.y - p.y, q.z - p.z}, at_a, at_b);
        tally.expect(proof && compare_length(found->upper, *proof) >= 0, told());
        tally.expect_narrow(found->upper - found->lower, promised_width(found->upper), told());
    }

    Scoreboard& board_;
    const HardHulls& hard_;
    std::optional<HullTruth> truth_;
    const HullVariant* variant_ = nullptr;
    Points placed_a_;
    Points placed_b_;
    std::mt19937 random_{7};
    Workspace workspace_;
};

}  // namespace

void score_hulls(const HardCaseOptions& options, Scoreboard& board) {
    const bool full = options.size == CaseSize::full;
    for (const HardHulls& hard : hard_hulls(full)) {
        if (!options.wants(hard.id)) continue;
        Asker asker(board, hard);
        const std::vector<HullVariant> variants = variants_of(hard, !full);
        // Of the many poses of one family each is asked in some guises only.
        const bool many = !full && (hard.id.starts_with("G03") || hard.id.starts_with("G05") ||
                                    hard.id.starts_with("G09") || hard.a.size() > 500);
        for (std::size_t i = 0; i < variants.size(); ++i) {
            if (!many || i < 2 || (i + hard.id.back()) % 4 == 0) asker.ask(variants[i]);
        }
    }
}

}  // namespace cdprep::test
