// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/model.h"
#include "cdprep/pose.h"
#include "cdprep/result.h"

namespace cdprep::dynamics {

/// Returns whether the program was built with Bullet. Without it, make_rigid_bodies() fails.
[[nodiscard]] bool has_dynamics() noexcept;

/// The numbers of a simulation. Lengths are in model units, times in seconds.
struct DynamicsOptions {
    Double3 gravity = {0, 0, -9.81};
    double step_s = 1.0 / 60;       ///< the time of a frame
    std::uint32_t substeps = 4;     ///< a frame is moved in so many equal parts
    std::uint32_t iterations = 50;  ///< of the solver, in each substep
    /// Surfaces as near as this have contacts. At least rest_gap + most_speed * (the time of a
    /// substep): then contacts are known before bodies meet. Slow bodies, which include
    /// driven ones, have a smaller tolerance of their own.
    double tolerance = 0.01;
    /// How far apart bodies rest. A body that rests apart has contacts between nearest features,
    /// which change least from one substep to the next.
    double rest_gap = 5e-4;
    double most_speed = 2;  ///< of two surfaces towards each other, for `tolerance`
    /// Contacts whose normals differ less are joined, and have at most four points then. These span
    /// an area, but a rough body may rest on others. Such bodies rock, so the default joins none.
    double cluster_angle = 0;
    std::uint32_t most_contacts = 32;  ///< of two bodies
    bool sleeps = true;                ///< bodies at rest stop, until something touches them
    /// A body sleeps after two seconds in which no point of it was faster than about this.
    double sleep_speed = 1e-2;
    /// Threads that parallel_for uses at a time. Results do not depend on it.
    std::uint32_t threads = 1;
    /// The pairs of groups whose bodies push each other. Empty: all bodies push all others.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> groups = {};
};

enum class BodyKind : std::uint8_t {
    moving,
    fixed,
    driven,  ///< moves as drive() says, and pushes others
};

/// A body to add.
struct RigidBody {
    const Model* model = nullptr;  ///< must serve Ask::contacts, and outlive the bodies
    std::string name = "body";     ///< for messages
    Pose world_from_model = {};
    BodyKind kind = BodyKind::moving;
    std::uint32_t group = 0;  ///< of DynamicsOptions::groups
    /// Of the whole body. Unset: density times the volume that the file has.
    std::optional<double> mass = {};
    double density = 1000;      ///< mass per cubic model unit
    double friction = 0.5;      ///< of two bodies: the geometric mean
    double restitution = 0;     ///< of two bodies: the larger one
    double linear_damping = 0;  ///< the share of the velocity lost in a second, 0 to 1
    double angular_damping = 0;
    /// It passes through nothing, and no body passes through it. Contacts alone keep out what it
    /// touches when a substep begins. Where it first meets another one in a substep, the motions
    /// of both end. A driven body goes on and takes it along. Between two driven or fixed bodies it
    /// may be squeezed. In a substep, centres move along straight lines, and no body may turn by
    /// more than 1000 radians. The models of all bodies must then serve Ask::distance.
    bool is_continuous = false;
    Double3 velocity = {0, 0, 0};          ///< of the centre of mass
    Double3 angular_velocity = {0, 0, 0};  ///< radians per second, in the world
};

/// A point at which two bodies push each other.
struct BodyContact {
    std::uint32_t a;  ///< a < b
    std::uint32_t b;
    Double3 point;   ///< on b, in the world
    Double3 normal;  ///< from a to b
    /// Along the normal. Negative: they overlap, at most four times as deep as the shortest way
    /// out.
    double distance;
    double impulse;  ///< along the normal, that of a bounce included; 0: they do not push
};

/// The first contact of a continuous body and another one in a substep.
struct BodyImpact {
    std::uint32_t body;  ///< continuous; the smaller number if both are
    std::uint32_t other;
    double time_s;  ///< since the first frame began
};

/// The work of the last step(), over all its substeps.
struct DynamicsCounts {
    std::uint64_t pairs = 0;     ///< of bodies that were asked for contacts
    std::uint64_t contacts = 0;  ///< after they were joined
    std::uint64_t deep = 0;      ///< contacts with a body inside the other
    /// Contacts whose way out is more than four times the shortest one. Their normal leads along a
    /// surface; they push no farther than that.
    std::uint64_t shortened = 0;
    std::uint64_t incomplete = 0;  ///< lists that most_contacts cut short
    /// Bodies of which a point may be faster than most_speed, in each substep. Two that fly towards
    /// each other count by their own speeds. Continuous bodies do not count.
    std::uint64_t too_fast = 0;
    std::uint64_t impacts = 0;  ///< of continuous bodies
};

/// Rigid bodies that push each other at the contacts of cdprep. Bullet's solver computes impulses;
/// cdprep::Scene is the collision world. Poses and turns are in double, other velocities in float.
///
/// Reads no clock. The same calls give the same bits for any number of threads, but not with
/// another build of Bullet.
class RigidBodies {
public:
    virtual ~RigidBodies() = default;

