// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "build/frame_map.h"
#include "build/make_leaves.h"
#include "cdprep/live_model.h"
#include "core/carver.h"
#include "exact/box3.h"
#include "live/changed_boxes.h"
#include "live/corner_lists.h"
#include "live/live_start.h"
#include "live/spread.h"
#include "live/tear_tables.h"

namespace cdprep {

/// The number of a vertex of the imported file that no triangle uses.
inline constexpr std::uint32_t kUnusedVertex = 0xffffffff;

/// The subtrees that a rebuild distributes anew, one at a time. No redistribution is larger.
inline constexpr std::uint32_t kSubtreeLevels = 3;
inline constexpr std::uint32_t kSubtreeLeaves = 1U << (3 * kSubtreeLevels);

/// Consecutive leaves.
struct LeafRange {
    std::uint32_t first;
    std::uint32_t last;  ///< one past
};

/// The points that a frame may hold.
struct FrameBounds {
    format::Double3 middle;
    double half;

    [[nodiscard]] bool hold(const format::Double3& p) const noexcept {
        return std::fabs(p.x - middle.x) <= half && std::fabs(p.y - middle.y) <= half &&
               std::fabs(p.z - middle.z) <= half;
    }
};

/// The counts that decide how much memory a live model takes besides its image.
struct LiveCounts {
    std::size_t numbers;   ///< of vertices, in the imported file
    std::size_t vertices;  ///< of the model
    std::uint32_t places;  ///< for triangles
    bool can_tear;
};

/// What a live model keeps besides its image. Lives in the memory behind it.
struct LiveTables {
    LiveTables(Carver& carver, const LiveCounts& counts) noexcept
        : vertex_of(carver.take<std::uint32_t>(counts.numbers), counts.numbers),
          users(carver, counts.vertices, counts.places),
          changed(carver, format::bvh_shape(counts.places)) {
        const std::size_t leaves =
            (std::size_t{counts.places} + format::kBvhWidth - 1) / format::kBvhWidth;
        const std::size_t subtrees = (leaves + kSubtreeLeaves - 1) / kSubtreeLeaves;
        const std::size_t most =
            std::min<std::size_t>(counts.places, std::size_t{kSubtreeLeaves} * format::kBvhWidth);
        built_cost = {carver.take<float>(subtrees), subtrees};
        growth = {carver.take<float>(subtrees), subtrees};
        items = {carver.take<SpreadItem>(most), most};
        item_triangles = {carver.take<format::Triangle>(most), most};
        if (counts.can_tear) tear.emplace(carver, counts.places);
    }

    /// By number in the imported file: the vertex of the model, or kUnusedVertex. In a model that
    /// can tear, a vertex with a position has its own number.
    std::span<std::uint32_t> vertex_of;
    CornerLists users;
    ChangedBoxes changed;
    std::span<float> built_cost;  ///< of each subtree when its triangles were distributed
    std::span<float> growth;      ///< of each subtree since then, in the present rebuild
    // Triangles that are being distributed.
    std::span<SpreadItem> items;
    std::span<format::Triangle> item_triangles;
    std::optional<TearTables> tear;
};

struct LiveModel::State {
    /// `image` is that of `opened`. `start` is what it was made of.
    State(std::span<std::byte> image, Model opened, const LiveTables& empty, const LiveBase& base,
          const LiveLimits& limits, const LiveStart& start);

    /// Makes a live model, as LiveModel::in().
    [[nodiscard]] static Result<LiveModel> make(std::span<std::byte> memory, const LiveBase& base,
                                                const LiveLimits& limits);

    /// Returns why positions cannot be set. `vertices` are their numbers; empty: 0, 1, 2 and so on.
    template <class Given>
    [[nodiscard]] std::optional<Error> find_fault(std::span<const Given> positions,
                                                  std::span<const std::uint32_t> vertices) const;
    /// Sets all positions, by number in the imported file, and fits everything to them.
    template <class Given>
    void set_all(std::span<const Given> positions, ParallelFor parallel_for);
    /// Sets the positions of some vertices, and fits what they change.
    template <class Given>
    void set_some(std::span<const std::uint32_t> vertices, std::span<const Given> positions,
                  ParallelFor parallel_for);
    /// Makes the image that of a bake of the same arrays. Requires a model that cannot tear.
    void complete_image();

    /// Returns whether a span of the caller lies in the memory of the model.
    [[nodiscard]] bool is_own(std::span<const std::byte> given) const;
    /// Returns why triangles cannot be appended.
    [[nodiscard]] std::optional<Error> find_fault(std::span<const format::Triangle> added) const;
    void append(std::span<const format::Triangle> added);
    /// Returns why triangles cannot be removed.
    [[nodiscard]] std::optional<Error> find_fault(std::span<const std::uint32_t> removed) const;
    void remove(std::span<const std::uint32_t> removed);

