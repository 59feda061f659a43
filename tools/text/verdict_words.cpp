// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/verdict_words.h"

#include <array>
#include <cstdint>
#include <span>

#include "text/number_text.h"

namespace cdprep::report {
namespace {

struct BitWord {
    std::uint32_t bit;
    const char* word;
};

constexpr std::array<BitWord, 8> kFacts = {{
    {format::verdict_closed, "closed"},
    {format::verdict_two_manifold, "two-manifold"},
    {format::verdict_oriented, "oriented"},
    {format::verdict_orientable, "orientable"},
    {format::verdict_balanced, "balanced"},
    {format::verdict_inverted, "inverted"},
    {format::verdict_crossings_examined, "crossings-examined"},
    {format::verdict_self_crossing, "self-crossing"},
}};

constexpr std::array<BitWord, 4> kPromises = {{
    {format::promise_surface, "surface"},
    {format::promise_inside_exact, "inside-exact"},
    {format::promise_simple_solid, "simple-solid"},
    {format::promise_contained_pieces, "contained-pieces"},
}};

std::vector<std::string> words_of(std::uint32_t bits, std::span<const BitWord> known) {
    std::vector<std::string> words;
    for (const BitWord& entry : known) {
        if ((bits & entry.bit) != 0) words.emplace_back(entry.word);
    }
    return words;
}

std::string winding_text(const format::Verdict& verdict) {
    if ((verdict.facts & format::verdict_oriented) != 0) {
        return (verdict.facts & format::verdict_inverted) != 0 ? "oriented inside out" : "oriented";
    }
    return (verdict.facts & format::verdict_orientable) != 0 ? "not consistently wound"
                                                             : "not orientable";
}

std::string crossing_text(const format::Verdict& verdict) {
    if ((verdict.facts & format::verdict_crossings_examined) == 0) return "crossings not examined";
    return (verdict.facts & format::verdict_self_crossing) != 0 ? "self-crossing"
                                                                : "not self-crossing";
}

/// Returns true if there was no triangle to judge: the mesh is open, has no boundary and no other
/// fact holds.
bool is_of_nothing(const format::Verdict& verdict) {
    return (verdict.facts & ~format::verdict_crossings_examined) == 0 &&
           verdict.boundary_loops == 0;
}

}  // namespace

std::vector<std::string> fact_words(const format::Verdict& verdict) {
    return words_of(verdict.facts, kFacts);
}

std::vector<std::string> promise_words(const format::Verdict& verdict) {
    return words_of(verdict.promises, kPromises);
}

std::string verdict_text(const format::Verdict& verdict) {
    if (is_of_nothing(verdict)) return "no triangles to judge";
    const bool closed = (verdict.facts & format::verdict_closed) != 0;
    const bool manifold = (verdict.facts & format::verdict_two_manifold) != 0;
    const bool balanced = (verdict.facts & format::verdict_balanced) != 0;
    std::string text = closed ? "closed" : "open";
    text += manifold ? ", 2-manifold, " : ", not 2-manifold, ";
    text += winding_text(verdict) + ", " + crossing_text(verdict);
    text += "; Euler characteristic " + std::to_string(verdict.euler);
    if (verdict.genus >= 0) text += ", genus " + std::to_string(verdict.genus);
    if (verdict.boundary_loops > 0) {
        text += ", " + counted(verdict.boundary_loops, "boundary loop", "boundary loops");
    }
    text += ", area " + number_text(verdict.area);
    if (balanced) text += ", volume " + number_text(verdict.volume);
    return text;
}

std::string promises_text(const format::Verdict& verdict) {
    const std::uint32_t promises = verdict.promises;
    std::string text = (promises & format::promise_surface) != 0
                           ? "queries of the surface are exact"
                           : "it answers no query";
    if ((promises & format::promise_simple_solid) != 0) {
        text += "; inside is exact, and the volume is the enclosed volume";
    } else if ((promises & format::promise_inside_exact) != 0) {
        text += "; inside is exact, but winding numbers may differ from 0 and 1";
    } else {
        text += "; inside is unknown, so queries of the solid see the surface only";
    }
    text += (promises & format::promise_contained_pieces) != 0
                ? "; convex pieces can lie within it"
                : "; no convex piece is known to lie within it";
    return text;
}

}  // namespace cdprep::report
