// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace cdprep::mesh {

enum class Severity : std::uint8_t { off, note, warning, error };

/// The rules: defects of a mesh and notes about it. The number is the id, "CDP0203" for 203. An
/// id is never reused for another rule. RULES.md has the definitions.
enum class Rule : std::uint16_t {
    non_finite_coordinate = 101,
    index_out_of_range = 102,
    extent_beyond_float = 103,
    unreferenced_vertex = 104,
    duplicate_vertex = 105,  ///< equal positions
    near_vertex = 106,       ///< within the weld distance, not equal
    empty_mesh = 107,        ///< no triangle is left to query
    repeated_corner = 201,
    zero_area = 202,
    sliver = 203,
    duplicate_triangle = 204,  ///< same winding
    opposite_triangle = 205,   ///< same corners, opposite winding
    boundary_edge = 301,
    boundary_loop = 302,
    non_manifold_edge = 303,
    non_manifold_vertex = 304,
    inconsistent_winding = 305,
    non_orientable = 306,
    t_junction = 307,
    near_seam = 308,
    inverted_component = 401,
    nested_component = 402,
    overlapping_components = 403,
    several_components = 404,
    crossing_triangles = 501,
    touching_triangles = 502,
    coplanar_overlap = 503,
};

/// The text of a rule. The texts are whole sentences for people.
struct RuleText {
    Rule rule;
    const char* name;  ///< the enumerator with hyphens: "repeated-corner"
    Severity severity;
    const char* title;    ///< "Triangle repeats a corner"
    const char* meaning;  ///< the exact definition
    const char* why;      ///< its effect on collision queries
    const char* remedy;   ///< the repair
    const char* decided;  ///< "exact", or the method of decision
    const char* measure;  ///< the meaning of Place::measure, with its unit; "" if there is none
};

/// Returns all rules, by ascending id.
[[nodiscard]] std::span<const RuleText> all_rules() noexcept;

[[nodiscard]] const RuleText& text_of(Rule rule) noexcept;

/// Returns the id, such as "CDP0203".
[[nodiscard]] std::string id_of(Rule rule);

/// Returns the rule with this id or name, in any case of letters; nothing if there is none.
[[nodiscard]] std::optional<Rule> find_rule(std::string_view id_or_name) noexcept;

}  // namespace cdprep::mesh
