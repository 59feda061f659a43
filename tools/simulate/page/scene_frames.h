// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "simulate/run/simulation.h"

namespace cdprep::report {

/// The pose of an object from a frame on.
struct ObjectPose {
    std::uint32_t object;  ///< its number in SceneFile::objects
    Pose pose;
};

/// The triangles of an object that touch another one: source numbers, ascending.
struct LitTriangles {
    std::uint32_t object;
    std::vector<std::uint32_t> triangles;
};

/// Two objects for which effects hold.
struct ShownHit {
    std::uint32_t a;
    std::uint32_t b;
    std::uint32_t effects;  ///< bit i: kSimulatedEffects[i]
};

struct ShownContact {
    std::uint32_t a;
    std::uint32_t b;
    Double3 point;   ///< between the points on a and on b; of response: on b
    Double3 normal;  ///< from a to b
    double lower;    ///< bounds of the distance; negative: the depth
    double upper;
};

struct ShownDistance {
    std::uint32_t a;
    std::uint32_t b;
    Double3 from;  ///< on a
    Double3 to;    ///< on b
    double lower;
    double upper;
};

/// The bodies of a frame.
struct ShownBodies {
    std::uint64_t awake = 0;
    std::uint64_t calls = 0;  ///< pairs of objects that were asked for contacts, in all substeps
};

/// The shape of a live model from a frame on.
struct ShownShape {
    std::uint32_t changing;  ///< its number in Simulation::changing()
    bool is_torn = false;
    std::vector<float> positions;  ///< from the middle of the box at rest, three a vertex
};

/// The triangles of a live model, before or after its tear.
struct ShownTopology {
    std::vector<std::uint32_t> indices;  ///< three a triangle
    std::vector<std::uint32_t> numbers;  ///< of the triangles, rising
};

/// The triangles of a live model that the page draws as it changes.
struct ShownLiveModel {
    bool is_drawn = false;  ///< false: it has too many triangles, or no object on the page
    std::array<ShownTopology, 2> topologies;  ///< at rest, and torn
};

/// A frame as the page shows it. Objects are numbers in SceneFile::objects.
struct ShownFrame {
    std::uint64_t frame = 0;
    std::vector<ObjectPose> moved;   ///< since the shown frame before it; all in the first one
    std::vector<ShownShape> shapes;  ///< that changed since the shown frame before it
    std::vector<LitTriangles> lit;
    std::vector<ShownHit> hits;
    std::vector<ShownContact> contacts;
    std::vector<ShownDistance> distances;
    SceneCounts counts;
    std::uint64_t pairs_unknown = 0;  ///< for which it is not known whether they collide
    std::optional<ShownBodies> bodies;
    double seconds = 0;
    /// What the limits or the choice of objects leave out.
    std::uint64_t lit_left_out = 0;
    std::uint64_t hits_left_out = 0;
    std::uint64_t contacts_left_out = 0;
    std::uint64_t distances_left_out = 0;

    [[nodiscard]] std::size_t bytes() const noexcept;  ///< on the page, before base64
};

/// The limits of a page. Those of a frame bound its first and last frame.
struct FrameLimits {
    std::size_t frames = 2000;
    std::size_t bytes = 24'000'000;  ///< of all frames
    std::size_t objects = 20'000;    ///< the first ones of the file
    std::size_t lit = 50'000;        ///< triangles in a frame
    std::size_t hits = 20'000;       ///< in a frame; and so on
    std::size_t contacts = 5'000;
    std::size_t distances = 5'000;
    std::size_t changing = 100'000;  ///< triangles of all live models that are drawn as they change
};

/// The frames of a run that its page shows: each n-th, and the last one. n is 1 if the limits
/// allow it, and otherwise the least power of two for which they are kept. Memory is bounded.
class SceneFrames {
public:
    /// `file` must outlive the object. `count` is the number of frames of the run.
    SceneFrames(const scenes::SceneFile& file, std::uint64_t count, const FrameLimits& limits);

    /// Adds the last frame of a simulation. Fails as scenes::pose_of() does, for objects that the
    /// simulation leaves out.
    [[nodiscard]] Result<Done> add(std::uint64_t frame, const scenes::Simulation& simulation);

    [[nodiscard]] const std::vector<ShownFrame>& frames() const noexcept {
        return frames_;
    }
    [[nodiscard]] std::uint64_t stride() const noexcept {
        return stride_;
    }
    /// The live models, in the order of Simulation::changing().
    [[nodiscard]] const std::vector<ShownLiveModel>& live_models() const noexcept {
        return live_models_;
    }
    /// The objects on the page.
    [[nodiscard]] std::uint32_t objects() const noexcept {
        return static_cast<std::uint32_t>(poses_.size());
    }

private:
    [[nodiscard]] bool is_shown(std::uint64_t frame) const noexcept {
        return frame % stride_ == 0 || frame + 1 == count_;
    }
    [[nodiscard]] Result<Done> add_poses(ShownFrame& shown, const scenes::Simulation& simulation);
    void add_pose(ShownFrame& shown, std::uint32_t object, const Pose& pose);
    void choose_live_models(const scenes::Simulation& simulation);
    void add_shapes(ShownFrame& shown, const scenes::Simulation& simulation);
    void thin();

    const scenes::SceneFile& file_;
    std::uint64_t count_;
    FrameLimits limits_;
    std::uint64_t stride_ = 1;
    std::size_t bytes_ = 0;
    std::vector<ShownFrame> frames_;
    std::vector<ObjectPose> left_out_;  ///< since the last one of them
    std::vector<ShownShape> shapes_left_out_;
    std::vector<ShownLiveModel> live_models_;
    std::vector<std::uint64_t> versions_;  ///< by live model, as last shown
    bool has_chosen_ = false;
    std::vector<std::optional<Pose>> poses_;  ///< of each object on the page, as last shown
};

}  // namespace cdprep::report
