// SPDX-License-Identifier: MIT
#include "live/live_state.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "build/bad_argument.h"
#include "build/chunks.h"
#include "build/make_leaves.h"
#include "build/make_nodes.h"
#include "build/mesh_fault.h"
#include "cdprep/advanced/mesh_arrays.h"
#include "cdprep/format/portable.h"
#include "exact/powers_of_two.h"
#include "live/image_table.h"

// The frame stays as long as it holds all vertices and the model is not small in it. So a move of
// some vertices leaves the boxes of others as they are.

namespace cdprep {
namespace {

using build::bad_argument;
using build::Frame;
using build::frame_of;
using format::BvhNode;
using format::Double3;
using format::Float3;
using format::kBvhWidth;
using format::SectionEntry;
using format::SectionId;
using format::Triangle;

bool is_positions(SectionId id) {
    return id == SectionId::positions_f32 || id == SectionId::positions_f64;
}

/// Mixes the bits of two words. The constants are odd and have about as many ones as zeros.
std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
    std::uint64_t hash = a * 0xbf58476d1ce4e5b9 ^ std::rotl(b * 0x94d049bb133111eb, 32);
    hash = (hash ^ (hash >> 32)) * 0xa0761d6478bd642f;
    return (hash ^ (hash >> 29)) * 0xe7037ed1a0b428db;
}

/// Returns a number that differs, almost certainly, for other vertices and other positions.
std::uint64_t hash_of(std::uint32_t vertex, const Float3& p) {
    const auto bits = [](float x) { return std::uint64_t{format::bit_cast<std::uint32_t>(x)}; };
    return mixed(bits(p.x) | bits(p.y) << 32, bits(p.z) | std::uint64_t{vertex} << 32);
}
std::uint64_t hash_of(std::uint32_t vertex, const Double3& p) {
    const auto bits = [](double x) { return format::bit_cast<std::uint64_t>(x); };
    return mixed(mixed(bits(p.x), bits(p.y)), bits(p.z) + vertex * 0x9e3779b97f4a7c15);
}

bool is_float(const Float3& /*p*/) {
    return true;
}
bool is_float(const Double3& p) {
    const auto is_kept = [](double x) { return double{static_cast<float>(x)} == x; };
    return is_kept(p.x) && is_kept(p.y) && is_kept(p.z);
}

/// Returns a position in the precision of the model. Floats are not made of doubles.
template <class Kept, class Given>
Kept as_kept(const Given& p) {
    if constexpr (std::is_same_v<Kept, Given>) {
        return p;
    } else {
        return build::as_double(p);
    }
}

/// Returns the triangles in import order: components are numbered in that order.
std::vector<Triangle> in_source_order(const Model& model) {
    const auto triangles = model.mesh().triangles;
    std::vector<Triangle> sorted(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        sorted[model.source().triangle[i]] = triangles[i];
    }
    return sorted;
}

std::vector<Double3> positions_of(const Model& model) {
    std::vector<Double3> positions(model.mesh().positions_f64.begin(),
                                   model.mesh().positions_f64.end());
    for (const Float3& p : model.mesh().positions_f32) positions.push_back(build::as_double(p));
    return positions;
}

}  // namespace

template <class Kept>
void LiveModel::State::Sums::add(std::uint32_t vertex, const Kept& p) {
    hash += hash_of(vertex, p);
    rounded += is_float(p) ? 0 : 1;
}

template <class Kept>
void LiveModel::State::Sums::remove(std::uint32_t vertex, const Kept& p) {
    hash -= hash_of(vertex, p);
    rounded -= is_float(p) ? 0 : 1;
}

LiveModel::State::State(std::span<std::byte> bytes, Model opened, const LiveTables& empty,
                        const LiveBase& base, const LiveLimits& limits, const LiveStart& start)
    : image(bytes),
      model(std::move(opened)),
      triangles(elements_of<Triangle>(bytes, SectionId::triangles)),
      source_triangle(elements_of<std::uint32_t>(bytes, SectionId::source_triangle)),
      positions_f32(elements_of<Float3>(bytes, SectionId::positions_f32)),
      positions_f64(elements_of<Double3>(bytes, SectionId::positions_f64)),
      nodes(elements_of<BvhNode>(bytes, SectionId::bvh_nodes)),
      leaves(elements_of<format::BvhLeaf>(bytes, SectionId::bvh_leaves)),
      degenerate_bits(elements_of<std::uint64_t>(bytes, SectionId::degenerate_bits)),
      components(elements_of<format::Component>(bytes, SectionId::components)),
      tables(empty),
      frame_{model.header().frame_origin, model.header().frame_exponent} {
    model.set_live();
    std::ranges::fill(tables.vertex_of, kUnusedVertex);
    for (std::uint32_t i = 0; i < base.source_vertex.size(); ++i) {
        const std::uint32_t number = base.source_vertex[i];
        const std::uint32_t vertex = tables.tear ? number : i;
        tables.vertex_of[number] = vertex;
        with_positions([&](const auto& positions) { sums_.add(vertex, positions[vertex]); });
    }
    if (tables.tear) {
        start_to_tear(base, limits, start);
    } else {
        for (std::uint32_t place = 0; place < triangles.size(); ++place) {
            tables.users.add(place, triangles[place]);
        }
    }
    note_costs();
}

