// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "support/meshes.h"

#include "cdprep/pose.h"

namespace cdprep::test {

/// One of two bodies in contact.
struct ContactBody {
    std::shared_ptr<const TestMesh> mesh;  ///< the same for all cases of a scale
    Pose pose;
    bool is_convex = true;
    bool in_triangles = false;  ///< each triangle is a piece by itself
};

/// Two bodies whose contacts are known by construction.
struct HardContact {
    std::string id;  ///< S16, K01 ... K07, and a description
    ContactBody a;
    ContactBody b;
    double tolerance = 0;
    double size = 1;        ///< the scale: a power of two
    double separation = 0;  ///< the gap, or minus the length of the shortest way out
    /// The directions of shortest ways, from A to B; several where several are as short. Empty:
    /// those along which no point is beyond `separation` (a cone, of touching vertices and edges).
    std::vector<Double3> normals{};
    /// What counts as right for a peer: of a cone samples, and of deep pairs all ways out at most
    /// twice as long as the shortest.
    std::vector<Double3> allowed{};
    /// The corners of the region that two faces share, on the lower one; empty where there is none.
    std::vector<Double3> outline{};
    bool is_swapped = false;  ///< the shape that the outline lies on is B
    bool is_plain = true;     ///< neither scaled nor shifted

    [[nodiscard]] Placement placement() const;
    [[nodiscard]] std::vector<Double3> points_a() const;  ///< as they are moved
    [[nodiscard]] std::vector<Double3> points_b() const;
    /// The largest coordinate of both, moved or not.
    [[nodiscard]] double largest() const;
    /// By how much lengths may be off for rounding: 32 units in the last place of largest().
    [[nodiscard]] double rounding() const;
};

/// S16: a rough scan in a large box. K01: resting stacks. K02: sliding over 20,000 coplanar
/// triangles. K03: edge on edge. K04: vertex on edge. K05: vertex on face. K06: thin plates that
/// cross. K07: deep overlap. Families whose names do not begin with `family` are left out.
[[nodiscard]] std::vector<HardContact> hard_contacts(const std::string& family = {});

/// How far B's points are beyond A's along a direction; negative: how far they reach back.
[[nodiscard]] long double reach(const Double3& normal, std::span<const Double3> a,
                                std::span<const Double3> b);

[[nodiscard]] double length_of(const Double3& v);
/// Radians between two directions, of any length.
[[nodiscard]] double angle_between(const Double3& a, const Double3& b);

}  // namespace cdprep::test
