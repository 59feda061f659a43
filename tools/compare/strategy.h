// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cdprep/advanced/convex_points.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/advanced/structure.h"
#include "cdprep/cells.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/contacts.h"
#include "cdprep/pairs.h"
#include "compare/model_forms.h"

namespace cdprep::study {

/// The queries to two models.
enum class Asked : std::uint8_t { collide, overlap, distance, within, contacts };
inline constexpr std::size_t kAsked = 5;
inline constexpr std::array<const char*, kAsked> kAskedNames = {"collide", "overlap", "distance",
                                                                "within", "contacts"};

/// A way in which this library answers queries.
struct Strategy {
    const char* name;     ///< such as "octree"
    const char* setting;  ///< "paper", "tuned", or empty
    MemoryModel ModelForms::*form;
    StructureOptions through;
    bool of_hulls = false;    ///< queries the models' hulls instead
    bool is_literal = false;  ///< the literal search (literal_octree.h), which misses pairs

    /// Returns true if answers for the models may be wrong.
    [[nodiscard]] bool is_approximate() const noexcept {
        return of_hulls || is_literal;
    }
};

/// Returns all strategies; the last one is the BVH as baked.
[[nodiscard]] std::span<const Strategy> strategies();

/// The bounds of a distance: it is in [lower, upper].
struct Gap {
    double lower = 0;
    double upper = 0;
};

/// Two models as one strategy queries them. Use from one thread at a time.
class StrategyPair {
public:
    /// The models must outlive this.
    StrategyPair(const Strategy& strategy, const ModelForms& a, const ModelForms& b);

    /// Returns why it cannot answer that query; empty if it can.
    [[nodiscard]] std::string find_reason(Asked asked) const;

    [[nodiscard]] bool collides(const Placement& placement);
    /// Returns the number of overlapping triangle pairs. Writes up to 65,536 pairs, or as many as
    /// pairs() returned.
    [[nodiscard]] std::size_t count_pairs(const Placement& placement);
    /// Returns all overlapping pairs; valid until the next call.
    [[nodiscard]] std::span<const TrianglePair> pairs(const Placement& placement);
    [[nodiscard]] Gap gap(const Placement& placement);
    [[nodiscard]] bool is_within(const Placement& placement, double tolerance);
    /// Returns the number of contacts. Writes as many as fit.
    [[nodiscard]] std::size_t contacts(const Placement& placement, double tolerance,
                                       std::span<Contact> room = {});

    /// Counts the work of queries from now on; null ends counting.
    void count_into(QueryCounts* counts) noexcept {
        counts_ = counts;
        workspace_.count_into(counts);
    }

private:
    Strategy strategy_;
    const Model& a_;
    const Model& b_;
    /// Calls `keep` with the pairs that the literal search finds, until it returns false.
    void visit_literally(const Placement& placement, PairVisitor keep);

    std::optional<ConvexPoints> hull_a_;
    std::optional<ConvexPoints> hull_b_;
    Workspace workspace_{cells()};
    QueryCounts* counts_ = nullptr;
    std::vector<TrianglePair> pairs_;
};

}  // namespace cdprep::study
