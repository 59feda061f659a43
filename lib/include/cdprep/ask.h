// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "cdprep/format/section_set.h"

namespace cdprep {

/// What a model can be asked for: questions, effects of scenes, and the structures that a
/// question may go through, as bits of one set. Values are never reused; 5 to 10, 19 and 24 to
/// 29 are kept for effects that are not built yet.
enum class Ask : std::uint32_t {
    nothing = 0,
    collide = 1U << 0,
    overlap = 1U << 1,
    distance = 1U << 2,
    within = 1U << 3,
    contacts = 1U << 4,
    response = 1U << 5,  ///< mass properties
    inside = 1U << 11,
    ray = 1U << 12,
    closest = 1U << 13,
    touch = 1U << 14,    ///< box, sphere, capsule and triangle against a model
    hulls = 1U << 15,    ///< convex hulls of the whole, of components, instances and parts
    pieces = 1U << 16,   ///< convex pieces of the surface, and questions through them
    corners = 1U << 17,  ///< geometry out: corners, numbers and names of the imported file
    inaccessible = 1U << 18,
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
/// What is in `a` and not in `b`.
[[nodiscard]] constexpr Ask without(Ask a, Ask b) noexcept {
    return static_cast<Ask>(static_cast<std::uint32_t>(a) & ~static_cast<std::uint32_t>(b));
}
/// True when all of `b` is in `a`.
[[nodiscard]] constexpr bool contains(Ask a, Ask b) noexcept {
    return (a & b) == b;
}

/// Vertex data that a query requires.
enum class Vertices : std::uint8_t {
    none,
    corners,    ///< positions and triangles, or leaves that hold the corners without loss
    positions,  ///< positions, and corners as above
};

/// The sections of a file that one question, effect or structure reads.
struct Needs {
    Ask ask;
    const char* name;           ///< as options of `cdprep bake` spell it
    const char* bake_option;    ///< of `cdprep bake`, adds what is missing: "--effects collide"
    format::SectionSet needed;  ///< every one of them
    Vertices vertices;          ///< besides
    format::SectionSet used;    ///< read where the file has them: for speed, or for names
};

/// The table of needs: a row for each bit of Ask. Model::serves(), `bake --effects`, `info`,
/// `query` and the C API read it; nothing else knows what a question needs.
[[nodiscard]] std::span<const Needs> needs() noexcept;

/// Returns the row of one bit, or null for a set, or a bit that this version does not know.
[[nodiscard]] const Needs* find_needs(Ask one) noexcept;

/// Returns the row with this name, or null.
[[nodiscard]] const Needs* find_needs(std::string_view name) noexcept;

/// Returns the bits that this version knows.
[[nodiscard]] Ask known_asks() noexcept;

/// Returns the sections to open, or to bake, for all of `asks`: needed, used, and both kinds of
/// positions, of which a file has one.
[[nodiscard]] format::SectionSet sections_for(Ask asks) noexcept;

/// Returns what a file with these sections can be asked. `has_exact_leaves`: its leaves hold
/// model coordinates without loss (format::model_exact_leaves).
[[nodiscard]] Ask served_by(format::SectionSet sections, bool has_exact_leaves) noexcept;

/// Returns those sections that `ask`, one bit, needs and `sections` lacks. Of two kinds of
/// positions, positions_f32 is named.
[[nodiscard]] format::SectionSet missing_sections(Ask ask, format::SectionSet sections,
                                                  bool has_exact_leaves) noexcept;

}  // namespace cdprep