    /// Adds a body and returns its number: 0, 1, and so on. Fails with bad_argument if the model
    /// does not serve the contacts, or a moving body has no mass. Also fails if there are too many
    /// groups. A balanced model's mass is in the file. An unbalanced model needs body.mass; its
    /// centre and inertia are then those of its box.
    [[nodiscard]] virtual Result<std::uint32_t> add_body(const RigidBody& body) = 0;

    /// Says where a driven body is at the end of the next step(). Fails with bad_argument if the
    /// body is not driven, or its way is too long.
    [[nodiscard]] virtual Result<Done> drive(std::uint32_t body, const Pose& world_from_model) = 0;
    /// Computes a frame. Fails with bad_argument if a body leaves the range of coordinates.
    [[nodiscard]] virtual Result<Done> step() = 0;

    [[nodiscard]] virtual std::uint32_t body_count() const noexcept = 0;
    [[nodiscard]] virtual const Pose& pose(std::uint32_t body) const noexcept = 0;
    [[nodiscard]] virtual Double3 centre_of_mass(std::uint32_t body) const noexcept = 0;
    [[nodiscard]] virtual Double3 velocity(std::uint32_t body) const noexcept = 0;
    [[nodiscard]] virtual Double3 angular_velocity(std::uint32_t body) const noexcept = 0;
    /// Returns a bound of the speed of all points of a body.
    [[nodiscard]] virtual double speed_bound(std::uint32_t body) const noexcept = 0;
    [[nodiscard]] virtual bool is_asleep(std::uint32_t body) const noexcept = 0;
    [[nodiscard]] virtual double mass(std::uint32_t body) const noexcept = 0;
    /// Of all moving bodies.
    [[nodiscard]] virtual double kinetic_energy() const noexcept = 0;

    /// The contacts of the last substep, in the order of (a, b).
    [[nodiscard]] virtual std::span<const BodyContact> contacts() const noexcept = 0;
    /// The impacts of the last step().
    [[nodiscard]] virtual std::span<const BodyImpact> impacts() const noexcept = 0;
    [[nodiscard]] virtual const DynamicsCounts& counts() const noexcept = 0;
    /// Returns the memory of the collision world. Bullet's own is not counted.
    [[nodiscard]] virtual std::size_t state_bytes() const noexcept = 0;
    /// Returns a hash of all poses and velocities.
    [[nodiscard]] virtual std::uint64_t state_hash() const noexcept = 0;
};

/// Makes a simulation without bodies. Fails with bad_argument if an option is out of range, or the
/// program was built without Bullet. parallel_for must outlive it.
[[nodiscard]] Result<std::unique_ptr<RigidBodies>> make_rigid_bodies(
    const DynamicsOptions& options = {}, ParallelFor parallel_for = serial_for);

}  // namespace cdprep::dynamics
