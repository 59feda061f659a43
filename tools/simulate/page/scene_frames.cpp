// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/page/scene_frames.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace cdprep::report {
namespace {

// The bytes of a part on the page.
constexpr std::size_t kFrameBytes = 200;
constexpr std::size_t kPoseBytes = 32;
constexpr std::size_t kHitBytes = 12;
constexpr std::size_t kLineBytes = 40;  ///< of a contact or a distance

std::uint32_t effect_bits(Ask effects) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < kSceneEffects.size(); ++i) {
        if (contains(effects, kSceneEffects[i])) bits |= 1U << i;
    }
    return bits;
}

Double3 middle_of(const Double3& p, const Double3& q) {
    return {p.x / 2 + q.x / 2, p.y / 2 + q.y / 2, p.z / 2 + q.z / 2};
}

/// Copies the results of a frame, as far as the limits allow.
class Results {
public:
    Results(const scenes::SceneFile& file, const scenes::Simulation& simulation,
            std::uint32_t objects, const FrameLimits& limits, ShownFrame& shown)
        : file_(file), simulation_(simulation), objects_(objects), limits_(limits), shown_(shown) {}

    void copy() {
        const Scene& scene = simulation_.scene();
        for (const SceneHit& hit : scene.hits()) add(hit);
        for (const SceneOverlaps& list : scene.overlaps()) add(list);
        for (const SceneDistance& distance : scene.distances()) add(distance);
        for (const SceneContacts& list : scene.contacts()) add(list);
        if (const scenes::Response* response = simulation_.response()) add(*response);
        for (auto& [object, triangles] : lit_) {
            std::ranges::sort(triangles);
            triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
            shown_.lit.push_back({object, std::move(triangles)});
        }
    }

private:
    [[nodiscard]] std::uint32_t number_of(ObjectId id) const {
        return static_cast<std::uint32_t>(&simulation_.object(id) - file_.objects.data());
    }
    /// Returns whether both objects are on the page.
    template <class Item>
    [[nodiscard]] bool are_shown(const Item& item) const {
        return std::max(number_of(item.a), number_of(item.b)) < objects_;
    }

    void add(const SceneHit& hit) {
        if (hit.holds == Ask::nothing) {
            ++shown_.pairs_unknown;
        } else if (!are_shown(hit) || shown_.hits.size() >= limits_.hits) {
            ++shown_.hits_left_out;
            left_out_.insert(std::minmax(number_of(hit.a), number_of(hit.b)));
        } else {
            shown_.hits.push_back({number_of(hit.a), number_of(hit.b), effect_bits(hit.holds)});
        }
    }

    void add(const scenes::Response& response) {
        shown_.bodies = {response.awake_count(), response.bodies().counts().pairs};
        add_pushing(response);
        add_contacts(response);
    }

    /// Objects that push each other are hits, whether another effect holds for them or not.
    void add_pushing(const scenes::Response& response) {
        constexpr std::uint32_t kResponseBit = 1U << kSceneEffects.size();
        std::map<std::pair<std::uint32_t, std::uint32_t>, ShownHit*> known;
        shown_.hits.reserve(shown_.hits.size() + response.pushing().size());
        for (ShownHit& hit : shown_.hits) known.emplace(std::minmax(hit.a, hit.b), &hit);
        for (const scenes::ObjectPair& pair : response.pushing()) {
            const auto at = known.find({pair.a, pair.b});
            if (at != known.end()) {
                at->second->effects |= kResponseBit;
            } else if (pair.b >= objects_ || shown_.hits.size() >= limits_.hits) {
                shown_.hits_left_out += left_out_.contains({pair.a, pair.b}) ? 0 : 1;
            } else {
                shown_.hits.push_back({pair.a, pair.b, kResponseBit});
            }
        }
    }

    /// Returns whether two objects have contacts of the library, which are then shown.
    [[nodiscard]] bool ask_for_contacts(std::uint32_t a, std::uint32_t b) const {
        const auto layers = std::minmax(file_.objects[a].layer, file_.objects[b].layer);
        return std::ranges::any_of(file_.pairs, [&](const scenes::AskedPair& pair) {
            return std::minmax(pair.asked.a, pair.asked.b) == layers &&
                   contains(pair.asked.effects, Ask::contacts);
        });
    }

    void add_contacts(const scenes::Response& response) {
        for (const dynamics::BodyContact& contact : response.bodies().contacts()) {
            const std::uint32_t a = response.object_of(contact.a);
            const std::uint32_t b = response.object_of(contact.b);
            if (contact.impulse <= 0 || ask_for_contacts(a, b)) continue;
            if (std::max(a, b) >= objects_ || shown_.contacts.size() >= limits_.contacts) {
                ++shown_.contacts_left_out;
                continue;
            }
            shown_.contacts.push_back(
                {a, b, contact.point, contact.normal, contact.distance, contact.distance});
        }
    }

