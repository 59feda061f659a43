// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/gltf_scene.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "cdprep/pose.h"
#include "import/source_file.h"
#include "mesh/vectors.h"
#include "scene_file/gltf_physics.h"
#include "text/number_text.h"

namespace cdprep::scenes {
namespace {

namespace fs = std::filesystem;
using import::Affine;
using mesh::cross;
using mesh::minus;
using mesh::scaled;

constexpr double kGravity = 9.81;  ///< metres per second squared
constexpr double kLeastSpeed = 2;  ///< metres per second: most_speed where nothing falls far
constexpr std::uint32_t kNone = 0xffffffffU;

// --- Vectors -------------------------------------------------------------------------

bool is_zero(const Double3& a) {
    return a.x == 0 && a.y == 0 && a.z == 0;
}

Double3 turned(const Affine& m, const Double3& v) {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
            m[8] * v.x + m[9] * v.y + m[10] * v.z};
}
Double3 origin_of(const Affine& m) {
    return {m[3], m[7], m[11]};
}
Double3 moved(const Affine& m, const Double3& p) {
    const Double3 turned_p = turned(m, p);
    return {turned_p.x + m[3], turned_p.y + m[7], turned_p.z + m[11]};
}

/// Returns the rotation of a transform whose columns are at right angles, whatever their lengths.
/// Nothing for a shear, a mirror or a length of 0.
std::optional<Affine> rotation_of(Affine m) {
    std::array<Double3, 3> columns{};
    for (std::size_t i = 0; i < 3; ++i) {
        columns[i] = {m[i], m[4 + i], m[8 + i]};
        const double size = mesh::safe_length(columns[i]);
        if (!(size > 0)) return std::nullopt;
        columns[i] = scaled(columns[i], 1 / size);
    }
    const Double3 off = minus(cross(columns[0], columns[1]), columns[2]);
    const Double3 side = minus(cross(columns[1], columns[2]), columns[0]);
    if (!(mesh::safe_length(off) <= kFloatRounding && mesh::safe_length(side) <= kFloatRounding))
        return std::nullopt;
    Affine rotation{};
    for (std::size_t i = 0; i < 3; ++i) {
        rotation[i] = columns[i].x;
        rotation[4 + i] = columns[i].y;
        rotation[8 + i] = columns[i].z;
    }
    return rotation;
}

// --- Files ---------------------------------------------------------------------------

/// Returns the JSON of a file: all of it, or the first JSON chunk of a GLB. tools/import has read
/// the file before.
std::string_view json_of(std::string_view bytes) {
    constexpr std::size_t kHeader = 12;
    constexpr std::size_t kChunkHeader = 8;
    if (!bytes.starts_with("glTF")) return bytes;
    std::size_t at = kHeader;
    while (at <= bytes.size() && bytes.size() - at >= kChunkHeader) {
        std::uint32_t size = 0;
        std::memcpy(&size, bytes.data() + at, sizeof size);
        const std::string_view type = bytes.substr(at + 4, 4);
        at += kChunkHeader;
        if (type == "JSON") return bytes.substr(at, size);
        at += size;
    }
    return {};
}

// --- The scene -----------------------------------------------------------------------

/// A use of a node. A node with several parents has several.
struct Place {
    std::uint32_t node = 0;        ///< in GltfPhysics::nodes
    std::uint32_t mover = kNone;   ///< the nearest place with a motion, itself or above it
    std::uint32_t object = kNone;  ///< in the objects of the assembly, and its nodes()
    std::uint32_t new_object = kNone;
};

/// What the objects of a layer have in common.
struct LayerKey {
    std::optional<GltfFilter> collider;
    std::optional<GltfFilter> trigger;
    bool is_body = false;

    auto operator<=>(const LayerKey&) const = default;
};

/// Turns an assembly and its physics into the scene of the assembly.
class SceneBuilder {
public:
    SceneBuilder(AssemblyScene& assembly, const GltfPhysics& physics,
                 const import::ImportOptions& options, Findings& findings)
        : assembly_(assembly),
          physics_(physics),
          options_(options),
          findings_(findings),
          metres_per_unit_(options.metres_per_unit.value_or(1)) {}

