// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cassert>
#include <string_view>
#include <utility>
#include <vector>

#include "c/c_mesh.h"
#include "c/c_model.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/format/sections.h"
#include "core/moved_model.h"
#include "core/triangle_facts.h"

namespace cdprep::c {
namespace {

static_assert(sizeof(cdprep_verdict) == sizeof(format::Verdict) &&
              offsetof(cdprep_verdict, genus) == offsetof(format::Verdict, genus) &&
              offsetof(cdprep_verdict, volume) == offsetof(format::Verdict, volume));
static_assert(CDPREP_FACT_CLOSED == int{format::verdict_closed} &&
              CDPREP_FACT_TWO_MANIFOLD == int{format::verdict_two_manifold} &&
              CDPREP_FACT_ORIENTED == int{format::verdict_oriented} &&
              CDPREP_FACT_ORIENTABLE == int{format::verdict_orientable} &&
              CDPREP_FACT_BALANCED == int{format::verdict_balanced} &&
              CDPREP_FACT_INVERTED == int{format::verdict_inverted} &&
              CDPREP_FACT_CROSSINGS_EXAMINED == int{format::verdict_crossings_examined} &&
              CDPREP_FACT_SELF_CROSSING == int{format::verdict_self_crossing});
static_assert(CDPREP_PROMISE_SURFACE == int{format::promise_surface} &&
              CDPREP_PROMISE_INSIDE_EXACT == int{format::promise_inside_exact} &&
              CDPREP_PROMISE_SIMPLE_SOLID == int{format::promise_simple_solid} &&
              CDPREP_PROMISE_CONTAINED_PIECES == int{format::promise_contained_pieces});

/// Sets of vertices that triangles connect, stored where their component numbers will be.
class ConnectedVertices {
public:
    explicit ConnectedVertices(std::span<std::uint32_t> parent) noexcept : parent_(parent) {
        for (std::uint32_t i = 0; i < parent_.size(); ++i) parent_[i] = i;
    }
    [[nodiscard]] std::uint32_t find(std::uint32_t vertex) noexcept {
        assert(vertex < parent_.size());
        while (parent_[vertex] != vertex) {
            parent_[vertex] = parent_[parent_[vertex]];
            vertex = parent_[vertex];
        }
        return vertex;
    }
    void join(std::uint32_t a, std::uint32_t b) noexcept {
        const std::uint32_t of_a = find(a), of_b = find(b);
        parent_[std::max(of_a, of_b)] = std::min(of_a, of_b);
    }

private:
    std::span<std::uint32_t> parent_;
};

bool has_several_components(const Model& model) noexcept {
    return model.record().components.size() > 1;
}

/// Numbers the components in the order of the section, which names one vertex of each.
void number_components(cdprep_model& model) noexcept {
    const std::span<std::uint32_t> of = model.component_of_vertex;
    ConnectedVertices connected(of);
    for (const format::Triangle& triangle : model.model.mesh().triangles) {
        if (std::ranges::any_of(triangle.vertex, [&](auto v) { return v >= of.size(); })) continue;
        connected.join(triangle.vertex[0], triangle.vertex[1]);
        connected.join(triangle.vertex[0], triangle.vertex[2]);
    }
    // A root is the lowest vertex of its set. So, in rising order, each parent is already a root.
    for (std::uint32_t i = 0; i < of.size(); ++i) of[i] = of[of[i]];
    // Roots take their component's number first, marked so that it is no vertex; then all others
    // do.
    constexpr std::uint32_t kNumber = 0x80000000U;
    const std::span<const format::Component> components = model.model.record().components;
    for (std::uint32_t i = 0; i < components.size(); ++i) {
        const std::uint32_t vertex = components[i].vertex;
        if (vertex >= of.size() || (of[vertex] & kNumber) != 0) continue;
        of[of[vertex]] = i | kNumber;
    }
    for (std::uint32_t& number : of) {
        if ((number & kNumber) == 0) number = of[number];
    }
    for (std::uint32_t& number : of) {
        number = (number & kNumber) != 0 ? number & ~kNumber : CDPREP_NONE;
    }
}

void number_triangles(cdprep_model& model) noexcept {
    std::ranges::fill(model.tree_triangle, 0U);
    const std::span<const std::uint32_t> source = model.model.source().triangle;
    for (std::uint32_t i = 0; i < source.size(); ++i) {
        if (source[i] < model.tree_triangle.size()) model.tree_triangle[source[i]] = i;
    }
}

/// Returns the run that holds a source triangle, or null.
template <class Run>
const Run* run_of(std::span<const Run> runs, std::uint32_t triangle) noexcept {
    const auto after = std::ranges::upper_bound(runs, triangle, {}, &Run::first_triangle);
    return after == runs.begin() ? nullptr : &*std::prev(after);
}

std::uint32_t name_of_run(std::span<const format::NamedRun> runs, std::uint32_t triangle) noexcept {
    const format::NamedRun* const run = run_of(runs, triangle);
    return run == nullptr ? CDPREP_NONE : run->name;
}

std::uint32_t component_of(const cdprep_model& model, std::uint32_t vertex) noexcept {
    if (!model.component_of_vertex.empty()) return model.component_of_vertex[vertex];
    if (model.can_tear()) return CDPREP_NONE;
    return model.model.record().components.size() == 1 ? 0 : CDPREP_NONE;
}

cdprep_corners corners_of(const cdprep_model& model, std::uint32_t triangle) noexcept {
    const Model& m = model.model;
    const std::uint32_t at = place_of(model, triangle);
    assert(at != CDPREP_NONE);
    cdprep_corners corners{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t vertex = m.mesh().triangles[at].vertex[i];
        store(position_of(m, vertex), corners.point[i]);
        corners.vertex[i] = source_vertex_of(m, vertex);
        corners.component = component_of(model, vertex);
    }
    const std::span<const std::uint32_t> faces = m.source().face;
    const format::Instance* const instance = run_of(m.source().instances, triangle);
    const std::uint32_t first = instance == nullptr ? 0 : instance->first_triangle;
    corners.face = faces.empty() ? triangle - first : faces[triangle];
    corners.instance = instance == nullptr
                           ? CDPREP_NONE
                           : static_cast<std::uint32_t>(instance - m.source().instances.data());
    corners.group = name_of_run(m.source().group_runs, triangle);
    corners.material = name_of_run(m.source().material_runs, triangle);
    corners.degenerate = is_marked_degenerate(m, at) ? CDPREP_YES : CDPREP_NO;
    return corners;
}

/// Returns the number of triangles, and not that of their places.
std::uint32_t count_triangles(const cdprep_model& model) noexcept {
    if (model.live != nullptr) return model.live->triangle_count();
    const Model& m = model.model;
    if (m.bvh().lanes.empty()) return m.triangle_count();
    std::uint32_t count = 0;  // a window has places without triangles
    each_triangle(m, 0, m.triangle_count(), [&](std::uint32_t /*place*/) { return ++count, true; });
    return count;
}

int check_triangles(Call& call, const std::uint32_t* triangles, std::size_t count,
                    const cdprep_model& model) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
        if (place_of(model, triangles[i]) != CDPREP_NONE) continue;
        if (model.can_tear()) {
            return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"triangles", i},
                               "is %u, and the model has no such triangle.", triangles[i]);
        }
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"triangles", i},
                           "is %u, but the model has %u triangles.", triangles[i],
                           count_triangles(model));
    }
    return CDPREP_OK;
}

