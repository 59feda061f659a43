// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cdprep/contacts.h"
#include "mesh/vectors.h"
#include "simulate/dynamics/body_ways.h"
#include "simulate/dynamics/bullet_world.h"
#include "simulate/dynamics/contact_scene.h"
#include "text/number_text.h"

namespace cdprep::dynamics {
namespace {

/// Impacts of continuous bodies are found this exactly. In rest gaps.
constexpr double kImpactTolerance = 1e-3;
/// A body that turns farther goes its way in parts, each by less than pi.
constexpr double kPartTurn = 2;
constexpr double kMostTurn = 1000;    ///< in a substep
constexpr double kMostSteps = 20000;  ///< of a body's turn in a substep

Error refused(const std::string& sentence) {
    return {ErrorCode::bad_argument, sentence};
}

std::string text(double number) {
    return report::number_text(number);
}

/// Returns why the options are out of range, or an empty text.
std::string fault_of(const DynamicsOptions& o) {
    const auto positive = [](double number) { return std::isfinite(number) && number > 0; };
    if (!positive(o.step_s)) return "The step is " + text(o.step_s) + " s, but it must be above 0.";
    if (o.substeps == 0 || o.iterations == 0 || o.threads == 0) {
        return "There are " + std::to_string(o.substeps) + " substeps, " +
               std::to_string(o.iterations) + " iterations and " + std::to_string(o.threads) +
               " threads, but at least 1 of each is needed.";
    }
    constexpr std::uint32_t kMost = 1'000'000;  // of Bullet's int
    if (o.substeps > kMost || o.iterations > kMost) {
        return "There are " + std::to_string(o.substeps) + " substeps and " +
               std::to_string(o.iterations) + " iterations; at most 1000000 are supported.";
    }
    if (o.most_contacts == 0 || o.most_contacts > kMostListedContacts) {
        return "The maximum number of contacts of two bodies is " +
               std::to_string(o.most_contacts) + ", but it must be 1 to " +
               std::to_string(kMostListedContacts) + ".";
    }
    if (!positive(o.rest_gap)) {
        return "The rest gap is " + text(o.rest_gap) + ", but it must be above 0.";
    }
    if (!std::isfinite(mesh::length(o.gravity))) return "Gravity must be finite.";
    const double needed = o.rest_gap + o.most_speed * o.step_s / o.substeps;
    if (!(o.most_speed >= 0) || !(o.tolerance >= needed) || !std::isfinite(o.tolerance)) {
        return "The contact tolerance is " + text(o.tolerance) + ", but at a speed of " +
               text(o.most_speed) + " it must be at least " + text(needed) +
               ": the rest gap plus the distance moved in a substep.";
    }
    return {};
}

/// Returns why a body's numbers are out of range, or an empty text.
std::string fault_of(const RigidBody& body) {
    struct Number {
        const char* name;
        double value;
        double most;
    };
    constexpr double kMost = 1e6;  // of friction: no surfaces come near
    for (const Number& number :
         {Number{"friction", body.friction, kMost}, Number{"restitution", body.restitution, 1},
          Number{"linear damping", body.linear_damping, 1},
          Number{"angular damping", body.angular_damping, 1}}) {
        if (number.value >= 0 && number.value <= number.most) continue;
        return "the " + std::string(number.name) + " is " + text(number.value) +
               ", but it must be 0 to " + text(number.most) + ".";
    }
    if (!std::isfinite(mesh::length(body.velocity)) ||
        !std::isfinite(mesh::length(body.angular_velocity))) {
        return "a velocity is not finite.";
    }
    return {};
}

/// Where a body is at the end of a substep.
struct WayEnd {
    RigidState state;
    Pose pose;
};

class BulletBodies final : public RigidBodies, private SubstepParts {
public:
    BulletBodies(const DynamicsOptions& options, ParallelFor parallel_for);
    ~BulletBodies() override;
    BulletBodies(const BulletBodies&) = delete;
    BulletBodies& operator=(const BulletBodies&) = delete;

    Result<std::uint32_t> add_body(const RigidBody& body) override;
    Result<Done> drive(std::uint32_t body, const Pose& world_from_model) override;
    Result<Done> step() override;

