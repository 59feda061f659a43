// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <vector>

#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/content_hash.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/format/pieces.h"
#include "cdprep/format/sections.h"

namespace cdprep::format {
namespace {

using Found = std::optional<Damage>;
using Bytes = std::span<const std::byte>;

/// Returns a copy of a section's elements, because the file's bytes may have any alignment.
template <class T>
std::vector<T> copy_of(Bytes file, SectionId id) {
    const std::optional<SectionEntry> entry = find_section(file, id);
    assert(!entry || entry->count == 0 || entry->element_size == sizeof(T));
    std::vector<T> elements(entry ? static_cast<std::size_t>(entry->count) : 0);
    if (!elements.empty()) {
        std::memcpy(elements.data(), file.data() + entry->offset, elements.size() * sizeof(T));
    }
    return elements;
}

std::uint64_t place_of(Bytes file, SectionId id, std::uint64_t index) {
    const std::optional<SectionEntry> entry = find_section(file, id);
    return entry ? entry->offset + index * entry->element_size : 0;
}

std::vector<Double3> positions_of(Bytes file) {
    std::vector<Double3> positions = copy_of<Double3>(file, SectionId::positions_f64);
    for (const Float3& p : copy_of<Float3>(file, SectionId::positions_f32)) {
        positions.push_back({p.x, p.y, p.z});
    }
    return positions;
}

/// Returns the sign of (x - origin) * 2^exponent - bound in exact arithmetic. The difference is
/// kept with its rounding error. The scaling is exact unless it underflows; then only a bound of 0
/// can compare equal.
int compare(double x, double origin, int exponent, float bound) {
    const double difference = x - origin;
    const double virtual_origin = x - difference;
    const double virtual_x = difference + virtual_origin;
    const double tail = (x - virtual_x) + (virtual_origin - origin);
    const double scaled = std::ldexp(difference, exponent);
    const auto limit = static_cast<double>(bound);
    if (scaled != limit) return scaled < limit ? -1 : 1;
    const double rest = scaled == 0 && difference != 0 ? difference : tail;
    return (rest > 0) - (rest < 0);
}

double coordinate(const Double3& p, std::size_t axis) {
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/// The data that the checks of the tree read.
struct Tree {
    FileHeader header;
    BvhShape shape;
    std::vector<Double3> positions;
    std::vector<Triangle> triangles;
    std::vector<BvhNode> nodes;
};

bool box_holds(const Tree& tree, const BvhNode& node, std::uint32_t box, const Double3& p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = coordinate(p, axis);
        const double origin = coordinate(tree.header.frame_origin, axis);
        const int exponent = tree.header.frame_exponent;
        if (compare(x, origin, exponent, node.lower[axis][box]) < 0) return false;
        if (compare(x, origin, exponent, node.upper[axis][box]) > 0) return false;
    }
    return true;
}

bool box_holds_triangles(const Tree& tree, const BvhNode& node, std::uint32_t box,
                         std::uint64_t leaf) {
    const std::uint64_t first = leaf * kBvhWidth;
    const std::uint64_t last = std::min<std::uint64_t>(first + kBvhWidth, tree.triangles.size());
    for (std::uint64_t i = first; i < last; ++i) {
        for (const std::uint32_t vertex : tree.triangles[i].vertex) {
            assert(vertex < tree.positions.size());
            if (!box_holds(tree, node, box, tree.positions[vertex])) return false;
        }
    }
    return true;
}

bool box_holds_node(const BvhNode& node, std::uint32_t box, const BvhNode& child,
                    std::uint32_t used) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::uint32_t i = 0; i < used; ++i) {
            if (child.lower[axis][i] < node.lower[axis][box]) return false;
            if (child.upper[axis][i] > node.upper[axis][box]) return false;
        }
    }
    return true;
}

Found find_loose_box(Bytes file, SectionId id, const Tree& tree) {
    for (std::uint32_t level = 0; level < tree.shape.levels; ++level) {
        for (std::uint32_t i = 0; i < tree.shape.count[level]; ++i) {
            const std::uint32_t index = tree.shape.first[level] + i;
            const BvhNode& node = tree.nodes[index];
            for (std::uint32_t box = 0; box < tree.shape.used_boxes(level, i); ++box) {
                const std::uint32_t below = i * kBvhWidth + box;
                const bool holds =
                    level == 0
                        ? box_holds_triangles(tree, node, box, below)
                        : box_holds_node(node, box, tree.nodes[tree.shape.first[level - 1] + below],
                                         tree.shape.used_boxes(level - 1, below));
                if (!holds) {
                    return Damage{DamageKind::bad_box, id, place_of(file, id, index), box, 0};
                }
            }
        }
    }
    return std::nullopt;
}

