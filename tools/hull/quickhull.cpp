// SPDX-License-Identifier: GPL-3.0-or-later
#include "hull/quickhull.h"

#include <limits>
#include <utility>

#include "cdprep/exact/predicates.h"

// Points in front of no new face can be dropped. Proof: let q have been in front of a removed
// face f. Let q be outside the new hull, in front of one of its faces g. If g is not new, it
// existed before, and q saw f and g. The faces that q sees are connected. So q sees both faces
// at some edge of the horizon, one removed and one kept. The new face at that edge lies in the
// wedge between the two planes, including the kept face's plane. Its normal is a sum of their
// normals, so q is in front of it too.
//
// CGAL::convex_hull_3 is exact too, but takes about twice as long on points of a sphere.
namespace cdprep::convex {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct Face {
    HullFace links;
    exact::Plane plane;
    std::uint32_t outside = kNone;   ///< the first point in front of this face
    std::uint32_t farthest = kNone;  ///< of these points
    double height = 0;               ///< of that point
    bool removed = false;
};

/// An edge between visible and other faces.
struct HorizonEdge {
    std::uint32_t from, to;  ///< in the direction of the removed face
    std::uint32_t kept;      ///< the face beyond, which is kept
};

class Quickhull {
public:
    Quickhull(std::span<const Double3> points, const std::array<std::uint32_t, 4>& first)
        : points_(points), next_(points.size(), kNone), face_from_(points.size(), kNone) {
        add_tetrahedron(first);
        for (std::uint32_t p = 0; p < points.size(); ++p) hand_out(p, 0);
        for (std::uint32_t f = 0; f < faces_.size(); ++f) grow_from(f);
    }

    [[nodiscard]] std::vector<HullFace> faces() const {
        std::vector<std::uint32_t> place(faces_.size(), kNone);
        std::vector<HullFace> left;
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            if (faces_[f].removed) continue;
            place[f] = static_cast<std::uint32_t>(left.size());
            left.push_back(faces_[f].links);
        }
        for (HullFace& face : left) {
            for (std::uint32_t& across : face.across) across = place[across];
        }
        return left;
    }

private:
    void add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                  const std::array<std::uint32_t, 3>& across) {
        faces_.push_back({{{a, b, c}, across}, {points_[a], points_[b], points_[c]}});
    }

    void add_tetrahedron(const std::array<std::uint32_t, 4>& first) {
        auto [a, b, c, d] = first;
        if (exact::orient3d(points_[a], points_[b], points_[c], points_[d]) < 0) std::swap(b, c);
        add_face(a, b, c, {1, 2, 3});
        add_face(b, a, d, {0, 3, 2});
        add_face(c, b, d, {0, 1, 3});
        add_face(a, c, d, {0, 2, 1});
    }

    /// Gives a point to the first face, from `first` on, that it is in front of, if any.
    void hand_out(std::uint32_t p, std::size_t first) {
        for (std::size_t f = first; f < faces_.size(); ++f) {
            Face& face = faces_[f];
            if (face.plane.side(points_[p]) >= 0) continue;
            const double height = face.plane.height(points_[p]);
            if (face.outside == kNone || height > face.height) {
                face.farthest = p;
                face.height = height;
            }
            next_[p] = face.outside;
            face.outside = p;
            return;
        }
    }

    void grow_from(std::uint32_t f) {
        if (faces_[f].removed || faces_[f].outside == kNone) return;
        const std::uint32_t p = faces_[f].farthest;
        find_visible(f, p);
        const std::size_t first = faces_.size();
        add_cone(p);
        for (const std::uint32_t seen : visible_) hand_on(seen, p, first);
    }

    /// Marks the faces that `p` sees as removed; starts with a face that it does see.
    void find_visible(std::uint32_t f, std::uint32_t p) {
        visible_.assign(1, f);
        horizon_.clear();
        faces_[f].removed = true;
        for (std::size_t i = 0; i < visible_.size(); ++i) {
            const HullFace links = faces_[visible_[i]].links;
            for (std::size_t edge = 0; edge < 3; ++edge) {
                Face& other = faces_[links.across[edge]];
                if (other.removed) continue;  // just now: faces removed earlier are no neighbours
                if (other.plane.side(points_[p]) < 0) {
                    other.removed = true;
                    visible_.push_back(links.across[edge]);
                } else {
                    horizon_.push_back(
                        {links.corner[edge], links.corner[(edge + 1) % 3], links.across[edge]});
                }
            }
        }
    }

    /// The horizon is one simple ring, so the start of an edge identifies it.
    void add_cone(std::uint32_t p) {
        const auto first = static_cast<std::uint32_t>(faces_.size());
        for (const HorizonEdge& edge : horizon_) {
            const auto number = static_cast<std::uint32_t>(faces_.size());
            face_from_[edge.from] = number;
            HullFace& kept = faces_[edge.kept].links;
            for (std::size_t i = 0; i < 3; ++i) {
                if (kept.corner[i] == edge.to) kept.across[i] = number;
            }
            add_face(edge.from, edge.to, p, {edge.kept, kNone, kNone});
        }
        for (std::uint32_t f = first; f < faces_.size(); ++f) {
            const std::uint32_t after = face_from_[faces_[f].links.corner[1]];
            faces_[f].links.across[1] = after;
            faces_[after].links.across[2] = f;
        }
    }

    /// Gives the points of a removed face, except the new corner, to the new faces.
    void hand_on(std::uint32_t seen, std::uint32_t corner, std::size_t first) {
        std::uint32_t p = std::exchange(faces_[seen].outside, kNone);
        while (p != kNone) {
            const std::uint32_t next = next_[p];
            if (p != corner) hand_out(p, first);
            p = next;
        }
    }

    std::span<const Double3> points_;
    std::vector<Face> faces_;               ///< with removed faces: a face's number never changes
    std::vector<std::uint32_t> next_;       ///< by point: the next one of the same face
    std::vector<std::uint32_t> face_from_;  ///< by point: the new face at the edge from it
    std::vector<std::uint32_t> visible_;
    std::vector<HorizonEdge> horizon_;
};

}  // namespace

std::vector<HullFace> quickhull(std::span<const Double3> points,
                                const std::array<std::uint32_t, 4>& first) {
    return Quickhull(points, first).faces();
}

}  // namespace cdprep::convex