std::uint32_t count_names(const Model& model, SectionId names) noexcept {
    const std::span<const std::byte> bytes = section_bytes(model, names);
    return static_cast<std::uint32_t>(std::ranges::count(bytes, std::byte{0}));
}

void grow(cdprep_model_info& info, bool is_first, const Double3& point) noexcept {
    std::array<double, 3> p{};
    store(point, p.data());
    for (std::size_t axis = 0; axis < 3; ++axis) {
        info.lower[axis] = is_first ? p[axis] : std::min(info.lower[axis], p[axis]);
        info.upper[axis] = is_first ? p[axis] : std::max(info.upper[axis], p[axis]);
    }
}

/// Stores a box around all triangles: the baked one, otherwise that of the positions if they are
/// open. A model that can tear has positions that no triangle uses, and a window may have none.
void store_box(const Model& model, cdprep_model_info& info) noexcept {
    if (model.record().bounds != nullptr) {
        store(model.record().bounds->lower, info.lower);
        store(model.record().bounds->upper, info.upper);
        return;
    }
    if (model.bvh().lanes.empty()) {
        const std::uint32_t vertices = count_positions(model);
        for (std::uint32_t i = 0; i < vertices; ++i) grow(info, i == 0, position_of(model, i));
        return;
    }
    const MovedModel corners(model, nullptr);
    bool is_first = true;
    each_triangle(model, 0, model.triangle_count(), [&](std::uint32_t place) {
        for (const Double3& corner : corners.corners(place)) {
            grow(info, std::exchange(is_first, false), corner);
        }
        return true;
    });
}