/// Returns a coordinate of a position in the coordinates that leaves keep.
double stored_in_leaf(const Tree& tree, const Double3& p, std::size_t axis) {
    const double x = coordinate(p, axis);
    if ((tree.header.flags & model_exact_leaves) != 0) return x;
    return std::ldexp(x - coordinate(tree.header.frame_origin, axis), tree.header.frame_exponent);
}

bool leaf_matches(const Tree& tree, const BvhLeaf& leaf, std::uint64_t first) {
    assert(leaf.count > 0 && leaf.count <= tree.triangles.size() - first);
    const bool exact = (tree.header.flags & model_exact_leaves) != 0;
    const double scale = exact ? std::ldexp(1.0, tree.header.frame_exponent) : 1;
    for (std::uint32_t lane = 0; lane < kBvhWidth; ++lane) {
        const Triangle& t = tree.triangles[first + std::min(lane, leaf.count - 1)];
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double x = stored_in_leaf(tree, tree.positions[t.vertex[i]], axis);
                const double local = x - double{leaf.origin[axis]};
                const double reach = double{leaf.half[axis]} * (1 + 0x1p-40);
                if (std::fabs(local * scale) > reach) return false;
                const float kept = static_cast<float>(exact ? x : local);
                if (leaf.corner[i][axis][lane] != kept) return false;
                if (exact && double{kept} != x) return false;  // the flag means: without loss
            }
        }
    }
    return true;
}

Found find_wrong_leaf(Bytes file, const Tree& tree) {
    const auto leaves = copy_of<BvhLeaf>(file, SectionId::bvh_leaves);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        if (!leaf_matches(tree, leaves[i], i * kBvhWidth)) {
            return Damage{DamageKind::bad_fact, SectionId::bvh_leaves,
                          place_of(file, SectionId::bvh_leaves, i), i, 0};
        }
    }
    return std::nullopt;
}

using Vector = std::array<double, 3>;

// A copy of that of lib/exact, which format may not include.
double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// One oriented box with its third axis.
struct OrientedBox {
    Vector centre;
    Vector half;
    std::array<Vector, 3> axis;
};

OrientedBox oriented_box(const OrientedNode& node, std::uint32_t box) {
    OrientedBox result{};
    for (std::size_t i = 0; i < 3; ++i) {
        result.centre[i] = double{node.centre[i][box]};
        result.half[i] = double{node.half[i][box]};
        for (std::size_t k = 0; k < 2; ++k) result.axis[k][i] = double{node.axis[k][i][box]};
    }
    const auto& [a, b, c] = result.axis;
    result.axis[2] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                      a[0] * b[1] - a[1] * b[0]};
    return result;
}

constexpr double kAxisTolerance = 8 * 0x1p-24;

/// Returns whether axes have unit length and are orthogonal, up to the rounding of float.
bool are_orthonormal(std::span<const Vector> axes) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
        for (std::size_t k = 0; k < axes.size(); ++k) {
            const double wanted = i == k ? 1 : 0;
            if (!(std::fabs(dot(axes[i], axes[k]) - wanted) <= kAxisTolerance)) return false;
        }
    }
    return true;
}

/// Returns a vertex in frame coordinates, relative to `centre`.
Vector vertex_from(const Tree& tree, std::uint32_t vertex, const Vector& centre) {
    Vector at{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double x = coordinate(tree.positions[vertex], i);
        const double o = coordinate(tree.header.frame_origin, i);
        at[i] = std::ldexp(x - o, tree.header.frame_exponent) - centre[i];
    }
    return at;
}

/// Returns whether a box has orthonormal axes and contains every vertex of the triangles.
bool oriented_box_holds(const Tree& tree, const OrientedBox& box, std::uint64_t first,
                        std::uint64_t last) {
    if (!are_orthonormal(box.axis)) return false;
    for (std::uint64_t t = first; t < last; ++t) {
        for (const std::uint32_t vertex : tree.triangles[t].vertex) {
            const Vector at = vertex_from(tree, vertex, box.centre);
            for (std::size_t k = 0; k < 3; ++k) {
                if (!(std::fabs(dot(at, box.axis[k])) <= box.half[k])) return false;
            }
        }
    }
    return true;
}

/// One swept sphere.
struct SweptSphere {
    Vector centre;
    std::array<Vector, 2> axis;
    std::array<double, 2> half;
    double radius;
};

