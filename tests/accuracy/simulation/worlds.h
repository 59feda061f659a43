// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include "cdprep/pose.h"
#include "simulate/dynamics/rigid_bodies.h"
#include "support/meshes.h"

namespace cdprep::test {

enum class Form : std::uint8_t { box, sphere, mesh };

/// A body of a case, for every engine.
struct Actor {
    Form form = Form::box;
    Double3 half = {0.5, 0.5, 0.5};  ///< of a box
    double radius = 0.5;             ///< of a sphere
    int level = 3;                   ///< of the icosphere that stands for a sphere
    const TestMesh* mesh = nullptr;  ///< of a mesh
    double mass = 1;                 ///< 0: fixed
    Double3 at{};
    Double3 axis = {0, 0, 1};  ///< of its turn, a unit vector
    double angle = 0;
    double friction = 0.5;
    double restitution = 0;
    double damping = 0;  ///< of both velocities
    Double3 velocity{};
    Double3 turn{};  ///< radians per second
    /// Ours by the time of impact. Bullet's primitives by a sphere that is swept (CCD).
    bool is_continuous = false;
};

/// An engine with the bodies of one case. Bodies are numbered as they are added.
class World {
public:
    virtual ~World() = default;
    virtual std::uint32_t add(const Actor& actor) = 0;
    virtual void step() = 0;
    [[nodiscard]] virtual Double3 position(std::uint32_t body) const = 0;  ///< centre of mass
    [[nodiscard]] virtual Double3 velocity(std::uint32_t body) const = 0;
    [[nodiscard]] virtual Double3 angular_velocity(std::uint32_t body) const = 0;
    /// The angular velocity along the axes of the model.
    [[nodiscard]] virtual Double3 spin(std::uint32_t body) const = 0;
    /// Null unless the bodies are ours.
    [[nodiscard]] virtual dynamics::RigidBodies* ours() {
        return nullptr;
    }
};

enum class Engine : std::uint8_t { cdprep, bullet, gimpact };
[[nodiscard]] const char* name_of(Engine engine);

/// Makes an empty world of ours.
[[nodiscard]] std::unique_ptr<World> make_our_world(const dynamics::DynamicsOptions& options,
                                                    ParallelFor parallel_for = serial_for);
/// Makes one of Bullet's own. It takes the steps, the iterations and the gravity from the options;
/// everything else is as Bullet has it.
[[nodiscard]] std::unique_ptr<World> make_peer_world(Engine engine,
                                                     const dynamics::DynamicsOptions& options);
[[nodiscard]] inline std::unique_ptr<World> make_world(Engine engine,
                                                       const dynamics::DynamicsOptions& options) {
    return engine == Engine::cdprep ? make_our_world(options) : make_peer_world(engine, options);
}

/// A box about the origin.
[[nodiscard]] TestMesh box_mesh(const Double3& half);
/// The mesh of an actor.
[[nodiscard]] TestMesh mesh_of(const Actor& actor);

}  // namespace cdprep::test
