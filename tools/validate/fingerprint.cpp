// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/fingerprint.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "cdprep/format/checksum.h"
#include "mesh/component_numbers.h"
#include "mesh/weld.h"

namespace cdprep::report {
namespace {

constexpr std::size_t kDigits = 16;
constexpr int kHexadecimal = 16;

using Point = std::array<std::uint64_t, 3>;

/// Returns one bit pattern per value: both zeros share one, and so do all NaNs.
std::uint64_t bits_of(double coordinate) {
    if (coordinate == 0) return 0;
    if (std::isnan(coordinate)) coordinate = std::numeric_limits<double>::quiet_NaN();
    return std::bit_cast<std::uint64_t>(coordinate);
}

/// Returns the position of a vertex; an out-of-range number represents itself.
Point point_of(const mesh::TriangleSoup& soup, std::uint32_t vertex) {
    if (vertex >= soup.positions.size()) return {vertex, ~std::uint64_t{0}, 0};
    const mesh::Double3& p = soup.positions[vertex];
    return {bits_of(p.x), bits_of(p.y), bits_of(p.z)};
}

std::array<Point, 3> corners_of(const mesh::TriangleSoup& soup, std::uint32_t triangle) {
    const mesh::Triangle& t = soup.triangles[triangle];
    std::array<Point, 3> corners = {point_of(soup, t.vertex[0]), point_of(soup, t.vertex[1]),
                                    point_of(soup, t.vertex[2])};
    std::sort(corners.begin(), corners.end());
    return corners;
}

std::array<double, 3> coordinates(const mesh::Double3& p) {
    return {p.x, p.y, p.z};
}

/// Returns the soup with vertices that are not finite moved to the origin, as welding requires.
mesh::TriangleSoup finite_part(const mesh::TriangleSoup& soup) {
    mesh::TriangleSoup part;
    part.positions = soup.positions;
    part.triangles = soup.triangles;
    for (mesh::Double3& p : part.positions) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) p = {0, 0, 0};
    }
    return part;
}

bool is_about_components(mesh::Rule rule) {
    switch (rule) {
        case mesh::Rule::non_orientable:
        case mesh::Rule::inverted_component:
        case mesh::Rule::nested_component:
        case mesh::Rule::overlapping_components:
        case mesh::Rule::several_components:
            return true;
        default:
            return false;
    }
}

void append(std::vector<std::uint64_t>& words, const Point& point) {
    words.insert(words.end(), point.begin(), point.end());
}

}  // namespace

void Fingerprints::find_components() {
    const mesh::Mesh mesh = mesh::weld(finite_part(soup_)).mesh;
    const mesh::ComponentNumbers numbers = mesh::number_components(mesh);
    const auto precedes = [&](std::uint32_t a, std::uint32_t b) {
        return coordinates(mesh.positions[a]) < coordinates(mesh.positions[b]);
    };
    constexpr std::uint32_t kNone = 0xffffffff;
    std::vector<std::uint32_t> least(numbers.count, kNone);
    for (std::uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        std::uint32_t& best = least[numbers.of_vertex[vertex]];
        if (best == kNone || precedes(vertex, best)) best = vertex;
    }
    least_vertex_.reserve(mesh.triangles.size());
    for (const mesh::Triangle& triangle : mesh.triangles) {
        const std::uint32_t component = numbers.of_vertex[triangle.vertex[0]];
        least_vertex_.push_back(mesh.source_vertex[least[component]]);
    }
}

std::uint64_t Fingerprints::of(mesh::Rule rule, const mesh::Place& place) {
    const bool is_of_components = is_about_components(rule);
    if (is_of_components && least_vertex_.empty()) find_components();
    std::vector<std::array<Point, 3>> triangles;
    std::vector<Point> vertices;
    if (is_of_components) {
        for (const std::uint32_t triangle : place.triangles) {
            vertices.push_back(point_of(soup_, least_vertex_[triangle]));
        }
    } else if (!place.vertices.empty()) {
        for (const std::uint32_t vertex : place.vertices) {
            vertices.push_back(point_of(soup_, vertex));
        }
    } else {
        for (const std::uint32_t triangle : place.triangles) {
            triangles.push_back(corners_of(soup_, triangle));
        }
    }
    std::sort(triangles.begin(), triangles.end());
    std::sort(vertices.begin(), vertices.end());
    // A walk along a hole that touches itself passes some vertex twice. Its start determines
    // which.
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<std::uint64_t> words = {static_cast<std::uint64_t>(rule), triangles.size()};
    for (const auto& corners : triangles) {
        for (const Point& corner : corners) append(words, corner);
    }
    for (const Point& vertex : vertices) append(words, vertex);
    return format::checksum(std::as_bytes(std::span(words)));
}

std::string fingerprint_text(std::uint64_t fingerprint) {
    std::array<char, kDigits> digits{};
    const auto end =
        std::to_chars(digits.data(), digits.data() + kDigits, fingerprint, kHexadecimal).ptr;
    const std::string text(digits.data(), end);
    return std::string(kDigits - text.size(), '0') + text;
}

std::optional<std::uint64_t> parse_fingerprint(std::string_view text) noexcept {
    std::uint64_t fingerprint = 0;
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), fingerprint, kHexadecimal);
    const bool is_whole = error == std::errc{} && end == text.data() + text.size();
    return text.size() == kDigits && is_whole ? std::optional(fingerprint) : std::nullopt;
}

}  // namespace cdprep::report
