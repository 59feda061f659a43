// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/dynamics/bullet_world.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "bullet_manifold.h"
#include "mesh/vectors.h"

namespace cdprep::dynamics {
namespace {

/// The way out of a contact may be so many times as long as the shortest one. It pushes no farther:
/// its normal leads along a surface.
constexpr double kLongWay = 4;
/// Bodies that slide slower keep their directions of friction. In gravity times a substep.
constexpr double kSlideSteps = 0.05;
/// A slower approach does not bounce: it would never end. In gravity times a substep.
constexpr double kBounceSteps = 4;
constexpr int kBounceSweeps = 8;

btVector3 velocity_at(const btRigidBody& body, const btVector3& p) {
    return body.getVelocityInLocalPoint(p - body.getCenterOfMassPosition());
}

btMatrix3x3 basis_of(const RigidState& state, const BodyMass& mass) {
    const auto [w, x, y, z] = state.turn;
    const auto r = Pose::from_quaternion(w, x, y, z, {0, 0, 0}).value().rotation();
    const auto& axes = mass.model_from_axes;
    btMatrix3x3 basis;
    for (std::size_t column = 0; column < 3; ++column) {
        const Double3 axis = rotated(r, {axes[column], axes[3 + column], axes[6 + column]});
        const int c = static_cast<int>(column);
        basis[0][c] = static_cast<btScalar>(axis.x);
        basis[1][c] = static_cast<btScalar>(axis.y);
        basis[2][c] = static_cast<btScalar>(axis.z);
    }
    return basis;
}

/// Sets two directions of friction across the normal: along the slide, else the last ones. Keeps
/// the last impulse, as far as it lies across the normal.
void set_friction_directions(btManifoldPoint& point, const btVector3& slide, double least_slide) {
    const btVector3 n = point.m_normalWorldOnB;
    const btVector3 impulse = point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                              point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
    btVector3 first = point.m_lateralFrictionDir1 - n * n.dot(point.m_lateralFrictionDir1);
    constexpr btScalar kUsable = btScalar(0.25);  // of a unit vector, squared
    if (double{slide.length()} > least_slide) {
        first = slide;
    } else if (first.length2() < kUsable) {
        btVector3 unused;
        btPlaneSpace1(n, first, unused);
    }
    point.m_lateralFrictionDir1 = first.normalized();
    point.m_lateralFrictionDir2 = n.cross(point.m_lateralFrictionDir1);
    point.m_appliedImpulseLateral1 = impulse.dot(point.m_lateralFrictionDir1);
    point.m_appliedImpulseLateral2 = impulse.dot(point.m_lateralFrictionDir2);
    point.m_contactPointFlags |= BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
}

double gravity_of(const BulletBody& body, const Double3& gravity, const Double3& along) {
    return body.given.kind == BodyKind::moving ? mesh::dot(gravity, along) : 0;
}

/// Applies an impulse so that the point leaves with its speed. The total never pulls.
void rebound(Bounce& bounce) {
    btManifoldPoint& p = *bounce.point;
    // The bodies have moved since the contact was found.
    const btVector3 n = p.m_normalWorldOnB;
    const btVector3 on_a = bounce.a->getCenterOfMassPosition() + bounce.arm_a;
    const btVector3 on_b = bounce.b->getCenterOfMassPosition() + bounce.arm_b;
    const btScalar speed = n.dot(velocity_at(*bounce.a, on_a) - velocity_at(*bounce.b, on_b));
    const btScalar denominator =
        bounce.a->computeImpulseDenominator(on_a, n) + bounce.b->computeImpulseDenominator(on_b, n);
    if (!(denominator > 0)) return;
    const btScalar wanted = (static_cast<btScalar>(bounce.speed) - speed) / denominator;
    const btScalar total = std::max(p.m_appliedImpulse + wanted, btScalar(0));
    const btVector3 impulse = n * (total - p.m_appliedImpulse);
    p.m_appliedImpulse = total;
    bounce.a->applyImpulse(impulse, bounce.arm_a);
    bounce.b->applyImpulse(-impulse, bounce.arm_b);
}

}  // namespace

BulletBody::BulletBody(const RigidBody& description, const BodyMass& its_mass)
    : given(description),
      mass(its_mass),
      state(state_of(given.world_from_model, mass.centre)),
      pose(given.world_from_model),
      shape(std::make_unique<btSphereShape>(static_cast<btScalar>(mass.radius))) {
    const bool moves = given.kind == BodyKind::moving;
    btRigidBody::btRigidBodyConstructionInfo info(
        moves ? static_cast<btScalar>(mass.mass) : btScalar(0), nullptr, shape.get(),
        moves ? bullet(mass.moments) : btVector3(0, 0, 0));
    info.m_linearDamping = static_cast<btScalar>(given.linear_damping);
    info.m_angularDamping = static_cast<btScalar>(given.angular_damping);
    rigid = std::make_unique<btRigidBody>(info);
    rigid->setFlags(0);  // moved_freely() turns bodies about their axes; Bullet's way loses energy
    rigid->setUserPointer(this);
    if (given.kind == BodyKind::driven) {
        rigid->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    }
    if (moves) {
        rigid->setLinearVelocity(bullet(given.velocity));
        rigid->setAngularVelocity(bullet(given.angular_velocity));
        spin = given.angular_velocity;
    }
    place(state, pose);
}

void BulletBody::place(const RigidState& next, const Pose& next_pose) {
    state = next;
    pose = next_pose;
    rigid->setCenterOfMassTransform(btTransform(basis_of(state, mass), bullet(state.centre)));
}

/// Friction begins each substep with no impulse in Bullet 3.24; contacts begin with the last one.
/// Without the friction that belongs to them, bodies at rest creep.
void ImpulseSolver::start_friction(const btSolverConstraint& contact, int friction,
                                   btScalar impulse) {
    if (friction >= m_tmpSolverContactFrictionConstraintPool.size()) return;
    btSolverConstraint& row = m_tmpSolverContactFrictionConstraintPool[friction];
    if (btScalar(row.m_appliedImpulse) != 0) return;
    btSolverBody& a = m_tmpSolverBodyPool[contact.m_solverBodyIdA];
    btSolverBody& b = m_tmpSolverBodyPool[contact.m_solverBodyIdB];
    row.m_appliedImpulse = impulse;
    if (a.m_originalBody != nullptr) {
        a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(),
                               row.m_angularComponentA, impulse);
    }
    if (b.m_originalBody != nullptr) {
        b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(),
                               row.m_angularComponentB, impulse);
    }
}

