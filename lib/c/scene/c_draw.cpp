// SPDX-License-Identifier: MIT
#include "cdprep/c/draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>
#include <string>

#include "c/c_mesh.h"
#include "c/c_model.h"
#include "c/c_workspace.h"
#include "c/pose_input.h"
#include "c/scene/c_scene.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/hulls.h"
#include "core/triangle_facts.h"
#include "pieces/piece_parts.h"

namespace cdprep::c {

template <>
struct Input<cdprep_draw> {
    static const InputType type;
    static cdprep_draw defaults() noexcept {
        return {};
    }
};

namespace {

constexpr Name kDraw = {"draw"};

constexpr std::uint32_t kOfModels = CDPREP_DRAW_SURFACE | CDPREP_DRAW_BOXES | CDPREP_DRAW_HULLS |
                                    CDPREP_DRAW_PIECES | CDPREP_DRAW_NUMBERS;
constexpr std::uint32_t kOfScenes = kOfModels | CDPREP_DRAW_CONTACTS | CDPREP_DRAW_OVERLAPS;
constexpr std::uint32_t kLines = CDPREP_DRAW_BOXES | CDPREP_DRAW_CONTACTS;
constexpr std::uint32_t kTriangles =
    CDPREP_DRAW_SURFACE | CDPREP_DRAW_HULLS | CDPREP_DRAW_PIECES | CDPREP_DRAW_OVERLAPS;

constexpr std::uint32_t kSurfaceColour = 0xb0b0b0ff;
constexpr std::uint32_t kBoxColour = 0x2ca02cff;
constexpr std::uint32_t kContactColour = 0xffd000ff;
constexpr std::uint32_t kOverlapColour = 0xd62728ff;
constexpr std::uint32_t kTextColour = 0xffffffff;
constexpr std::array<std::uint32_t, 8> kColours = {0x1f77b4ff, 0xff7f0eff, 0x9467bdff, 0x8c564bff,
                                                   0xe377c2ff, 0x17becfff, 0xbcbd22ff, 0x7f7f7fff};

using Corners = std::array<Double3, 3>;

/// A box along a model's axes; absent if lower exceeds upper.
struct ModelBox {
    std::array<double, 3> lower;
    std::array<double, 3> upper;

    [[nodiscard]] bool is_absent() const noexcept {
        return lower[0] > upper[0];
    }
    [[nodiscard]] Double3 middle() const noexcept {
        return {lower[0] / 2 + upper[0] / 2, lower[1] / 2 + upper[1] / 2,
                lower[2] / 2 + upper[2] / 2};
    }
    [[nodiscard]] double diagonal() const noexcept {
        return is_absent()
                   ? 0
                   : std::hypot(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]);
    }
};

/// Hands shapes to the functions of the caller, until one of them returns 0. Everything is computed
/// in the default floating-point environment.
class Painter {
public:
    Painter(const cdprep_draw& draw, format::FloatEnvironment& environment) noexcept
        : draw_(draw), environment_(environment) {}

    /// Moves all shapes that follow.
    void place(const Pose& pose) noexcept {
        pose_ = pose;
    }
    [[nodiscard]] bool wants(std::uint32_t what) const noexcept {
        return goes_on_ && (draw_.what & what) != 0;
    }
    [[nodiscard]] bool goes_on() const noexcept {
        return goes_on_;
    }
    [[nodiscard]] std::uint32_t level() const noexcept {
        return draw_.level;
    }

    void draw_line(const Double3& start, const Double3& end, std::uint32_t rgba) noexcept {
        const std::array<double, 6> points = moved(std::array{start, end});
        hand_on([&] { return draw_.line(draw_.context, points.data(), points.data() + 3, rgba); });
    }
    void draw_triangle(const Corners& corners, std::uint32_t rgba) noexcept {
        const std::array<double, 9> points = moved(corners);
        hand_on([&] { return draw_.triangle(draw_.context, points.data(), rgba); });
    }
    void draw_number(const Double3& at, std::uint32_t number) noexcept {
        const std::array<double, 3> point = moved(std::array{at});
        std::array<char, 16> text{};
        std::snprintf(text.data(), text.size(), "%u", number);
        hand_on([&] { return draw_.label(draw_.context, point.data(), text.data(), kTextColour); });
    }

private:
    template <std::size_t kCount>
    [[nodiscard]] std::array<double, 3 * kCount> moved(
        const std::array<Double3, kCount>& points) const noexcept {
        std::array<double, 3 * kCount> numbers{};
        for (std::size_t i = 0; i < kCount; ++i) {
            store(transform_point(pose_, points[i]), numbers.data() + 3 * i);
        }
        return numbers;
    }
    template <class Function>
    void hand_on(Function&& function) noexcept {
        if (goes_on_) goes_on_ = environment_.outside(function) != 0;
    }

