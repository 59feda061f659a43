// SPDX-License-Identifier: MIT
// S16 and K: contacts of two models, through the hierarchy and through pieces. Truths are known
// by construction: directions, gaps and depths. Each contact is also tested by itself: along its
// normal, B's vertices are as far beyond A's as it says.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "accuracy/hard_cases.h"
#include "accuracy/in_mode.h"
#include "support/hard_contacts.h"
#include "unit/tools/with_pieces.h"

#include "cdprep/contacts.h"

namespace cdprep::test {
namespace {

constexpr double kAngle = 1e-6;  ///< radians between a normal and the nearest right one

bool is_finite(const Double3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double distance_between(const Double3& a, const Double3& b) {
    return length_of({a.x - b.x, a.y - b.y, a.z - b.z});
}

/// Of a flat polygon of up to four corners in any order.
double area_of(const std::vector<Double3>& corners) {
    const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
        const Double3 p = corners[a], q = corners[b], r = corners[c];
        const double pq = distance_between(p, q), pr = distance_between(p, r);
        return pq * pr *
               std::sin(angle_between({q.x - p.x, q.y - p.y, q.z - p.z},
                                      {r.x - p.x, r.y - p.y, r.z - p.z})) /
               2;
    };
    if (corners.size() != 4) return 0;
    // Whichever two are opposite, a convex one is covered twice by all its triangles.
    return (triangle(0, 1, 2) + triangle(0, 1, 3) + triangle(0, 2, 3) + triangle(1, 2, 3)) / 2;
}

double area_of_outline(const std::vector<Double3>& outline) {
    double area = 0;
    for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
        const Double3 p = outline[0], q = outline[i], r = outline[i + 1];
        area += distance_between(p, q) * distance_between(p, r) *
                std::sin(angle_between({q.x - p.x, q.y - p.y, q.z - p.z},
                                       {r.x - p.x, r.y - p.y, r.z - p.z})) /
                2;
    }
    return area;
}

/// A model with pieces, and its vertices in the order of the file.
struct Baked {
    explicit Baked(const ContactBody& body)
        : open(open_with_pieces(*body.mesh,
                                body.in_triangles ? PiecesOf::triangles : PiecesOf::surface)),
          positions(builder_input(open.model).positions) {}

    /// The corners of a piece's hull, moved.
    [[nodiscard]] std::vector<Double3> points_of(std::uint32_t piece, const Pose& pose) const {
        const PieceView& pieces = open.model.pieces();
        const std::size_t end = piece + 1 < pieces.pieces.size()
                                    ? pieces.pieces[piece + 1].first_vertex
                                    : pieces.vertices.size();
        std::vector<Double3> points;
        for (std::size_t i = pieces.pieces[piece].first_vertex; i < end; ++i) {
            points.push_back(transform_point(pose, positions[pieces.vertices[i]]));
        }
        return points;
    }

    OpenModel open;
    std::vector<Double3> positions;
};

/// Models are baked once, however many cases use them.
class Models {
public:
    const Baked& of(const ContactBody& body) {
        const auto [at, is_new] = baked_.try_emplace({body.mesh.get(), body.in_triangles}, nullptr);
        if (is_new) at->second = std::make_unique<Baked>(body);
        return *at->second;
    }

private:
    std::map<std::pair<const TestMesh*, bool>, std::unique_ptr<Baked>> baked_;
};

/// One way to ask about one case.
class Asker {
public:
    Asker(const HardContact& hard, const Baked& a, const Baked& b, Structure through, Tally& tally)
        : hard_(hard), a_(a), b_(b), through_(through), tally_(tally), rounding_(hard.rounding()) {}

    void ask(Workspace& workspace) {
        const Pair pair = {a_.open.model, b_.open.model, hard_.placement(), {.through = through_}};
        const ContactOptions options = {.tolerance = hard_.tolerance, .manifold = Manifold::four};
        std::vector<Contact> found(
            in_mode([&] { return contacts(pair, workspace, {}, options); }).found);
        const ContactsVerdict verdict =
            in_mode([&] { return contacts(pair, workspace, found, options); });
        expect("a list that is not whole", verdict.complete && verdict.count == found.size());
        expect_form(found);
        // What is met from behind is not to push.
        std::erase_if(found, [](const Contact& c) { return (c.flags & contact_from_behind) != 0; });
        expect_normals(found);
        expect_depths(found);
        if (hard_.a.is_convex && hard_.b.is_convex) {
            expect("other than one contact", found.size() == 1);
            for (const Contact& contact : found) expect_convex(contact);
        } else {
            expect_pieces(found);
        }
        if (!hard_.outline.empty() && !found.empty()) expect_outline(found[0]);
    }

private:
    void expect(const char* what, bool is_right) {
        tally_.expect(is_right, [&] { return hard_.id + ": " + what; });
    }

