// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/finding.h"

namespace cdprep::report {

/// Tells the places of a rule on a mesh from each other, by numbers that stay the same
/// when vertices and triangles are numbered anew.
///
/// A fingerprint is a hash of the rule and of the exact coordinates of the place's
/// triangles and vertices, in any order. For rules about components (CDP0306 and the
/// CDP04xx) a triangle stands for its component's vertex with the least coordinates: the
/// number of the triangle that names a component says nothing. Equal defects in equal
/// positions, such as two copies of a sliver, share a fingerprint. Of a hole with more
/// vertices than a place holds, the numbering decides which are hashed.
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
