// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "build/frame_map.h"
#include "cdprep/live_model.h"
#include "core/carver.h"
#include "live/changed_boxes.h"
#include "live/corner_lists.h"

namespace cdprep {

/// The number of a vertex of the imported file that no triangle uses.
inline constexpr std::uint32_t kUnusedVertex = 0xffffffff;

/// What a live model keeps besides its image. Lives in the memory behind it.
struct LiveTables {
    LiveTables(Carver& carver, std::size_t numbers, std::size_t vertices,
               std::uint32_t triangles) noexcept
        : vertex_of(carver.take<std::uint32_t>(numbers), numbers),
          users(carver, vertices, triangles),
          changed(carver, format::bvh_shape(triangles)) {}

    /// By number in the imported file: the vertex of the model, or kUnusedVertex.
    std::span<std::uint32_t> vertex_of;
    CornerLists users;
    ChangedBoxes changed;
};

struct LiveModel::State {
    /// `image` is that of `opened`.
    State(std::span<std::byte> image, Model opened, const LiveTables& empty);

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
    /// Makes the image that of a bake of the same arrays.
    void complete_image();

    std::span<std::byte> image;
    Model model;

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

        void add(std::uint32_t vertex, const Double3& p);
        void remove(std::uint32_t vertex, const Double3& p);
    };

    template <class Given, class Kept>
    void set_all(std::span<const Given> given, std::span<Kept> kept, ParallelFor parallel_for);
    template <class Given, class Kept>
    void set_some(std::span<const std::uint32_t> vertices, std::span<const Given> given,
                  std::span<Kept> kept, ParallelFor parallel_for);
    /// Chooses a frame if the present one does not hold all vertices, and fits the boxes.
    template <class Kept>
    void fit(std::span<Kept> kept, bool all, bool is_in_frame, ParallelFor parallel_for);
    template <class Kept>
    void fit_all(std::span<const Kept> positions, ParallelFor parallel_for);
    template <class Kept>
    void fit_changed(std::span<const Kept> positions, ParallelFor parallel_for);
    [[nodiscard]] bool is_in_frame(const Double3& p) const;
    [[nodiscard]] bool is_small_in_frame() const;
    [[nodiscard]] bool has_exact_leaves() const;
    void update_header();

    build::Frame frame_;
    Sums sums_;
};

}  // namespace cdprep