    std::optional<Error> run() {
        if (auto error = place_nodes()) return error;
        std::vector<FileObject> all = std::move(scene().objects);
        scene().objects.clear();
        for (Place& place : places_) keep_object(place, all);
        if (scene().objects.empty()) {
            return refusal(
                "no node has triangles and a collider or trigger of KHR_physics_rigid_bodies, so "
                "there is nothing to compute");
        }
        move_all();
        if (auto error = add_layers()) return error;
        add_pairs();
        free_bodies();
        keep_used();
        set_world();
        return set_most_speed();
    }

private:
    [[nodiscard]] SceneFile& scene() const noexcept {
        return assembly_.scene;
    }
    [[nodiscard]] const GltfNode& node_of(const Place& place) const {
        return physics_.nodes[place.node];
    }
    [[nodiscard]] Error refusal(const std::string& what) const {
        return {ErrorCode::unreadable, scene().name + ": " + what + "."};
    }
    [[nodiscard]] const Affine& world_from(std::uint32_t place) const {
        return assembly_.file.world_from_nodes()[place];
    }
    [[nodiscard]] static std::string pointer_of(const Place& place, const char* part) {
        return "/nodes/" + std::to_string(place.node) + "/extensions/KHR_physics_rigid_bodies/" +
               part;
    }

    // --- Nodes -----------------------------------------------------------------------

    /// Walks the tree as tools/import did. That has proven that it ends.
    std::optional<Error> place_nodes() {
        const std::size_t count = assembly_.file.world_from_nodes().size();
        struct Pending {
            std::uint32_t node, mover;
        };
        std::vector<Pending> pending;
        for (const std::uint32_t root : physics_.roots) pending.push_back({root, kNone});
        std::ranges::reverse(pending);
        while (!pending.empty() && places_.size() <= count) {
            const Pending top = pending.back();
            pending.pop_back();
            const auto number = static_cast<std::uint32_t>(places_.size());
            const GltfNode& node = physics_.nodes[top.node];
            const std::uint32_t mover = node.motion ? number : top.mover;
            places_.push_back({.node = top.node, .mover = mover});
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
                pending.push_back({*child, mover});
            }
        }
        bool fits = places_.size() == count;
        const auto nodes = assembly_.file.nodes();
        for (std::uint32_t i = 0; i < nodes.size() && fits; ++i) {
            fits = node_of(places_[nodes[i].number]).mesh.has_value();
            places_[nodes[i].number].object = i;
        }
        if (fits) return std::nullopt;
        return refusal("its nodes changed while it was read");
    }

    /// Keeps the object of a node with a collider or a trigger.
    void keep_object(Place& place, std::vector<FileObject>& all) {
        const GltfNode& node = node_of(place);
        const bool has_surface = node.collider || node.trigger;
        const std::string name = node.collider ? "collider" : "trigger";
        if (place.object == kNone) {
            if (has_surface) {
                findings_.not_taken("a " + name + " whose mesh has no triangles",
                                    pointer_of(place, name.c_str()));
            }
            return;
        }
        if (!has_surface) {
            findings_.not_taken("a node with triangles but without a collider or trigger",
                                "/nodes/" + std::to_string(place.node));
            return;
        }
        const auto number = static_cast<std::uint32_t>(&place - places_.data());
        const Affine& m = world_from(number);
        if (is_zero({m[0], m[4], m[8]}) && is_zero({m[1], m[5], m[9]}) &&
            is_zero({m[2], m[6], m[10]})) {
            findings_.not_taken("a " + name + " of scale 0, which the draft disables",
                                pointer_of(place, name.c_str()));
            return;
        }
        place.new_object = static_cast<std::uint32_t>(scene().objects.size());
        scene().objects.push_back(std::move(all[place.object]));
        if (!node.collider) return;
        scene().objects.back().material =
            node.collider->material.value_or(Material{.friction = kGltfFriction});
    }

