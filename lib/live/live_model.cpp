// SPDX-License-Identifier: MIT
#include "cdprep/live_model.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "build/bad_argument.h"
#include "build/degenerate.h"
#include "build/frame_map.h"
#include "build/make_leaves.h"
#include "build/make_nodes.h"
#include "build/mesh_fault.h"
#include "cdprep/format/checksum.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/format/make_user_block.h"
#include "cdprep/format/sections.h"
#include "core/guarded_for.h"

namespace cdprep {
namespace {

using format::Double3;
using format::Float3;
using format::SectionEntry;
using format::SectionId;
using format::SectionSet;
using format::Triangle;
using build::bad_argument;
using build::Frame;
using build::ModelArrays;
using build::SectionList;

/// The sections of a live model: those that follow from its positions, and those that do not
/// depend on them.
constexpr SectionSet kSections = {
    SectionId::positions_f32,   SectionId::positions_f64,   SectionId::triangles,
    SectionId::source_triangle, SectionId::source_vertex,   SectionId::bvh_nodes,
    SectionId::bvh_leaves,      SectionId::degenerate_bits, SectionId::components};

/// Returns the facts without swept spheres, which a live model omits.
format::FileHeader facts_of(format::FileHeader base) {
    base.flags &= ~(format::model_swept_lines | format::model_swept_rectangles);
    return base;
}

/// The parts of a live model: views of its base.
struct Start {
    format::FileHeader facts;
    SectionList list;
    /// A triangle may become degenerate, so the model has marks even if none is set.
    std::vector<std::uint64_t> no_marks;

    Start(const format::FileHeader& base, SectionList views, bool has_marks)
        : facts(facts_of(base)), list(std::move(views)) {
        if (has_marks) return;
        no_marks.resize((std::size_t{base.triangle_count} + 63) / 64);
        list.add(SectionId::degenerate_bits, no_marks);
    }
    // The list has a view of the marks.
    Start(const Start&) = delete;
    Start& operator=(const Start&) = delete;
};

/// Returns why a model cannot be the base of a live model.
std::optional<Error> find_fault(const Model& base) {
    for (const SectionId id :
         {SectionId::triangles, SectionId::source_triangle, SectionId::source_vertex,
          SectionId::bvh_nodes, SectionId::bvh_leaves}) {
        if (base.sections().contains(id)) continue;
        return bad_argument(std::string("A live model needs the section ") +
                            format::section_name(id) +
                            ": bake it with --effects overlap, and open it "
                            "with that section.");
    }
    if (!base.sections().contains(SectionId::positions_f32) &&
        !base.sections().contains(SectionId::positions_f64)) {
        return bad_argument(
            "A live model needs positions: bake the mesh with --effects overlap, and open the "
            "model for overlap.");
    }
    const auto source = base.source().vertex;
    const auto made = std::ranges::find(source, format::kMadeByRepair);
    if (made == source.end()) return std::nullopt;
    return bad_argument("A live model cannot be made of this model: vertex " +
                        std::to_string(made - source.begin()) +
                        " was made by a repair, so the imported file has no position for it.");
}

SectionList views_of(const Model& base) {
    SectionList list(kSections);
    const SectionSet present = base.sections();
    const auto add = [&](SectionId id, const auto& elements) {
        if (present.contains(id)) list.add(id, elements);
    };
    add(SectionId::positions_f32, base.mesh().positions_f32);
    add(SectionId::positions_f64, base.mesh().positions_f64);
    add(SectionId::triangles, base.mesh().triangles);
    add(SectionId::source_triangle, base.source().triangle);
    add(SectionId::source_vertex, base.source().vertex);
    add(SectionId::bvh_nodes, base.bvh().nodes);
    add(SectionId::bvh_leaves, base.bvh().leaves);
    add(SectionId::components, base.record().components);
    list.add_unless_empty(SectionId::degenerate_bits, base.mesh().degenerate_bits);
    return list;
}

Start start_of(const ModelArrays& base) {
    return {base.facts, base.sections(kSections), !base.degenerate_bits.empty()};
}

Start start_of(const Model& base) {
    return {base.header(), views_of(base), !base.mesh().degenerate_bits.empty()};
}

/// Returns the elements of a section of a checked image.
template <class Element>
std::span<Element> elements_of(std::span<std::byte> image, SectionId id) {
    const std::optional<SectionEntry> entry = format::find_section(image, id);
    if (!entry || entry->count == 0) return {};
    return {reinterpret_cast<Element*>(image.data() + entry->offset),
            static_cast<std::size_t>(entry->count)};
}

/// The section table of an image, to be changed and written back.
struct Table {
    explicit Table(std::span<const std::byte> image)
        : count(format::read_header(image).section_count) {
        std::memcpy(entries.data(), image.data() + format::kSectionTableOffset,
                    count * sizeof(SectionEntry));
    }
    [[nodiscard]] std::span<SectionEntry> used() {
        return std::span(entries).first(count);
    }
    /// Computes the checksum of a section again.
    static void sum(std::span<const std::byte> image, SectionEntry& entry) {
        entry.checksum = format::checksum(
            image.subspan(static_cast<std::size_t>(entry.offset),
                          static_cast<std::size_t>(entry.count * entry.element_size)));
    }
    void put(std::span<std::byte> image, const format::FileHeader& facts) {
        constexpr std::array<std::byte, sizeof(format::FileHeader::superblock)> kEmptySuperblock{};
        const format::UserBlock block =
            format::make_user_block(facts, used(), kEmptySuperblock, image.size());
        std::memcpy(image.data(), block.data(), block.size());
    }