    std::uint32_t body_count() const noexcept override {
        return static_cast<std::uint32_t>(bodies_.size());
    }
    const Pose& pose(std::uint32_t body) const noexcept override {
        return bodies_[body]->pose;
    }
    Double3 centre_of_mass(std::uint32_t body) const noexcept override {
        return bodies_[body]->state.centre;
    }
    Double3 velocity(std::uint32_t body) const noexcept override {
        return doubles(bullet_body(body).getLinearVelocity());
    }
    Double3 angular_velocity(std::uint32_t body) const noexcept override {
        return doubles(bullet_body(body).getAngularVelocity());
    }
    double speed_bound(std::uint32_t body) const noexcept override {
        return mesh::length(velocity(body)) +
               mesh::length(angular_velocity(body)) * bodies_[body]->mass.radius;
    }
    bool is_asleep(std::uint32_t body) const noexcept override {
        return bullet_body(body).getActivationState() == ISLAND_SLEEPING;
    }
    double mass(std::uint32_t body) const noexcept override {
        return bodies_[body]->mass.mass;
    }
    double kinetic_energy() const noexcept override;
    std::span<const BodyContact> contacts() const noexcept override {
        return contacts_;
    }
    std::span<const BodyImpact> impacts() const noexcept override {
        return impacts_;
    }
    const DynamicsCounts& counts() const noexcept override {
        return counts_;
    }
    std::size_t state_bytes() const noexcept override {
        return scene_.bytes();
    }
    std::uint64_t state_hash() const noexcept override;

private:
    const btRigidBody& bullet_body(std::uint32_t body) const noexcept {
        return *bodies_[body]->rigid;
    }
    void find_contacts() override;
    void move_bodies(double substep_s) override;
    void set_paces();
    Result<std::uint32_t> turn_parts(const BulletBody& body, const Double3& spin,
                                     double substep_s) const;
    static std::uint32_t turn_steps(const BulletBody& body, const Double3& spin, double substep_s,
                                    std::uint32_t parts);
    static Result<Done> add_motion(const BulletBody& body, const Pose& start, const Pose& end,
                                   std::vector<Motion>* way);
    Result<Done> fly(std::uint32_t number, double substep_s, std::vector<Motion>* way);
    Result<Done> find_ends(double substep_s, std::vector<BodyWay>& ways);
    std::vector<BodyWay> empty_ways() const;
    Result<Done> find_impacts(std::span<const BodyWay> ways, double substep_s);
    void end_drives();