    void light(std::uint32_t object, std::uint32_t triangle) {
        std::vector<std::uint32_t>& triangles = lit_[object];
        // Neighbours in a list often name one triangle.
        if (!triangles.empty() && triangles.back() == triangle) return;
        if (object >= objects_ || lit_count_ >= limits_.lit) {
            ++shown_.lit_left_out;
            if (triangles.empty()) lit_.erase(object);
            return;
        }
        triangles.push_back(triangle);
        ++lit_count_;
    }

    void add(const SceneOverlaps& list) {
        for (const TrianglePair& pair : list.triangles) {
            light(number_of(list.a), pair.a);
            light(number_of(list.b), pair.b);
        }
    }

    void add(const SceneDistance& item) {
        const Distance& found = item.distance;
        // Surfaces that touch have one witness; solids one in the other have two.
        if (found.upper == 0 && found.triangle_a != kNoTriangleNumber &&
            found.witness_a.x == found.witness_b.x && found.witness_a.y == found.witness_b.y &&
            found.witness_a.z == found.witness_b.z) {
            light(number_of(item.a), found.triangle_a);
            light(number_of(item.b), found.triangle_b);
        }
        if (!are_shown(item) || shown_.distances.size() >= limits_.distances) {
            ++shown_.distances_left_out;
            return;
        }
        shown_.distances.push_back({number_of(item.a), number_of(item.b), found.witness_a,
                                    found.witness_b, found.lower, found.upper});
    }

    void add(const SceneContacts& list) {
        for (const Contact& contact : list.contacts) {
            if (!are_shown(list) || shown_.contacts.size() >= limits_.contacts) {
                ++shown_.contacts_left_out;
                continue;
            }
            shown_.contacts.push_back({number_of(list.a), number_of(list.b),
                                       middle_of(contact.point_a, contact.point_b), contact.normal,
                                       contact.lower, contact.upper});
        }
    }

    const scenes::SceneFile& file_;
    const scenes::Simulation& simulation_;
    std::uint32_t objects_;
    const FrameLimits& limits_;
    ShownFrame& shown_;
    std::map<std::uint32_t, std::vector<std::uint32_t>> lit_;  ///< by object
    std::size_t lit_count_ = 0;
    std::set<std::pair<std::uint32_t, std::uint32_t>> left_out_;  ///< hits
};

/// Keeps the shapes of a frame that is left out, unless the next one has newer ones.
void take_shapes(ShownFrame& next, std::vector<ShownShape> left_out) {
    for (ShownShape& shape : left_out) {
        const auto at = std::ranges::find(next.shapes, shape.changing, &ShownShape::changing);
        if (at == next.shapes.end()) next.shapes.push_back(std::move(shape));
    }
}

/// Puts the poses of a frame that is left out before those of the next one.
void take_poses(ShownFrame& next, const std::vector<ObjectPose>& left_out) {
    std::vector<ObjectPose> both;
    std::ranges::merge(next.moved, left_out, std::back_inserter(both), {}, &ObjectPose::object,
                       &ObjectPose::object);
    // Of equal objects, the later pose is first: merge() is stable.
    const auto is_same = [](const ObjectPose& p, const ObjectPose& q) {
        return p.object == q.object;
    };
    both.erase(std::unique(both.begin(), both.end(), is_same), both.end());
    next.moved = std::move(both);
}

}  // namespace

std::size_t ShownFrame::bytes() const noexcept {
    std::size_t sum = kFrameBytes + kPoseBytes * moved.size() + kHitBytes * hits.size() +
                      kLineBytes * (contacts.size() + distances.size());
    for (const LitTriangles& one : lit) sum += 16 + 4 * one.triangles.size();
    for (const ShownShape& shape : shapes) sum += 16 + sizeof(float) * shape.positions.size();
    return sum;
}

SceneFrames::SceneFrames(const scenes::SceneFile& file, std::uint64_t count,
                         const FrameLimits& limits)
    : file_(file),
      count_(count),
      limits_(limits),
      poses_(std::min(file.objects.size(), limits.objects)) {
    // The last frame is shown too, whether its number is a multiple or not.
    while ((count - 1) / stride_ + 2 > std::max<std::size_t>(limits.frames, 2)) stride_ *= 2;
}