    /// Numbers are numbers, in order, and normals have a length of 1.
    void expect_form(const std::vector<Contact>& found) {
        expect("a broken contact", std::all_of(found.begin(), found.end(), [](const Contact& c) {
                   bool is_right = is_finite(c.point_a) && is_finite(c.point_b) &&
                                   std::fabs(length_of(c.normal) - 1) < 1e-12 &&
                                   std::isfinite(c.lower) && c.lower <= c.upper &&
                                   c.point_count >= 1 && c.point_count <= kMostManifoldPoints;
                   for (std::size_t i = 0; is_right && i < c.point_count; ++i) {
                       is_right = is_finite(c.points[i].on_a) && is_finite(c.points[i].on_b) &&
                                  std::isfinite(c.points[i].distance);
                   }
                   return is_right && ((c.flags & contact_overlap) == 0 || c.upper <= 0);
               }));
    }

    void expect_normals(const std::vector<Contact>& found) {
        if (hard_.normals.empty()) return;
        bool is_signed = true, is_near = true;
        for (const Contact& contact : found) {
            double angle = 4;
            for (const Double3& normal : hard_.normals) {
                angle = std::min(angle, angle_between(contact.normal, normal));
            }
            is_signed = is_signed && angle < 1.57;
            is_near = is_near && angle <= kAngle;
        }
        expect("a normal of the wrong sign", is_signed);
        expect("a ghost normal", is_near);
    }

    /// The deepest is as deep as all of B in all of A, or as far away.
    void expect_depths(const std::vector<Contact>& found) {
        double lower = INFINITY;
        for (const Contact& contact : found) lower = std::min(lower, contact.lower);
        expect("a wrong depth", std::fabs(lower - hard_.separation) <= rounding_);
    }

    void expect_convex(const Contact& contact) {
        const auto told = [&] { return hard_.id + ": a wide interval"; };
        const double separation = hard_.separation;
        expect("an interval without the truth",
               contact.lower <= separation + rounding_ && contact.upper >= separation - rounding_);
        // Of gaps as convex_distance() promises; of overlaps equal up to rounding.
        tally_.expect_narrow(
            contact.upper - contact.lower,
            1e-12 * std::fabs(separation) + (separation > 0 ? 1e-13 : 1e-11) * hard_.largest(),
            told);
        // A motion along the normal by what it says, and no more, takes B out of A.
        const auto far =
            static_cast<double>(reach(contact.normal, hard_.points_a(), hard_.points_b()));
        expect("a way that does not separate", far >= contact.lower - rounding_);
        expect("a way that is not the shortest", far >= separation - rounding_);
        expect("an overlap for a gap, or none",
               std::fabs(separation) <= rounding_ ||
                   ((contact.flags & contact_overlap) != 0) == (separation < 0));
    }

    /// The one plane side pushes each piece of the other no farther than by its own depth.
    void expect_pieces(const std::vector<Contact>& found) {
        const Double3 normal = hard_.normals.front();
        expect("no contact", !found.empty());
        bool is_right = true;
        for (const Contact& contact : found) {
            const auto far =
                static_cast<double>(reach(normal, a_.points_of(contact.piece_a, hard_.a.pose),
                                          b_.points_of(contact.piece_b, hard_.b.pose)));
            is_right = is_right && contact.lower >= far - rounding_;
        }
        expect("a piece pushed too far", is_right);
    }

    /// The points are corners of what faces share; all four of a square, and of more corners those
    /// that span at least half of it.
    void expect_outline(const Contact& contact) {
        std::vector<Double3> corners;
        bool is_right = contact.point_count == 4;
        for (std::size_t i = 0; i < contact.point_count; ++i) {
            const ManifoldPoint& point = contact.points[i];
            double nearest = INFINITY;
            const Double3 on = (hard_.is_swapped ? point.on_b : point.on_a);
            for (const Double3& corner : hard_.outline) {
                nearest = std::min(nearest, distance_between(on, corner));
            }
            is_right = is_right && nearest <= kCorners * rounding_ &&
                       std::fabs(point.distance - hard_.separation) <= rounding_;
            corners.push_back(on);
        }
        expect("points that are no corners", is_right);
        const double share = area_of(corners) / area_of_outline(hard_.outline);
        constexpr double kAll = 0.999;
        expect("points that do not span the face",
               share >= (hard_.outline.size() == 4 ? kAll : 0.5));
    }
    /// Where sides cross at an angle of 7 degrees, corners are as much farther off.
    static constexpr double kCorners = 16;

    const HardContact& hard_;
    const Baked& a_;
    const Baked& b_;
    Structure through_;
    Tally& tally_;
    double rounding_;
};

}  // namespace

void score_contacts(const HardCaseOptions& options, Scoreboard& board) {
    Models models;
    Workspace workspace;
    for (const HardContact& hard : hard_contacts(options.family)) {
        const Baked &a = models.of(hard.a), &b = models.of(hard.b);
        for (const auto& [through, name] :
             {std::pair(Structure::bvh, "bvh"), std::pair(Structure::pieces, "pieces")}) {
            Asker(hard, a, b, through, board.of(hard.id, name)).ask(workspace);
        }
    }
}

}  // namespace cdprep::test