    const cdprep_draw& draw_;
    format::FloatEnvironment& environment_;
    Pose pose_;
    bool goes_on_ = true;
};

/// What a drawn model must serve.
Ask needs_of_draw(std::uint32_t what) noexcept {
    Ask asks = Ask::nothing;
    if ((what & CDPREP_DRAW_SURFACE) != 0) asks = asks | Ask::corners;
    if ((what & CDPREP_DRAW_HULLS) != 0) asks = asks | Ask::hulls;
    if ((what & CDPREP_DRAW_PIECES) != 0) asks = asks | Ask::pieces | Ask::corners;
    return asks;
}

/// Reads what to draw. Refuses bits that are not `allowed`, and functions that are not there.
int read_draw(Call& call, const cdprep_draw* given, std::uint32_t allowed, cdprep_draw& draw) {
    if (const int code = read_input(call, kDraw, given, draw)) return code;
    const auto has = [&](std::uint32_t what) { return (draw.what & what) != 0; };
    if (has(~kOfScenes)) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, kDraw.of("what"),
                           "is 0x%x; this version knows only the bits 0x%x.", draw.what, kOfScenes);
    }
    if (has(~allowed)) {
        return call.refuse(CDPREP_WHY_NO_MEANING, kDraw.of("what"),
                           "is 0x%x, but a model has neither contacts nor overlaps.", draw.what);
    }
    if (draw.level != 0 && !has(CDPREP_DRAW_BOXES)) {
        return call.refuse(CDPREP_WHY_NO_MEANING, kDraw.of("level"),
                           "is %u, but no boxes are drawn; leave it at 0.", draw.level);
    }
    if (has(kLines) && draw.line == nullptr) return call.need(nullptr, kDraw.of("line"));
    if (has(kTriangles) && draw.triangle == nullptr) {
        return call.need(nullptr, kDraw.of("triangle"));
    }
    if (has(CDPREP_DRAW_NUMBERS) && draw.label == nullptr) {
        return call.need(nullptr, kDraw.of("label"));
    }
    return CDPREP_OK;
}

Corners corners_at(const Model& model, std::uint32_t place) noexcept {
    const auto& vertex = model.mesh().triangles[place].vertex;
    return {position_of(model, vertex[0]), position_of(model, vertex[1]),
            position_of(model, vertex[2])};
}

void draw_surface(Painter& painter, const Model& model) noexcept {
    each_triangle(model, 0, model.triangle_count(), [&](std::uint32_t place) {
        painter.draw_triangle(corners_at(model, place), kSurfaceColour);
        return painter.goes_on();
    });
}

/// Returns one box of a node, in model coordinates.
ModelBox box_of(const Model& model, const format::BvhNode& node, std::size_t box) noexcept {
    const format::FileHeader& header = model.header();
    const std::array<double, 3> origin = {header.frame_origin.x, header.frame_origin.y,
                                          header.frame_origin.z};
    ModelBox to{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto in_model = [&](float x) {
            return origin[axis] + std::ldexp(double{x}, -header.frame_exponent);
        };
        if (node.lower[axis][box] > node.upper[axis][box]) return {{1, 1, 1}, {-1, -1, -1}};
        to.lower[axis] = in_model(node.lower[axis][box]);
        to.upper[axis] = in_model(node.upper[axis][box]);
    }
    return to;
}

