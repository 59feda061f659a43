// SPDX-License-Identifier: MIT
// The hard cases on other libraries, those that were found at configure time. A program of its
// own, for one of them may crash or never end: hard_cases runs it as a child.
//
// Usage: hard_peers [--list | PEER FIRST]
// --list prints the names of peers. With one, each case from number FIRST on is printed before
// it is asked ("ask ID") and after ("right", "wrong", "yes" or "no"; the last two of those who
// touch and no more, where conventions differ).
//
// Peers get vertices where they stand, so that no pose rounds them. Answers count as wrong where
// they contradict exact arithmetic: a hit of those who are apart, a miss of those who cross, a
// triangle pair made up or lost; a distance of 0 of those who are apart, or off by more than
// 1e-6 of it and 1e-9 of the largest coordinate. Of contacts: "wrong", and "sign" where a normal
// points away from all right ones, "ghost" where it is more than 10 degrees off, "depth" where the
// deepest is off by a factor of 2, "none" where there is no contact of those who overlap.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "accuracy/mesh_variants.h"
#include "accuracy/peers/peer.h"
#include "support/exact_pairs.h"
#include "support/hard_contacts.h"
#include "support/hard_distances.h"
#include "support/hard_hulls.h"
#include "support/hard_meshes.h"
#include "support/hard_triangles.h"
#include "support/small_hull.h"

namespace cdprep::test {
namespace {

/// Every case in turn; those before the first one wanted are passed over.
class Course {
public:
    Course(const Peer& peer, std::size_t first) : peer_(peer), first_(first) {}

    void run() {
        if (peer_.collide) run_triangles();
        if (peer_.collide) run_meshes();
        if (peer_.distance) run_distances();
        if (peer_.hulls_collide || peer_.hull_distance) run_hulls();
        if (peer_.contacts) run_contacts();
    }

private:
    enum class Verdict : std::uint8_t { right, wrong, yes, no };

    template <class Ask>
    void each(const std::string& id, Ask&& ask) {
        if (number_++ < first_) return;
        std::printf("ask %s\n", id.c_str());
        std::fflush(stdout);
        constexpr std::array kWords = {"right", "wrong", "yes", "no"};
        if constexpr (std::is_same_v<decltype(ask()), Verdict>) {
            std::puts(kWords[static_cast<std::size_t>(ask())]);
        } else {
            std::puts(ask().c_str());
        }
        std::fflush(stdout);
    }

    static Verdict judge(bool hit, bool closed, bool proper) {
        if (closed && !proper) return hit ? Verdict::yes : Verdict::no;
        return hit == closed ? Verdict::right : Verdict::wrong;
    }

    /// Pairs between those that cross and those that touch.
    static Verdict judge(const PeerAnswer& found, const ExactPairs& truth) {
        const Verdict flag = judge(found.hit, !truth.closed.empty(), !truth.proper.empty());
        if (!found.pairs || flag == Verdict::wrong) return flag;
        std::vector<TrianglePair> pairs = *found.pairs;
        std::sort(pairs.begin(), pairs.end());
        const bool made_up =
            !std::includes(truth.closed.begin(), truth.closed.end(), pairs.begin(), pairs.end());
        const bool lost =
            !std::includes(pairs.begin(), pairs.end(), truth.proper.begin(), truth.proper.end());
        return made_up || lost ? Verdict::wrong : flag;
    }

    void run_triangles() {
        const auto mesh_of = [](const Corners& t) {
            return TestMesh{{t[0], t[1], t[2]}, {{{0, 1, 2}}}};
        };
        for (const HardPair& pair : hard_triangles()) {
            std::vector<HardPair> all;
            for (std::size_t i = 0; i < kRelabellings; i += 5) all.push_back(relabelled(pair, i));
            for (std::size_t i = 0; i < kAxisTurns; i += 5) all.push_back(turned(pair, i));
            for (const int exponent : {-40, -20, 20, 40}) {
                if (const auto changed = scaled(pair, exponent)) all.push_back(*changed);
            }
            if (const auto changed = shifted(pair, 0x1p20)) all.push_back(*changed);
            for (const HardPair& other : all) {
                each(pair.id, [&] {
                    const PeerAnswer found = peer_.collide(mesh_of(other.a), mesh_of(other.b));
                    return judge(found.hit, pair.closed, pair.proper);
                });
            }
        }
    }

    void run_meshes() {
        for (const HardMeshes& hard : hard_meshes(CaseSize::small)) {
            if (hard.a.triangles.empty() || hard.b.triangles.empty()) continue;
            std::optional<ExactPairs> truth;
            std::size_t count = 0;
            for (const MeshVariant& variant : mesh_variants(hard.a, hard.b, hard.placement, true)) {
                if (variant.name.ends_with("by poses") || count++ % 3 != 0) continue;
                each(hard.id, [&] {
                    if (!truth) truth = exact_pairs(hard.a, hard.b, hard.placement);
                    const PeerAnswer found =
                        peer_.collide(placed(variant.a, variant.placement.pose_a()),
                                      placed(variant.b, variant.placement.pose_b()));
                    return judge(found, {variant.told(truth->closed), variant.told(truth->proper)});
                });
            }
        }
    }