bool LiveModel::State::is_own(std::span<const std::byte> given) const {
    const std::less<> before;
    return !given.empty() && before(given.data(), image.data() + image.size()) &&
           before(image.data(), given.data() + given.size());
}

template <class Position>
std::optional<Error> LiveModel::State::find_fault(std::span<const Position> positions,
                                                  std::span<const std::uint32_t> vertices) const {
    if (std::is_same_v<Position, Double3> && !positions_f32.empty()) {
        return bad_argument(
            "The live model stores positions as floats, but doubles were given. Give floats, or "
            "build it from doubles.");
    }
    if (is_own(std::as_bytes(positions))) {
        return bad_argument(
            "The positions point into the live model itself, which stores them in another order: "
            "give a copy.");
    }
    return build::find_bad_position(positions, vertices);
}

template <class Given>
void LiveModel::State::set_all(std::span<const Given> positions, ParallelFor parallel_for) {
    if constexpr (std::is_same_v<Given, Float3>) {
        if (!positions_f32.empty()) return set_all(positions, positions_f32, parallel_for);
    }
    set_all(positions, positions_f64, parallel_for);
}

template <class Given>
void LiveModel::State::set_some(std::span<const std::uint32_t> vertices,
                                std::span<const Given> positions, ParallelFor parallel_for) {
    if constexpr (std::is_same_v<Given, Float3>) {
        if (!positions_f32.empty()) {
            return set_some(vertices, positions, positions_f32, parallel_for);
        }
    }
    set_some(vertices, positions, positions_f64, parallel_for);
}

template std::optional<Error> LiveModel::State::find_fault(std::span<const Double3>,
                                                           std::span<const std::uint32_t>) const;
template std::optional<Error> LiveModel::State::find_fault(std::span<const Float3>,
                                                           std::span<const std::uint32_t>) const;
template void LiveModel::State::set_all(std::span<const Double3>, ParallelFor);
template void LiveModel::State::set_all(std::span<const Float3>, ParallelFor);
template void LiveModel::State::set_some(std::span<const std::uint32_t>, std::span<const Double3>,
                                         ParallelFor);
template void LiveModel::State::set_some(std::span<const std::uint32_t>, std::span<const Float3>,
                                         ParallelFor);

template <class Given, class Kept>
void LiveModel::State::set_all(std::span<const Given> given, std::span<Kept> kept,
                               ParallelFor parallel_for) {
    const std::span<const std::uint32_t> source = model.source().vertex;
    const std::size_t count = tables.tear ? position_count() : kept.size();
    std::atomic<std::uint64_t> hash = 0;
    std::atomic<std::uint32_t> rounded = 0;
    std::atomic<bool> in_frame = true;
    const FrameBounds bounds = frame_bounds();
    for_chunks(count, build::kItemsPerTask, parallel_for, [&](std::size_t first, std::size_t last) {
        Sums part;
        bool fits = true;
        for (auto i = static_cast<std::uint32_t>(first); i < last; ++i) {
            kept[i] = as_kept<Kept>(given[source[i]]);
            part.add(i, kept[i]);
            fits &= bounds.hold(build::as_double(kept[i])) || !tables.users.is_used(i);
        }
        hash += part.hash;
        rounded += part.rounded;
        if (!fits) in_frame = false;
    });
    sums_ = {hash, rounded};
    for (std::uint32_t i = 0; tables.tear && i < count; ++i) tables.vertex_of[i] = i;
    fit(true, in_frame, parallel_for);
}

template <class Given, class Kept>
void LiveModel::State::set_some(std::span<const std::uint32_t> vertices,
                                std::span<const Given> given, std::span<Kept> kept,
                                ParallelFor parallel_for) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        std::uint32_t& vertex = tables.vertex_of[vertices[i]];
        if (vertex != kUnusedVertex) {
            sums_.remove(vertex, kept[vertex]);
        } else if (tables.tear) {
            vertex = vertices[i];
            tables.tear->positions = std::max(tables.tear->positions, vertex + 1);
        } else {
            continue;
        }
        kept[vertex] = as_kept<Kept>(given[i]);
        sums_.add(vertex, kept[vertex]);
        tables.users.each_at(vertex,
                             [&](std::uint32_t place) { tables.changed.mark(place / kBvhWidth); });
    }
    // A vertex may be listed twice: only its last position counts.
    const FrameBounds bounds = frame_bounds();
    const bool in_frame = std::ranges::all_of(vertices, [&](std::uint32_t number) {
        const std::uint32_t vertex = tables.vertex_of[number];
        return vertex == kUnusedVertex || !tables.users.is_used(vertex) ||
               bounds.hold(build::as_double(kept[vertex]));
    });
    fit(false, in_frame, parallel_for);
}

