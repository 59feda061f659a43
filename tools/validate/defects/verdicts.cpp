// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/defects/verdicts.h"

namespace cdprep::mesh {
namespace {

using format::Verdict;

/// The counts of a component, or of the whole mesh.
struct Tally {
    std::int64_t vertices = 0;
    std::int64_t triangles = 0;
    std::int64_t repeated = 0;
    std::int64_t boundary = 0;
    std::int64_t non_manifold = 0;
    std::int64_t non_manifold_uses = 0;
    std::int64_t inconsistent = 0;
    std::int64_t pinched = 0;
    std::int64_t loops = 0;
    std::uint32_t first_triangle = 0;
    bool orientable = true;
    bool balanced = true;
    bool self_crossing = false;
    int winding_outside = 0;  ///< the sum over all other components around it

    /// Returns the number of edges. Every use belongs to an edge with one, two or more uses.
    [[nodiscard]] std::int64_t edges() const {
        const std::int64_t used_twice = (3 * triangles - boundary - non_manifold_uses) / 2;
        return boundary + non_manifold + used_twice;
    }
};

class VerdictMaker {
public:
    explicit VerdictMaker(const VerdictGrounds& grounds)
        : g_(grounds), tally_(grounds.components.count) {}

    std::vector<Verdict> make() {
        tally_triangles();
        tally_edges();
        for (std::size_t i = 0; i < tally_.size(); ++i) {
            tally_[i].balanced = g_.balanced[i];
            tally_[i].self_crossing = g_.meetings != nullptr && g_.meetings->self_crossing[i];
        }
        for (const NonOrientable& found : g_.non_orientable) {
            tally_[found.component].orientable = false;
        }
        for (const Nested& nested : g_.nested) {
            tally_[nested.inner].winding_outside += nested.winding;
        }
        std::vector<Verdict> verdicts(1);
        for (std::size_t i = 0; i < tally_.size(); ++i) {
            verdicts.push_back(verdict_of(tally_[i], g_.measures.component[i]));
        }
        verdicts.front() = verdict_of_whole(verdicts);
        return verdicts;
    }

private:
    [[nodiscard]] Tally& at_vertex(std::uint32_t vertex) {
        return tally_[g_.components.of_vertex[vertex]];
    }

    void tally_triangles() {
        const std::vector<Triangle>& triangles = g_.sound.mesh.triangles;
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            Tally& tally = at_vertex(triangles[i].vertex[0]);
            if (tally.triangles++ == 0) tally.first_triangle = g_.sound.source_triangle[i];
        }
        for (const std::uint32_t component : g_.components.of_vertex) ++tally_[component].vertices;
        for (const RepeatedCorner& repeated : g_.sound.repeated) {
            if (repeated.connected) ++at_vertex(repeated.vertex).repeated;
        }
    }

    void tally_edges() {
        for (const FlawedEdge& edge : g_.boundary.edge) ++at_vertex(edge.from).boundary;
        for (const FlawedEdge& edge : g_.flaws.non_manifold) {
            ++at_vertex(edge.from).non_manifold;
            at_vertex(edge.from).non_manifold_uses += edge.uses;
        }
        for (const FlawedEdge& edge : g_.flaws.inconsistent) ++at_vertex(edge.from).inconsistent;
        for (const PinchedVertex& pinched : g_.flaws.pinched) ++at_vertex(pinched.vertex).pinched;
        for (const BoundaryLoop& loop : g_.boundary.loop) {
            ++at_vertex(g_.boundary.edge[loop.first_edge].from).loops;
        }
    }