    // --- Motions ---------------------------------------------------------------------

    /// The velocities of a node with a motion, in the world and in model units.
    struct Velocities {
        Double3 velocity{};
        Double3 turn{};
        Double3 centre{};
    };

    Velocities velocities_of(std::uint32_t mover) {
        const GltfMotion& motion = *node_of(places_[mover]).motion;
        const Affine& world = world_from(mover);
        const auto rotation = rotation_of(world);
        Velocities found;
        found.centre = motion.centre ? moved(world, *motion.centre) : origin_of(world);
        if (rotation) {
            found.velocity = scaled(turned(*rotation, motion.velocity), 1 / metres_per_unit_);
            found.turn = turned(*rotation, motion.turn);
        } else if (!is_zero(motion.velocity) || !is_zero(motion.turn)) {
            findings_.not_taken("velocities of a node that is sheared, mirrored or flat",
                                pointer_of(places_[mover], "motion"));
        }
        return found;
    }

    void move_all() {
        std::map<std::uint32_t, std::vector<std::uint32_t>> members;
        for (std::uint32_t i = 0; i < places_.size(); ++i) {
            const Place& place = places_[i];
            if (node_of(place).motion) members[i];
            if (place.mover == kNone || place.new_object == kNone) continue;
            members[place.mover].push_back(i);
        }
        for (const auto& [mover, followers] : members) move(mover, followers);
    }

    /// Moves the objects of a node with a motion.
    void move(std::uint32_t mover, const std::vector<std::uint32_t>& members) {
        const auto colliders = std::ranges::count_if(members, [&](std::uint32_t member) {
            return node_of(places_[member]).collider.has_value();
        });
        const bool has_triggers = std::ranges::any_of(members, [&](std::uint32_t member) {
            return node_of(places_[member]).trigger.has_value();
        });
        if (has_triggers && colliders > 0 && members.size() > 1) {
            findings_.assumed("a trigger also detects the colliders of its own body");
        }
        const Velocities velocities = velocities_of(mover);
        const GltfMotion& motion = *node_of(places_[mover]).motion;
        const std::string place = pointer_of(places_[mover], "motion");
        if (members.empty()) {
            findings_.not_taken("a motion without a collider or trigger that is used", place);
        } else if (motion.is_kinematic) {
            for (const std::uint32_t member : members) move_steadily(member, velocities, mover);
        } else if (colliders > 1 && !join(mover, members)) {
            findings_.not_taken(
                "a body of several colliders that differ in filter or material, or "
                "whose node is sheared, mirrored or flat; they stay where they are",
                place);
        } else if (colliders == 0) {
            findings_.not_taken("a body without a collider; its triggers stay where they are",
                                place);
        } else {
            for (const std::uint32_t member : members) make_body(member, velocities, motion);
        }
    }

    // --- Bodies of several colliders -------------------------------------------------

    /// Makes one object of all colliders of a body, in the frame of its node: that of the first
    /// collider. Returns false if they cannot be one object.
    bool join(std::uint32_t mover, const std::vector<std::uint32_t>& members) {
        std::vector<std::uint32_t> joined;
        for (const std::uint32_t member : members) {
            if (node_of(places_[member]).collider) joined.push_back(member);
        }
        const GltfSurface& first = *node_of(places_[joined[0]]).collider;
        const bool are_equal = std::ranges::all_of(joined, [&](std::uint32_t member) {
            const GltfNode& node = node_of(places_[member]);
            return node.collider->filter == first.filter &&
                   node.collider->material == first.material && !node.trigger;
        });
        const Affine& world = world_from(mover);
        const auto rotation = rotation_of(world);
        if (!are_equal || !rotation) return false;
        const Affine& r = *rotation;
        const Result<Pose> pose = nearest_pose({r[0], r[1], r[2], world[3], r[4], r[5], r[6],
                                                world[7], r[8], r[9], r[10], world[11], 0, 0, 0, 1},
                                               kFloatRounding);
        if (!pose) return false;
        AssemblyModel model;
        for (const std::uint32_t member : joined) {
            const std::uint32_t object = places_[member].object;
            const Affine& world_from_mesh = assembly_.file.nodes()[object].world_from_node;
            model.push_back({object, in_frame(*pose, world_from_mesh)});
            if (member != joined[0]) places_[member].new_object = kNone;
        }
        keep_joined(mover, joined[0], *pose, std::move(model));
        findings_.assumed(
            node_of(places_[mover]).motion->mass
                ? "the colliders of a body do not overlap: its inertia is computed from all of them"
                : "the colliders of a body do not overlap: its mass is the sum of their masses");
        return true;
    }