void SceneFrames::add_pose(ShownFrame& shown, std::uint32_t object, const Pose& pose) {
    if (object >= poses_.size()) return;
    std::optional<Pose>& last = poses_[object];
    if (last && scenes::are_equal(*last, pose)) return;
    last = pose;
    shown.moved.push_back({object, pose});
}

Result<Done> SceneFrames::add_poses(ShownFrame& shown, const scenes::Simulation& simulation) {
    const double time_s = static_cast<double>(shown.frame) * file_.step_s;
    const std::span<const Pose> poses = simulation.poses();
    std::size_t slot = 0;
    for (std::uint32_t i = 0; i < poses_.size(); ++i) {
        const scenes::FileObject& object = file_.objects[i];
        // The simulation has the objects that it was asked for, in the order of the file.
        if (is_asked(file_, simulation.plan(), object)) {
            add_pose(shown, i, poses[slot++]);
            continue;
        }
        if (poses_[i] && !file_.motions[object.motion].moves()) continue;
        const Result<Pose> pose = pose_of(file_, object, time_s);
        if (!pose) return pose.error();
        add_pose(shown, i, *pose);
    }
    return Done{};
}

/// The smallest models first: as many as possible are then drawn as they change.
void SceneFrames::choose_live_models(const scenes::Simulation& simulation) {
    has_chosen_ = true;
    const auto changing = simulation.changing();
    live_models_.resize(changing.size());
    versions_.assign(changing.size(), 0);
    std::vector<std::pair<std::size_t, std::size_t>> sizes;  // triangles, number
    for (std::size_t i = 0; i < changing.size(); ++i) {
        if (changing[i].objects.front() >= objects()) continue;  // not on the page
        const scenes::Cut& cut = changing[i].live.cut();
        sizes.emplace_back(changing[i].live.live().triangle_count() + cut.appended.size(), i);
    }
    std::ranges::sort(sizes);
    std::size_t sum = 0;
    for (const auto& [size, number] : sizes) {
        sum += size;
        live_models_[number].is_drawn = sum <= limits_.changing;
    }
}

/// Copies the shapes that changed since the last frame that was shown.
void SceneFrames::add_shapes(ShownFrame& shown, const scenes::Simulation& simulation) {
    for (std::uint32_t i = 0; i < live_models_.size(); ++i) {
        const scenes::ChangingModel& live = simulation.changing()[i].live;
        if (!live_models_[i].is_drawn || versions_[i] == live.version()) continue;
        versions_[i] = live.version();
        ShownTopology& topology = live_models_[i].topologies[live.is_torn() ? 1 : 0];
        if (topology.numbers.empty()) {
            for (const LiveTriangle& triangle : live.triangles()) {
                topology.numbers.push_back(triangle.number);
                topology.indices.insert(topology.indices.end(), triangle.vertex.begin(),
                                        triangle.vertex.end());
            }
        }
        ShownShape shape{i, live.is_torn(), {}};
        const Double3 middle = live.rest_box().middle();
        for (const Double3& p : live.positions()) {
            for (const double x : {p.x - middle.x, p.y - middle.y, p.z - middle.z}) {
                shape.positions.push_back(static_cast<float>(x));
            }
        }
        shown.shapes.push_back(std::move(shape));
    }
}

Result<Done> SceneFrames::add(std::uint64_t frame, const scenes::Simulation& simulation) {
    if (!has_chosen_) choose_live_models(simulation);
    if (!is_shown(frame)) return Done{};
    ShownFrame shown;
    shown.frame = frame;
    if (Result<Done> added = add_poses(shown, simulation); !added) return added;
    add_shapes(shown, simulation);
    take_poses(shown, std::exchange(left_out_, {}));
    take_shapes(shown, std::exchange(shapes_left_out_, {}));
    Results(file_, simulation, objects(), limits_, shown).copy();
    shown.counts = simulation.scene().counts();
    shown.seconds = simulation.frame_seconds();
    bytes_ += shown.bytes();
    frames_.push_back(std::move(shown));
    while (bytes_ > limits_.bytes && stride_ < count_) thin();
    return Done{};
}

/// Leaves out each second frame.
void SceneFrames::thin() {
    stride_ *= 2;
    bytes_ = 0;
    for (ShownFrame& shown : std::exchange(frames_, {})) {
        take_poses(shown, std::exchange(left_out_, {}));
        take_shapes(shown, std::exchange(shapes_left_out_, {}));
        if (is_shown(shown.frame)) {
            bytes_ += shown.bytes();
            frames_.push_back(std::move(shown));
        } else {
            left_out_ = std::move(shown.moved);
            shapes_left_out_ = std::move(shown.shapes);
        }
    }
}

}  // namespace cdprep::report
