// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "validate/defects/finding.h"

namespace cdprep::report {

/// Tells the places of a rule on a mesh from each other, by numbers that stay the same
/// when vertices and triangles are numbered anew.
///
/// A fingerprint is a hash of the rule and of the exact coordinates of the place's
/// vertices, in any order, or of its triangles where it names no vertex: which of the
/// triangles at an edge or a vertex are named is often the lowest, a matter of numbering.
/// For rules about components (CDP0306 and the CDP04xx) a triangle stands for its
/// component's vertex with the least coordinates, for the same reason. Equal defects in
/// equal positions, such as two copies of a sliver, share a fingerprint. Where the rule
/// itself follows the numbering, the fingerprint does: which of several equal triangles
/// is the lowest, and which vertices of a hole with more than a place holds.
class Fingerprints {
public:
    /// `soup` outlives the object.
    explicit Fingerprints(const mesh::TriangleSoup& soup) : soup_(soup) {}

    /// Finds the components when it is first asked for a place of one.
    [[nodiscard]] std::uint64_t of(mesh::Rule rule, const mesh::Place& place);

private:
    void find_components();

    const mesh::TriangleSoup& soup_;
    std::vector<std::uint32_t> least_vertex_;  ///< per triangle, of its component; of soup_
};

/// 16 hexadecimal digits.
[[nodiscard]] std::string fingerprint_text(std::uint64_t fingerprint);

/// The reverse; nothing for other text.
[[nodiscard]] std::optional<std::uint64_t> parse_fingerprint(std::string_view text) noexcept;

}  // namespace cdprep::report
