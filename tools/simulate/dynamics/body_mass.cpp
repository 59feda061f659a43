// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/dynamics/body_mass.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/vectors.h"
#include "text/number_text.h"

namespace cdprep::dynamics {
namespace {

struct Box {
    Double3 lower;
    Double3 upper;
};

std::optional<Box> box_of(const Model& model) {
    if (const format::Bounds* bounds = model.record().bounds)
        return Box{bounds->lower, bounds->upper};
    std::optional<Box> box;
    const auto add = [&](const Double3& p) {
        if (!box) box = Box{p, p};
        box->lower = {std::min(box->lower.x, p.x), std::min(box->lower.y, p.y),
                      std::min(box->lower.z, p.z)};
        box->upper = {std::max(box->upper.x, p.x), std::max(box->upper.y, p.y),
                      std::max(box->upper.z, p.z)};
    };
    for (const Double3& p : model.mesh().positions_f64) add(p);
    for (const format::Float3& p : model.mesh().positions_f32) add({p.x, p.y, p.z});
    return box;
}

double radius_about(const Double3& centre, const Box& box) {
    const Double3 far = {std::max(centre.x - box.lower.x, box.upper.x - centre.x),
                         std::max(centre.y - box.lower.y, box.upper.y - centre.y),
                         std::max(centre.z - box.lower.z, box.upper.z - centre.z)};
    return std::sqrt(mesh::dot(far, far));
}

/// The holes of the model, or 0 if the file does not tell.
std::uint32_t boundary_loops(const Model& model) {
    const auto verdicts = model.record().verdicts;
    return verdicts.empty() ? 0 : verdicts.front().boundary_loops;
}

Error no_mass(const RigidBody& body) {
    const std::string begin = body.name + ": response needs mass, and the ";
    const std::uint32_t loops = boundary_loops(*body.model);
    if (body.model->is_balanced() && loops == 0) {
        return {ErrorCode::bad_argument,
                begin +
                    "file has no mass properties. Bake it again with --effects response, or give "
                    "a mass in the scene."};
    }
    const std::string holes =
        " (" + std::to_string(loops) + " boundary loop" + (loops == 1 ? "" : "s") + ")";
    return {ErrorCode::bad_argument,
            begin + "mesh is unbalanced" + (loops == 0 ? "" : holes) +
                ". Give a mass in the scene, or repair the mesh (bake --repair closed)."};
}

/// A solid box.
BodyMass mass_of_box(const Box& box, double mass) {
    const Double3 d = mesh::minus(box.upper, box.lower);
    // A flat model still resists turns about every axis.
    const double least = 1e-3 * (d.x * d.x + d.y * d.y + d.z * d.z);
    const double x = std::max(d.x * d.x, least), y = std::max(d.y * d.y, least),
                 z = std::max(d.z * d.z, least);
    BodyMass made;
    made.mass = mass;
    made.is_box = true;
    made.centre = mesh::middle_of(box.lower, box.upper);
    made.moments = {mass / 12 * (y + z), mass / 12 * (z + x), mass / 12 * (x + y)};
    return made;
}

BodyMass mass_of_solid(const format::MassProperties& solid, double mass) {
    BodyMass made;
    made.mass = mass;
    made.centre = solid.centre;
    std::array<double, 6> tensor = solid.inertia;
    for (double& entry : tensor) entry *= mass / solid.volume;
    const PrincipalAxes found = principal_axes(tensor);
    made.model_from_axes = found.axes;
    made.moments = found.moments;
    return made;
}

// Bullet's numbers are floats, and so are the inverses of masses and moments.
constexpr double kLeastMass = 1e-30;
constexpr double kMostMass = 1e30;
constexpr double kLeastMoment = 1e-37;
constexpr double kMostMoment = 1e37;

bool has_usable_moments(const BodyMass& mass) {
    const Double3& m = mass.moments;
    return std::ranges::all_of(std::array{m.x, m.y, m.z}, [](double moment) {
        return moment >= kLeastMoment && moment <= kMostMoment;
    });
}

Error refused(const RigidBody& body, const std::string& why) {
    return {ErrorCode::bad_argument, body.name + ": " + why};
}

/// Turns rows and columns p and q of a symmetric matrix so that its entry (p, q) vanishes.
void rotate_away(std::array<double, 9>& m, std::array<double, 9>& axes, std::size_t p,
                 std::size_t q) {
    const double theta = (m[4 * q] - m[4 * p]) / (2 * m[3 * p + q]);
    const double t = std::copysign(1, theta) / (std::fabs(theta) + std::hypot(theta, 1));
    const double c = 1 / std::hypot(t, 1), s = t * c;
    for (std::size_t i = 0; i < 3; ++i) {
        const double ip = m[3 * i + p], iq = m[3 * i + q];
        m[3 * i + p] = c * ip - s * iq;
        m[3 * i + q] = s * ip + c * iq;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const double pi = m[3 * p + i], qi = m[3 * q + i];
        m[3 * p + i] = c * pi - s * qi;
        m[3 * q + i] = s * pi + c * qi;
        const double ap = axes[3 * i + p], aq = axes[3 * i + q];
        axes[3 * i + p] = c * ap - s * aq;
        axes[3 * i + q] = s * ap + c * aq;
    }
}

}  // namespace

PrincipalAxes principal_axes(const std::array<double, 6>& tensor) noexcept {
    const auto [xx, yy, zz, xy, yz, zx] = tensor;
    std::array<double, 9> m = {xx, xy, zx, xy, yy, yz, zx, yz, zz};
    PrincipalAxes found{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {}};
    constexpr int kSweeps = 20;  // 3 x 3 converges in six or so
    constexpr double kNegligible = 1e-15;
    const double small = kNegligible * (std::fabs(xx) + std::fabs(yy) + std::fabs(zz));
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (const auto& [p, q] : {std::array<std::size_t, 2>{0, 1}, {0, 2}, {1, 2}}) {
            if (std::fabs(m[3 * p + q]) > small) rotate_away(m, found.axes, p, q);
        }
    }
    found.moments = {m[0], m[4], m[8]};
    return found;
}

Result<BodyMass> mass_of(const RigidBody& body) {
    const std::optional<Box> box = box_of(*body.model);
    if (!box) return refused(body, "the model has no triangles.");
    BodyMass made;
    made.centre = mesh::middle_of(box->lower, box->upper);
    if (body.kind == BodyKind::moving) {
        const format::MassProperties* solid = body.model->record().mass;
        if (solid == nullptr && !body.mass) return no_mass(body);
        const double mass =
            body.mass.value_or(solid != nullptr ? body.density * std::fabs(solid->volume) : 0);
        if (!(mass >= kLeastMass && mass <= kMostMass)) {
            return refused(body, "the mass is " + report::number_text(mass) + ", but it must be " +
                                     report::number_text(kLeastMass) + " to " +
                                     report::number_text(kMostMass) + ".");
        }
        made = solid != nullptr ? mass_of_solid(*solid, mass) : mass_of_box(*box, mass);
        // Components of opposite windings may add up to no solid.
        if (!has_usable_moments(made) && body.mass) made = mass_of_box(*box, mass);
        if (!has_usable_moments(made)) {
            return refused(body,
                           "the moments of inertia are not usable: they are not those of a solid. "
                           "Give a mass in the scene, or repair the mesh.");
        }
    }
    made.radius = radius_about(made.centre, *box);
    return made;
}

}  // namespace cdprep::dynamics
