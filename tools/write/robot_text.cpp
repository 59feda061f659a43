// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <pugixml.hpp>
#include <sstream>

#include "write/hulls_text.h"
#include "write/mesh_bytes.h"

namespace cdprep::write {
namespace {

using format::Double3;
using pugi::xml_node;

std::string number_text(double value) {
    std::string text;
    append_number(text, value);
    return text;
}

std::string point_text(const Double3& p) {
    std::string text;
    append_point_text(text, p);
    return text;
}

xml_node add(xml_node parent, const char* element) {
    return parent.append_child(element);
}

void set(xml_node element, const char* attribute, const std::string& value) {
    element.append_attribute(attribute).set_value(value.c_str());
}

xml_node add_named(xml_node parent, const char* element, const std::string& name) {
    const xml_node node = add(parent, element);
    set(node, "name", name);
    return node;
}

void add_text(xml_node parent, const char* element, const std::string& text) {
    add(parent, element).text().set(text.c_str());
}

std::string written(const pugi::xml_document& document) {
    std::ostringstream text;
    document.save(text, "  ");
    return text.str();
}

/// The name of an inertia element in URDF and SDF, and its place in BodyMass.
struct InertiaName {
    const char* name;
    std::size_t place;
};
constexpr std::array<InertiaName, 6> kInertiaNames = {
    {{"ixx", 0}, {"ixy", 3}, {"ixz", 5}, {"iyy", 1}, {"iyz", 4}, {"izz", 2}}};

void add_urdf_origin(xml_node parent, const Double3& place) {
    const xml_node origin = add(parent, "origin");
    set(origin, "xyz", point_text(place));
    set(origin, "rpy", "0 0 0");
}

void add_urdf_inertial(xml_node link, const BodyMass& body) {
    const xml_node inertial = add(link, "inertial");
    add_urdf_origin(inertial, body.centre);
    set(add(inertial, "mass"), "value", number_text(body.mass));
    const xml_node inertia = add(inertial, "inertia");
    for (const auto& [name, place] : kInertiaNames) {
        set(inertia, name, number_text(body.inertia[place]));
    }
}

void add_urdf_shape(xml_node link, const RobotFile& file, const char* kind,
                    const std::string& name) {
    const xml_node shape = add_named(link, kind, name);
    add_urdf_origin(shape, {});
    const xml_node mesh = add(add(shape, "geometry"), "mesh");
    const std::string& package = file.options.package;
    set(mesh, "filename",
        (package.empty() ? "" : "package://" + package + "/") + mesh_name(file, name));
    set(mesh, "scale", file.scale);
}

void add_sdf_inertial(xml_node link, const BodyMass& body) {
    const xml_node inertial = add(link, "inertial");
    add_text(inertial, "pose", point_text(body.centre) + " 0 0 0");
    add_text(inertial, "mass", number_text(body.mass));
    const xml_node inertia = add(inertial, "inertia");
    for (const auto& [name, place] : kInertiaNames) {
        add_text(inertia, name, number_text(body.inertia[place]));
    }
}

void add_sdf_shape(xml_node link, const RobotFile& file, const char* kind,
                   const std::string& name) {
    const xml_node mesh = add(add(add_named(link, kind, name), "geometry"), "mesh");
    add_text(mesh, "uri", mesh_name(file, name));
    add_text(mesh, "scale", file.scale);
}

void add_mjcf_inertial(xml_node body_element, const BodyMass& body) {
    constexpr std::array<std::size_t, 6> kPlaces = {0, 1, 2, 3, 5, 4};  // xx yy zz xy xz yz
    std::string inertia;
    for (const std::size_t place : kPlaces) {
        if (!inertia.empty()) inertia += ' ';
        append_number(inertia, body.inertia[place]);
    }
    const xml_node inertial = add(body_element, "inertial");
    set(inertial, "pos", point_text(body.centre));
    set(inertial, "mass", number_text(body.mass));
    set(inertial, "fullinertia", inertia);
}

std::string mjcf_visual(const RobotFile& file) {
    return file.name + "_" + kVisual;
}

void add_mjcf_visual_mesh(xml_node asset, const RobotFile& file) {
    const xml_node mesh = add_named(asset, "mesh", mjcf_visual(file));
    set(mesh, "file", mesh_name(file, kVisual));
    set(mesh, "scale", file.scale);
}

/// Adds a geom that collides with nothing and has no mass.
void add_mjcf_visual_geom(xml_node body, const RobotFile& file) {
    const xml_node geom = add_named(body, "geom", mjcf_visual(file));
    set(geom, "type", "mesh");
    set(geom, "mesh", mjcf_visual(file));
    set(geom, "contype", "0");
    set(geom, "conaffinity", "0");
    set(geom, "group", "2");
    set(geom, "mass", "0");
}

std::string vertices_text(const HullArrays& hull) {
    std::string text;
    for (const Double3& p : hull.points) {
        if (!text.empty()) text += "  ";
        append_point_text(text, p);
    }
    return text;
}

}  // namespace

std::string urdf_text(const RobotFile& file) {
    pugi::xml_document document;
    const xml_node link = add_named(add_named(document, "robot", file.name), "link", file.name);
    if (file.options.mass) add_urdf_inertial(link, *file.options.mass);
    if (file.options.visual) add_urdf_shape(link, file, "visual", kVisual);
    for (const HullArrays& hull : file.hulls) add_urdf_shape(link, file, "collision", hull.name);
    return written(document);
}

std::string sdf_text(const RobotFile& file) {
    pugi::xml_document document;
    const xml_node sdf = add(document, "sdf");
    set(sdf, "version", "1.7");
    const xml_node link = add_named(add_named(sdf, "model", file.name), "link", file.name);
    if (file.options.mass) add_sdf_inertial(link, *file.options.mass);
    if (file.options.visual) add_sdf_shape(link, file, "visual", kVisual);
    for (const HullArrays& hull : file.hulls) add_sdf_shape(link, file, "collision", hull.name);
    return written(document);
}

/// Returns an MJCF file that contains the vertices themselves; MuJoCo computes their hull. A shown
/// mesh is a geom of group 2, and the hulls are of group 3, which viewers hide at first.
std::string mjcf_text(const RobotFile& file) {
    pugi::xml_document document;
    const xml_node mujoco = add(document, "mujoco");
    set(mujoco, "model", file.name);
    const xml_node asset = add(mujoco, "asset");
    const bool has_visual = file.options.visual.has_value();
    if (has_visual) add_mjcf_visual_mesh(asset, file);
    for (const HullArrays& hull : file.hulls) {
        const xml_node mesh = add_named(asset, "mesh", hull.name);
        set(mesh, "scale", file.scale);
        set(mesh, "vertex", vertices_text(hull));
    }
    const xml_node body = add_named(add(mujoco, "worldbody"), "body", file.name);
    if (file.options.is_floating) add(body, "freejoint");
    if (file.options.mass) add_mjcf_inertial(body, *file.options.mass);
    if (has_visual) add_mjcf_visual_geom(body, file);
    for (const HullArrays& hull : file.hulls) {
        const xml_node geom = add_named(body, "geom", hull.name);
        set(geom, "type", "mesh");
        set(geom, "mesh", hull.name);
        if (has_visual) set(geom, "group", "3");
    }
    return written(document);
}

}  // namespace cdprep::write
