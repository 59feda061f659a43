// SPDX-License-Identifier: MIT
#include "cdprep/advanced/build_model.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "build/degenerate.h"
#include "build/frame_map.h"
#include "build/mesh_fault.h"
#include "build/section_places.h"
#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/format/sections.h"
#include "core/guarded_for.h"

namespace cdprep::build {
namespace {

using format::Double3;
using format::Float3;
using format::SectionId;
using format::Triangle;

template <class Position>
std::optional<Error> find_fault(std::span<const Position> positions,
                                std::span<const Triangle> triangles) {
    if (auto fault = find_bad_position(positions)) return fault;
    return find_bad_triangle(positions.size(), triangles);
}

/// Adds the positions that triangles use, in the order of their first use.
void add_positions(ModelArrays& arrays, std::span<const Double3> positions) {
    const std::vector<std::uint32_t>& order = arrays.source_vertex;
    if (arrays.precision == Precision::double_precision) {
        arrays.positions_f64.reserve(order.size());
        for (const std::uint32_t vertex : order) arrays.positions_f64.push_back(positions[vertex]);
        return;
    }
    arrays.positions_f32.reserve(order.size());
    for (const std::uint32_t vertex : order) {
        const Double3& p = positions[vertex];
        arrays.positions_f32.push_back(
            {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
}

void add_degenerate_bits(ModelArrays& arrays, ParallelFor parallel_for) {
    std::vector<std::uint64_t> bits((arrays.triangles.size() + 63) / 64);
    if (arrays.precision == Precision::double_precision) {
        mark_degenerate(arrays.positions_f64, arrays.triangles, bits, parallel_for);
    } else {
        mark_degenerate(arrays.positions_f32, arrays.triangles, bits, parallel_for);
    }
    if (std::ranges::any_of(bits, [](std::uint64_t word) { return word != 0; })) {
        arrays.degenerate_bits = std::move(bits);
    }
}

format::FileHeader facts_of(const ModelArrays& arrays, bool is_balanced) {
    format::FileHeader facts{};
    facts.vertex_count = static_cast<std::uint32_t>(arrays.source_vertex.size());
    facts.triangle_count = static_cast<std::uint32_t>(arrays.triangles.size());
    if (is_balanced) facts.flags |= format::model_balanced;
    if (arrays.bvh.exact_leaves) facts.flags |= format::model_exact_leaves;
    facts.flags |= format::swept_flags(arrays.bvh.swept_kind);
    facts.frame_origin = arrays.bvh.frame.origin;
    facts.frame_exponent = arrays.bvh.frame.exponent;
    return facts;
}

}  // namespace

SectionList ModelArrays::sections(format::SectionSet wanted) const {
    SectionList list(wanted);
    if (precision == Precision::double_precision) {
        list.add(SectionId::positions_f64, positions_f64);
    } else {
        list.add(SectionId::positions_f32, positions_f32);
    }
    list.add(SectionId::triangles, triangles);
    list.add(SectionId::source_vertex, source_vertex);
    add_sections(list, bvh);
    list.add_unless_empty(SectionId::degenerate_bits, degenerate_bits);
    list.add(SectionId::components, components);
    return list;
}

std::uint64_t image_size_bound(const PlannedModel& planned) noexcept {
    const std::uint64_t triangles = planned.triangle_count;
    // Vertices that no triangle uses are omitted. A component has at least one vertex and one
    // triangle.
    const std::uint64_t vertices = std::min<std::uint64_t>(planned.vertex_count, 3 * triangles);
    const std::uint64_t components = std::min(vertices, triangles);
    const format::BvhShape shape = format::bvh_shape(planned.triangle_count);
    const bool is_single = planned.precision == Precision::single_precision;
    const bool has_oriented =
        planned.bounds == BvhBounds::oriented || planned.bounds == BvhBounds::oriented_and_swept;
    const bool has_swept = planned.bounds > BvhBounds::oriented;
    struct Most {
        SectionId id;
        std::uint64_t elements;
    };
    std::array most = {
        Most{SectionId::positions_f32, is_single ? vertices : 0},
        Most{SectionId::positions_f64, is_single ? 0 : vertices},
        Most{SectionId::triangles, triangles},
        Most{SectionId::source_vertex, vertices},
        Most{SectionId::source_triangle, triangles},
        Most{SectionId::bvh_nodes, shape.node_count},
        Most{SectionId::bvh_leaves, shape.leaf_count},
        Most{SectionId::oriented_nodes, has_oriented ? shape.node_count : 0},
        Most{SectionId::swept_nodes, has_swept ? shape.node_count : 0},
        Most{SectionId::degenerate_bits, (triangles + 63) / 64},
        Most{SectionId::components, components},
    };
    std::ranges::sort(most, {}, &Most::id);
    SectionPlaces places(ImageOptions{}.section_alignment);
    for (const Most& section : most) {
        if (!planned.wanted.contains(section.id)) continue;
        places.next(section.elements * format::element_size(section.id));
    }
    return places.end();
}

namespace {

/// The hook must run in the caller's floating-point environment. The builders below cannot see that
/// one, so the guard restores it for the hook.
BvhOptions guarded_options(const BvhOptions& options, const GuardedFor& guarded) {
    BvhOptions inner = options;
    inner.parallel_for = guarded;
    return inner;
}

}  // namespace

ModelArrays arrange_model(std::span<const Double3> positions, std::span<const Triangle> triangles,
                          Bvh bvh, Precision precision, ParallelFor parallel_for) {
    format::FloatEnvironment environment;
    const GuardedFor guarded(environment, parallel_for);
    ModelArrays arrays;
    arrays.bvh = std::move(bvh);
    arrays.precision = precision;
    TreeOrder ordered = in_tree_order(positions.size(), triangles, arrays.bvh.order);
    arrays.triangles = std::move(ordered.triangles);
    arrays.source_vertex = std::move(ordered.vertices);
    add_positions(arrays, positions);
    add_degenerate_bits(arrays, guarded);
    Topology topology = find_topology(positions, triangles);
    for (format::Component& component : topology.components) {
        component.vertex = ordered.new_vertex[component.vertex];
    }
    arrays.components = std::move(topology.components);
    arrays.facts = facts_of(arrays, topology.balanced);
    return arrays;
}

Result<ModelArrays> build_model(std::span<const Double3> positions,
                                std::span<const Triangle> triangles, const BvhOptions& options) {
    format::FloatEnvironment environment;
    const GuardedFor guarded(environment, options.parallel_for);
    if (const auto fault = find_fault(positions, triangles)) return *fault;
    return arrange_model(positions, triangles,
                         build_bvh(positions, triangles, guarded_options(options, guarded)),
                         Precision::double_precision, guarded);
}

Result<ModelArrays> build_model(std::span<const Float3> positions,
                                std::span<const Triangle> triangles, const BvhOptions& options) {
    format::FloatEnvironment environment;
    const GuardedFor guarded(environment, options.parallel_for);
    if (const auto fault = find_fault(positions, triangles)) return *fault;
    std::vector<Double3> doubles;
    doubles.reserve(positions.size());
    for (const Float3& p : positions) doubles.push_back(as_double(p));
    return arrange_model(doubles, triangles,
                         build_bvh(doubles, triangles, guarded_options(options, guarded)),
                         Precision::single_precision, guarded);
}

}  // namespace cdprep::build