    static TestMesh placed(TestMesh mesh, const Pose& pose) {
        for (Double3& p : mesh.positions) p = transform_point(pose, p);
        return mesh;
    }

    static double largest_of(const std::vector<Double3>& points) {
        double largest = 0;
        for (const Double3& p : points) {
            largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
        }
        return largest;
    }
    /// `truth` is exact up to 2^-60.
    static Verdict judge_distance(double found, long double truth, double largest) {
        if (truth > 0 && !(found > 0)) return Verdict::wrong;
        const long double permitted = 1e-6L * truth + 1e-9L * largest;
        return std::fabs(std::max(found, 0.0) - truth) <= permitted ? Verdict::right
                                                                    : Verdict::wrong;
    }

    void run_distances() {
        for (const HardDistance& hard : hard_distances()) {
            std::optional<long double> truth;
            each(hard.id, [&] {
                truth = std::sqrt(squared_distance_of(hard).approximation());
                const TestMesh a = placed(hard.a, hard.placement.pose_a());
                const TestMesh b = placed(hard.b, hard.placement.pose_b());
                const double largest = std::max(largest_of(a.positions), largest_of(b.positions));
                return judge_distance(peer_.distance(a, b), *truth, largest);
            });
        }
    }

    static bool is_flat(const Points& points) {
        return SmallHull(points, Edges::none).triangles().empty();
    }

    void run_hulls() {
        for (const HardHulls& hard : hard_hulls(false)) {
            if (hard.is_large && !hard.gap && !hard.depth) continue;
            if (!peer_.takes_flat_hulls && (is_flat(hard.a) || is_flat(hard.b))) continue;
            each(hard.id, [&] {
                const HullTruth truth = hull_truth(hard);
                const Points a = moved_points(hard.a, hard.placement.pose_a());
                const Points b = moved_points(hard.b, hard.placement.pose_b());
                if (peer_.hulls_collide) {
                    const bool touches =
                        !truth.distance && truth.depth && truth.depth->numerator.sign() == 0;
                    const Verdict flag =
                        judge(peer_.hulls_collide(a, b), !truth.distance, !touches);
                    if (flag == Verdict::wrong || !peer_.hull_distance) return flag;
                }
                if (!truth.distance) return Verdict::right;
                const long double length = std::sqrt(truth.distance->numerator.approximation() /
                                                     truth.distance->denominator.approximation());
                return judge_distance(peer_.hull_distance(a, b), length,
                                      std::max(largest_of(a), largest_of(b)));
            });
        }
    }

    /// "right", or "wrong" and in what: sign, ghost, depth, none.
    static std::string judge(const HardContact& hard, const std::vector<PeerContact>& found) {
        constexpr double kSign = 90, kGhost = 10, kDegrees = 57.295779513082323;
        double farthest = 0, deepest = HUGE_VAL;
        for (const PeerContact& contact : found) {
            double angle = 180;
            for (const Double3& normal : hard.allowed) {
                angle = std::min(angle, kDegrees * angle_between(contact.normal, normal));
            }
            farthest = std::max(farthest, angle);
            deepest = std::min(deepest, contact.distance);
        }
        const double separation = hard.separation;
        const bool touches = std::fabs(separation) <= hard.rounding();
        std::string wrong;
        if (found.empty()) return separation < 0 && !touches ? "wrong none" : "right";
        if (!(farthest <= kSign)) wrong = " sign";
        if (farthest > kGhost && farthest <= kSign) wrong = " ghost";
        constexpr double kTouching = 1e-2;
        const double ratio = deepest / separation;
        if (touches ? !(std::fabs(deepest) <= kTouching * hard.size)
                    : !(ratio >= 0.5 && ratio <= 2)) {
            wrong += " depth";
        }
        return wrong.empty() ? "right" : "wrong" + wrong;
    }

    void run_contacts() {
        for (const HardContact& hard : hard_contacts()) {
            const bool both = hard.a.is_convex && hard.b.is_convex;
            if (!both && peer_.takes_two_hulls) continue;
            each(hard.id, [&] { return judge(hard, peer_.contacts(hard)); });
        }
    }

    const Peer& peer_;
    std::size_t first_;
    std::size_t number_ = 0;
};

}  // namespace
}  // namespace cdprep::test

int main(int count, char** values) {
    using cdprep::test::Peer;
    const std::vector<Peer> peers = cdprep::test::all_peers();
    if (count == 2 && std::string(values[1]) == "--list") {
        for (const Peer& peer : peers) std::puts(peer.name.c_str());
        return 0;
    }
    if (count != 3) {
        std::fprintf(stderr, "usage: hard_peers [--list | PEER FIRST]\n");
        return 2;
    }
    for (const Peer& peer : peers) {
        if (peer.name != values[1]) continue;
        cdprep::test::Course(peer, std::strtoull(values[2], nullptr, 10)).run();
        return 0;
    }
    std::fprintf(stderr, "hard_peers: no peer %s here\n", values[1]);
    return 2;
}
