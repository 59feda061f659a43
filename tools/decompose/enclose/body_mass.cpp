// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/body_mass.h"

#include <cmath>

#include "decompose/enclose/windings.h"
#include "mesh/mass_properties.h"

namespace cdprep::cli {
namespace {

/// Returns true if the mass is that of a solid. Simulators refuse an inertia that is not positive
/// definite.
bool is_of_solid(const write::BodyMass& body) {
    const auto& [xx, yy, zz, xy, yz, zx] = body.inertia;
    const double minor = xx * yy - xy * xy;
    const double determinant = minor * zz - xx * yz * yz - yy * zx * zx + 2 * xy * yz * zx;
    return body.mass > 0 && xx > 0 && minor > 0 && determinant > 0 && std::isfinite(determinant);
}

std::optional<write::BodyMass> mass_of(const mesh::Mesh& mesh, const WeighOptions& options) {
    if (!convex::has_known_volume(mesh)) return std::nullopt;
    const auto found = convex::find_mass_properties(mesh);
    if (!found) return std::nullopt;
    const double scale = options.metres_per_unit > 0 ? options.metres_per_unit : 1;
    // If the mesh is inside out, all signs change.
    const double per_volume = std::copysign(options.density, found->volume) * scale * scale * scale;
    write::BodyMass body;
    body.mass = per_volume * found->volume;
    const format::Double3& centre = found->centre;
    body.centre = {centre.x * scale, centre.y * scale, centre.z * scale};
    for (std::size_t i = 0; i < body.inertia.size(); ++i) {
        body.inertia[i] = per_volume * scale * scale * found->inertia[i];
    }
    if (!is_of_solid(body)) return std::nullopt;
    return body;
}

mesh::Mesh mesh_of(std::span<const convex::ConvexHull> parts) {
    mesh::Mesh all;
    for (const convex::ConvexHull& part : parts) {
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        all.positions.insert(all.positions.end(), part.points.begin(), part.points.end());
        for (const auto& [a, b, c] : part.facets) {
            all.triangles.push_back({{first + a, first + b, first + c}});
        }
    }
    return all;
}

}  // namespace

const char* word_of(MassOf of) noexcept {
    return of == MassOf::solid ? "solid" : of == MassOf::mesh ? "mesh" : "parts";
}

std::string text_of(MassOf of) {
    if (of == MassOf::solid) return "the solid";
    if (of == MassOf::parts) return "the parts; overlaps count twice";
    return "the mesh, which may meet itself; each region counts by its winding number, which may "
           "be "
           "negative";
}

std::optional<WeighedBody> weigh(const mesh::Mesh& mesh, std::span<const convex::ConvexHull> parts,
                                 const WeighOptions& options) {
    if (const auto body = options.is_balanced ? mass_of(mesh, options) : std::nullopt) {
        const convex::Windings windings = convex::find_windings(mesh, options.parallel_for);
        const bool is_simple = windings == convex::Windings::simple;
        if (windings != convex::Windings::opposed) {
            return WeighedBody{*body, is_simple ? MassOf::solid : MassOf::mesh};
        }
    }
    if (const auto body = mass_of(mesh_of(parts), options)) {
        return WeighedBody{*body, MassOf::parts};
    }
    return std::nullopt;
}

}  // namespace cdprep::cli