/// A text, and whether a text of its kind and number exists.
struct Found {
    bool exists;
    std::string_view text;
};

Found find_name(const Model& model, SectionId names, std::uint32_t number) noexcept {
    return {number < count_names(model, names), model.name(names, number)};
}

Found find_text(const Model& model, std::uint32_t kind, std::uint32_t number) noexcept {
    switch (kind) {
        case CDPREP_PROVENANCE:
            return {number == 0, model.record().provenance};
        case CDPREP_FINDINGS:
            return {number == 0, model.record().findings};
        case CDPREP_INSTANCE_NAME:
            if (number >= model.source().instances.size()) return {false, {}};
            return find_name(model, SectionId::instance_names,
                             model.source().instances[number].name);
        case CDPREP_GROUP_NAME:
            return find_name(model, SectionId::group_names, number);
        case CDPREP_MATERIAL_NAME:
            return find_name(model, SectionId::material_names, number);
        default:
            return {false, {}};
    }
}

/// Returns whether the file has a section, even if it was not opened.
bool is_in_file(const Model& model, SectionId id) noexcept {
    const format::FileHeader& header = model.header();
    return format::find_section({reinterpret_cast<const std::byte*>(&header),
                                 static_cast<std::size_t>(header.file_size)},
                                id)
        .has_value();
}

}  // namespace

std::uint32_t place_of(const cdprep_model& model, std::uint32_t triangle) noexcept {
    if (model.can_tear()) return model.live->place_of(triangle).value_or(CDPREP_NONE);
    return triangle < model.tree_triangle.size() ? model.tree_triangle[triangle] : CDPREP_NONE;
}

int check_bvh(Call& call, const Name& name, const Model& model) noexcept {
    if (model.triangle_count() == 0 || !model.bvh().nodes.empty()) return CDPREP_OK;
    const bool is_there = is_in_file(model, SectionId::bvh_nodes);
    return call.refuse(is_there ? CDPREP_WHY_NOT_OPENED : CDPREP_WHY_NOT_BAKED, name,
                       "has no BVH: the section bvh_nodes is %s.",
                       is_there ? "in the file, but was not opened" : "not in the file");
}

std::size_t index_size(const Model& model) noexcept {
    if (!model.serves(Ask::corners)) return 0;
    std::size_t numbers = model.triangle_count();
    if (has_several_components(model)) numbers += model.vertex_count();
    return numbers * sizeof(std::uint32_t);
}

void make_index(cdprep_model& model, void* room) noexcept {
    if (index_size(model.model) == 0) return;
    assert(room != nullptr);
    auto* const numbers = static_cast<std::uint32_t*>(room);
    const std::uint32_t triangles = model.model.triangle_count();
    model.tree_triangle = {numbers, triangles};
    number_triangles(model);
    if (!has_several_components(model.model)) return;
    model.component_of_vertex = {numbers + triangles, model.model.vertex_count()};
    number_components(model);
}

}  // namespace cdprep::c