    /// Distributes the triangles of subtrees anew, those first whose boxes have grown most, as
    /// LiveModel::rebuild(). Returns the number of triangles distributed.
    std::uint32_t rebuild(std::uint32_t most);

    [[nodiscard]] std::size_t position_count() const {
        return tables.tear ? tables.tear->positions : tables.vertex_of.size();
    }

    std::span<std::byte> image;
    Model model;
    std::span<format::Triangle> triangles;
    std::span<std::uint32_t> source_triangle;

    // The sections that follow from the positions.
    std::span<format::Float3> positions_f32;  ///< empty if the model keeps doubles
    std::span<format::Double3> positions_f64;
    std::span<format::BvhNode> nodes;
    std::span<format::BvhLeaf> leaves;
    std::span<std::uint64_t> degenerate_bits;
    std::span<format::Component> components;

    LiveTables tables;

private:
    /// The facts about all positions, which a moved vertex changes.
    struct Sums {
        std::uint64_t hash = 0;     ///< the sum over all vertices
        std::uint32_t rounded = 0;  ///< vertices with a coordinate that is not a float

        template <class Kept>
        void add(std::uint32_t vertex, const Kept& p);
        template <class Kept>
        void remove(std::uint32_t vertex, const Kept& p);
    };

    template <class Given, class Kept>
    void set_all(std::span<const Given> given, std::span<Kept> kept, ParallelFor parallel_for);
    template <class Given, class Kept>
    void set_some(std::span<const std::uint32_t> vertices, std::span<const Given> given,
                  std::span<Kept> kept, ParallelFor parallel_for);
    /// Chooses a frame if the present one does not hold all vertices, and fits the boxes.
    void fit(bool all, bool is_in_frame, ParallelFor parallel_for);
    void fit_all(ParallelFor parallel_for);
    void fit_changed(ParallelFor parallel_for);
    /// Fits the boxes around nodes of a level.
    void fit_boxes_around(std::uint32_t level, std::size_t first, std::size_t last);
    [[nodiscard]] FrameBounds frame_bounds() const;
    [[nodiscard]] bool is_small_in_frame() const;
    [[nodiscard]] bool has_exact_leaves() const;
    [[nodiscard]] build::LeafRoom leaf_room() const;
    [[nodiscard]] build::Frame new_frame(ParallelFor parallel_for) const;
    void update_header();
    /// Calls visit(positions) with those of the kept precision.
    template <class Visit>
    decltype(auto) with_positions(const Visit& visit) const {
        return positions_f32.empty() ? visit(std::span<const Double3>(positions_f64))
                                     : visit(std::span<const format::Float3>(positions_f32));
    }

    // Of a model that can tear.
    void start_to_tear(const LiveBase& base, const LiveLimits& limits, const LiveStart& start);
    /// Returns the bounds of all vertices that triangles use.
    [[nodiscard]] build::Extent used_extent() const;
    void widen_frame(std::span<const format::Triangle> added);
    void insert(const format::Triangle& triangle);
    /// Returns a leaf with a free place, and grows the boxes around it. Marks nodes that should be
    /// distributed anew.
    [[nodiscard]] std::uint32_t choose_leaf(const format::Triangle& triangle);
    void redistribute_marked();
    /// Returns whether a place has a triangle, also while the header does not count it yet.
    [[nodiscard]] bool is_taken(std::uint32_t place) const {
        return !tables.tear ||
               ((tables.tear->lanes[place / format::kBvhWidth] >> (place % format::kBvhWidth)) &
                1) != 0;
    }
    void put(std::uint32_t place, const NumberedTriangle& added);
    void take_out(std::uint32_t place);
    /// Adds to the counts of the subtrees around a place.
    void count_at(std::uint32_t place, std::int32_t by);
    /// Returns the number of places of a subtree that stay free, so that the next redistribution is
    /// far off. A leaf has the height 0.
    [[nodiscard]] std::uint64_t to_be_free(std::uint64_t places, std::uint32_t height) const;
    [[nodiscard]] bool has_room(std::uint32_t height, std::uint32_t subtree) const;
    /// Distributes the triangles of a subtree anew. Fits no boxes.
    void redistribute(const LeafRange& range);
    [[nodiscard]] Corners corners(const format::Triangle& triangle) const;
    void fit_leaves(const LeafRange& range);
    void note_tear();
    /// Notes that triangles may have got other places, by a change that `by` tells from others.
    void note_places(std::uint64_t by);

    [[nodiscard]] LeafRange subtree(std::uint32_t number) const;
    /// Returns the number of triangles in leaves.
    [[nodiscard]] std::uint32_t count_in(const LeafRange& range) const;
    /// Returns the cost of a subtree by the surface-area heuristic.
    [[nodiscard]] float cost_of(std::uint32_t number) const;
    void note_costs();

    build::Frame frame_;
    Sums sums_;
    bool is_rebuilding_ = false;
    std::uint64_t places_ = 0;  ///< a hash of what led to the places, as caches must know; or 0
};

}  // namespace cdprep