    void keep_joined(std::uint32_t mover, std::uint32_t first, const Pose& pose,
                     AssemblyModel model) {
        FileObject& object = scene().objects[places_[first].new_object];
        object.name = assembly_.file.path_of(mover);
        const auto is_taken = [&](const FileObject& other) {
            return &other != &object && other.name == object.name;
        };
        while (std::ranges::any_of(scene().objects, is_taken)) object.name += "#body";
        object.model = static_cast<std::uint32_t>(assembly_.models.size());
        assembly_.models.push_back(std::move(model));
        scene().models.emplace_back(scene().name + "/" + object.name);
        scene().motions[object.motion] = Motion::fixed(pose);
    }

    /// Returns a transform as seen from a frame.
    static Affine in_frame(const Pose& world_from_frame, const Affine& world) {
        const auto& r = world_from_frame.rotation();
        const Double3& t = world_from_frame.translation();
        const std::array<double, 3> origin = {t.x, t.y, t.z};
        Affine local{};
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t column = 0; column < 4; ++column) {
                double sum = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    const double entry = world[4 * k + column] - (column == 3 ? origin[k] : 0);
                    sum += r[3 * k + row] * entry;
                }
                local[4 * row + column] = sum;
            }
        }
        return local;
    }

    void move_steadily(std::uint32_t place, const Velocities& velocities, std::uint32_t mover) {
        FileObject& object = scene().objects[places_[place].new_object];
        const Pose start = *pose_of(scene(), object, 0);
        Double3 turn = velocities.turn;
        const GltfMotion& motion = *node_of(places_[mover]).motion;
        if (!is_zero(turn) && !motion.centre) {
            findings_.assumed("a kinematic node without a centre of mass turns about its origin");
        }
        // A steady motion turns about the origin of its object.
        constexpr double kRounding = 1e-9;
        const double size =
            mesh::safe_length(start.translation()) + mesh::safe_length(velocities.centre);
        const double off =
            mesh::safe_length(cross(minus(start.translation(), velocities.centre), turn));
        if (!(off <= kRounding * size * mesh::safe_length(turn))) {
            findings_.not_taken(
                "a rotation of a kinematic node about an axis that misses the origin "
                "of its collider or trigger",
                pointer_of(places_[place],
                           node_of(places_[place]).collider ? "collider" : "trigger"));
            turn = {};
        }
        scene().motions[object.motion] = Motion::steady(start, velocities.velocity, turn);
    }

    void make_body(std::uint32_t place, const Velocities& velocities, const GltfMotion& motion) {
        if (places_[place].new_object == kNone) return;  // joined with another collider
        if (!node_of(places_[place]).collider) {
            findings_.not_taken("a trigger that moves with a body; it stays where it is",
                                pointer_of(places_[place], "trigger"));
            return;
        }
        FileObject& object = scene().objects[places_[place].new_object];
        object.body = static_cast<std::uint32_t>(scene().bodies.size());
        scene().bodies.push_back(
            {.mass = motion.mass, .velocity = velocities.velocity, .turn = velocities.turn});
        if (!motion.mass) findings_.assumed("a body without a mass has the density of water");
    }

    // --- Layers and pairs ------------------------------------------------------------

    std::optional<Error> add_layers() {
        std::map<LayerKey, std::uint32_t> numbers;
        for (const Place& place : places_) {
            if (place.new_object == kNone) continue;
            const GltfNode& node = node_of(place);
            FileObject& object = scene().objects[place.new_object];
            LayerKey key;
            if (node.collider) key.collider = node.collider->filter;
            if (node.trigger) key.trigger = node.trigger->filter;
            key.is_body = object.body != kNoBody;
            const auto [at, is_new] =
                numbers.try_emplace(key, static_cast<std::uint32_t>(keys_.size()));
            if (is_new) keys_.push_back(key);
            object.layer = at->second;
        }
        if (keys_.size() > kLayers) {
            return refusal("its bodies, other colliders and triggers have " +
                           std::to_string(keys_.size()) + " different collision filters; at most " +
                           std::to_string(kLayers) + " are possible, because each is a layer");
        }
        scene().layers.clear();
        std::set<std::string> used;
        for (const LayerKey& key : keys_) {
            const std::string name = name_of(key);
            std::string unique = name;
            for (int i = 2; !used.insert(unique).second; ++i) {
                unique = name + "#" + std::to_string(i);
            }
            scene().layers.push_back(unique);
        }
        return std::nullopt;
    }

    static std::string name_of(const LayerKey& key) {
        const auto named = [](const std::string& kind, const GltfFilter& filter) {
            std::string systems;
            for (const std::string& system : filter.systems) {
                systems += (systems.empty() ? " of " : "+") + system;
            }
            return kind + systems;
        };
        std::string name;
        if (key.collider) name = named(key.is_body ? "bodies" : "colliders", *key.collider);
        if (key.trigger) name += (name.empty() ? "" : " and ") + named("triggers", *key.trigger);
        return name;
    }

    void add_pairs() {
        scene().has_pairs = true;
        for (std::uint32_t a = 0; a < keys_.size(); ++a) {
            for (std::uint32_t b = a; b < keys_.size(); ++b) {
                AskedPair pair{.asked = {.a = a, .b = b}};
                LayerPair& asked = pair.asked;
                if (respond(keys_[a], keys_[b])) asked.effects = Ask::response;
                if (detects(keys_[a], keys_[b]) || detects(keys_[b], keys_[a])) {
                    asked.effects = asked.effects | Ask::collide;
                    asked.body = Body::solid;  // the draft says that a trigger is a volume
                }
                if (asked.effects != Ask::nothing) scene().pairs.push_back(pair);
            }
        }
        list_filters();
        if (scene().pairs.empty()) {
            findings_.assumed(
                "nothing is computed, because no trigger meets a collider and no "
                "body meets another collider");
        }
    }

    static bool respond(const LayerKey& a, const LayerKey& b) {
        return a.collider && b.collider && (a.is_body || b.is_body) &&
               accept(*a.collider, *b.collider);
    }
    static bool detects(const LayerKey& trigger, const LayerKey& collider) {
        return trigger.trigger && collider.collider && accept(*trigger.trigger, *collider.collider);
    }

    /// The draft's text and its formula contradict each other here.
    void list_filters() {
        bool has_lists = false, has_loners = false;
        for (const LayerKey& key : keys_) {
            for (const auto* filter : {&key.collider, &key.trigger}) {
                if (!*filter) continue;
                has_lists = has_lists || (*filter)->with || (*filter)->without;
                has_loners = has_loners || (*filter)->systems.empty();
            }
        }
        if (has_lists && has_loners) {
            findings_.assumed(
                "a collider or trigger without collision systems is in no system "
                "that a filter lists");
        }
    }

    /// A scene moves a body only if something can push it.
    void free_bodies() {
        std::set<std::uint32_t> responding;
        for (const AskedPair& pair : scene().pairs) {
            if (!contains(pair.asked.effects, Ask::response)) continue;
            responding.insert({pair.asked.a, pair.asked.b});
        }
        for (const Place& place : places_) {
            if (place.new_object == kNone) continue;
            FileObject& object = scene().objects[place.new_object];
            if (object.body == kNoBody || responding.contains(object.layer)) continue;
            object.body = kNoBody;
            findings_.not_taken("a body that no collider can push; it stays where it is",
                                pointer_of(place, "collider"));
        }
    }

    // --- The rest --------------------------------------------------------------------

    /// Drops the objects that were joined with others, and the models, motions and bodies that no
    /// object has.
    void keep_used() {
        std::vector<std::uint32_t> numbers(assembly_.models.size(), kNone);
        std::vector<AssemblyModel> models;
        std::vector<fs::path> paths;
        std::vector<Motion> motions;
        std::vector<BodyMotion> bodies;
        std::vector<FileObject> objects;
        for (const Place& place : places_) {
            if (place.new_object == kNone) continue;
            objects.push_back(std::move(scene().objects[place.new_object]));
        }
        scene().objects = std::move(objects);
        for (FileObject& object : scene().objects) {
            std::uint32_t& number = numbers[object.model];
            if (number == kNone) {
                number = static_cast<std::uint32_t>(models.size());
                models.push_back(assembly_.models[object.model]);
                paths.push_back(scene().models[object.model]);
            }
            object.model = number;
            motions.push_back(scene().motions[object.motion]);
            object.motion = static_cast<std::uint32_t>(motions.size() - 1);
            if (object.body == kNoBody) continue;
            bodies.push_back(scene().bodies[object.body]);
            object.body = static_cast<std::uint32_t>(bodies.size() - 1);
        }
        assembly_.models = std::move(models);
        scene().models = std::move(paths);
        scene().motions = std::move(motions);
        scene().bodies = std::move(bodies);
    }

    void set_world() {
        scene().metres_per_unit = metres_per_unit_;
        scene().step_s = 1.0 / 60;
        scene().duration_s = 1;
        if (assembly_.rounding > 0) {
            findings_.assumed("transforms were rounded to rigid ones; the largest deviation is " +
                              report::number_text(assembly_.rounding));
        }
        findings_.assumed("a step is 1/60 s, and a run takes 1 s without --frames or --until");
        const format::UpAxis up = options_.up_axis.value_or(format::UpAxis::y);
        scene().y_is_up = up == format::UpAxis::y;
        if (scene().bodies.empty()) return;
        const double g = -kGravity / metres_per_unit_;
        const bool is_x = up == format::UpAxis::x, is_z = up == format::UpAxis::z;
        scene().dynamics.gravity = Double3{is_x ? g : 0, is_x || is_z ? 0 : g, is_z ? g : 0};
        const char* const axis = is_x ? "-x" : is_z ? "-z" : "-y";
        findings_.assumed(std::string("gravity is 9.81 m/s^2 along ") + axis);
        findings_.assumed(
            "two surfaces have the geometric mean of their frictions and the "
            "larger restitution");
        const bool lacks_material = std::ranges::any_of(places_, [&](const Place& place) {
            const auto& collider = node_of(place).collider;
            return place.new_object != kNone && collider && !collider->material;
        });
        if (lacks_material) {
            findings_.assumed("a collider without a material has a friction of " +
                              report::number_text(kGltfFriction));
        }
    }

    /// A body may fall from the highest point of all bodies to the lowest one of the scene. A ball
    /// that rolls down has a point that is faster than a fall, but not twice as fast.
    std::optional<Error> set_most_speed() {
        if (scene().bodies.empty()) return std::nullopt;
        const Double3& gravity = *scene().dynamics.gravity;
        const double g = mesh::safe_length(gravity);
        std::vector<std::vector<Double3>> corners;
        for (const AssemblyModel& model : assembly_.models) {
            auto found = corners_of(model);
            if (!found) return found.error();
            corners.push_back(std::move(found).value());
        }
        double highest = -HUGE_VAL, lowest = HUGE_VAL, fastest = 0;
        for (const FileObject& object : scene().objects) {
            const Result<Pose> pose = pose_of(scene(), object, 0);
            if (!pose) return pose.error();
            for (const Double3& corner : corners[object.model]) {
                const double height = -mesh::dot(transform_point(*pose, corner), gravity) / g;
                lowest = std::min(lowest, height);
                if (object.body != kNoBody) highest = std::max(highest, height);
            }
            if (object.body == kNoBody) continue;
            const BodyMotion& body = scene().bodies[object.body];
            fastest = std::max(fastest, mesh::safe_length(body.velocity));
        }
        const double fall = std::sqrt(fastest * fastest + 2 * g * std::max(highest - lowest, 0.0));
        const double speed = std::max(2 * fall, kLeastSpeed / metres_per_unit_);
        if (!std::isfinite(speed)) return std::nullopt;
        scene().dynamics.most_speed = speed;
        findings_.assumed("dynamics.most_speed is " + report::number_text(speed) +
                          ": twice the speed of a fall through the height of the scene");
        return std::nullopt;
    }

    /// Returns the corners of the box of a model, without numbers that are not finite.
    Result<std::vector<Double3>> corners_of(const AssemblyModel& model) const {
        std::vector<import::PlacedNode> nodes;
        for (const AssemblyNode& node : model) {
            nodes.push_back({&assembly_.file.nodes()[node.node], node.model_from_mesh});
        }
        const Result<mesh::TriangleSoup> soup = assembly_.file.triangles(nodes);
        if (!soup) return soup.error();
        std::array<std::array<double, 2>, 3> box = {
            {{HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}}};
        for (const Double3& p : soup->positions) {
            const std::array<double, 3> at = {p.x, p.y, p.z};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (!std::isfinite(at[axis])) continue;
                box[axis] = {std::min(box[axis][0], at[axis]), std::max(box[axis][1], at[axis])};
            }
        }
        std::vector<Double3> corners;
        if (box[0][0] > box[0][1] || box[1][0] > box[1][1] || box[2][0] > box[2][1]) return corners;
        for (std::size_t i = 0; i < 8; ++i) {
            corners.push_back({box[0][i & 1], box[1][i >> 1 & 1], box[2][i >> 2]});
        }
        return corners;
    }

    AssemblyScene& assembly_;
    const GltfPhysics& physics_;
    const import::ImportOptions& options_;
    Findings& findings_;
    double metres_per_unit_;
    std::vector<Place> places_;   ///< depth first: MeshNode::number is an index
    std::vector<LayerKey> keys_;  ///< of the layers
};

}  // namespace

