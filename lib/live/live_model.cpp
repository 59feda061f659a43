// SPDX-License-Identifier: MIT
#include "cdprep/live_model.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "build/bad_argument.h"
#include "cdprep/format/float_environment.h"
#include "core/guarded_for.h"
#include "core/smallest.h"
#include "core/triangle_facts.h"
#include "live/live_start.h"
#include "live/live_state.h"

namespace cdprep {
namespace {

using build::bad_argument;
using build::ModelArrays;
using format::Double3;
using format::Float3;
using format::Triangle;

LiveTables tables_of(Carver& carver, const LiveBase& base, const LiveLimits& limits) {
    const bool can_tear = limits.triangles > 0;
    const std::size_t vertices = vertices_for(base, limits);
    return {carver,
            {can_tear ? vertices : base.number_count(), vertices,
             can_tear ? places_for(limits.triangles)
                      : static_cast<std::uint32_t>(base.triangles.size()),
             can_tear}};
}

/// Returns the number of bytes behind the image.
std::size_t tables_size(const LiveBase& base, const LiveLimits& limits) {
    Carver carver(nullptr);
    tables_of(carver, base, limits);
    return carver.used();
}

/// With 32 bits, memory does not hold the largest models that the limits allow.
std::optional<Error> find_size_fault(std::uint64_t size) {
    if (size <= PTRDIFF_MAX) return std::nullopt;
    return bad_argument("The live model needs at least " + std::to_string(size) +
                        " bytes, more than memory holds.");
}

Result<std::size_t> bytes_of(const LiveBase& base, const LiveLimits& limits,
                             std::span<const build::Section> sections) {
    const Result<std::size_t> image = build::image_size(sections);
    if (!image) return image.error();
    const std::uint64_t size = std::uint64_t{*image} + tables_size(base, limits);
    if (const auto fault = find_size_fault(size)) return *fault;
    return static_cast<std::size_t>(size);
}

Result<std::size_t> bytes_of(const LiveBase& base, const LiveLimits& limits) {
    const format::FloatEnvironment environment;
    if (const auto fault = find_limit_fault(base, limits)) return *fault;
    // Before the image takes memory.
    if (const auto fault = find_size_fault(tables_size(base, limits))) return *fault;
    return bytes_of(base, limits, LiveStart(base, limits).sections());
}

}  // namespace

LiveModel::LiveModel(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
LiveModel::LiveModel(LiveModel&&) noexcept = default;
LiveModel& LiveModel::operator=(LiveModel&&) noexcept = default;
LiveModel::~LiveModel() = default;

Result<LiveModel> LiveModel::State::make(std::span<std::byte> memory, const LiveBase& base,
                                         const LiveLimits& limits) {
    const format::FloatEnvironment environment;
    if (const auto fault = find_limit_fault(base, limits)) return *fault;
    const LiveStart start(base, limits);
    const Result<std::size_t> size = bytes_of(base, limits, start.sections());
    if (!size) return size.error();
    if (memory.size() < *size) {
        return bad_argument("The live model needs " + std::to_string(*size) + " bytes, but " +
                            std::to_string(memory.size()) + " were given.");
    }
    const Result<std::span<std::byte>> image =
        build::build_image(start.facts(), start.sections(), memory);
    if (!image) return image.error();
    Result<Model> opened = Model::open(std::span<const std::byte>(*image), {.name = "live model"});
    if (!opened) return opened.error();
    Carver carver(image->data() + image->size());
    return LiveModel(std::make_unique<State>(*image, std::move(opened).value(),
                                             tables_of(carver, base, limits), base, limits, start));
}

Result<std::size_t> LiveModel::bytes(const ModelArrays& base, const LiveLimits& limits) {
    return bytes_of(LiveBase(base), limits);
}

Result<std::size_t> LiveModel::bytes(const Model& base, const LiveLimits& limits) {
    if (const auto fault = find_base_fault(base)) return *fault;
    return bytes_of(LiveBase(base), limits);
}

Result<LiveModel> LiveModel::in(std::span<std::byte> memory, const ModelArrays& base,
                                const LiveLimits& limits) {
    return State::make(memory, LiveBase(base), limits);
}

Result<LiveModel> LiveModel::in(std::span<std::byte> memory, const Model& base,
                                const LiveLimits& limits) {
    if (const auto fault = find_base_fault(base)) return *fault;
    return State::make(memory, LiveBase(base), limits);
}

const Model& LiveModel::model() const noexcept {
    return state_->model;
}

std::size_t LiveModel::position_count() const noexcept {
    return state_->position_count();
}

std::uint32_t LiveModel::triangle_count() const noexcept {
    return state_->tables.tear ? state_->tables.tear->count : state_->model.triangle_count();
}

std::optional<std::uint32_t> LiveModel::place_of(std::uint32_t number) const noexcept {
    if (!state_->tables.tear) return std::nullopt;
    const std::uint32_t place = state_->tables.tear->ids.find(number);
    return place == IdMap::kNone ? std::nullopt : std::optional(place);
}

std::size_t LiveModel::triangles(std::span<LiveTriangle> room) const noexcept {
    if (!state_->tables.tear) return 0;
    Smallest<LiveTriangle> smallest(room);
    const Model& model = state_->model;
    each_triangle(model, 0, model.triangle_count(), [&](std::uint32_t place) {
        smallest.add({state_->source_triangle[place], state_->triangles[place].vertex});
        return true;
    });
    std::ranges::sort(smallest.kept(), {}, &LiveTriangle::number);
    return smallest.count();
}

std::uint32_t LiveModel::rebuild(std::uint32_t most_triangles) noexcept {
    const format::FloatEnvironment environment;
    return state_->rebuild(most_triangles);
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
    const std::size_t numbers = state_->tables.vertex_of.size();
    const auto beyond =
        std::ranges::find_if(vertices, [&](std::uint32_t vertex) { return vertex >= numbers; });
    if (beyond != vertices.end()) {
        return bad_argument("Vertex " + std::to_string(*beyond) + " does not exist: there are " +
                            std::to_string(numbers) + ", numbered from 0.");
    }
    if (const auto fault = state_->find_fault(positions, vertices)) return *fault;
    state_->set_some(vertices, positions, guarded);
    return Done{};
}

Result<std::uint32_t> LiveModel::append(std::span<const Triangle> triangles) {
    const format::FloatEnvironment environment;
    if (const auto fault = state_->find_fault(triangles)) return *fault;
    const std::uint32_t first = state_->tables.tear->next_id;
    state_->append(triangles);
    return first;
}

Result<Done> LiveModel::remove(std::span<const std::uint32_t> numbers) {
    const format::FloatEnvironment environment;
    if (const auto fault = state_->find_fault(numbers)) return *fault;
    state_->remove(numbers);
    return Done{};
}

Result<std::span<const std::byte>> LiveModel::image() {
    const format::FloatEnvironment environment;
    if (state_->tables.tear) {
        return bad_argument(
            "A live model that can tear has places without triangles: build a model of its "
            "triangles().");
    }
    state_->complete_image();
    return std::span<const std::byte>(state_->image);
}

}  // namespace cdprep