/// Returns the box around everything.
ModelBox whole_box(const Model& model) noexcept {
    ModelBox whole = {{1, 1, 1}, {-1, -1, -1}};
    if (model.bvh().nodes.empty()) return whole;
    for (std::size_t box = 0; box < format::kBvhWidth; ++box) {
        const ModelBox one = box_of(model, model.bvh().nodes[0], box);
        if (one.is_absent()) continue;
        const bool is_first = whole.is_absent();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            whole.lower[axis] =
                is_first ? one.lower[axis] : std::min(whole.lower[axis], one.lower[axis]);
            whole.upper[axis] =
                is_first ? one.upper[axis] : std::max(whole.upper[axis], one.upper[axis]);
        }
    }
    return whole;
}

void draw_box(Painter& painter, const ModelBox& box) noexcept {
    if (box.is_absent()) return;
    const auto corner = [&](std::size_t bits) -> Double3 {
        const auto at = [&](std::size_t axis) {
            return (bits >> axis & 1) != 0 ? box.upper[axis] : box.lower[axis];
        };
        return {at(0), at(1), at(2)};
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t bits = 0; bits < 8; ++bits) {
            if ((bits >> axis & 1) != 0) continue;
            painter.draw_line(corner(bits), corner(bits | std::size_t{1} << axis), kBoxColour);
        }
    }
}

/// Level 0 is the box around everything, level 1 are the boxes of the root.
void draw_boxes(Painter& painter, const Model& model) noexcept {
    const std::span<const format::BvhNode> nodes = model.bvh().nodes;
    const format::BvhShape& shape = model.bvh().shape;
    if (nodes.empty() || shape.levels == 0) return;
    if (painter.level() == 0) {
        draw_box(painter, whole_box(model));
        return;
    }
    const std::uint32_t level = shape.levels - std::min(painter.level(), shape.levels);
    const std::size_t first = shape.first[level];
    const std::size_t end = std::min(nodes.size(), first + shape.count[level]);
    for (std::size_t node = first; node < end; ++node) {
        for (std::size_t box = 0; box < format::kBvhWidth && painter.goes_on(); ++box) {
            draw_box(painter, box_of(model, nodes[node], box));
        }
    }
}

/// Draws one hull, whose facets have their corners in `corner`, and its number.
template <class Facet>
void draw_hull(Painter& painter, const ConvexPoints& points, std::span<const Facet> facets,
               std::array<std::uint32_t, 3> Facet::*corner, std::uint32_t number) noexcept {
    const std::uint32_t rgba = kColours[number % kColours.size()];
    for (const Facet& facet : facets) {
        if (!painter.goes_on()) return;
        const std::array<std::uint32_t, 3>& of = facet.*corner;
        painter.draw_triangle({points.point(of[0]), points.point(of[1]), points.point(of[2])},
                              rgba);
    }
    if (!painter.wants(CDPREP_DRAW_NUMBERS) || points.count == 0) return;
    Double3 middle{};
    for (std::uint32_t i = 0; i < points.count; ++i) {
        const Double3 p = points.point(i);
        middle = {middle.x + p.x / points.count, middle.y + p.y / points.count,
                  middle.z + p.z / points.count};
    }
    painter.draw_number(middle, number);
}

void draw_stored_hull(Painter& painter, const Model& model, std::uint32_t hull,
                      std::uint32_t number) noexcept {
    const format::Hull& stored = model.hulls().hulls[hull];
    draw_hull(painter, convex_points(model, hull),
              model.hulls().facets.subspan(stored.first_facet, stored.facet_count),
              &format::HullFacet::point, number);
}

void draw_hulls(Painter& painter, const Model& model) noexcept {
    std::uint32_t part = 0;
    while (const auto hull = find_hull(model, format::HullScope::part, part)) {
        draw_stored_hull(painter, model, *hull, part++);
        if (!painter.goes_on()) return;
    }
    if (part > 0) return;
    if (const auto whole = find_hull(model, format::HullScope::whole)) {
        draw_stored_hull(painter, model, *whole, 0);
    }
}

void draw_pieces(Painter& painter, const Model& model) noexcept {
    for (std::uint32_t piece = 0; piece < model.pieces().pieces.size() && painter.goes_on();
         ++piece) {
        draw_hull(painter, piece_points(model, piece),
                  part_of_piece(model.pieces().facets, model, piece, &format::Piece::first_facet),
                  &format::PieceFacet::corner, piece);
    }
}