using cdprep::Ask;
using cdprep::Model;
using cdprep::SectionId;
using cdprep::c::Call;
using cdprep::c::guarded;

int cdprep_model_describe(const cdprep_model* model, cdprep_model_info* info, cdprep_error* error) {
    Call call(error);
    if (info != nullptr) *info = {};
    if (const int code = call.need(model, {"model"})) return code;
    if (const int code = call.need(info, {"info"})) return code;
    const cdprep::format::FloatEnvironment environment;
    const Model& m = model->model;
    info->triangles = cdprep::c::count_triangles(*model);
    info->vertices = m.vertex_count();
    info->components = m.is_torn() ? 0 : static_cast<uint32_t>(m.record().components.size());
    info->instances = static_cast<uint32_t>(m.source().instances.size());
    info->groups = cdprep::c::count_names(m, SectionId::group_names);
    info->materials = cdprep::c::count_names(m, SectionId::material_names);
    info->pieces = static_cast<uint32_t>(m.pieces().pieces.size());
    info->hulls = static_cast<uint32_t>(m.hulls().hulls.size());
    info->verdicts = static_cast<uint32_t>(m.record().verdicts.size());
    info->serves = static_cast<uint32_t>(m.asks());
    info->balanced = m.is_balanced() ? CDPREP_YES : CDPREP_NO;
    info->stores_f64 = cdprep::c::is_in_file(m, SectionId::positions_f64) ? CDPREP_YES : CDPREP_NO;
    cdprep::c::store_box(m, *info);
    info->metres_per_unit = m.header().metres_per_unit;
    info->hash[0] = m.header().content_hash;
    return CDPREP_OK;
}

int cdprep_model_corners(const cdprep_model* model, const uint32_t* triangles, size_t count,
                         cdprep_corners* corners, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(model, {"model"})) return code;
        if (const int code = check_serves(call, {"model"}, *model, Ask::corners)) return code;
        if (count == 0) return CDPREP_OK;
        if (const int code = call.need(triangles, {"triangles"})) return code;
        if (const int code = call.need(corners, {"corners"})) return code;
        if (const int code = cdprep::c::check_triangles(call, triangles, count, *model)) {
            return code;
        }
        const cdprep::format::FloatEnvironment environment;
        for (size_t i = 0; i < count; ++i) {
            corners[i] = cdprep::c::corners_of(*model, triangles[i]);
        }
        return CDPREP_OK;
    });
}

int cdprep_model_mesh(const cdprep_model* model, cdprep_mesh* mesh, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = cdprep::c::begin_mesh(call, mesh)) return code;
        if (const int code = call.need(model, {"model"})) return code;
        if (const int code = check_serves(call, {"model"}, *model, Ask::corners)) return code;
        const cdprep::format::FloatEnvironment environment;
        const Model& m = model->model;
        cdprep::c::MeshWriter writer(*mesh);
        for (uint32_t i = 0; i < m.vertex_count() && writer.has_room_for_vertex(); ++i) {
            writer.add_vertex(cdprep::c::position_of(m, i), cdprep::c::source_vertex_of(m, i));
        }
        if (model->can_tear()) {
            std::vector<cdprep::LiveTriangle> listed(
                std::min<std::size_t>(mesh->triangle_room, model->live->triangle_count()));
            model->live->triangles(listed);
            for (const cdprep::LiveTriangle& triangle : listed)
                writer.add_triangle(triangle.vertex);
        } else {
            for (uint32_t i = 0; i < m.triangle_count() && writer.has_room_for_triangle(); ++i) {
                writer.add_triangle(m.mesh().triangles[model->tree_triangle[i]].vertex);
            }
        }
        mesh->vertex_count = m.vertex_count();
        mesh->triangle_count = cdprep::c::count_triangles(*model);
        return CDPREP_OK;
    });
}

