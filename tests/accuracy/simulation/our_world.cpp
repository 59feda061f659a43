// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <utility>

#include "accuracy/simulation/worlds.h"
#include "study/memory_model.h"
#include "unit/tools/soup_of.h"

namespace cdprep::test {
namespace {

[[noreturn]] void stop(const std::string& message) {
    std::fprintf(stderr, "simulation: %s\n", message.c_str());
    std::exit(2);
}

/// A balanced mesh has mass properties.
bool is_balanced(const TestMesh& mesh) {
    std::size_t odd = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t c = 0; c < 3; ++c) {
            edges.emplace_back(t.vertex[c], t.vertex[(c + 1) % 3]);
        }
    }
    std::sort(edges.begin(), edges.end());
    for (const auto& [from, to] : edges) {
        odd += std::binary_search(edges.begin(), edges.end(), std::pair{to, from}) ? 0 : 1;
    }
    return odd == 0;
}

/// Models that cases have in common, baked once.
const Model& baked(const TestMesh& mesh) {
    struct Kept {
        TestMesh mesh;
        study::MemoryModel made;
    };
    static std::deque<Kept> kept;
    const auto equals = [&](const TestMesh& other) {
        if (other.positions.size() != mesh.positions.size()) return false;
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const Double3 &p = mesh.positions[i], &q = other.positions[i];
            if (p.x != q.x || p.y != q.y || p.z != q.z) return false;
        }
        return other.triangles.size() == mesh.triangles.size();
    };
    for (const Kept& one : kept) {
        if (equals(one.mesh)) return one.made.model;
    }
    auto made = study::make_memory_model(
        mesh_of(mesh), {.hulls = true, .pieces = true, .mass = is_balanced(mesh)});
    if (!made) stop(made.error().message);
    kept.push_back({mesh, std::move(made).value()});
    return kept.back().made.model;
}

class OurWorld final : public World {
public:
    OurWorld(const dynamics::DynamicsOptions& options, ParallelFor parallel_for) {
        auto made = dynamics::make_rigid_bodies(options, parallel_for);
        if (!made) stop(made.error().message);
        bodies_ = std::move(made).value();
    }
    std::uint32_t add(const Actor& actor) override {
        const double s = std::sin(actor.angle / 2);
        dynamics::RigidBody body;
        body.model = &baked(test::mesh_of(actor));
        body.world_from_model = Pose::from_quaternion(std::cos(actor.angle / 2), s * actor.axis.x,
                                                      s * actor.axis.y, s * actor.axis.z, actor.at)
                                    .value();
        body.kind = actor.mass > 0 ? dynamics::BodyKind::moving : dynamics::BodyKind::fixed;
        if (actor.mass > 0) body.mass = actor.mass;
        body.friction = actor.friction;
        body.restitution = actor.restitution;
        body.linear_damping = body.angular_damping = actor.damping;
        body.velocity = actor.velocity;
        body.angular_velocity = actor.turn;
        body.is_continuous = actor.is_continuous;
        const auto added = bodies_->add_body(body);
        if (!added) stop(added.error().message);
        return *added;
    }
    void step() override {
        if (const auto stepped = bodies_->step(); !stepped) stop(stepped.error().message);
    }
    Double3 position(std::uint32_t body) const override {
        return bodies_->centre_of_mass(body);
    }
    Double3 velocity(std::uint32_t body) const override {
        return bodies_->velocity(body);
    }
    Double3 angular_velocity(std::uint32_t body) const override {
        return bodies_->angular_velocity(body);
    }
    Double3 spin(std::uint32_t body) const override {
        const auto& r = bodies_->pose(body).rotation();
        const Double3 w = bodies_->angular_velocity(body);
        return {r[0] * w.x + r[3] * w.y + r[6] * w.z, r[1] * w.x + r[4] * w.y + r[7] * w.z,
                r[2] * w.x + r[5] * w.y + r[8] * w.z};
    }
    dynamics::RigidBodies* ours() override {
        return bodies_.get();
    }

private:
    std::unique_ptr<dynamics::RigidBodies> bodies_;
};

}  // namespace

TestMesh box_mesh(const Double3& half) {
    TestMesh mesh = moved_by(unit_cube(), 2, {-1, -1, -1});
    for (Double3& p : mesh.positions) p = {half.x * p.x, half.y * p.y, half.z * p.z};
    return mesh;
}

TestMesh mesh_of(const Actor& actor) {
    switch (actor.form) {
        case Form::box:
            return box_mesh(actor.half);
        case Form::sphere:
            return moved_by(icosphere(actor.level), actor.radius, {0, 0, 0});
        case Form::mesh:
            break;
    }
    return *actor.mesh;
}

std::unique_ptr<World> make_our_world(const dynamics::DynamicsOptions& options,
                                      ParallelFor parallel_for) {
    return std::make_unique<OurWorld>(options, parallel_for);
}

}  // namespace cdprep::test
