// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/colliders_json.h"

#include "mesh/mass_properties.h"
#include "mesh/vectors.h"
#include "text/json_layout.h"

namespace cdprep::report {
namespace {

using convex::ConvexHull;
using format::Double3;
using Json = nlohmann::ordered_json;

/// Sums signed tetrahedra around a corner: no cancellation, since the hull is convex.
double volume_of(const ConvexHull& hull) {
    const Double3& top = hull.points.front();
    double sum = 0;
    for (const auto& [a, b, c] : hull.facets) {
        const Double3 u = mesh::minus(hull.points[a], top);
        const Double3 v = mesh::minus(hull.points[b], top);
        const Double3 w = mesh::minus(hull.points[c], top);
        sum += mesh::dot(u, mesh::cross(v, w));
    }
    return sum / 6;
}

Json part_json(const NamedHull& part) {
    const ConvexHull& hull = *part.hull;
    Json points = Json::array();
    for (const Double3& p : hull.points) {
        for (const double value : {p.x, p.y, p.z}) points.push_back(value);
    }
    Json triangles = Json::array();
    for (const auto& facet : hull.facets) {
        for (const std::uint32_t point : facet) triangles.push_back(point);
    }
    return {{"name", part.name},
            {"points", std::move(points)},
            {"triangles", std::move(triangles)},
            {"volume", volume_of(hull)}};
}

Json mass_json(const Colliders& colliders) {
    if (!colliders.mass) return nullptr;
    const auto& [mass, centre, inertia] = *colliders.mass;
    const auto& [xx, yy, zz, xy, yz, zx] = inertia;
    const auto [moments, axes] = convex::principal_inertia(inertia);
    return {{"volume", mass},
            {"centre", position_json(centre)},
            {"inertia", {{xx, xy, zx}, {xy, yy, yz}, {zx, yz, zz}}},
            {"moments", moments},
            {"axes", axes},
            {"of_solid", colliders.is_of_solid}};
}

}  // namespace

std::string colliders_json(const Colliders& colliders) {
    const auto member = [](const char* name, const Json& value) {
        return "\"" + std::string(name) + "\": " + compact(value) + ",\n";
    };
    std::string text = "{" + member("format", "cdprep colliders") + member("version", 1) +
                       member("name", colliders.name);
    text += member("metres_per_unit",
                   colliders.metres_per_unit > 0 ? Json(colliders.metres_per_unit) : Json(nullptr));
    text += member("mass", mass_json(colliders)) + "\"parts\": [";
    const char* separator = "\n ";
    for (const NamedHull& part : colliders.parts) {
        text += separator + compact(part_json(part));
        separator = ",\n ";
    }
    return text + "],\n\"error\": " + compact(colliders.error) + "}\n";
}

}  // namespace cdprep::report