void LiveModel::State::fit(bool all, bool in_frame, ParallelFor parallel_for) {
    if (leaves.empty()) return;
    const bool was_exact = (model.header().flags & format::model_exact_leaves) != 0;
    if (!in_frame) frame_ = new_frame(parallel_for);
    if (!all) fit_changed(parallel_for);
    if (all || !in_frame || has_exact_leaves() != was_exact) fit_all(parallel_for);
    if (is_small_in_frame()) {
        const Frame tight = new_frame(parallel_for);
        if (tight.origin != frame_.origin || tight.exponent != frame_.exponent) {
            frame_ = tight;
            fit_all(parallel_for);
        }
    }
    update_header();
}

Frame LiveModel::State::new_frame(ParallelFor parallel_for) const {
    if (tables.tear) return tables.tear->count > 0 ? frame_of(used_extent()) : frame_;
    return with_positions(
        [&](const auto& positions) { return frame_of(build::extent_of(positions, parallel_for)); });
}

build::LeafRoom LiveModel::State::leaf_room() const {
    return {frame_,
            has_exact_leaves(),
            nodes,
            leaves,
            tables.tear ? tables.tear->lanes.data() : nullptr,
            degenerate_bits};
}

void LiveModel::State::fit_all(ParallelFor parallel_for) {
    with_positions([&](const auto& positions) {
        build::make_leaves(leaf_room(), positions, triangles, parallel_for);
    });
    build::make_nodes(nodes, static_cast<std::uint32_t>(triangles.size()), parallel_for);
}

void LiveModel::State::fit_changed(ParallelFor parallel_for) {
    with_positions([&](const auto& positions) {
        const build::LeafRoom room = leaf_room();
        tables.changed.sweep(
            parallel_for,
            [&](std::size_t first, std::size_t last) {
                build::make_some_leaves(room, positions, triangles, first, last);
            },
            [&](std::uint32_t level, std::size_t first, std::size_t last) {
                fit_boxes_around(level, first, last);
            });
    });
}

void LiveModel::State::fit_boxes_around(std::uint32_t level, std::size_t first, std::size_t last) {
    const format::BvhShape& shape = model.bvh().shape;
    for (std::size_t i = first; i < last; ++i) {
        build::set_box_around(nodes[shape.first[level + 1] + i / kBvhWidth], i % kBvhWidth,
                              nodes[shape.first[level] + i]);
    }
}

FrameBounds LiveModel::State::frame_bounds() const {
    // A new frame leaves twice the room that the vertices take, and more.
    constexpr double kReach = 1 - 0x1p-20;
    return {frame_.origin, Scale(-frame_.exponent)(kReach)};
}

/// Boxes have 24 bits of the frame: in a frame that is much too large they would be too large.
bool LiveModel::State::is_small_in_frame() const {
    constexpr float kSmall = 0.125F;  // sides of a new frame are at least 0.5 long
    const BvhNode& root = nodes[0];
    return std::ranges::all_of(std::array{0, 1, 2}, [&](std::size_t axis) {
        return std::ranges::max(root.upper[axis]) - std::ranges::min(root.lower[axis]) < kSmall;
    });
}

bool LiveModel::State::has_exact_leaves() const {
    return build::has_exact_leaves(sums_.rounded == 0, frame_);
}

/// Places follow from what there was before, which the content hash covers, and from the change. So
/// triangles that are removed again leave a trace: they may have moved others.
void LiveModel::State::note_places(std::uint64_t by) {
    places_ = mixed(model.header().content_hash ^ places_, by);
}

/// The content hash must distinguish these positions from any others, because caches compare it.
/// All else that changes follows from the positions, the triangles and their places, so these are
/// enough.
void LiveModel::State::update_header() {
    format::FileHeader facts = format::read_header(image);
    facts.flags &= ~format::model_exact_leaves;
    if (has_exact_leaves()) facts.flags |= format::model_exact_leaves;
    facts.frame_origin = frame_.origin;
    facts.frame_exponent = frame_.exponent;
    ImageTable table(image);
    for (SectionEntry& entry : table.entries()) {
        if (is_positions(entry.id)) entry.checksum = sums_.hash;
        if (places_ != 0 && entry.id == SectionId::bvh_leaves) entry.checksum = places_;
        if (tables.tear && entry.id == SectionId::triangles) entry.checksum = tables.tear->hash;
    }
    // Without triangles, no query looks at the places.
    if (tables.tear) {
        const bool is_empty = tables.tear->count == 0;
        facts.triangle_count = is_empty ? 0 : static_cast<std::uint32_t>(triangles.size());
    }
    table.write(facts);
}

void LiveModel::State::complete_image() {
    fit(true, false, serial_for);
    const build::Topology topology =
        build::find_topology(positions_of(model), in_source_order(model));
    if (components.size() == topology.components.size()) {
        std::ranges::copy(topology.components, components.begin());
    }
    ImageTable table(image);
    table.add_checksums();
    table.write(format::read_header(image));
}

}  // namespace cdprep
