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

/// What two models are asked.
enum class Asked : std::uint8_t { collide, overlap, distance, within, contacts };
inline constexpr std::size_t kAsked = 5;
inline constexpr std::array<const char*, kAsked> kAskedNames = {"collide", "overlap", "distance",
                                                                "within", "contacts"};

/// A way in which this library answers.
struct Strategy {
    const char* name;     ///< "octree"
    const char* setting;  ///< "paper", "tuned", or empty
    MemoryModel ModelForms::*form;
    StructureOptions through;
    bool of_hulls = false;    ///< asks the models' hulls instead of them
    bool is_literal = false;  ///< the talk's search, which misses pairs (literal_octree.h)

    /// Whether answers about the models may be wrong.
    [[nodiscard]] bool is_approximate() const noexcept {
        return of_hulls || is_literal;
    }
};

/// All of them; the last one is the hierarchy of boxes as it is baked.
[[nodiscard]] std::span<const Strategy> strategies();

/// The distance is in [lower, upper].
struct Gap {
    double lower = 0;
    double upper = 0;
};

/// Two models as one strategy asks them. Not for several threads at once.
class StrategyPair {
public:
    /// The models outlive it.
    StrategyPair(const Strategy& strategy, const ModelForms& a, const ModelForms& b);

    /// Why it cannot be asked that; empty when it can.
    [[nodiscard]] std::string find_reason(Asked asked) const;

    [[nodiscard]] bool collides(const Placement& placement);
    /// How many triangles overlap; up to 65,536 pairs are written, or as many as pairs() had.
    [[nodiscard]] std::size_t count_pairs(const Placement& placement);
    /// All overlapping pairs; valid until the next call.
    [[nodiscard]] std::span<const TrianglePair> pairs(const Placement& placement);
    [[nodiscard]] Gap gap(const Placement& placement);
    [[nodiscard]] bool is_within(const Placement& placement, double tolerance);
    /// How many contacts there are; those that have room are written.
    [[nodiscard]] std::size_t contacts(const Placement& placement, double tolerance,
                                       std::span<Contact> room = {});

    /// From now on counts what questions do; null ends that.
    void count_into(QueryCounts* counts) noexcept {
        counts_ = counts;
        workspace_.count_into(counts);
    }

private:
    Strategy strategy_;
    const Model& a_;
    const Model& b_;
    /// Calls `keep` with the pairs that the talk's search finds, until it returns false.
    void visit_literally(const Placement& placement, PairVisitor keep);

    std::optional<ConvexPoints> hull_a_;
    std::optional<ConvexPoints> hull_b_;
    Workspace workspace_{cells()};
    QueryCounts* counts_ = nullptr;
    std::vector<TrianglePair> pairs_;
};

}  // namespace cdprep::study