    [[nodiscard]] Verdict verdict_of(const Tally& tally, const SurfaceMeasure& measure) const {
        using namespace format;
        Verdict verdict{};
        const auto fact = [&verdict](VerdictFacts bit, bool is_true) {
            if (is_true) verdict.facts |= bit;
        };
        // Without triangles all facts would hold, but mean nothing.
        if (tally.triangles > 0) {
            fact(verdict_closed, tally.boundary == 0);
            fact(verdict_two_manifold, tally.non_manifold == 0 && tally.pinched == 0);
            fact(verdict_oriented, tally.inconsistent == 0);
            fact(verdict_orientable, tally.orientable);
            fact(verdict_balanced, tally.balanced);
            fact(verdict_inverted, tally.balanced && measure.volume_sign < 0);
        }
        fact(verdict_crossings_examined, tally.self_crossing || is_examined());
        fact(verdict_self_crossing, tally.self_crossing);
        verdict.promises = promises_of(verdict.facts);
        verdict.triangle_count = static_cast<std::uint32_t>(tally.triangles + tally.repeated);
        verdict.first_triangle = tally.first_triangle;
        verdict.boundary_loops = static_cast<std::uint32_t>(tally.loops);
        verdict.euler = static_cast<std::int32_t>(tally.vertices - tally.edges() + tally.triangles);
        verdict.genus = has_genus(verdict) ? (2 - verdict.euler) / 2 : -1;
        verdict.area = measure.area;
        verdict.volume = tally.balanced ? measure.volume : 0;
        return verdict;
    }

    /// Returns whether all pairs were examined: no pair found then means that none exists.
    [[nodiscard]] bool is_examined() const {
        return g_.meetings != nullptr && g_.meetings->is_complete;
    }

    static bool has_genus(const Verdict& verdict) {
        constexpr std::uint32_t kNeeded =
            format::verdict_closed | format::verdict_two_manifold | format::verdict_orientable;
        return (verdict.facts & kNeeded) == kNeeded;
    }

    static std::uint32_t promises_of(std::uint32_t facts) {
        using namespace format;
        const auto all = [facts](std::uint32_t bits) { return (facts & bits) == bits; };
        std::uint32_t promises = promise_surface;
        if (all(verdict_balanced)) promises |= promise_inside_exact;
        if (all(verdict_closed | verdict_oriented)) promises |= promise_contained_pieces;
        constexpr std::uint32_t kSimple =
            verdict_closed | verdict_two_manifold | verdict_oriented | verdict_crossings_examined;
        if (all(kSimple) && (facts & (verdict_self_crossing | verdict_inverted)) == 0) {
            promises |= promise_simple_solid;
        }
        return promises;
    }

    [[nodiscard]] Verdict verdict_of_whole(const std::vector<Verdict>& verdicts) const {
        Tally sum;
        std::int32_t genus = 0;
        for (std::size_t i = 0; i < tally_.size(); ++i) {
            add(sum, tally_[i]);
            genus += verdicts[i + 1].genus;
        }
        // Includes those without a component.
        sum.repeated = static_cast<std::int64_t>(g_.sound.repeated.size());
        sum.first_triangle = tally_.empty() ? 0 : tally_.front().first_triangle;
        sum.self_crossing = g_.meetings != nullptr && g_.meetings->any;
        Verdict verdict = verdict_of(sum, g_.measures.whole);
        if (has_genus(verdict)) verdict.genus = genus;
        if (!windings_are_simple(verdicts)) verdict.promises &= ~format::promise_simple_solid;
        return verdict;
    }

    static void add(Tally& sum, const Tally& more) {
        sum.vertices += more.vertices;
        sum.triangles += more.triangles;
        sum.boundary += more.boundary;
        sum.non_manifold += more.non_manifold;
        sum.non_manifold_uses += more.non_manifold_uses;
        sum.inconsistent += more.inconsistent;
        sum.pinched += more.pinched;
        sum.loops += more.loops;
        sum.orientable = sum.orientable && more.orientable;
        sum.balanced = sum.balanced && more.balanced;
    }

    /// Returns whether the winding number is 0 or 1 on both sides of every component, if no
    /// components cross.
    [[nodiscard]] bool windings_are_simple(const std::vector<Verdict>& verdicts) const {
        for (std::size_t i = 0; i < tally_.size(); ++i) {
            const bool inverted = (verdicts[i + 1].facts & format::verdict_inverted) != 0;
            if (tally_[i].winding_outside != (inverted ? 1 : 0)) return false;
        }
        return true;
    }

    const VerdictGrounds& g_;
    std::vector<Tally> tally_;
};

}  // namespace

std::vector<Verdict> make_verdicts(const VerdictGrounds& grounds) {
    return VerdictMaker(grounds).make();
}

}  // namespace cdprep::mesh
