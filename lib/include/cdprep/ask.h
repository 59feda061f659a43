// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "cdprep/format/api.h"
#include "cdprep/format/section_set.h"

namespace cdprep {

/// The features of a model, one bit each. A feature is a query, another effect, or a structure that
/// a query may use. Values are never reused. Bits 19 and 24 to 29 are reserved for future features.
enum class Ask : std::uint32_t {
    nothing = 0,
    collide = 1U << 0,
    overlap = 1U << 1,
    distance = 1U << 2,
    within = 1U << 3,
    contacts = 1U << 4,
    response = 1U << 5,    ///< contacts and mass properties, for bodies that push each other
    continuous = 1U << 6,  ///< the time of impact of two models that move
    self = 1U << 7,        ///< overlaps of a model with itself
    deform = 1U << 8,      ///< the data to make a LiveModel
    tear = 1U << 9,        ///< the data to make a LiveModel that can tear
    haptic = 1U << 10,     ///< distances within a limit of work
    inside = 1U << 11,
    ray = 1U << 12,
    closest = 1U << 13,
    touch = 1U << 14,    ///< queries with a box, sphere, capsule or triangle
    hulls = 1U << 15,    ///< convex hulls of the whole model, components, instances and parts
    pieces = 1U << 16,   ///< convex pieces of the surface, and queries through them
    corners = 1U << 17,  ///< access to geometry: corners, numbers and names of the imported file
    inaccessible = 1U << 18,  ///< triangles occluded along every ray to the tetra-tree's centre
    octree = 1U << 20,
    adaptive_octree = 1U << 21,
    tetra_tree = 1U << 22,
    hashed_octree = 1U << 23,
    solid = 1U << 30,  ///< collide, distance and containment of solids
};

[[nodiscard]] constexpr Ask operator|(Ask a, Ask b) noexcept {
    return static_cast<Ask>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
[[nodiscard]] constexpr Ask operator&(Ask a, Ask b) noexcept {
    return static_cast<Ask>(static_cast<std::uint32_t>(a) & static_cast<std::uint32_t>(b));
}
/// Returns the bits of `a` that are not in `b`.
[[nodiscard]] constexpr Ask without(Ask a, Ask b) noexcept {
    return static_cast<Ask>(static_cast<std::uint32_t>(a) & ~static_cast<std::uint32_t>(b));
}
/// Returns whether `a` contains all of `b`.
[[nodiscard]] constexpr bool contains(Ask a, Ask b) noexcept {
    return (a & b) == b;
}

/// Vertex data that a query requires.
enum class Vertices : std::uint8_t {
    none,
    corners,    ///< positions and triangles, or leaves that hold the corners without loss
    positions,  ///< positions and, in addition, corners as above
};

/// The sections of a file that one query, effect or structure reads.
struct Needs {
    Ask ask;
    const char* name;           ///< in messages and, except "solid", in options of `cdprep bake`
    const char* bake_option;    ///< of `cdprep bake`, to add the sections: "--effects collide"
    format::SectionSet needed;  ///< all of them are required
    Vertices vertices;          ///< required in addition
    format::SectionSet used;    ///< read if the file has them, for speed or for names
};

/// Returns the table of needs: a row for each bit of Ask. Model::serves(), `bake --effects`,
/// `info`, `query` and the C API read this table. No other place lists the sections of each query.
[[nodiscard]] CDPREP_API std::span<const Needs> needs() noexcept;

/// Returns the row of one bit, or null for a set of bits or an unknown bit.
[[nodiscard]] CDPREP_API const Needs* find_needs(Ask one) noexcept;

/// Returns the row with this name, or null.
[[nodiscard]] CDPREP_API const Needs* find_needs(std::string_view name) noexcept;

/// Returns the bits that this version knows.
[[nodiscard]] CDPREP_API Ask known_asks() noexcept;

/// Returns the sections to open or to bake for all of `asks`: those that are needed or used. If
/// positions are among them, the result includes positions_f32 and positions_f64, although a file
/// has only one of them.
[[nodiscard]] CDPREP_API format::SectionSet sections_for(Ask asks) noexcept;

/// Returns the bits that a file with these sections serves. `has_exact_leaves` means that the
/// file's leaves hold model coordinates without loss (format::model_exact_leaves).
[[nodiscard]] CDPREP_API Ask served_by(format::SectionSet sections, bool has_exact_leaves) noexcept;

/// Returns the sections that `ask` needs and `sections` lacks. `ask` is one bit; for any other
/// value, the result is empty. If positions are needed and both kinds are missing, the result
/// contains positions_f32 only.
[[nodiscard]] CDPREP_API format::SectionSet missing_sections(Ask ask, format::SectionSet sections,
                                                             bool has_exact_leaves) noexcept;

}  // namespace cdprep
