// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "support/hard_contacts.h"
#include "support/meshes.h"

#include "cdprep/pairs.h"

namespace cdprep::test {

/// What a peer says of two meshes.
struct PeerAnswer {
    bool hit = false;
    std::optional<std::vector<TrianglePair>> pairs{};  ///< where it names them
};

using Points = std::vector<Double3>;

/// A point of contact, as a peer says it.
struct PeerContact {
    Double3 normal;   ///< from A to B
    double distance;  ///< negative: overlap
};
using PeerContacts = std::vector<PeerContact>;

/// Another library. What it does not answer is empty.
struct Peer {
    std::string name;
    std::function<PeerAnswer(const TestMesh& a, const TestMesh& b)> collide{};
    std::function<double(const TestMesh& a, const TestMesh& b)> distance{};
    std::function<bool(const Points& a, const Points& b)> hulls_collide{};
    std::function<double(const Points& a, const Points& b)> hull_distance{};
    std::function<PeerContacts(const HardContact&)> contacts{};
    bool takes_two_hulls = false;  ///< contacts of two convex bodies alone
    bool takes_flat_hulls = true;  ///< squares, segments and points too
};

// Each is there where its library was found at configure time.
void add_fcl(std::vector<Peer>& peers);
void add_ccd(std::vector<Peer>& peers);
void add_bullet(std::vector<Peer>& peers);
void add_ode(std::vector<Peer>& peers);
void add_cgal(std::vector<Peer>& peers);

[[nodiscard]] std::vector<Peer> all_peers();

}  // namespace cdprep::test
