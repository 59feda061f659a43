// SPDX-License-Identifier: MIT
#include "support/hard_triangles.h"

#include <array>
#include <cmath>
#include <utility>

#include "support/exact_contact.h"
#include "support/exact_rational.h"

namespace cdprep::test {
namespace {

constexpr double g = 0x1p-20;  ///< one grid step
constexpr Corners kA = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};

HardPair by_definition(std::string id, const Corners& a, const Corners& b) {
    const TriangleContact kind =
        contact_by_definition(exact<ExactNumber>(a), exact<ExactNumber>(b));
    return {std::move(id), a, b, kind != TriangleContact::disjoint,
            kind == TriangleContact::cross || kind == TriangleContact::coplanar_overlap};
}

void add_touching(std::vector<HardPair>& all) {
    all.push_back({"T01 shared vertex", kA, {{{0, 0, 0}, {-1, 0, 1}, {0, -1, 1}}}, true, false});
    all.push_back({"T02 shared edge", kA, {{{0, 0, 0}, {1, 0, 0}, {0, -1, 1}}}, true, false});
    all.push_back(
        {"T03 vertex on face", kA, {{{0.25, 0.25, 0}, {0, 0, 1}, {1, 1, 1}}}, true, false});
    all.push_back({"T04 vertex on edge", kA, {{{0.5, 0, 0}, {0, -1, 1}, {1, -1, 1}}}, true, false});
    all.push_back(
        {"T05 edges cross", kA, {{{0.5, 0.5, -1}, {0.5, 0.5, 1}, {2, 2, 0}}}, true, false});
    all.push_back(
        {"T22 edge in the plane, apart", kA, {{{2, 0, 0}, {2, 1, 0}, {2, 0, 1}}}, false, false});
    all.push_back({"T22 edge in the plane, touching",
                   kA,
                   {{{0.25, -1, 0}, {0.25, 1, 0}, {0.25, 0, 1}}},
                   true,
                   false});
}

void add_coplanar(std::vector<HardPair>& all) {
    all.push_back({"T06 partial overlap",
                   kA,
                   {{{0.25, 0.25, 0}, {1.25, 0.25, 0}, {0.25, 1.25, 0}}},
                   true,
                   true});
    all.push_back(
        {"T07 part of an edge", kA, {{{0.25, 0, 0}, {0.75, 0, 0}, {0.5, -1, 0}}}, true, false});
    all.push_back({"T08 vertex only", kA, {{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}}}, true, false});
    all.push_back(
        {"T09 nested", kA, {{{0.125, 0.125, 0}, {0.5, 0.125, 0}, {0.125, 0.5, 0}}}, true, true});
    all.push_back({"T10 boxes overlap", kA, {{{1, 1, 0}, {1, g, 0}, {g, 1, 0}}}, false, false});
    all.push_back({"T19 identical", kA, kA, true, true});
    all.push_back({"T19 identical, turned over", kA, {kA[0], kA[2], kA[1]}, true, true});
}

/// B has A's corners, each a step below, in or above A's plane.
void add_one_step(std::vector<HardPair>& all) {
    for (int pattern = 0; pattern < 27; ++pattern) {
        Corners b = kA;
        b[0].z = g * (pattern % 3 - 1);
        b[1].z = g * (pattern / 3 % 3 - 1);
        b[2].z = g * (pattern / 9 - 1);
        all.push_back(by_definition("T11 one step, pattern " + std::to_string(pattern), kA, b));
    }
}

void add_needles(std::vector<HardPair>& all) {
    constexpr double kThin = 0x1p-40;
    for (int step = -2; step <= 2; ++step) {
        const double y = 0.5 + step * kThin;
        const Corners b = {{{0.5, y, -0.5}, {0.5, y, 0.5}, {0.5 + kThin, y, 0.5}}};
        all.push_back(by_definition("T12 needle, step " + std::to_string(step), kA, b));
        const Corners lying = {{{-0.5, y, 0}, {1.5, y, 0}, {1.5, y + kThin, 0}}};
        all.push_back(by_definition("T12 needle in the plane, " + std::to_string(step), kA, lying));
    }
}

void add_without_area(std::vector<HardPair>& all) {
    constexpr double q = 0.25;
    all.push_back({"T13 segment", kA, {{{q, q, -1}, {q, q, 1}, {q, q, 3}}}, true, false});
    all.push_back({"T13 segment, apart", kA, {{{q, q, g}, {q, q, 1}, {q, q, 3}}}, false, false});
    all.push_back(
        {"T13 segment in the plane", kA, {{{-1, q, 0}, {2, q, 0}, {q, q, 0}}}, true, false});
    all.push_back({"T13 segments crossing",
                   {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}},
                   {{{2, 0, 1}, {0, 2, 1}, {0, 2, 1}}},
                   true,
                   false});
    all.push_back({"T13 segments in one line",
                   {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}},
                   {{{2, 2, 2}, {3, 3, 3}, {4, 4, 4}}},
                   true,
                   false});
    all.push_back({"T13 segments in one line, apart",
                   {{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}}},
                   {{{2 + g, 2 + g, 2 + g}, {3, 3, 3}, {4, 4, 4}}},
                   false,
                   false});
    all.push_back({"T14 point", kA, {{{q, q, 0}, {q, q, 0}, {q, q, 0}}}, true, false});
    all.push_back({"T14 point above", kA, {{{q, q, g}, {q, q, g}, {q, q, g}}}, false, false});
    all.push_back({"T14 point on itself",
                   {{{q, q, g}, {q, q, g}, {q, q, g}}},
                   {{{q, q, g}, {q, q, g}, {q, q, g}}},
                   true,
                   false});
}

