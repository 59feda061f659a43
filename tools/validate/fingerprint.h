// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "validate/defects/finding.h"

namespace cdprep::report {

/// Computes fingerprints that distinguish the places of a rule on a mesh. They stay the same
/// when vertices and triangles are renumbered.
///
/// A fingerprint is a hash of the rule and of the exact coordinates of the place's vertices, in
/// any order. If the place has no vertices, it hashes those of its triangles. Vertices are
/// preferred for a reason: a place at an edge or vertex often lists only the lowest triangle,
/// which depends on the numbering.
///
/// For rules about components (CDP0306 and CDP04xx), a vertex replaces each triangle, for the
/// same reason. It is the vertex of the component with the least coordinates. Equal defects at
/// equal positions, such as two copies of a sliver, share a fingerprint.
///
/// A fingerprint follows the numbering where the rule does. This concerns the lowest of several
/// equal triangles. It also concerns the kept vertices of a hole that has more than a place
/// holds.
class Fingerprints {
public:
    /// `soup` must outlive the object.
    explicit Fingerprints(const mesh::TriangleSoup& soup) : soup_(soup) {}

    /// Returns the fingerprint. Finds the components on the first call that uses one.
    [[nodiscard]] std::uint64_t of(mesh::Rule rule, const mesh::Place& place);

private:
    void find_components();

    const mesh::TriangleSoup& soup_;
    std::vector<std::uint32_t> least_vertex_;  ///< per triangle, of its component; index in soup_
};

/// Returns 16 hexadecimal digits.
[[nodiscard]] std::string fingerprint_text(std::uint64_t fingerprint);

/// Parses fingerprint_text(); returns nothing for other text.
[[nodiscard]] std::optional<std::uint64_t> parse_fingerprint(std::string_view text) noexcept;

}  // namespace cdprep::report
