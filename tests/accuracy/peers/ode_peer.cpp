// SPDX-License-Identifier: MIT
#ifdef CDPREP_HAVE_ODE
#include <ode/ode.h>

#include <array>

#include "accuracy/peers/peer.h"

// Its trimeshes are OPCODE's.
namespace cdprep::test {
namespace {

/// A trimesh of ODE, which points into what it is made of.
class Trimesh {
public:
    explicit Trimesh(const TestMesh& mesh) {
        for (const Double3& p : mesh.positions) {
            for (const double x : {p.x, p.y, p.z}) points_.push_back(static_cast<float>(x));
        }
        for (const Triangle& t : mesh.triangles) {
            corners_.insert(corners_.end(), t.vertex.begin(), t.vertex.end());
        }
        // OPCODE has no tree of one triangle, and ODE asks for it.
        if (mesh.triangles.size() == 1) {
            const auto& only = mesh.triangles[0].vertex;
            corners_.insert(corners_.end(), only.begin(), only.end());
        }
        data_ = dGeomTriMeshDataCreate();
        dGeomTriMeshDataBuildSingle(data_, points_.data(), 3 * sizeof(float),
                                    static_cast<int>(points_.size() / 3), corners_.data(),
                                    static_cast<int>(corners_.size()), 3 * sizeof(dTriIndex));
        geom_ = dCreateTriMesh(nullptr, data_, nullptr, nullptr, nullptr);
    }
    Trimesh(const Trimesh&) = delete;
    Trimesh& operator=(const Trimesh&) = delete;
    ~Trimesh() {
        dGeomDestroy(geom_);
        dGeomTriMeshDataDestroy(data_);
    }
    [[nodiscard]] dGeomID geom() const {
        return geom_;
    }

private:
    std::vector<float> points_;
    std::vector<dTriIndex> corners_;
    dTriMeshDataID data_ = nullptr;
    dGeomID geom_ = nullptr;
};

PeerAnswer collide(const TestMesh& a, const TestMesh& b) {
    const Trimesh mesh_a(a), mesh_b(b);
    std::array<dContactGeom, 256> contacts{};
    const int count = dCollide(mesh_a.geom(), mesh_b.geom(), static_cast<int>(contacts.size()),
                               contacts.data(), sizeof(dContactGeom));
    return {count > 0, std::nullopt};
}

}  // namespace

void add_ode(std::vector<Peer>& peers) {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    peers.push_back({"ODE-OPCODE", collide});
}

}  // namespace cdprep::test
#endif
