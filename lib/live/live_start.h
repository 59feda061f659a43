// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/advanced/section_list.h"
#include "cdprep/live_model.h"

namespace cdprep {

/// What a live model takes of the model or the arrays that it is made of.
struct LiveBase {
    format::FileHeader facts;
    bool has_doubles;
    std::span<const format::Float3> positions_f32;
    std::span<const format::Double3> positions_f64;
    std::span<const format::Triangle> triangles;
    std::span<const std::uint32_t> source_triangle;
    std::span<const std::uint32_t> source_vertex;
    std::span<const format::BvhNode> nodes;
    std::span<const format::BvhLeaf> leaves;
    std::span<const std::uint64_t> degenerate_bits;
    std::optional<std::span<const format::Component>> components;

    explicit LiveBase(const build::ModelArrays& arrays);
    explicit LiveBase(const Model& model);

    /// Returns the number of vertices of the imported file, without unused ones at its end.
    [[nodiscard]] std::size_t number_count() const;
};

/// Returns why a model cannot be the base of a live model.
[[nodiscard]] std::optional<Error> find_base_fault(const Model& base);
/// Returns why a live model of this base cannot have these limits.
[[nodiscard]] std::optional<Error> find_limit_fault(const LiveBase& base, const LiveLimits& limits);

/// A ninth of the places stays free, so that triangles find a place near their neighbours.
inline constexpr std::uint64_t kFreeShare = 9;

/// The number of places for at most so many triangles.
[[nodiscard]] std::uint32_t places_for(std::uint32_t triangles);
/// The number of vertices of the model: of one that can tear, those that triangles may use.
[[nodiscard]] std::uint32_t vertices_for(const LiveBase& base, const LiveLimits& limits);

/// The sections from which the image of a live model is made.
class LiveStart {
public:
    LiveStart(const LiveBase& base, const LiveLimits& limits);
    // The list has views of the arrays.
    LiveStart(const LiveStart&) = delete;
    LiveStart& operator=(const LiveStart&) = delete;

    [[nodiscard]] const format::FileHeader& facts() const {
        return facts_;
    }
    [[nodiscard]] std::span<const build::Section> sections() const {
        return list_.sections();
    }
    /// Of a model that can tear, the places of each leaf that have a triangle; otherwise empty.
    [[nodiscard]] std::span<const std::uint8_t> lanes() const {
        return lanes_;
    }

private:
    void keep_order(const LiveBase& base);
    void make_room(const LiveBase& base, const LiveLimits& limits);
    void place_triangles(const LiveBase& base);
    template <class Position>
    void fit(std::span<const Position> positions);

    format::FileHeader facts_;
    build::SectionList list_;
    std::vector<std::uint8_t> lanes_;

    // Of a model that can tear.
    std::vector<format::Float3> positions_f32_;
    std::vector<format::Double3> positions_f64_;
    std::vector<format::Triangle> triangles_;
    std::vector<std::uint32_t> source_triangle_;
    std::vector<std::uint32_t> source_vertex_;
    std::vector<format::BvhNode> nodes_;
    std::vector<format::BvhLeaf> leaves_;
    std::vector<format::Component> components_;
    /// A triangle may become degenerate, so the model has marks even if none is set.
    std::vector<std::uint64_t> marks_;
};

}  // namespace cdprep