    std::uint32_t count;
    std::array<SectionEntry, format::kMaxSections> entries{};
};

bool shares_memory(std::span<const std::byte> a, std::span<const std::byte> b) {
    const std::less<> before;
    return !a.empty() && !b.empty() && before(a.data(), b.data() + b.size()) &&
           before(b.data(), a.data() + a.size());
}

bool is_positions(SectionId id) {
    return id == SectionId::positions_f32 || id == SectionId::positions_f64;
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

LiveModel::LiveModel(std::span<std::byte> image, Model model)
    : image_(image),
      model_(std::move(model)),
      moving_{elements_of<Float3>(image, SectionId::positions_f32),
              elements_of<Double3>(image, SectionId::positions_f64),
              elements_of<format::BvhNode>(image, SectionId::bvh_nodes),
              elements_of<format::BvhLeaf>(image, SectionId::bvh_leaves),
              elements_of<std::uint64_t>(image, SectionId::degenerate_bits),
              elements_of<format::Component>(image, SectionId::components)} {
    for (const std::uint32_t vertex : model_.source().vertex) {
        position_count_ = std::max(position_count_, std::size_t{vertex} + 1);
    }
}

Result<std::size_t> LiveModel::bytes(const ModelArrays& base) {
    return build::image_size(start_of(base).list.sections());
}

Result<std::size_t> LiveModel::bytes(const Model& base) {
    if (const auto fault = find_fault(base)) return *fault;
    return build::image_size(start_of(base).list.sections());
}

Result<LiveModel> LiveModel::in(std::span<std::byte> memory, const ModelArrays& base) {
    const Start start = start_of(base);
    return in(memory, start.facts, start.list);
}

Result<LiveModel> LiveModel::in(std::span<std::byte> memory, const Model& base) {
    if (const auto fault = find_fault(base)) return *fault;
    const Start start = start_of(base);
    return in(memory, start.facts, start.list);
}

Result<LiveModel> LiveModel::in(std::span<std::byte> memory, const format::FileHeader& facts,
                                      const SectionList& list) {
    const Result<std::span<std::byte>> image = build::build_image(facts, list.sections(), memory);
    if (!image) return image.error();
    Result<Model> opened =
        Model::open(std::span<const std::byte>(image.value()), {.name = "live model"});
    if (!opened) return opened.error();
    return LiveModel(image.value(), std::move(opened).value());
}

Result<double> LiveModel::refit(std::span<const Double3> positions, ParallelFor parallel_for) {
    if (!moving_.positions_f32.empty()) {
        return bad_argument(
            "The live model keeps positions as floats, and doubles were given: give "
            "floats, or build it from doubles.");
    }
    return refit_to(positions, parallel_for);
}

Result<double> LiveModel::refit(std::span<const Float3> positions, ParallelFor parallel_for) {
    return refit_to(positions, parallel_for);
}

template <class Position>
Result<double> LiveModel::refit_to(std::span<const Position> positions,
                                      ParallelFor parallel_for) {
    format::FloatEnvironment environment;
    const GuardedFor guarded(environment, parallel_for);
    if (positions.size() < position_count_) {
        return bad_argument("The live model has " + std::to_string(position_count_) +
                            " positions, and " + std::to_string(positions.size()) + " were given.");
    }
    const std::span<const Position> used = positions.first(position_count_);
    if (shares_memory(std::as_bytes(used), image_)) {
        return bad_argument(
            "The positions point into the live model itself, which stores them in another "
            "order: give a copy.");
    }
    if (const auto fault = build::find_bad_position(used)) return *fault;
    const std::span<const std::uint32_t> source = model_.source().vertex;
    if constexpr (std::is_same_v<Position, Float3>) {
        if (!moving_.positions_f32.empty()) {
            assert(source.size() == moving_.positions_f32.size());
            std::ranges::transform(source, moving_.positions_f32.begin(),
                                   [&](std::uint32_t vertex) { return used[vertex]; });
            return refit_over(model_.mesh().positions_f32, guarded);
        }
    }
    assert(source.size() == moving_.positions_f64.size());
    std::ranges::transform(source, moving_.positions_f64.begin(),
                           [&](std::uint32_t vertex) { return build::as_double(used[vertex]); });
    return refit_over(model_.mesh().positions_f64, guarded);
}

/// Computes everything that follows from the positions, which are in the image.
template <class Kept>
double LiveModel::refit_over(std::span<const Kept> positions, ParallelFor parallel_for) {
    if (moving_.leaves.empty()) return 0;
    const build::Extent extent = build::extent_of(positions, parallel_for);
    const Frame frame = build::frame_of(extent);
    const bool exact = build::has_exact_leaves(extent, frame);
    const std::span<const Triangle> triangles = model_.mesh().triangles;
    build::make_leaves({frame, exact, moving_.nodes, moving_.leaves}, positions, triangles, parallel_for);
    build::make_nodes(moving_.nodes, static_cast<std::uint32_t>(triangles.size()), parallel_for);
    build::mark_degenerate(positions, triangles, moving_.degenerate_bits, parallel_for);
    update_header(frame, exact);
    return build::surface_cost(moving_.nodes);
}

/// The content hash must distinguish these positions from any others, because caches compare it.
/// All else that moves follows from the positions, so their checksum is enough.
void LiveModel::update_header(const Frame& frame, bool exact_leaves) {
    format::FileHeader facts = format::read_header(image_);
    facts.flags &= ~format::model_exact_leaves;
    if (exact_leaves) facts.flags |= format::model_exact_leaves;
    facts.frame_origin = frame.origin;
    facts.frame_exponent = frame.exponent;
    Table table(image_);
    for (SectionEntry& entry : table.used()) {
        if (is_positions(entry.id)) Table::sum(image_, entry);
    }
    table.put(image_, facts);
}

std::span<const std::byte> LiveModel::image() {
    const format::FloatEnvironment environment;
    const build::Topology topology = build::find_topology(positions_of(model_), in_source_order(model_));
    if (moving_.components.size() == topology.components.size()) {
        std::ranges::copy(topology.components, moving_.components.begin());
    }
    Table table(image_);
    for (SectionEntry& entry : table.used()) Table::sum(image_, entry);
    table.put(image_, format::read_header(image_));
    return image_;
}

}  // namespace cdprep