void draw_model(Painter& painter, const Model& model) noexcept {
    if (painter.wants(CDPREP_DRAW_SURFACE)) draw_surface(painter, model);
    if (painter.wants(CDPREP_DRAW_BOXES)) draw_boxes(painter, model);
    if (painter.wants(CDPREP_DRAW_HULLS)) draw_hulls(painter, model);
    if (painter.wants(CDPREP_DRAW_PIECES)) draw_pieces(painter, model);
}

/// Refuses a model that lacks what is to be drawn.
int check_drawn(Call& call, const Name& name, const Model& model, std::uint32_t what) {
    if (const int code = check_serves(call, name, model, needs_of_draw(what))) return code;
    const bool needs_boxes = (what & (CDPREP_DRAW_BOXES | CDPREP_DRAW_CONTACTS)) != 0;
    return needs_boxes ? check_bvh(call, name, model) : CDPREP_OK;
}

/// An object of a scene, as it is drawn.
struct Drawn {
    const cdprep_model* model;
    Pose pose;
};

std::optional<Drawn> find_drawn(const cdprep_scene& scene, const ObjectId& id) noexcept {
    const std::optional<SceneObject> object = scene.scene.find(id);
    if (!object) return std::nullopt;
    return Drawn{scene.models[id.slot], object->world_from_model};
}

/// Calls visit(slot, object) for each object, until it returns false.
template <class Visit>
void each_object(const cdprep_scene& scene, Visit&& visit) {
    for (std::uint32_t slot = 0; slot < scene.plan->plan.limits().objects; ++slot) {
        const std::optional<Drawn> object = find_drawn(scene, scene.scene.object_at(slot));
        if (object && !visit(slot, *object)) return;
    }
}

/// Refuses a scene with a model that lacks what is to be drawn. Lists of triangles need corners,
/// but only of the objects in them.
int check_scene(Call& call, const cdprep_scene& scene, std::uint32_t what) {
    int refused = CDPREP_OK;
    const auto check = [&](std::uint32_t slot, const Model& model, std::uint32_t of) {
        cdprep_error error;
        Call one(&error);
        if (check_drawn(one, {"scene"}, model, of) == CDPREP_OK) return true;
        refused = call.refuse_with(
            error.why, {"scene"},
            "The object in slot " + std::to_string(slot) + " cannot be drawn. " + error.message);
        return false;
    };
    each_object(scene, [&](std::uint32_t slot, const Drawn& object) {
        return check(slot, object.model->model, what);
    });
    if (refused != CDPREP_OK || (what & CDPREP_DRAW_OVERLAPS) == 0) return refused;
    const auto check_listed = [&](const ObjectId& id) {
        const std::optional<Drawn> object = find_drawn(scene, id);
        return !object || check(id.slot, object->model->model, CDPREP_DRAW_SURFACE);
    };
    for (const SceneOverlaps& list : scene.scene.overlaps()) {
        if (!check_listed(list.a) || !check_listed(list.b)) return refused;
    }
    for (const SceneSelfOverlaps& list : scene.scene.self_overlaps()) {
        if (!check_listed(list.object)) return refused;
    }
    return CDPREP_OK;
}

void draw_listed(Painter& painter, const Drawn& object, std::uint32_t triangle) noexcept {
    const std::uint32_t place = place_of(*object.model, triangle);
    if (place == CDPREP_NONE) return;
    painter.place(object.pose);
    painter.draw_triangle(corners_at(object.model->model, place), kOverlapColour);
}

/// Draws the pairs of triangles of two objects, unless one is gone.
void draw_pairs(Painter& painter, const cdprep_scene& scene, const ObjectId& a, const ObjectId& b,
                std::span<const TrianglePair> pairs) noexcept {
    const std::optional<Drawn> of_a = find_drawn(scene, a);
    const std::optional<Drawn> of_b = find_drawn(scene, b);
    if (!of_a || !of_b) return;
    for (const TrianglePair& pair : pairs) {
        draw_listed(painter, *of_a, pair.a);
        draw_listed(painter, *of_b, pair.b);
        if (!painter.goes_on()) return;
    }
}

