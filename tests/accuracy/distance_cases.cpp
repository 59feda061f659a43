// SPDX-License-Identifier: MIT
// X: how far two meshes are apart, by the hierarchy with every kind of bounds, through pieces
// and through the C face. Truths are known by hand or by rational numbers.
#include <algorithm>
#include <cmath>
#include <limits>

#include "accuracy/asked_models.h"
#include "accuracy/hard_cases.h"
#include "accuracy/in_mode.h"
#include "accuracy/mesh_variants.h"
#include "support/exact_distance.h"
#include "support/hard_distances.h"

#include "cdprep/cells/overlap_through.h"
#include "cdprep/pairs.h"

namespace cdprep::test {
namespace {

double largest_of(const MeshVariant& variant) {
    double largest = 0;
    const Placement& placement = variant.placement;
    const auto take = [&](const TestMesh& mesh, const Pose& pose) {
        for (const Double3& p : mesh.positions) {
            const Double3 q = transform_point(pose, p);
            largest = std::max({largest, std::fabs(q.x), std::fabs(q.y), std::fabs(q.z)});
        }
    };
    take(variant.a, placement.a_is_moved() ? placement.pose_a() : Pose());
    take(variant.b, placement.b_is_moved() ? placement.pose_b() : Pose());
    return largest;
}

class Asker {
    /// What is being asked.
    [[nodiscard]] auto told() const {
        return [this] { return hard_.id + ": " + variant_->name; };
    }

public:
    Asker(Scoreboard& board, const HardDistance& hard)
        : board_(board), hard_(hard), truth_(squared_distance_of(hard)) {}

    void ask(const MeshVariant& variant) {
        const std::size_t turn = turn_++;
        variant_ = &variant;
        largest_ = largest_of(variant);
        const AskedModel asked_a(variant.a, turn, Holding::pieces);
        const AskedModel asked_b(variant.b, turn, Holding::pieces);
        const Model &a = asked_a.model(), &b = asked_b.model();
        const Placement& placement = variant.placement;
        const std::string bvh = std::string("bvh/") + asked_a.bounds();
        const StructureOptions pieces = {.structure = Structure::pieces};

        PairCache cache;
        const auto found = in_mode([&] { return distance({a, b, placement}, workspace_); });
        expect(bvh, found);
        expect(bvh, in_mode([&] { return distance({a, b, placement, {}, &cache}, workspace_); }));
        expect(bvh, in_mode([&] { return distance({a, b, placement, {}, &cache}, workspace_); }));
        expect("pieces", in_mode([&] {
                   return distance({a, b, placement, {.through = pieces.structure}}, workspace_);
               }));
        ask_again(bvh, found, in_mode([&] { return distance({a, b, placement}, workspace_); }));
        ask_permitted(bvh, a, b);
        expect_within("within", [&](double length) {
            return in_mode([&] { return within({a, b, placement}, length, workspace_); });
        });
        expect_within("pieces", [&](double length) {
            return in_mode([&] {
                return within({a, b, placement, {.through = pieces.structure}}, length, workspace_);
            });
        });
        if (hard_.is_nested) {
            const auto solid = in_mode([&] {
                return distance({a, b, placement, {.body = Body::solid}}, workspace_);
            });
            of(bvh).expect(solid && solid->lower == 0 && solid->upper == 0, told());
        }
        if (turn % 2 == 0) ask_c_face(asked_a, asked_b);
    }

private:
    [[nodiscard]] Tally& of(const std::string& strategy) {
        return board_.of(hard_.id, strategy);
    }
    /// The sign of length^2 - truth, for a length of the variant's scale.
    [[nodiscard]] int compare(double length) const {
        return (square(std::ldexp(length, -variant_->change.exponent)) - truth_).sign();
    }
    [[nodiscard]] bool is_held(double lower, double upper) const {
        if (lower < 0 || compare(lower) > 0 || compare(upper) < 0) return false;
        return (upper == 0) == (truth_.sign() == 0);
    }

    void expect(const std::string& strategy, const std::optional<Distance>& found) {
        Tally& tally = of(strategy);
        tally.expect(found && is_held(found->lower, found->upper), told());
        if (!found) return;
        tally.expect_narrow(found->upper - found->lower, 1e-12 * found->lower + 1e-15 * largest_,
                            told());
    }
    /// The same question has the same answer, witnesses and numbers too.
    void ask_again(const std::string& strategy, const std::optional<Distance>& first,
                   const std::optional<Distance>& again) {
        of(strategy).expect(first && again && first->triangle_a == again->triangle_a &&
                                first->triangle_b == again->triangle_b &&
                                first->witness_a == again->witness_a &&
                                first->upper == again->upper,
                            told());
    }

    /// X08: whatever is permitted is kept, and the truth held.
    void ask_permitted(const std::string& strategy, const Model& a, const Model& b) {
        if (!hard_.id.starts_with("X08")) return;
        const double unit = variant_->change.length(1);
        for (const double error : {1e-6, 1e-3, 0.1, 1.0}) {
            const auto by_ratio = in_mode([&] {
                return distance({a, b, variant_->placement}, workspace_, {.relative_error = error});
            });
            const double permitted = error * unit;
            const auto by_length = in_mode([&] {
                return distance({a, b, variant_->placement}, workspace_,
                                {.absolute_error = permitted});
            });
            Tally& tally = of(strategy);
            for (const auto& found : {by_ratio, by_length}) {
                tally.expect(found && is_held(found->lower, found->upper), told());
            }
            tally.expect_narrow(by_ratio->upper - by_ratio->lower,
                                error * by_ratio->lower + 1e-15 * largest_, told());
            tally.expect_narrow(by_length->upper - by_length->lower,
                                error * unit + 1e-15 * largest_, told());
        }
    }

    /// A distance is within itself to the last bit, and one step less is not.
    template <class Within>
    void expect_within(const std::string& strategy, Within&& within) {
        const long double root = std::sqrt(truth_.approximation());
        const double near = variant_->change.length(static_cast<double>(root));
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        for (const double length :
             {0.0, near, std::nextafter(near, 0.0), std::nextafter(near, kInfinity), 2 * near}) {
            of(strategy).expect(within(length) == (compare(length) >= 0), told());
        }
    }

    void ask_c_face(const AskedModel& asked_a, const AskedModel& asked_b) {
        const CModel a(asked_a.bytes()), b(asked_b.bytes());
        const cdprep_pair pair = in_c(a, b, variant_->placement);
        cdprep_nearest between{};
        const int code = cdprep_distance(&pair, nullptr, c_workspace_.get(), &between, nullptr);
        of("C face").expect(code == CDPREP_OK && between.found == CDPREP_YES &&
                                is_held(between.lower, between.upper),
                            told());
    }

    Scoreboard& board_;
    const HardDistance& hard_;
    ExactRational truth_;
    std::size_t turn_ = 0;
    const MeshVariant* variant_ = nullptr;
    double largest_ = 0;
    Workspace workspace_;
    CWorkspace c_workspace_;
};

}  // namespace

void score_distances(const HardCaseOptions& options, Scoreboard& board) {
    for (const HardDistance& hard : hard_distances()) {
        if (!options.wants(hard.id)) continue;
        Asker asker(board, hard);
        const bool few = options.size == CaseSize::small;
        const std::size_t step = few && hard.id.starts_with("X04") ? 3 : 1;
        const std::vector<MeshVariant> variants =
            mesh_variants(hard.a, hard.b, hard.placement, few);
        for (std::size_t i = 0; i < variants.size(); i += step) asker.ask(variants[i]);
    }
}

}  // namespace cdprep::test