void ImpulseSolver::convertContacts(btPersistentManifold** manifolds, int count,
                                    const btContactSolverInfo& info) {
    btSequentialImpulseConstraintSolver::convertContacts(manifolds, count, info);
    for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); ++i) {
        const btSolverConstraint& contact = m_tmpSolverContactConstraintPool[i];
        const auto& point = *static_cast<btManifoldPoint*>(contact.m_originalContactPoint);
        const btScalar factor = info.m_warmstartingFactor;
        start_friction(contact, contact.m_frictionIndex, factor * point.m_appliedImpulseLateral1);
        start_friction(contact, contact.m_frictionIndex + 1,
                       factor * point.m_appliedImpulseLateral2);
    }
}

btScalar ImpulseSolver::solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int count,
                                                      const btContactSolverInfo& info) {
    for (int i = 0; i < m_tmpSolverBodyPool.size(); ++i) {
        const btSolverBody& solved = m_tmpSolverBodyPool[i];
        if (solved.m_originalBody == nullptr) continue;
        BulletBody& body = body_of(*solved.m_originalBody);
        body.push = doubles(solved.getPushVelocity());
        body.push_turn =
            mesh::scaled(doubles(solved.getTurnVelocity()), double{info.m_splitImpulseTurnErp});
    }
    return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyFinish(bodies, count, info);
}

/// Bodies with a common manifold are of one island.
void ImpulseWorld::calculateSimulationIslands() {
    btSimulationIslandManager& islands = *getSimulationIslandManager();
    islands.updateActivationState(this, getDispatcher());
    for (int i = 0; i < getDispatcher()->getNumManifolds(); ++i) {
        const btPersistentManifold& manifold = *getDispatcher()->getManifoldByIndexInternal(i);
        const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
        if (manifold.getNumContacts() == 0) continue;
        if (a.isStaticOrKinematicObject() || b.isStaticOrKinematicObject()) continue;
        islands.getUnionFind().unite(a.getIslandTag(), b.getIslandTag());
    }
    islands.storeIslandActivationState(this);
}

Manifolds::~Manifolds() {
    for (auto& [pair, kept] : pairs_) release(kept.manifolds);
}

void Manifolds::release(btManifoldArray& manifolds) {
    for (int m = 0; m < manifolds.size(); ++m) dispatcher_.releaseManifold(manifolds[m]);
    manifolds.clear();
}

void Manifolds::begin() {
    bounces_.clear();
    for (auto& [pair, kept] : pairs_) kept.is_listed = false;
}

void Manifolds::end() {
    for (auto next = pairs_.begin(); next != pairs_.end();) {
        const auto at = next++;
        if (at->second.is_listed) continue;
        release(at->second.manifolds);
        pairs_.erase(at);
    }
}

Contact Manifolds::adapted(const Contact& contact, DynamicsCounts& counts) const {
    Contact made = contact;
    double deepest = made.lower;
    if (made.flags & contact_deep) {
        ++counts.deep;
    } else if (-made.lower > kLongWay * std::max(-made.upper, options_.rest_gap)) {
        deepest = -kLongWay * std::max(-made.upper, options_.rest_gap);
        ++counts.shortened;
    }
    if (made.point_count == 0) {
        made.points[made.point_count++] = {made.point_a, made.point_b, made.lower, 0};
    }
    for (ManifoldPoint& point : std::span(made.points).first(made.point_count)) {
        point.distance = std::max(point.distance, std::min(deepest, 0.0)) - options_.rest_gap;
    }
    return made;
}

