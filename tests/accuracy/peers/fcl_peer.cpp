// SPDX-License-Identifier: MIT
#ifdef CDPREP_HAVE_FCL
#include <fcl/fcl.h>

#include <cmath>

#include "accuracy/peers/peer.h"
#include "support/small_hull.h"

namespace cdprep::test {
namespace {

template <class Volume>
fcl::BVHModel<Volume> model_of(const TestMesh& mesh) {
    std::vector<fcl::Vector3d> points;
    for (const Double3& p : mesh.positions) points.emplace_back(p.x, p.y, p.z);
    std::vector<fcl::Triangle> triangles;
    for (const Triangle& t : mesh.triangles) {
        triangles.emplace_back(t.vertex[0], t.vertex[1], t.vertex[2]);
    }
    fcl::BVHModel<Volume> made;
    made.beginModel();
    made.addSubModel(points, triangles);
    made.endModel();
    return made;
}

PeerAnswer collide(const TestMesh& a, const TestMesh& b) {
    const auto model_a = model_of<fcl::OBBd>(a), model_b = model_of<fcl::OBBd>(b);
    constexpr std::size_t kMost = 1 << 20;
    fcl::CollisionResultd result;
    fcl::collide(&model_a, fcl::Transform3d::Identity(), &model_b, fcl::Transform3d::Identity(),
                 fcl::CollisionRequestd(kMost, false), result);
    PeerAnswer answer = {result.isCollision(), std::vector<TrianglePair>()};
    for (std::size_t i = 0; i < result.numContacts(); ++i) {
        const auto& contact = result.getContact(i);
        answer.pairs->push_back(
            {static_cast<std::uint32_t>(contact.b1), static_cast<std::uint32_t>(contact.b2)});
    }
    return answer;
}

double distance(const TestMesh& a, const TestMesh& b) {
    const auto model_a = model_of<fcl::RSSd>(a), model_b = model_of<fcl::RSSd>(b);
    fcl::DistanceResultd result;
    return fcl::distance(&model_a, fcl::Transform3d::Identity(), &model_b,
                         fcl::Transform3d::Identity(), fcl::DistanceRequestd(false, false, 0, 0),
                         result);
}

fcl::Convexd convex_of(const Points& points) {
    const SmallHull hull(points);
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (const Double3& p : hull.points()) vertices->emplace_back(p.x, p.y, p.z);
    auto faces = std::make_shared<std::vector<int>>();
    for (const auto& t : hull.triangles()) {
        faces->push_back(3);
        for (const std::uint32_t v : t) faces->push_back(static_cast<int>(v));
    }
    return fcl::Convexd(vertices, static_cast<int>(hull.triangles().size()), faces);
}

bool hulls_collide(const Points& a, const Points& b, fcl::GJKSolverType solver) {
    auto hull_a = convex_of(a), hull_b = convex_of(b);
    fcl::CollisionRequestd request(1, false);
    request.gjk_solver_type = solver;
    fcl::CollisionResultd result;
    fcl::collide(&hull_a, fcl::Transform3d::Identity(), &hull_b, fcl::Transform3d::Identity(),
                 request, result);
    return result.isCollision();
}

double hull_distance(const Points& a, const Points& b, fcl::GJKSolverType solver) {
    auto hull_a = convex_of(a), hull_b = convex_of(b);
    fcl::DistanceRequestd request(false, true, 0, 0);
    request.gjk_solver_type = solver;
    fcl::DistanceResultd result;
    fcl::distance(&hull_a, fcl::Transform3d::Identity(), &hull_b, fcl::Transform3d::Identity(),
                  request, result);
    return result.min_distance;
}

fcl::Transform3d in_fcl(const Pose& pose) {
    fcl::Transform3d transform = fcl::Transform3d::Identity();
    const auto& r = pose.rotation();
    for (int i = 0; i < 9; ++i) transform.linear()(i / 3, i % 3) = r[static_cast<std::size_t>(i)];
    const Double3 t = pose.translation();
    transform.translation() = fcl::Vector3d(t.x, t.y, t.z);
    return transform;
}

template <class Shape>
PeerContacts contacts_of(const HardContact& hard, const Shape& a, const Shape& b,
                         fcl::GJKSolverType solver) {
    constexpr std::size_t kMost = 1 << 16;
    fcl::CollisionRequestd request(kMost, true);
    request.gjk_solver_type = solver;
    fcl::CollisionResultd result;
    fcl::collide(&a, in_fcl(hard.a.pose), &b, in_fcl(hard.b.pose), request, result);
    std::vector<PeerContact> found;
    for (std::size_t i = 0; i < result.numContacts(); ++i) {
        const auto& contact = result.getContact(i);
        const auto& n = contact.normal;
        // Its two solvers give depths of different signs.
        found.push_back({{n[0], n[1], n[2]}, -std::fabs(contact.penetration_depth)});
    }
    return found;
}

PeerContacts mesh_contacts(const HardContact& hard) {
    return contacts_of(hard, model_of<fcl::OBBd>(*hard.a.mesh), model_of<fcl::OBBd>(*hard.b.mesh),
                       fcl::GST_LIBCCD);
}

PeerContacts hull_contacts(const HardContact& hard, fcl::GJKSolverType solver) {
    return contacts_of(hard, convex_of(hard.a.mesh->positions), convex_of(hard.b.mesh->positions),
                       solver);
}

}  // namespace

void add_fcl(std::vector<Peer>& peers) {
    Peer meshes = {"FCL", collide, distance};
    meshes.contacts = mesh_contacts;
    peers.push_back(meshes);
    for (const auto& [name, solver] :
         {std::pair("FCL-libccd", fcl::GST_LIBCCD), std::pair("FCL-indep", fcl::GST_INDEP)}) {
        Peer peer = {name};
        peer.takes_flat_hulls = false;  // its Convex is a body of triangles
        peer.hulls_collide = [solver = solver](const Points& a, const Points& b) {
            return hulls_collide(a, b, solver);
        };
        peer.hull_distance = [solver = solver](const Points& a, const Points& b) {
            return hull_distance(a, b, solver);
        };
        peer.takes_two_hulls = true;
        peer.contacts = [solver = solver](const HardContact& hard) {
            return hull_contacts(hard, solver);
        };
        peers.push_back(peer);
    }
}

}  // namespace cdprep::test
#endif
