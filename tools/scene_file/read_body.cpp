// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/read_body.h"

#include "cdprep/contacts.h"

namespace cdprep::scenes {
namespace {

// As the dynamics allow.
constexpr std::uint32_t kMostSteps = 1'000'000;  ///< substeps, and iterations
constexpr double kLeastMass = 1e-30;
constexpr double kMostMass = 1e30;

void take_number(const JsonElement& parent, const char* key, Range range, double& number) {
    if (const auto member = parent.find(key)) number = member->number(range).value_or(number);
}

void take_number(const JsonElement& parent, const char* key, Range range,
                 std::optional<double>& number) {
    if (const auto member = parent.find(key)) number = member->number(range);
}

void take_whole(const JsonElement& parent, const char* key, std::uint32_t most,
                std::uint32_t& number) {
    if (const auto member = parent.find(key)) number = member->whole(1, most).value_or(number);
}

std::optional<Double3> find_vector(const JsonElement& parent, const char* key) {
    const auto member = parent.find(key);
    return member ? member->vector() : std::nullopt;
}

std::optional<double> read_mass(const JsonElement& element) {
    const std::optional<double> mass = element.number(Range::any);
    if (!mass || (*mass >= kLeastMass && *mass <= kMostMass)) return mass;
    element.refuse_value("a number from 1e-30 to 1e+30");
    return std::nullopt;
}

BodyMotion read_members(const JsonElement& element) {
    BodyMotion body;
    if (!element.is_object_of({"mass", "density", "linear_damping", "angular_damping", "velocity",
                               "turn_rad_per_s", "continuous"})) {
        return body;
    }
    if (const auto mass = element.find("mass")) body.mass = read_mass(*mass);
    take_number(element, "density", Range::above_zero, body.density);
    if (const auto density = element.find("density"); density && element.find("mass")) {
        density->refuse("a body has a mass or a density, not both.");
    }
    take_number(element, "linear_damping", Range::share, body.linear_damping);
    take_number(element, "angular_damping", Range::share, body.angular_damping);
    body.velocity = find_vector(element, "velocity").value_or(Double3{});
    body.turn = find_vector(element, "turn_rad_per_s").value_or(Double3{});
    if (const auto continuous = element.find("continuous")) {
        body.is_continuous = continuous->boolean().value_or(false);
    }
    return body;
}

}  // namespace

std::optional<BodyMotion> read_body(const JsonElement& motion) {
    if (motion.is_word("body")) return BodyMotion{};
    const auto body = motion.find("body");
    if (!body) return std::nullopt;
    for (const char* other : {"path", "velocity", "turn_rad_per_s", "deform", "tear"}) {
        if (const auto member = motion.find(other)) {
            member->refuse(
                "a body cannot have " + std::string(other) +
                ": it is rigid, and contacts and gravity move it. Its initial velocities "
                "belong in 'body'.");
        }
    }
    return read_members(*body);
}

Material read_material(const JsonElement& object) {
    Material material;
    const auto element = object.find("material");
    if (!element || !element->is_object_of({"friction", "restitution"})) return material;
    take_number(*element, "friction", Range::zero_or_more, material.friction);
    take_number(*element, "restitution", Range::share, material.restitution);
    return material;
}

Dynamics read_dynamics(const JsonElement& root) {
    Dynamics dynamics;
    dynamics.gravity = find_vector(root, "gravity");
    const auto element = root.find("dynamics");
    if (!element ||
        !element->is_object_of({"substeps", "iterations", "rest_gap", "most_speed", "tolerance",
                                "sleep_speed", "most_contacts", "sleeps"})) {
        return dynamics;
    }
    take_whole(*element, "substeps", kMostSteps, dynamics.substeps);
    take_whole(*element, "iterations", kMostSteps, dynamics.iterations);
    take_whole(*element, "most_contacts", kMostListedContacts, dynamics.most_contacts);
    take_number(*element, "rest_gap", Range::above_zero, dynamics.rest_gap);
    take_number(*element, "most_speed", Range::zero_or_more, dynamics.most_speed);
    take_number(*element, "tolerance", Range::above_zero, dynamics.tolerance);
    take_number(*element, "sleep_speed", Range::zero_or_more, dynamics.sleep_speed);
    if (const auto sleeps = element->find("sleeps")) {
        dynamics.sleeps = sleeps->boolean().value_or(true);
    }
    return dynamics;
}

}  // namespace cdprep::scenes
