// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/place_text.h"

#include <algorithm>

#include "text/number_text.h"

namespace cdprep::report {
namespace {

/// Returns "triangle 17", "vertices 3, 4 and 98 more", or "" for none.
std::string numbers_text(const char* one, const char* many,
                         const std::vector<std::uint32_t>& numbers, std::size_t most) {
    if (numbers.empty()) return "";
    std::string text = numbers.size() == 1 ? one : many;
    const std::size_t shown = std::min(numbers.size(), most);
    for (std::size_t i = 0; i < shown; ++i) {
        text += (i == 0 ? " " : ", ") + std::to_string(numbers[i]);
    }
    const std::size_t left = numbers.size() - shown;
    return left == 0 ? text : text + " and " + std::to_string(left) + " more";
}

}  // namespace

std::string node_of(const ValidationReport& report, std::uint32_t triangle) {
    const auto after =
        std::upper_bound(report.first_triangle.begin(), report.first_triangle.end(), triangle);
    if (after == report.first_triangle.begin()) return "";
    return report
        .node_of_triangle_run[static_cast<std::size_t>(after - report.first_triangle.begin()) - 1];
}

std::string place_text(const ValidationReport& report, mesh::Rule rule, const mesh::Place& place,
                       std::size_t most_numbers) {
    if (rule == mesh::Rule::empty_mesh) return "the whole mesh";
    const std::string triangles =
        numbers_text("triangle", "triangles", place.triangles, most_numbers);
    const std::string vertices = numbers_text("vertex", "vertices", place.vertices, most_numbers);
    std::string text = triangles;
    if (!triangles.empty() && !vertices.empty()) text += ", ";
    text += vertices;
    if (!place.triangles.empty()) {
        const std::string node = node_of(report, place.triangles.front());
        if (!node.empty()) text += " of " + node;
    }
    text += std::string(text.empty() ? "at (" : " at (") + number_text(place.position.x) + ", " +
            number_text(place.position.y) + ", " + number_text(place.position.z) + ")";
    const std::string measure = mesh::text_of(rule).measure;
    return measure.empty() ? text : text + "; " + measure + ": " + number_text(place.measure);
}

std::string count_text(const mesh::Finding& finding, std::uint64_t count) {
    return (finding.is_lower_bound ? "at least " : "") + std::to_string(count);
}

}  // namespace cdprep::report