int cdprep_model_section(const cdprep_model* model, uint32_t section, cdprep_array* array,
                         cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (array != nullptr) *array = {};
        if (const int code = call.need(model, {"model"})) return code;
        if (const int code = call.need(array, {"array"})) return code;
        const SectionId id{section};
        const uint32_t stride = cdprep::format::element_size(id);
        if (stride == 0) {
            return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"section"}, "%u does not exist.", section);
        }
        if (!model->model.sections().contains(id)) {
            const bool is_there = cdprep::c::is_in_file(model->model, id);
            return call.refuse(
                is_there ? CDPREP_WHY_NOT_OPENED : CDPREP_WHY_NOT_BAKED, {"section"}, "%s %s.",
                cdprep::format::section_name(id),
                is_there ? "is in the file, but was not opened" : "is not in the file");
        }
        const auto bytes = cdprep::c::section_bytes(model->model, id);
        *array = {bytes.empty() ? nullptr : bytes.data(), bytes.size() / stride, stride};
        return CDPREP_OK;
    });
}

int cdprep_model_bytes(const cdprep_model* model, cdprep_array* bytes, cdprep_error* error) {
    Call call(error);
    if (bytes != nullptr) *bytes = {};
    if (const int code = call.need(model, {"model"})) return code;
    if (const int code = call.need(bytes, {"bytes"})) return code;
    if (!model->own) {
        return call.refuse(CDPREP_WHY_NO_MEANING, {"model"},
                           "is the model of a %s, which has no bytes of a file.",
                           model->live != nullptr ? "live model" : "window");
    }
    const std::span<const std::byte> file = model->model.bytes();
    *bytes = {file.data(), file.size(), 1};
    return CDPREP_OK;
}

int cdprep_model_text(const cdprep_model* model, uint32_t kind, uint32_t number, const char** text,
                      size_t* length, cdprep_error* error) {
    Call call(error);
    if (text != nullptr) *text = nullptr;
    if (length != nullptr) *length = 0;
    if (const int code = call.need(model, {"model"})) return code;
    if (const int code = call.need(text, {"text"})) return code;
    if (const int code = call.need(length, {"length"})) return code;
    const cdprep::c::Found found = cdprep::c::find_text(model->model, kind, number);
    if (!found.exists) {
        return call.refuse(
            CDPREP_WHY_OUT_OF_RANGE, {kind > CDPREP_MATERIAL_NAME ? "kind" : "number"},
            "is out of range: the model has no text of kind %u and number %u.", kind, number);
    }
    *text = found.text.data();
    *length = found.text.size();
    return CDPREP_OK;
}

int cdprep_model_mass(const cdprep_model* model, cdprep_mass* mass, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (mass != nullptr) *mass = {};
        if (const int code = call.need(model, {"model"})) return code;
        if (const int code = call.need(mass, {"mass"})) return code;
        const cdprep::format::MassProperties* const found = model->model.record().mass;
        if (found == nullptr) {
            if (const int code = check_serves(call, {"model"}, *model, Ask::response)) return code;
            return call.fail(CDPREP_INTERNAL, "The mass properties are empty.");
        }
        mass->volume = found->volume;
        cdprep::c::store(found->centre, mass->centre);
        std::ranges::copy(found->inertia, mass->inertia);
        return CDPREP_OK;
    });
}

int cdprep_model_verdict(const cdprep_model* model, uint32_t number, cdprep_verdict* verdict,
                         cdprep_error* error) {
    Call call(error);
    if (verdict != nullptr) *verdict = {};
    if (const int code = call.need(model, {"model"})) return code;
    if (const int code = call.need(verdict, {"verdict"})) return code;
    const auto verdicts = model->model.record().verdicts;
    if (number >= verdicts.size()) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"number"},
                           "is %u, but the model has %zu verdicts.", number, verdicts.size());
    }
    std::memcpy(verdict, &verdicts[number], sizeof *verdict);
    return CDPREP_OK;
}