void Manifolds::prepare(btManifoldPoint& point, BulletBody& a, BulletBody& b) {
    point.m_combinedFriction =
        static_cast<btScalar>(std::sqrt(a.given.friction * b.given.friction));
    point.m_combinedRestitution = 0;  // a point that is early would end the approach: see bounce()
    const btVector3 velocity = velocity_at(*a.rigid, point.m_positionWorldOnA) -
                               velocity_at(*b.rigid, point.m_positionWorldOnB);
    const btVector3 n = point.m_normalWorldOnB;
    const double approach = -double{n.dot(velocity)};
    const double fall = std::sqrt(mesh::dot(options_.gravity, options_.gravity)) * options_.step_s /
                        options_.substeps;
    set_friction_directions(point, velocity - n * n.dot(velocity), kSlideSteps * fall);
    const double restitution = std::max(a.given.restitution, b.given.restitution);
    if (restitution <= 0 || approach <= kBounceSteps * fall) return;
    // What gravity adds until the surfaces meet.
    const double gained =
        gravity_of(b, options_.gravity, doubles(n)) - gravity_of(a, options_.gravity, doubles(n));
    const double gap = std::max(double{point.m_distance1}, 0.0);
    const double speed = std::sqrt(std::max(approach * approach + 2 * gained * gap, 0.0));
    bounces_.push_back({&point, a.rigid.get(), b.rigid.get(),
                        point.m_positionWorldOnA - a.rigid->getCenterOfMassPosition(),
                        point.m_positionWorldOnB - b.rigid->getCenterOfMassPosition(),
                        restitution * speed});
}

void Manifolds::set(BulletBody& a, BulletBody& b, std::pair<std::uint32_t, std::uint32_t> pair,
                    std::span<const Contact> contacts, DynamicsCounts& counts) {
    PairManifolds& kept = pairs_[pair];
    kept.is_listed = true;
    adapted_.clear();
    for (const Contact& contact : contacts) adapted_.push_back(adapted(contact, counts));
    set_manifolds(adapted_, *a.rigid, *b.rigid, dispatcher_, kept.manifolds);
    for (int m = 0; m < kept.manifolds.size(); ++m) {
        btPersistentManifold& manifold = *kept.manifolds[m];
        for (int p = 0; p < manifold.getNumContacts(); ++p) {
            prepare(manifold.getContactPoint(p), a, b);
        }
    }
}

template <class Visit>
void Manifolds::visit_points(const Visit& visit) const {
    for (const auto& [pair, kept] : pairs_) {
        for (int m = 0; m < kept.manifolds.size(); ++m) {
            const btPersistentManifold& manifold = *kept.manifolds[m];
            for (int p = 0; p < manifold.getNumContacts(); ++p) {
                visit(pair, manifold, manifold.getContactPoint(p));
            }
        }
    }
}

void Manifolds::mark_touched() const {
    visit_points(
        [](const auto&, const btPersistentManifold& manifold, const btManifoldPoint& point) {
            if (!(point.m_appliedImpulse > 0)) return;
            body_of(*manifold.getBody0()).touches = true;
            body_of(*manifold.getBody1()).touches = true;
        });
}

/// Bullet ends the approach of a point that is early: the solver leaves only gap / substep of its
/// speed. If it took restitution from that, little would be left to bounce with in the next
/// substep. So a point bounces when the solver has brought it to the surface. It has the speed that
/// it had before (as in Box2D 3).
void Manifolds::bounce() {
    std::erase_if(bounces_, [](const Bounce& b) { return !(b.point->m_appliedImpulse > 0); });
    for (int sweep = 0; sweep < kBounceSweeps; ++sweep) {
        for (Bounce& next : bounces_) rebound(next);
    }
    // The impulse of an impact is no guess for the next substep.
    for (Bounce& done : bounces_) {
        done.impulse = double{done.point->m_appliedImpulse};
        done.point->m_appliedImpulse = 0;
        done.point->m_appliedImpulseLateral1 = done.point->m_appliedImpulseLateral2 = 0;
    }
}

std::vector<BodyContact> Manifolds::listed() const {
    std::map<const btManifoldPoint*, double> bounced;
    for (const Bounce& bounce : bounces_) bounced.emplace(bounce.point, bounce.impulse);
    const auto impulse_of = [&](const btManifoldPoint& point) {
        const auto at = bounced.find(&point);
        return at != bounced.end() ? at->second : double{point.m_appliedImpulse};
    };
    std::vector<BodyContact> list;
    visit_points([&](const auto& pair, const btPersistentManifold&, const btManifoldPoint& point) {
        list.push_back({pair.first, pair.second, doubles(point.m_positionWorldOnB),
                        doubles(-point.m_normalWorldOnB),
                        double{point.m_distance1} + options_.rest_gap, impulse_of(point)});
    });
    return list;
}

}  // namespace cdprep::dynamics
