// SPDX-License-Identifier: MIT
#include "live/live_start.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "build/bad_argument.h"
#include "build/degenerate.h"
#include "build/frame_map.h"
#include "build/make_leaves.h"
#include "build/make_nodes.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/sections.h"
#include "live/spread.h"

namespace cdprep {
namespace {

using build::bad_argument;
using build::Frame;
using format::Double3;
using format::Float3;
using format::kBvhWidth;
using format::SectionId;

/// Returns the facts without swept spheres, which a live model omits.
format::FileHeader facts_of(format::FileHeader base) {
    base.flags &= ~(format::model_swept_lines | format::model_swept_rectangles);
    return base;
}

/// Corners of triangles are numbered in 32 bits, and one number means none.
constexpr std::uint32_t kMostPlaces = 0xfffffffe / 3;

/// Returns the first number that occurs twice, if any.
std::optional<std::uint32_t> find_repeat(std::span<const std::uint32_t> numbers) {
    if (numbers.empty()) return std::nullopt;
    std::vector<bool> seen(std::size_t{std::ranges::max(numbers)} + 1);
    for (const std::uint32_t number : numbers) {
        if (seen[number]) return number;
        seen[number] = true;
    }
    return std::nullopt;
}

/// Returns the positions of vertices by their number in the imported file. Numbers without a vertex
/// get that of the first vertex.
template <class Position>
std::vector<Position> by_number(std::span<const Position> positions,
                                std::span<const std::uint32_t> numbers, std::size_t count) {
    std::vector<Position> sorted(count, positions.empty() ? Position{} : positions.front());
    for (std::size_t i = 0; i < positions.size(); ++i) sorted[numbers[i]] = positions[i];
    return sorted;
}

}  // namespace

LiveBase::LiveBase(const build::ModelArrays& arrays)
    : facts(facts_of(arrays.facts)),
      has_doubles(arrays.precision == build::Precision::double_precision),
      positions_f32(arrays.positions_f32),
      positions_f64(arrays.positions_f64),
      triangles(arrays.triangles),
      source_triangle(arrays.bvh.order),
      source_vertex(arrays.source_vertex),
      nodes(arrays.bvh.nodes),
      leaves(arrays.bvh.leaves),
      degenerate_bits(arrays.degenerate_bits),
      components(arrays.components) {}

LiveBase::LiveBase(const Model& model)
    : facts(facts_of(model.header())),
      has_doubles(model.sections().contains(SectionId::positions_f64)),
      positions_f32(model.mesh().positions_f32),
      positions_f64(model.mesh().positions_f64),
      triangles(model.mesh().triangles),
      source_triangle(model.source().triangle),
      source_vertex(model.source().vertex),
      nodes(model.bvh().nodes),
      leaves(model.bvh().leaves),
      degenerate_bits(model.mesh().degenerate_bits) {
    if (model.sections().contains(SectionId::components)) components = model.record().components;
}

std::size_t LiveBase::number_count() const {
    return source_vertex.empty() ? 0 : std::size_t{std::ranges::max(source_vertex)} + 1;
}

std::optional<Error> find_base_fault(const Model& base) {
    for (const SectionId id :
         {SectionId::triangles, SectionId::source_triangle, SectionId::source_vertex,
          SectionId::bvh_nodes, SectionId::bvh_leaves}) {
        if (base.sections().contains(id)) continue;
        return bad_argument(std::string("A live model needs the section ") +
                            format::section_name(id) +
                            ": bake it with --effects overlap, and open it with that section.");
    }
    if (!base.sections().contains(SectionId::positions_f32) &&
        !base.sections().contains(SectionId::positions_f64)) {
        return bad_argument(
            "A live model needs positions: bake the mesh with --effects overlap, and open the "
            "model for overlap.");
    }
    if (!base.bvh().lanes.empty()) {
        return bad_argument(
            "A live model that can tear cannot be the base of another: build one from its "
            "triangles().");
    }
    const auto source = base.source().vertex;
    const auto made = std::ranges::find(source, format::kMadeByRepair);
    if (made != source.end()) {
        return bad_argument("A live model cannot be made of this model: vertex " +
                            std::to_string(made - source.begin()) +
                            " was made by a repair, so the imported file has no position for it.");
    }
    const auto vertex = find_repeat(source);
    const auto triangle = find_repeat(base.source().triangle);
    if (!vertex && !triangle) return std::nullopt;
    return bad_argument("A live model cannot be made of this model: two of its " +
                        std::string(vertex ? "vertices" : "triangles") + " have the number " +
                        std::to_string(vertex ? *vertex : *triangle) + ".");
}

std::optional<Error> find_limit_fault(const LiveBase& base, const LiveLimits& limits) {
    if (base.triangles.size() > kMostPlaces) {
        return bad_argument("A live model has at most " + std::to_string(kMostPlaces) +
                            " triangles, but the base has " +
                            std::to_string(base.triangles.size()) + ".");
    }
    if (limits.triangles == 0 && limits.vertices == 0) return std::nullopt;
    if (limits.triangles == 0) {
        return bad_argument("A limit of vertices has no meaning without a limit of triangles.");
    }
    if (limits.triangles < std::max<std::size_t>(base.triangles.size(), 1)) {
        return bad_argument("The limit of " + std::to_string(limits.triangles) +
                            " triangles is too low: the base has " +
                            std::to_string(base.triangles.size()) + ".");
    }
    if (limits.vertices != 0 && limits.vertices < base.number_count()) {
        return bad_argument("The limit of " + std::to_string(limits.vertices) +
                            " vertices is too low: the base has " +
                            std::to_string(base.number_count()) + ".");
    }
    if (std::uint64_t{limits.triangles} * kFreeShare / (kFreeShare - 1) + kBvhWidth > kMostPlaces) {
        return bad_argument("The limit of " + std::to_string(limits.triangles) +
                            " triangles is too high: with free places, a live model has at most " +
                            std::to_string(kMostPlaces) + ".");
    }
    if (limits.vertices > format::kMaxVertices) {
        return bad_argument("The limit of " + std::to_string(limits.vertices) +
                            " vertices is too high: a model has at most " +
                            std::to_string(format::kMaxVertices) + ".");
    }
    return std::nullopt;
}

std::uint32_t places_for(std::uint32_t triangles) {
    const std::uint64_t places =
        (triangles * kFreeShare + kFreeShare - 2) / (kFreeShare - 1);  // rounded up
    return static_cast<std::uint32_t>((places + kBvhWidth - 1) / kBvhWidth * kBvhWidth);
}

std::uint32_t vertices_for(const LiveBase& base, const LiveLimits& limits) {
    if (limits.triangles == 0) return static_cast<std::uint32_t>(base.source_vertex.size());
    if (limits.vertices != 0) return limits.vertices;
    return static_cast<std::uint32_t>(std::max<std::size_t>(base.number_count(), 1));
}

LiveStart::LiveStart(const LiveBase& base, const LiveLimits& limits) : facts_(base.facts) {
    limits.triangles == 0 ? keep_order(base) : make_room(base, limits);
}

void LiveStart::keep_order(const LiveBase& base) {
    base.has_doubles ? list_.add(SectionId::positions_f64, base.positions_f64)
                     : list_.add(SectionId::positions_f32, base.positions_f32);
    list_.add(SectionId::triangles, base.triangles);
    list_.add(SectionId::source_triangle, base.source_triangle);
    list_.add(SectionId::source_vertex, base.source_vertex);
    list_.add(SectionId::bvh_nodes, base.nodes);
    list_.add(SectionId::bvh_leaves, base.leaves);
    if (base.components) list_.add(SectionId::components, *base.components);
    if (base.degenerate_bits.empty()) {
        marks_.resize((base.triangles.size() + 63) / 64);
        list_.add(SectionId::degenerate_bits, marks_);
    } else {
        list_.add(SectionId::degenerate_bits, base.degenerate_bits);
    }
}

/// Free places repeat a triangle. So the image is that of a model, which can be opened and checked.
void LiveStart::make_room(const LiveBase& base, const LiveLimits& limits) {
    const std::uint32_t vertices = vertices_for(base, limits);
    facts_.vertex_count = vertices;
    facts_.triangle_count = places_for(limits.triangles);
    source_vertex_.resize(vertices);
    std::iota(source_vertex_.begin(), source_vertex_.end(), 0U);
    place_triangles(base);
    if (base.has_doubles) {
        positions_f64_ = by_number(base.positions_f64, base.source_vertex, vertices);
        fit(std::span<const Double3>(positions_f64_));
        list_.add(SectionId::positions_f64, positions_f64_);
    } else {
        positions_f32_ = by_number(base.positions_f32, base.source_vertex, vertices);
        fit(std::span<const Float3>(positions_f32_));
        list_.add(SectionId::positions_f32, positions_f32_);
    }
    if (base.components) {
        components_.assign(base.components->begin(), base.components->end());
        for (format::Component& component : components_) {
            component.vertex = base.source_vertex[component.vertex];
        }
        // An empty base has no component, but its free places count as triangles of one.
        if (components_.empty()) components_.emplace_back();
        components_[0].triangle_count +=
            facts_.triangle_count - static_cast<std::uint32_t>(base.triangles.size());
        list_.add(SectionId::components, components_);
    }
    list_.add(SectionId::triangles, triangles_);
    list_.add(SectionId::source_triangle, source_triangle_);
    list_.add(SectionId::source_vertex, source_vertex_);
    list_.add(SectionId::bvh_nodes, nodes_);
    list_.add(SectionId::bvh_leaves, leaves_);
    list_.add(SectionId::degenerate_bits, marks_);
}

/// Distributes the triangles over all leaves.
void LiveStart::place_triangles(const LiveBase& base) {
    const std::uint32_t leaf_count = facts_.triangle_count / kBvhWidth;
    const build::FrameMap map({facts_.frame_origin, facts_.frame_exponent});
    const auto position = [&](std::uint32_t vertex) {
        return base.has_doubles ? base.positions_f64[vertex]
                                : build::as_double(base.positions_f32[vertex]);
    };
    std::vector<SpreadItem> items;
    items.reserve(base.triangles.size());
    for (std::uint32_t i = 0; i < base.triangles.size(); ++i) {
        const auto& v = base.triangles[i].vertex;
        items.push_back({middle_of(map, position(v[0]), position(v[1]), position(v[2])),
                         base.source_triangle[i], i});
    }
    spread(items, leaf_count, Fill::even);
    triangles_.resize(facts_.triangle_count);
    source_triangle_.resize(facts_.triangle_count);
    lanes_.resize(leaf_count);
    for (std::uint32_t leaf = 0; leaf < leaf_count; ++leaf) {
        const std::size_t first = first_in_leaf(items.size(), leaf, leaf_count, Fill::even);
        const std::size_t count =
            first_in_leaf(items.size(), leaf + 1, leaf_count, Fill::even) - first;
        lanes_[leaf] = static_cast<std::uint8_t>((1U << count) - 1);
        for (std::size_t lane = 0; lane < kBvhWidth && !items.empty(); ++lane) {
            const std::size_t at =
                count == 0 ? std::min(first, items.size() - 1) : first + std::min(lane, count - 1);
            const std::uint32_t from = items[at].from;
            const std::size_t place = std::size_t{leaf} * kBvhWidth + lane;
            source_triangle_[place] = base.source_triangle[from];
            for (std::size_t k = 0; k < 3; ++k) {
                triangles_[place].vertex[k] = base.source_vertex[base.triangles[from].vertex[k]];
            }
        }
    }
}

/// Fits boxes and leaves. The frame is that of the base, which holds all positions.
template <class Position>
void LiveStart::fit(std::span<const Position> positions) {
    const auto shape = format::bvh_shape(facts_.triangle_count);
    nodes_.resize(shape.node_count);
    leaves_.resize(shape.leaf_count);
    marks_.resize((std::size_t{facts_.triangle_count} + 63) / 64);
    const Frame frame = {facts_.frame_origin, facts_.frame_exponent};
    const bool is_exact = (facts_.flags & format::model_exact_leaves) != 0;
    build::make_leaves({frame, is_exact, nodes_, leaves_}, positions, triangles_, serial_for);
    build::make_nodes(nodes_, facts_.triangle_count, serial_for);
    build::mark_degenerate(positions, triangles_, marks_, serial_for);
}

}  // namespace cdprep