GltfReading read_gltf_scene(const fs::path& path, const import::ImportOptions& options) {
    GltfReading reading;
    Result<AssemblyScene> assembly = read_assembly(path, options);
    if (!assembly) return {.assembly = {}, .findings = {}, .errors = {assembly.error()}};
    SceneFile& scene = assembly->scene;
    const Result<import::SourceFile> file = import::SourceFile::open(path, options.file_bytes);
    if (!file) return {.assembly = {}, .findings = {}, .errors = {file.error()}};
    scene.text = json_of(file->bytes());
    const Result<JsonFile> json = parse_json_file(scene.name, scene.text);
    if (!json) return {.assembly = {}, .findings = {}, .errors = {json.error()}};
    Findings findings;
    std::vector<std::string> errors;
    const GltfPhysics physics = read_gltf_physics(*json, findings, errors);
    for (std::string& error : errors) {
        reading.errors.push_back({ErrorCode::unreadable, std::move(error)});
    }
    if (!reading.errors.empty()) return reading;
    if (auto error = SceneBuilder(*assembly, physics, options, findings).run()) {
        reading.errors.push_back(*std::move(error));
        return reading;
    }
    reading.findings = findings.sentences(scene.name);
    reading.assembly.emplace(std::move(assembly).value());
    return reading;
}

}  // namespace cdprep::scenes