SweptSphere swept_sphere(const SweptNode& node, std::uint32_t box) {
    SweptSphere result{};
    for (std::size_t i = 0; i < 3; ++i) result.centre[i] = double{node.centre[i][box]};
    for (std::size_t k = 0; k < 2; ++k) {
        for (std::size_t i = 0; i < 3; ++i) {
            result.axis[k][i] = double{node.side[k].axis[i][box]};
        }
        result.half[k] = double{node.side[k].half[box]};
    }
    result.radius = double{node.radius[box]};
    return result;
}

/// Returns whether a swept sphere has orthonormal axes and every vertex is within the radius of a
/// point of the middle. That point is the nearest, as far as the axes are orthogonal.
bool swept_sphere_holds(const Tree& tree, const SweptSphere& sphere, std::uint64_t first,
                        std::uint64_t last) {
    if (!are_orthonormal(sphere.axis)) return false;
    for (std::uint64_t t = first; t < last; ++t) {
        for (const std::uint32_t vertex : tree.triangles[t].vertex) {
            Vector rest = vertex_from(tree, vertex, sphere.centre);
            for (std::size_t k = 0; k < 2; ++k) {
                const double along =
                    std::clamp(dot(rest, sphere.axis[k]), -sphere.half[k], sphere.half[k]);
                for (std::size_t i = 0; i < 3; ++i) rest[i] -= along * sphere.axis[k][i];
            }
            if (!(dot(rest, rest) <= sphere.radius * sphere.radius)) return false;
        }
    }
    return true;
}

/// Finds the first bound of a section, box by box, for which `holds(node, box, first, last)` is
/// false. The last two arguments are triangles.
template <class Node, class Holds>
Found find_loose_bound(Bytes file, SectionId id, const Tree& tree, Holds holds) {
    const auto nodes = copy_of<Node>(file, id);
    if (nodes.empty()) return std::nullopt;
    std::uint64_t triangles_per_box = kBvhWidth;
    for (std::uint32_t level = 0; level < tree.shape.levels; ++level) {
        for (std::uint32_t i = 0; i < tree.shape.count[level]; ++i) {
            const std::uint32_t index = tree.shape.first[level] + i;
            for (std::uint32_t box = 0; box < tree.shape.used_boxes(level, i); ++box) {
                const std::uint64_t below = std::uint64_t{i} * kBvhWidth + box;
                const std::uint64_t last =
                    std::min<std::uint64_t>((below + 1) * triangles_per_box, tree.triangles.size());
                if (!holds(nodes[index], box, below * triangles_per_box, last)) {
                    return Damage{DamageKind::bad_box, id, place_of(file, id, index), box, 0};
                }
            }
        }
        triangles_per_box *= kBvhWidth;
    }
    return std::nullopt;
}

Found find_loose_oriented(Bytes file, const Tree& tree) {
    return find_loose_bound<OrientedNode>(
        file, SectionId::oriented_nodes, tree,
        [&](const OrientedNode& node, std::uint32_t box, std::uint64_t first, std::uint64_t last) {
            return oriented_box_holds(tree, oriented_box(node, box), first, last);
        });
}

Found find_loose_swept(Bytes file, SectionId id, const Tree& tree) {
    return find_loose_bound<SweptNode>(
        file, id, tree,
        [&](const SweptNode& node, std::uint32_t box, std::uint64_t first, std::uint64_t last) {
            return swept_sphere_holds(tree, swept_sphere(node, box), first, last);
        });
}

/// Finds a number that occurs twice in a list of numbers below its length.
Found find_repeated(Bytes file, SectionId id) {
    const auto list = copy_of<std::uint32_t>(file, id);
    std::vector<bool> seen(list.size(), false);
    for (std::size_t i = 0; i < list.size(); ++i) {
        assert(list[i] < list.size());
        if (seen[list[i]]) {
            return Damage{DamageKind::bad_fact, id, place_of(file, id, i), list[i], i};
        }
        seen[list[i]] = true;
    }
    return std::nullopt;
}

/// Finds a triangle in two leaves of pieces. If there is none, each is in one leaf: the leaves
/// contain as many triangles as there are.
Found find_twice_held(Bytes file) {
    const auto leaves = copy_of<PieceLeaf>(file, SectionId::piece_leaves);
    std::vector<bool> seen(copy_of<std::uint32_t>(file, SectionId::piece_triangles).size(), false);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        for (std::uint32_t k = 0; k < leaves[i].count; ++k) {
            const std::size_t at = std::size_t{leaves[i].first_triangle} + k;
            assert(at < seen.size());
            if (seen[at]) {
                return Damage{DamageKind::bad_fact, SectionId::piece_leaves,
                              place_of(file, SectionId::piece_leaves, i), at, i};
            }
            seen[at] = true;
        }
    }
    return std::nullopt;
}