    DynamicsOptions options_;
    ContactScene scene_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;  // has no pairs: it is only asked for by Bullet
    ImpulseSolver solver_;
    ImpulseWorld world_{*this, dispatcher_, broadphase_, solver_, configuration_};
    Manifolds manifolds_;
    Bodies bodies_;
    bool has_continuous_ = false;
    std::vector<std::optional<WayEnd>> ends_;  ///< of the bodies that move in a substep
    std::vector<BodyContact> contacts_;
    std::vector<BodyImpact> impacts_;
    DynamicsCounts counts_;
    std::optional<Error> error_;  ///< of a substep
    std::uint64_t frame_ = 0;
    std::uint32_t substep_ = 0;
};

BulletBodies::BulletBodies(const DynamicsOptions& options, ParallelFor parallel_for)
    : options_(options), scene_(options, parallel_for), manifolds_(dispatcher_, options) {
    world_.setGravity(bullet(options.gravity));
    btContactSolverInfo& info = world_.getSolverInfo();
    info.m_numIterations = static_cast<int>(options.iterations);
    info.m_splitImpulse = 1;
    info.m_splitImpulsePenetrationThreshold = 0;
    info.m_warmstartingFactor = 1;
    info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_SIMD | SOLVER_USE_2_FRICTION_DIRECTIONS |
                        SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
}

BulletBodies::~BulletBodies() {
    for (auto& body : bodies_) world_.removeRigidBody(body->rigid.get());
}

Result<std::uint32_t> BulletBodies::add_body(const RigidBody& body) {
    if (const std::string fault = fault_of(body); !fault.empty()) {
        return refused(body.name + ": " + fault);
    }
    const bool continuous =
        body.is_continuous || std::any_of(bodies_.begin(), bodies_.end(), [](const auto& other) {
            return other->given.is_continuous;
        });
    const Ask asks = continuous ? Ask::contacts | Ask::distance : Ask::contacts;
    if (const auto refusal = body.model->refusal(asks)) return refused(refusal->message);
    const Result<BodyMass> mass = mass_of(body);
    if (!mass) return mass.error();
    if (Result<Done> added = scene_.add(body); !added) return added.error();
    bodies_.push_back(std::make_unique<BulletBody>(body, *mass));
    has_continuous_ = has_continuous_ || (body.is_continuous && body.kind == BodyKind::moving);
    btRigidBody& made = *bodies_.back()->rigid;
    const double angular = mass->radius > 0 ? options_.sleep_speed / mass->radius : 1;
    made.setSleepingThresholds(static_cast<btScalar>(options_.sleep_speed),
                               static_cast<btScalar>(angular));
    world_.addRigidBody(&made, 0, 0);
    if (body.kind == BodyKind::moving && !options_.sleeps) {
        made.forceActivationState(DISABLE_DEACTIVATION);
    }
    if (body.kind == BodyKind::driven) made.forceActivationState(ISLAND_SLEEPING);
    return body_count() - 1;
}

Result<Done> BulletBodies::drive(std::uint32_t number, const Pose& world_from_model) {
    BulletBody& body = *bodies_[number];
    if (body.given.kind != BodyKind::driven) {
        return refused(body.given.name + ": only the pose of a driven body can be set.");
    }
    Result<Motion> motion = Motion::between(body.pose, world_from_model, body.mass.centre);
    if (!motion) return refused(body.given.name + ": " + motion.error().message);
    body.drive = *motion;
    const Motion::Parts& parts = motion->parts();
    const double rate = 1 / options_.step_s;
    body.rigid->setLinearVelocity(bullet(mesh::scaled(parts.shift, rate)));
    body.rigid->setAngularVelocity(bullet(mesh::scaled(parts.axis, parts.angle * rate)));
    body.rigid->forceActivationState(DISABLE_DEACTIVATION);  // wakes what it touches
    return Done{};
}

void BulletBodies::end_drives() {
    for (auto& body : bodies_) {
        if (!body->drive) continue;
        body->drive.reset();
        body->rigid->setLinearVelocity({0, 0, 0});
        body->rigid->setAngularVelocity({0, 0, 0});
        body->rigid->forceActivationState(ISLAND_SLEEPING);
    }
}

Result<Done> BulletBodies::step() {
    counts_ = {};
    impacts_.clear();
    const double substep_s = options_.step_s / options_.substeps;
    for (substep_ = 0; substep_ < options_.substeps; ++substep_) {
        world_.stepSimulation(static_cast<btScalar>(substep_s), 0);
        if (error_) return *std::exchange(error_, std::nullopt);
    }
    end_drives();
    ++frame_;
    contacts_ = manifolds_.listed();
    return Done{};
}

void BulletBodies::find_contacts() {
    if (error_) return;
    set_paces();
    if (Result<Done> stepped = scene_.step(); !stepped) {
        error_ = stepped.error();
        return;
    }
    counts_.pairs += scene_.counts().calls_of(Ask::contacts);
    manifolds_.begin();
    for (const SceneContacts& found : scene_.contacts()) {
        if (found.contacts.empty()) continue;
        counts_.contacts += found.contacts.size();
        counts_.incomplete += found.verdict.complete ? 0 : 1;
        manifolds_.set(*bodies_[found.a.slot], *bodies_[found.b.slot], {found.a.slot, found.b.slot},
                       found.contacts, counts_);
    }
    manifolds_.end();
}

/// Also counts the bodies that are too fast.
void BulletBodies::set_paces() {
    const double slow = slow_speed(options_);
    for (std::uint32_t i = 0; i < body_count(); ++i) {
        const BulletBody& body = *bodies_[i];
        if (body.given.kind == BodyKind::fixed || !body.rigid->isActive()) continue;
        const double speed = speed_bound(i);
        scene_.set_pace(i, speed <= slow ? Pace::slow : Pace::fast);
        const bool is_too_fast = speed > options_.most_speed && !body.given.is_continuous;
        counts_.too_fast += is_too_fast ? 1 : 0;
    }
}

/// Returns in how many parts a body turns by kPartTurn at most, each.
Result<std::uint32_t> BulletBodies::turn_parts(const BulletBody& body, const Double3& spin,
                                               double substep_s) const {
    const double turn =
        (most_spin(body.mass, body.state, spin) + mesh::length(body.push_turn)) * substep_s;
    if (turn <= kMostTurn) return static_cast<std::uint32_t>(std::max(turn / kPartTurn, 0.0)) + 1;
    return refused(body.given.name + ": may turn by " + text(turn) +
                   " radians in a substep, but impacts are only found up to " + text(kMostTurn) +
                   ". Use more substeps.");
}

/// Returns in how many steps moved_freely() computes one of some equal parts of a turn. Beyond
/// kMostSteps in all, the turn is less exact.
std::uint32_t BulletBodies::turn_steps(const BulletBody& body, const Double3& spin,
                                       double substep_s, std::uint32_t parts) {
    const double change = most_spin_change(body.mass, body.state, spin) * substep_s;
    const double steps = std::min(std::ceil(change / kMostSpinChange), kMostSteps) / parts;
    return steps > 1 ? static_cast<std::uint32_t>(std::ceil(steps)) : 1;
}

/// Adds the end of a free body. `way` gets its motions, unless it is null.
Result<Done> BulletBodies::fly(std::uint32_t number, double substep_s, std::vector<Motion>* way) {
    BulletBody& body = *bodies_[number];
    const btRigidBody& solved = *body.rigid;
    const Double3 linear = mesh::plus(doubles(solved.getLinearVelocity()), body.push);
    Double3 shift = mesh::scaled(linear, substep_s);
    // In free flight, the way is that of the mean of both velocities: a parabola.
    if (!body.touches) {
        shift = mesh::minus(shift, mesh::scaled(options_.gravity, substep_s * substep_s / 2));
    }
    // The solver adds to a rounded spin. Flips of a body depend on the digits that are rounded off.
    const Double3 added =
        mesh::minus(doubles(solved.getAngularVelocity()), doubles(bullet(body.spin)));
    FreeMotion motion{body.state, mesh::plus(body.spin, added)};
    std::uint32_t parts = 1;
    if (way != nullptr) {
        const Result<std::uint32_t> needed = turn_parts(body, motion.spin, substep_s);
        if (!needed) return needed.error();
        parts = *needed;
    }
    const std::uint32_t steps = turn_steps(body, motion.spin, substep_s, parts);
    const double share = 1.0 / parts / steps;
    Pose pose = body.pose;
    for (std::uint32_t part = 0; part < parts; ++part) {
        for (std::uint32_t step = 0; step < steps; ++step) {
            motion =
                moved_freely(body.mass, motion.state, mesh::scaled(shift, share), motion.spin,
                             mesh::scaled(body.push_turn, substep_s * share), substep_s * share);
        }
        const Result<Pose> next = pose_of(motion.state, body.mass.centre);
        if (!next) {
            return refused(body.given.name + ": the body moved too far. " + next.error().message);
        }
        if (Result<Done> added_to = add_motion(body, pose, *next, way); !added_to) return added_to;
        pose = *next;
    }
    body.spin = motion.spin;
    body.rigid->setAngularVelocity(bullet(motion.spin));
    ends_[number] = {motion.state, pose};
    return Done{};
}

/// Adds a motion of a body to its way, unless that is null.
Result<Done> BulletBodies::add_motion(const BulletBody& body, const Pose& start, const Pose& end,
                                      std::vector<Motion>* way) {
    if (way == nullptr) return Done{};
    const Result<Motion> motion = Motion::between(start, end, body.mass.centre);
    if (!motion) return refused(body.given.name + ": " + motion.error().message);
    way->push_back(*motion);
    return Done{};
}

/// Finds where bodies are at the end of a substep if nothing ends their ways.
Result<Done> BulletBodies::find_ends(double substep_s, std::vector<BodyWay>& ways) {
    const double time = static_cast<double>(substep_ + 1) / options_.substeps;
    ends_.assign(bodies_.size(), std::nullopt);
    for (std::uint32_t i = 0; i < body_count(); ++i) {
        BulletBody& body = *bodies_[i];
        std::vector<Motion>* const way = ways.empty() ? nullptr : &ways[i].motions;
        if (body.drive) {
            const Pose pose = body.drive->at(time);
            ends_[i] = {state_of(pose, body.mass.centre), pose};
            if (Result<Done> added = add_motion(body, body.pose, pose, way); !added) return added;
        } else if (body.given.kind == BodyKind::moving && body.rigid->isActive()) {
            if (Result<Done> flown = fly(i, substep_s, way); !flown) return flown;
            body.push = body.push_turn = {};
        } else if (way != nullptr) {
            way->push_back(Motion(body.pose));
        }
    }
    return Done{};
}

/// Returns a way without motions for each body, or none if no body is continuous.
std::vector<BodyWay> BulletBodies::empty_ways() const {
    std::vector<BodyWay> ways;
    if (!has_continuous_) return ways;
    for (const auto& body : bodies_) {
        const bool is_free = body->given.kind == BodyKind::moving;
        ways.push_back({.model = body->given.model,
                        .motions = {},
                        .centre = body->mass.centre,
                        .radius = body->mass.radius,
                        .is_continuous = is_free && body->given.is_continuous,
                        .is_free = is_free});
    }
    return ways;
}

/// Ends the ways of bodies at their impacts.
Result<Done> BulletBodies::find_impacts(std::span<const BodyWay> ways, double substep_s) {
    BodyWays moved(
        ways, [&](std::uint32_t a, std::uint32_t b) { return scene_.are_paired(a, b); },
        scene_.workspace(), kImpactTolerance * options_.rest_gap);
    if (Result<Done> found = moved.run(); !found) return found;
    const double before =
        static_cast<double>(frame_) * options_.step_s + static_cast<double>(substep_) * substep_s;
    for (const WayImpact& impact : moved.impacts()) {
        ++counts_.impacts;
        impacts_.push_back({impact.body, impact.other, before + impact.time * substep_s});
    }
    for (std::uint32_t i = 0; i < body_count(); ++i) {
        const std::optional<Pose> end = moved.changed_end(i);
        if (end) ends_[i] = {state_of(*end, bodies_[i]->mass.centre), *end};
    }
    return Done{};
}

void BulletBodies::move_bodies(double substep_s) {
    if (error_) return;
    for (auto& body : bodies_) body->touches = false;
    manifolds_.mark_touched();
    std::vector<BodyWay> ways = empty_ways();
    Result<Done> moved = find_ends(substep_s, ways);
    if (moved && has_continuous_) moved = find_impacts(ways, substep_s);
    if (!moved) {
        error_ = moved.error();
        return;
    }
    for (std::uint32_t i = 0; i < body_count(); ++i) {
        if (!ends_[i]) continue;
        bodies_[i]->place(ends_[i]->state, ends_[i]->pose);
        scene_.set_pose(i, ends_[i]->pose);
    }
    manifolds_.bounce();
}

double BulletBodies::kinetic_energy() const noexcept {
    double energy = 0;
    for (std::uint32_t i = 0; i < body_count(); ++i) {
        const BulletBody& body = *bodies_[i];
        if (body.given.kind != BodyKind::moving) continue;
        const btMatrix3x3& basis = body.rigid->getWorldTransform().getBasis();
        const Double3 w = doubles(body.rigid->getAngularVelocity() * basis);
        const Double3 v = velocity(i), m = body.mass.moments;
        energy += body.mass.mass * mesh::dot(v, v) / 2 +
                  (m.x * w.x * w.x + m.y * w.y * w.y + m.z * w.z * w.z) / 2;
    }
    return energy;
}

/// FNV-1a over the bits of the numbers.
std::uint64_t BulletBodies::state_hash() const noexcept {
    std::uint64_t hash = 0xcbf29ce484222325U;
    const auto add = [&](double number) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(number)) * 0x100000001b3U;
    };
    const auto add_point = [&](const Double3& p) {
        add(p.x);
        add(p.y);
        add(p.z);
    };
    for (std::uint32_t i = 0; i < body_count(); ++i) {
        for (const double entry : pose(i).rotation()) add(entry);
        add_point(pose(i).translation());
        add_point(velocity(i));
        add_point(angular_velocity(i));
    }
    return hash;
}

}  // namespace

bool has_dynamics() noexcept {
    return true;
}

Result<std::unique_ptr<RigidBodies>> make_rigid_bodies(const DynamicsOptions& options,
                                                       ParallelFor parallel_for) {
    if (std::string fault = fault_of(options); !fault.empty()) return refused(fault);
    return std::unique_ptr<RigidBodies>(std::make_unique<BulletBodies>(options, parallel_for));
}

}  // namespace cdprep::dynamics