void add_unequal_sizes(std::vector<HardPair>& all) {
    constexpr double e = 0x1p-40;
    constexpr double q = 0.25;
    for (const int step : {-2, -1, 0, 1}) {
        const double z = step * e;
        const Corners b = {{{q, q, z}, {q + e, q, z + e}, {q, q + e, z + e}}};
        all.push_back(by_definition("T16 tiny, step " + std::to_string(step), kA, b));
    }
    const Corners through = {{{q, q, -e}, {q + e, q, e}, {q, q + e, e}}};
    all.push_back({"T16 tiny, through", kA, through, true, true});
    const Corners inside = {{{q, q, 0}, {q + e, q, 0}, {q, q + e, 0}}};
    all.push_back({"T16 tiny, in the plane", kA, inside, true, true});

    // At the origin it can be smaller still: differences then need more bits than machine
    // integers have.
    constexpr double f = 0x1p-80;
    const Corners around = {{{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}}};
    for (const int step : {-2, -1, 0, 1}) {
        const double z = step * f;
        const Corners b = {{{f, 0, z}, {2 * f, f, z + f}, {0, 2 * f, z + f}}};
        all.push_back(by_definition("T16 tinier, step " + std::to_string(step), around, b));
    }
    const Corners flat = {{{f, 0, 0}, {2 * f, f, 0}, {0, 2 * f, 0}}};
    all.push_back({"T16 tinier, in the plane", around, flat, true, true});
    const Corners beside = {{{f, 0, 0}, {1, 1, 1}, {2, -1, 1}}};
    all.push_back({"T16 a corner 2^-80 from the origin", around, beside, true, false});
    const Corners above = {{{f, 0, f}, {1, 1, 1}, {2, -1, 1}}};
    all.push_back({"T16 a corner 2^-80 above", around, above, false, false});
}

void add_others(std::vector<HardPair>& all) {
    all.push_back({"T21 minus zero",
                   {{{-0.0, 0.0, -0.0}, {1, -0.0, 0}, {0, 1, -0.0}}},
                   {{{0, 0, 0}, {-1, 0, 1}, {0, -1, 1}}},
                   true,
                   false});
    constexpr double kSlope = 0x1p-30;
    const Corners large = {{{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}}};
    Corners tilted = large;
    for (Double3& p : tilted) p.z = p.x * kSlope;
    all.push_back({"T23 nearly parallel", large, tilted, true, true});
}

template <class Change>
std::optional<HardPair> changed(HardPair pair, Change change) {
    for (Corners* corners : {&pair.a, &pair.b}) {
        for (Double3& p : *corners) {
            for (double* x : {&p.x, &p.y, &p.z}) {
                if (!change(*x)) return std::nullopt;
            }
        }
    }
    return pair;
}

}  // namespace

std::vector<HardPair> hard_triangles() {
    std::vector<HardPair> all;
    add_touching(all);
    add_coplanar(all);
    add_one_step(all);
    add_needles(all);
    add_without_area(all);
    add_unequal_sizes(all);
    add_others(all);
    return all;
}

std::optional<HardPair> scaled(const HardPair& pair, int exponent) {
    return changed(pair, [exponent](double& x) {
        const double before = x;
        x = std::ldexp(x, exponent);
        return std::ldexp(x, -exponent) == before;
    });
}

std::optional<HardPair> mapped(const HardPair& pair, const std::array<double, 9>& matrix) {
    HardPair result = pair;
    for (Corners* corners : {&result.a, &result.b}) {
        for (Double3& p : *corners) {
            const std::array<double, 3> old = {p.x, p.y, p.z};
            std::array<double, 3> made{};
            for (std::size_t i = 0; i < 3; ++i) {
                ExactNumber exact;
                for (std::size_t k = 0; k < 3; ++k) {
                    made[i] += matrix[3 * i + k] * old[k];
                    exact = exact + ExactNumber(matrix[3 * i + k]) * ExactNumber(old[k]);
                }
                if (ExactNumber(made[i]) != exact) return std::nullopt;
            }
            p = {made[0], made[1], made[2]};
        }
    }
    return result;
}

std::optional<HardPair> shifted(const HardPair& pair, double shift) {
    return changed(pair, [shift](double& x) {
        const double before = x;
        x += shift;
        return ExactNumber(x) == ExactNumber(before) + ExactNumber(shift);
    });
}

HardPair relabelled(const HardPair& pair, std::size_t number) {
    constexpr std::array<std::array<std::size_t, 3>, 6> kOrders = {
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    HardPair result = pair;
    for (std::size_t i = 0; i < 3; ++i) {
        result.a[i] = pair.a[kOrders[number % 6][i]];
        result.b[i] = pair.b[kOrders[number / 6 % 6][i]];
    }
    if (number >= 36) std::swap(result.a, result.b);
    return result;
}

HardPair turned(const HardPair& pair, std::size_t number) {
    constexpr std::array<std::array<std::size_t, 3>, 6> kOrders = {
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    const auto& order = kOrders[number % 6];
    const std::size_t signs = number / 6;
    HardPair result = pair;
    for (Corners* corners : {&result.a, &result.b}) {
        for (Double3& p : *corners) {
            const std::array<double, 3> old = {p.x, p.y, p.z};
            p = {(signs & 1) != 0 ? -old[order[0]] : old[order[0]],
                 (signs & 2) != 0 ? -old[order[1]] : old[order[1]],
                 (signs & 4) != 0 ? -old[order[2]] : old[order[2]]};
        }
    }
    return result;
}

}  // namespace cdprep::test
