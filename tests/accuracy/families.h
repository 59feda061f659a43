// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

namespace cdprep::test {

/// A family of the catalogue of numerically hard cases.
struct HardFamily {
    std::string_view id;
    std::string_view what;
    /// What the catalogue has of it that is not asked here even in the long form, and why.
    std::string_view less{};
};

// Families that are asked elsewhere alone.
inline constexpr std::string_view kSimulated = "the test simulation_cases asks it";
inline constexpr std::string_view kHaptic =
    "the unit tests Window and WindowMemory ask it, and bench/haptic_bench times it";

/// All of them, and after them failures that were found since (F).
inline constexpr std::array kHardFamilies = std::to_array<HardFamily>({
    {"T01", "shared vertex"},
    {"T02", "shared edge, folded"},
    {"T03", "vertex on a face"},
    {"T04", "vertex on an edge"},
    {"T05", "edges cross in a point"},
    {"T06", "coplanar, overlapping"},
    {"T07", "coplanar, part of an edge"},
    {"T08", "coplanar, a vertex alone"},
    {"T09", "coplanar, nested"},
    {"T10", "coplanar, apart"},
    {"T11", "one grid step above"},
    {"T12", "needles of 2^-40"},
    {"T13", "segments"},
    {"T14", "points"},
    {"T15", "far from the origin"},
    {"T16", "size ratio 2^40"},
    {"T17", "subnormal scale"},
    {"T18", "huge scale"},
    {"T19", "identical triangles"},
    {"T20", "relabelling"},
    {"T21", "NaN, infinity, -0"},
    {"T22", "edge in the other's plane"},
    {"T23", "planes 2^-30 apart"},
    {"P01", "fold vertex"},
    {"P02", "the centre itself"},
    {"P03", "diagonals from the centre"},
    {"P04", "planes of faces, outside"},
    {"P05", "on the boundary"},
    {"P06", "nested shells"},
    {"P07", "non-manifold solids"},
    {"P08", "open input"},
    {"P09", "overlap, inversion"},
    {"G01", "kissing boxes"},
    {"G02", "plate and tilted box"},
    {"G03", "origin on a simplex face"},
    {"G04", "24 corners, point queries"},
    {"G05", "false zeros"},
    {"G06", "coaxial 1000-gon prisms"},
    {"G07", "continuum of witnesses"},
    {"G08", "coincident shapes"},
    {"G09", "lower dimension"},
    {"G10", "fine hulls, small gap"},
    {"G11", "scale extremes"},
    {"G12", "needle in a cube"},
    {"G13", "support ties"},
    {"G14", "nearly coplanar support"},
    {"B01", "a mesh against itself"},
    {"B02", "nested shells", "icospheres of 81,920 triangles, the nearest to 100,000"},
    {"B03", "parallel sheets"},
    {"B04", "interlocked tori"},
    {"B05", "identical triangles",
     "10,000 copies on 10,000, not 100,000: counting 10^10 pairs takes minutes and shows no more"},
    {"B06", "fan"},
    {"B07", "one against many"},
    {"B08", "diagonal slivers",
     "5,000 on 5,000, not 10,000: the definition in exact numbers takes too long"},
    {"B09", "geometric progression"},
    {"B10", "quantised boxes"},
    {"B11", "trivial meshes"},
    {"B12", "big triangle, small cells"},
    {"B13", "cell boundaries"},
    {"B14", "poses"},
    {"B15", "order"},
    {"B16", "corrupted file"},
    {"C01", "low dimension"},
    {"C02", "lattice"},
    {"C03", "crowded faces"},
    {"C04", "co-spherical"},
    {"C05", "moment curve"},
    {"C06", "bumps"},
    {"C07", "noisy plane"},
    {"C08", "invariances"},
    {"C09", "ball"},
    {"D01", "convex input"},
    {"D02", "prisms"},
    {"D03", "curved concave"},
    {"D04", "thin shell"},
    {"D05", "non-manifold"},
    {"D06", "non-orientable"},
    {"D07", "open"},
    {"D08", "dirty soup"},
    {"D09", "slot"},
    {"D10", "one-ulp reflex edge"},
    {"D11", "coplanar strip"},
    {"X01", "parallel faces"},
    {"X02", "near-parallel edges"},
    {"X03", "degenerate triangle"},
    {"X04", "touching, one step apart"},
    {"X05", "equal minima"},
    {"X06", "cancellation"},
    {"X07", "tolerance equality"},
    {"X08", "error sweep"},
    {"X09", "contained objects"},
    {"S01", "stack", kSimulated},
    {"S02", "mass ratio", kSimulated},
    {"S03", "thin shell", kSimulated},
    {"S04", "bullet", kSimulated},
    {"S05", "spinning needle", kSimulated},
    {"S06", "resting drift", kSimulated},
    {"S07", "friction threshold", kSimulated},
    {"S08", "bounce", kSimulated},
    {"S09", "cradle", kSimulated},
    {"S10", "internal edges", kSimulated},
    {"S11", "corner", kSimulated},
    {"S12", "deformation", "without what it costs, which the unit test LiveCases prints"},
    {"S13", "tearing", "without its bound of memory, which the unit test LiveCases holds"},
    {"S14", "haptic rate", kHaptic},
    {"S15", "determinism", kSimulated},
    {"S16", "rough scan on a box"},
    {"K01", "resting stacks"},
    {"K02", "sliding on a flat mesh"},
    {"K03", "edge on edge"},
    {"K04", "vertex on edge"},
    {"K05", "vertex on face"},
    {"K06", "thin plates crossing"},
    {"K07", "deep overlap"},
    {"F01", "where libraries lose pairs"},
    {"F02", "leaves of pieces that wait"},
});

constexpr bool is_asked_elsewhere(const HardFamily& family) {
    return family.less == kSimulated || family.less == kHaptic;
}
constexpr bool is_of_contacts(std::string_view family) {
    return family.starts_with('K') || family.starts_with("S16");
}
/// Hulls of points and pieces of surfaces are made offline.
constexpr bool needs_tools(std::string_view family) {
    return family.starts_with('C') || family.starts_with('D') || is_of_contacts(family);
}

}  // namespace cdprep::test
