// SPDX-License-Identifier: MIT
#include "cdprep/live_model.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "build/bad_argument.h"
#include "build/mesh_fault.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/format/sections.h"
#include "core/guarded_for.h"
#include "live/live_state.h"

namespace cdprep {
namespace {

using build::bad_argument;
using build::ModelArrays;
using build::SectionList;
using format::Double3;
using format::Float3;
using format::SectionId;
using format::SectionSet;

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
    std::size_t vertices;
    std::size_t numbers;  ///< of vertices in the imported file, without unused ones at its end
    /// A triangle may become degenerate, so the model has marks even if none is set.
    std::vector<std::uint64_t> no_marks;

    Start(const format::FileHeader& base, SectionList views, bool has_marks,
          std::span<const std::uint32_t> source_vertex)
        : facts(facts_of(base)),
          list(std::move(views)),
          vertices(source_vertex.size()),
          numbers(vertices == 0 ? 0 : std::size_t{std::ranges::max(source_vertex)} + 1) {
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
    return {base.facts, base.sections(kSections), !base.degenerate_bits.empty(),
            base.source_vertex};
}

Start start_of(const Model& base) {
    return {base.header(), views_of(base), !base.mesh().degenerate_bits.empty(),
            base.source().vertex};
}

LiveTables tables_of(const Start& start, Carver& carver) {
    return {carver, start.numbers, start.vertices, start.facts.triangle_count};
}

Result<std::size_t> bytes_of(const Start& start) {
    const Result<std::size_t> image = build::image_size(start.list.sections());
    if (!image) return image.error();
    Carver carver(nullptr);
    tables_of(start, carver);
    return *image + carver.used();
}

/// A live model, as far as it is made without its state.
struct Made {
    std::span<std::byte> image;
    Model model;
    LiveTables tables;
};

Result<Made> make(std::span<std::byte> memory, const Start& start) {
    const Result<std::size_t> size = bytes_of(start);
    if (!size) return size.error();
    if (memory.size() < *size) {
        return bad_argument("The live model takes " + std::to_string(*size) + " bytes, and " +
                            std::to_string(memory.size()) + " were given.");
    }
    const Result<std::span<std::byte>> image =
        build::build_image(start.facts, start.list.sections(), memory);
    if (!image) return image.error();
    Result<Model> opened = Model::open(std::span<const std::byte>(*image), {.name = "live model"});
    if (!opened) return opened.error();
    Carver carver(image->data() + image->size());
    return Made{*image, std::move(opened).value(), tables_of(start, carver)};
}

bool shares_memory(std::span<const std::byte> a, std::span<const std::byte> b) {
    const std::less<> before;
    return !a.empty() && !b.empty() && before(a.data(), b.data() + b.size()) &&
           before(b.data(), a.data() + a.size());
}

}  // namespace

LiveModel::LiveModel(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
LiveModel::LiveModel(LiveModel&&) noexcept = default;
LiveModel& LiveModel::operator=(LiveModel&&) noexcept = default;
LiveModel::~LiveModel() = default;

Result<std::size_t> LiveModel::bytes(const ModelArrays& base) {
    return bytes_of(start_of(base));
}

Result<std::size_t> LiveModel::bytes(const Model& base) {
    if (const auto fault = find_fault(base)) return *fault;
    return bytes_of(start_of(base));
}

Result<LiveModel> LiveModel::in(std::span<std::byte> memory, const ModelArrays& base) {
    Result<Made> made = make(memory, start_of(base));
    if (!made) return made.error();
    return LiveModel(std::make_unique<State>(made->image, std::move(made->model), made->tables));
}

Result<LiveModel> LiveModel::in(std::span<std::byte> memory, const Model& base) {
    if (const auto fault = find_fault(base)) return *fault;
    Result<Made> made = make(memory, start_of(base));
    if (!made) return made.error();
    return LiveModel(std::make_unique<State>(made->image, std::move(made->model), made->tables));
}

const Model& LiveModel::model() const noexcept {
    return state_->model;
}

std::size_t LiveModel::position_count() const noexcept {
    return state_->tables.vertex_of.size();
}

double LiveModel::surface_cost() const noexcept {
    return build::surface_cost(state_->nodes);
}

Result<Done> LiveModel::refit(std::span<const Double3> positions, ParallelFor parallel_for) {
    return refit_all(positions, parallel_for);
}

Result<Done> LiveModel::refit(std::span<const Float3> positions, ParallelFor parallel_for) {
    return refit_all(positions, parallel_for);
}

Result<Done> LiveModel::refit(std::span<const std::uint32_t> vertices,
                              std::span<const Double3> positions, ParallelFor parallel_for) {
    return refit_some(vertices, positions, parallel_for);
}

Result<Done> LiveModel::refit(std::span<const std::uint32_t> vertices,
                              std::span<const Float3> positions, ParallelFor parallel_for) {
    return refit_some(vertices, positions, parallel_for);
}

template <class Position>
Result<Done> LiveModel::refit_all(std::span<const Position> positions, ParallelFor parallel_for) {
    format::FloatEnvironment environment;
    const GuardedFor guarded(environment, parallel_for);
    if (positions.size() < position_count()) {
        return bad_argument("The live model has " + std::to_string(position_count()) +
                            " positions, and " + std::to_string(positions.size()) + " were given.");
    }
    const std::span<const Position> used = positions.first(position_count());
    if (const auto fault = state_->find_fault(used, {})) return *fault;
    state_->set_all(used, guarded);
    return Done{};
}

template <class Position>
Result<Done> LiveModel::refit_some(std::span<const std::uint32_t> vertices,
                                   std::span<const Position> positions, ParallelFor parallel_for) {
    format::FloatEnvironment environment;
    const GuardedFor guarded(environment, parallel_for);
    if (vertices.size() != positions.size()) {
        return bad_argument(std::to_string(vertices.size()) + " vertices and " +
                            std::to_string(positions.size()) + " positions were given.");
    }
    const auto beyond = std::ranges::find_if(
        vertices, [&](std::uint32_t vertex) { return vertex >= position_count(); });
    if (beyond != vertices.end()) {
        return bad_argument("Vertex " + std::to_string(*beyond) + " does not exist: there are " +
                            std::to_string(position_count()) + ", numbered from 0.");
    }
    if (const auto fault = state_->find_fault(positions, vertices)) return *fault;
    state_->set_some(vertices, positions, guarded);
    return Done{};
}

template <class Position>
std::optional<Error> LiveModel::State::find_fault(std::span<const Position> positions,
                                                  std::span<const std::uint32_t> vertices) const {
    if (std::is_same_v<Position, Double3> && !positions_f32.empty()) {
        return bad_argument(
            "The live model keeps positions as floats, and doubles were given: give floats, or "
            "build it from doubles.");
    }
    if (shares_memory(std::as_bytes(positions), image)) {
        return bad_argument(
            "The positions point into the live model itself, which stores them in another order: "
            "give a copy.");
    }
    return build::find_bad_position(positions, vertices);
}

std::span<const std::byte> LiveModel::image() {
    const format::FloatEnvironment environment;
    state_->complete_image();
    return state_->image;
}

}  // namespace cdprep