void draw_contact(Painter& painter, const Contact& contact, double length) noexcept {
    const std::span points(contact.points.data(), contact.point_count);
    for (const ManifoldPoint& point : points) {
        painter.draw_line(point.on_a, point.on_b, kContactColour);
    }
    if (points.empty()) painter.draw_line(contact.point_a, contact.point_b, kContactColour);
    const Double3 &p = contact.point_a, &n = contact.normal;
    painter.draw_line(p, {p.x + length * n.x, p.y + length * n.y, p.z + length * n.z},
                      kContactColour);
}

void draw_results(Painter& painter, const cdprep_scene& scene) noexcept {
    if (painter.wants(CDPREP_DRAW_OVERLAPS)) {
        for (const SceneOverlaps& list : scene.scene.overlaps()) {
            draw_pairs(painter, scene, list.a, list.b, list.triangles);
        }
        for (const SceneSelfOverlaps& list : scene.scene.self_overlaps()) {
            draw_pairs(painter, scene, list.object, list.object, list.triangles);
        }
    }
    if (!painter.wants(CDPREP_DRAW_CONTACTS)) return;
    painter.place(Pose());
    for (const SceneContacts& list : scene.scene.contacts()) {
        const std::optional<Drawn> a = find_drawn(scene, list.a);
        const std::optional<Drawn> b = find_drawn(scene, list.b);
        if (!a || !b) continue;
        const double length =
            std::min(whole_box(a->model->model).diagonal(), whole_box(b->model->model).diagonal()) /
            8;
        for (const Contact& contact : list.contacts) draw_contact(painter, contact, length);
    }
}

void draw_scene(Painter& painter, const cdprep_scene& scene) noexcept {
    each_object(scene, [&](std::uint32_t slot, const Drawn& object) {
        painter.place(object.pose);
        draw_model(painter, object.model->model);
        const bool numbers = painter.wants(CDPREP_DRAW_NUMBERS);
        if (numbers) painter.draw_number(whole_box(object.model->model).middle(), slot);
        return painter.goes_on();
    });
    draw_results(painter, scene);
}

}  // namespace

const InputType Input<cdprep_draw>::type = {
    "cdprep_draw", 0xcd500016U, sizeof(cdprep_draw), sizeof(cdprep_draw), {}};

}  // namespace cdprep::c

using cdprep::c::Call;
using cdprep::c::guarded;
using cdprep::c::Painter;

void cdprep_draw_init(cdprep_draw* draw, size_t size) {
    cdprep::c::initialise(draw, size);
}

int cdprep_model_draw(const cdprep_model* model, const cdprep_pose* world_from_model,
                      const cdprep_draw* draw, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(model, {"model"})) return code;
        if (const int code = call.need(world_from_model, {"world_from_model"})) return code;
        if (const int code = call.need(draw, cdprep::c::kDraw)) return code;
        cdprep_draw given;
        if (const int code = cdprep::c::read_draw(call, draw, cdprep::c::kOfModels, given)) {
            return code;
        }
        cdprep::Pose pose;
        if (const int code = read_pose(call, {"world_from_model"}, world_from_model, pose)) {
            return code;
        }
        if (const int code = cdprep::c::check_drawn(call, {"model"}, model->model, given.what)) {
            return code;
        }
        cdprep::format::FloatEnvironment environment;
        Painter painter(given, environment);
        painter.place(pose);
        cdprep::c::draw_model(painter, model->model);
        return CDPREP_OK;
    });
}

int cdprep_scene_draw(const cdprep_scene* scene, const cdprep_draw* draw, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(scene, {"scene"})) return code;
        if (const int code = call.need(draw, cdprep::c::kDraw)) return code;
        if (const int code = cdprep::c::check_free(call, {"scene"}, scene->in_use)) return code;
        cdprep_draw given;
        if (const int code = cdprep::c::read_draw(call, draw, cdprep::c::kOfScenes, given)) {
            return code;
        }
        if (const int code = cdprep::c::check_scene(call, *scene, given.what)) return code;
        cdprep::format::FloatEnvironment environment;
        Painter painter(given, environment);
        cdprep::c::draw_scene(painter, *scene);
        return CDPREP_OK;
    });
}
