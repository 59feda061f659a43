// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cdprep/plan.h"
#include "scene_file/deform.h"
#include "scene_file/motion.h"
#include "scene_file/tear.h"

namespace cdprep::scenes {

/// The most objects of a scene file, copies counted.
inline constexpr std::uint32_t kMostObjects = 1U << 20;

/// What the objects of two layers are asked about each other.
struct AskedPair {
    LayerPair asked = {};      ///< its layers are numbers of SceneFile::layers
    bool tells_begins = true;  ///< events to report
    bool tells_ends = true;
    std::size_t line = 0;  ///< of the file; 0: it does not state the pair
};

/// A change of a model with time. Objects with the same model and change share one live model.
struct Change {
    std::optional<Deform> deform = {};
    std::optional<Tear> tear = {};

    auto operator<=>(const Change&) const = default;
};

/// The change of an object whose model stays as it is.
inline constexpr std::uint32_t kUnchanged = 0xffffffffU;

/// What `response` reads of every object, whether it is a body or not.
struct Material {
    double friction = 0.5;   ///< at least 0; of two objects: the geometric mean
    double restitution = 0;  ///< 0 to 1; of two objects: the larger one

    auto operator<=>(const Material&) const = default;
};

/// A rigid body that `response` moves: contacts push it, gravity pulls it.
struct BodyMotion {
    /// Of the whole body. Unset: the density times the volume of the model.
    std::optional<double> mass = {};
    std::optional<double> density = {};  ///< per cubic model unit; unset: of water
    double linear_damping = 0;           ///< the share of the velocity lost in a second, 0 to 1
    double angular_damping = 0;
    Double3 velocity{};  ///< at first, of the centre of mass
    Double3 turn{};      ///< at first, radians per second, in the world
    bool is_continuous = false;
};

/// The number of the body of an object that is not one.
inline constexpr std::uint32_t kNoBody = 0xffffffffU;

/// How `response` moves bodies. Lengths are in model units. What is unset follows from the others.
struct Dynamics {
    std::optional<Double3> gravity;  ///< needed if there are bodies
    std::uint32_t substeps = 4;
    std::uint32_t iterations = 50;
    std::optional<double> rest_gap = {};     ///< unset: half a millimetre
    std::optional<double> most_speed = {};   ///< unset: 2 metres per second
    std::optional<double> tolerance = {};    ///< unset: what most_speed needs, and a tenth more
    std::optional<double> sleep_speed = {};  ///< unset: 1 centimetre per second
    std::uint32_t most_contacts = 32;
    bool sleeps = true;
};

struct FileObject {
    std::string name;                   ///< unique; copies are "NAME[x,y,z]"
    std::uint32_t model = 0;            ///< its number in SceneFile::models
    std::uint32_t layer = 0;            ///< its number in SceneFile::layers
    std::uint32_t motion = 0;           ///< its number in SceneFile::motions
    Double3 offset{};                   ///< of a copy, in the world
    std::uint32_t change = kUnchanged;  ///< its number in SceneFile::changes
    std::uint32_t body = kNoBody;       ///< its number in SceneFile::bodies
    Material material = {};
};

/// The content of a scene file. Lengths are in model units.
struct SceneFile {
    std::string name;            ///< the file, for messages
    std::string text;            ///< of the file
    double metres_per_unit = 0;  ///< of every model; 0: not stated
    bool y_is_up = false;        ///< in pictures, as in glTF; else z is, or what gravity says
    double step_s = 1.0 / 60;
    double duration_s = 0;
    std::optional<std::uint32_t> most_pairs;  ///< SceneLimits::pairs
    std::vector<std::string> layers;
    bool has_pairs = true;  ///< otherwise the file does not say what is asked
    std::vector<AskedPair> pairs;
    Ask dropped = Ask::nothing;                 ///< by drop_effect(): pairs asked for these
    std::vector<std::filesystem::path> models;  ///< mesh files or baked files, each once
    std::vector<Motion> motions;
    std::vector<Change> changes;  ///< each once
    Dynamics dynamics;
    std::vector<BodyMotion> bodies;
    std::vector<FileObject> objects;
};

/// Returns the poses of an object at a time, from 0 on. Fails with bad_argument and names the
/// object if it leaves the range of coordinates.
[[nodiscard]] Result<Pose> pose_of(const SceneFile& scene, const FileObject& object, double time_s);

}  // namespace cdprep::scenes