/// Returns the BVH over pieces as one over triangles: eight per leaf, the last triangle repeated.
Tree piece_tree(Bytes file, const Tree& tree) {
    const auto leaves = copy_of<PieceLeaf>(file, SectionId::piece_leaves);
    const auto listed = copy_of<std::uint32_t>(file, SectionId::piece_triangles);
    Tree pieces{tree.header,
                piece_tree_shape(static_cast<std::uint32_t>(leaves.size())),
                tree.positions,
                {},
                copy_of<BvhNode>(file, SectionId::piece_nodes)};
    for (const PieceLeaf& leaf : leaves) {
        for (std::uint32_t lane = 0; lane < kBvhWidth; ++lane) {
            const std::uint32_t at = leaf.first_triangle + std::min(lane, leaf.count - 1);
            assert(leaf.count > 0 && at < listed.size());
            pieces.triangles.push_back(tree.triangles[listed[at]]);
        }
    }
    return pieces;
}

Found find_unmarked_degenerate(Bytes file, const Tree& tree) {
    const auto bits = copy_of<std::uint64_t>(file, SectionId::degenerate_bits);
    for (std::size_t i = 0; i < tree.triangles.size(); ++i) {
        const auto& v = tree.triangles[i].vertex;
        const bool repeats = v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
        const bool marked = i / 64 < bits.size() && ((bits[i / 64] >> (i % 64)) & 1) != 0;
        if (repeats && !marked) {
            return Damage{DamageKind::bad_fact, SectionId::degenerate_bits,
                          place_of(file, SectionId::triangles, i), 0, 1};
        }
    }
    return std::nullopt;
}

Found find_outside_bounds(Bytes file, const Tree& tree) {
    for (const Bounds& bounds : copy_of<Bounds>(file, SectionId::bounds)) {
        for (std::size_t i = 0; i < tree.positions.size(); ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double x = coordinate(tree.positions[i], axis);
                if (x < coordinate(bounds.lower, axis) || x > coordinate(bounds.upper, axis)) {
                    return Damage{DamageKind::bad_fact, SectionId::bounds,
                                  place_of(file, SectionId::bounds, 0), i, 0};
                }
            }
        }
    }
    return std::nullopt;
}

/// Compares the header's hash with the table's entries.
Found find_wrong_hash(Bytes file) {
    const FileHeader header = read_header(file);
    std::vector<SectionEntry> entries(header.section_count);
    if (!entries.empty()) {
        std::memcpy(entries.data(), file.data() + kSectionTableOffset,
                    entries.size() * sizeof(SectionEntry));
    }
    const std::uint64_t hash = content_hash(header, entries);
    if (hash == header.content_hash) return std::nullopt;
    return Damage{DamageKind::bad_fact, SectionId{0}, offsetof(FileHeader, content_hash),
                  header.content_hash, hash};
}

}  // namespace

std::optional<Damage> find_deep_damage(std::span<const std::byte> file) {
    const FloatEnvironment environment;
    if (const Found damage = find_damage(file)) return damage;
    if (const Found damage = find_wrong_hash(file)) return damage;
    if (const Found damage = find_repeated(file, SectionId::source_triangle)) return damage;
    if (const Found damage = find_repeated(file, SectionId::piece_triangles)) return damage;
    Tree tree{read_header(file), {}, positions_of(file), {}, {}};
    tree.shape = bvh_shape(tree.header.triangle_count);
    tree.triangles = copy_of<Triangle>(file, SectionId::triangles);
    tree.nodes = copy_of<BvhNode>(file, SectionId::bvh_nodes);
    if (!tree.nodes.empty()) {
        if (const Found damage = find_loose_box(file, SectionId::bvh_nodes, tree)) return damage;
    }
    if (const Found damage = find_wrong_leaf(file, tree)) return damage;
    if (const Found damage = find_loose_oriented(file, tree)) return damage;
    if (const Found damage = find_loose_swept(file, SectionId::swept_nodes, tree)) return damage;
    if (const Found damage = find_unmarked_degenerate(file, tree)) return damage;
    if (find_section(file, SectionId::piece_leaves)) {
        if (const Found damage = find_twice_held(file)) return damage;
        const Tree pieces = piece_tree(file, tree);
        if (const Found damage = find_loose_box(file, SectionId::piece_nodes, pieces)) {
            return damage;
        }
        if (const Found damage = find_loose_swept(file, SectionId::piece_swept, pieces)) {
            return damage;
        }
    }
    return find_outside_bounds(file, tree);
}

}  // namespace cdprep::format
