// SPDX-License-Identifier: MIT
// Reads what cdprep exported as simulators read it, and prints what they found as JSON:
// OBJ and GLB by assimp, MJCF and URDF by MuJoCo, SDF by SDFormat, the reader of Gazebo.
// Usage: simulator_readers FILE; exits with 1, and says why, when it is refused.
#include <mujoco/mujoco.h>

#include <array>
#include <assimp/Importer.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sdf/sdf.hh>
#include <string>

#include <assimp/scene.h>

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& why) {
    std::fprintf(stderr, "%s\n", why.c_str());
    std::exit(1);
}

Json point(double x, double y, double z) {
    return Json::array({x, y, z});
}

/// The nodes that have a mesh, in order.
void collect(const aiScene& scene, const aiNode& node, Json& parts) {
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
        Json vertices = Json::array();
        Json facets = Json::array();
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const aiVector3D& p = mesh.mVertices[v];
            vertices.push_back(point(p.x, p.y, p.z));
        }
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            facets.push_back(
                std::vector<unsigned>(face.mIndices, face.mIndices + face.mNumIndices));
        }
        parts.push_back({{"name", node.mName.C_Str()},
                         {"parent", node.mParent != nullptr ? node.mParent->mName.C_Str() : ""},
                         {"vertices", std::move(vertices)},
                         {"facets", std::move(facets)}});
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) collect(scene, *node.mChildren[i], parts);
}

Json read_by_assimp(const fs::path& path) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path.string(), 0);
    if (scene == nullptr) refuse(importer.GetErrorString());
    Json parts = Json::array();
    collect(*scene, *scene->mRootNode, parts);
    return {{"reader", "assimp"}, {"parts", std::move(parts)}};
}

/// Mass, centre and moments of the one body, and its shapes with what MuJoCo's own hull kept.
Json read_by_mujoco(const fs::path& path) {
    std::array<char, 1000> why = {};
    const std::unique_ptr<mjModel, void (*)(mjModel*)> model(
        mj_loadXML(path.c_str(), nullptr, why.data(), static_cast<int>(why.size())),
        mj_deleteModel);
    if (!model) refuse(why.data());
    Json parts = Json::array();
    for (int i = 0; i < model->ngeom; ++i) {
        const int mesh = model->geom_dataid[i];
        if (mesh < 0) refuse("a shape is no mesh");
        const char* name = mj_id2name(model.get(), mjOBJ_GEOM, i);
        parts.push_back({{"name", name != nullptr ? name : ""},
                         {"vertices", model->mesh_vertnum[mesh]},
                         {"collides", model->geom_contype[i] != 0}});
    }
    const int body = model->nbody - 1;
    const mjtNum* centre = model->body_ipos + 3 * body;
    const mjtNum* moments = model->body_inertia + 3 * body;
    return {{"reader", "MuJoCo"},
            {"bodies", model->nbody},
            {"positions", model->nq},
            {"mass", model->body_mass[body]},
            {"centre", point(centre[0], centre[1], centre[2])},
            {"moments", point(moments[0], moments[1], moments[2])},
            {"parts", std::move(parts)}};
}

Json shape(const std::string& name, const sdf::Geometry& geometry) {
    const sdf::Mesh* mesh = geometry.MeshShape();
    if (mesh == nullptr) refuse(name + " is no mesh");
    const auto& scale = mesh->Scale();
    return {
        {"name", name}, {"file", mesh->Uri()}, {"scale", point(scale.X(), scale.Y(), scale.Z())}};
}

Json read_by_sdformat(const fs::path& path) {
    sdf::Root root;
    const sdf::Errors errors = root.Load(path.string());
    if (!errors.empty()) refuse(errors.front().Message());
    const sdf::Model* model = root.Model();
    if (model == nullptr || model->LinkCount() != 1) refuse("not one model of one link");
    const sdf::Link& link = *model->LinkByIndex(0);
    const auto& inertial = link.Inertial();
    const auto moments = inertial.MassMatrix().DiagonalMoments();
    const auto off = inertial.MassMatrix().OffDiagonalMoments();
    const auto& centre = inertial.Pose().Pos();
    Json parts = Json::array();
    Json shown = Json::array();
    for (std::uint64_t i = 0; i < link.CollisionCount(); ++i) {
        const sdf::Collision& collision = *link.CollisionByIndex(i);
        parts.push_back(shape(collision.Name(), *collision.Geom()));
    }
    for (std::uint64_t i = 0; i < link.VisualCount(); ++i) {
        const sdf::Visual& visual = *link.VisualByIndex(i);
        shown.push_back(shape(visual.Name(), *visual.Geom()));
    }
    return {{"reader", "SDFormat"},
            {"model", model->Name()},
            {"mass", inertial.MassMatrix().Mass()},
            {"is_valid", inertial.MassMatrix().IsValid()},
            {"centre", point(centre.X(), centre.Y(), centre.Z())},
            {"inertia", Json::array({moments.X(), moments.Y(), moments.Z(), off.X(), off.Z(),
                                     off.Y()})},  // xx yy zz xy yz zx
            {"parts", std::move(parts)},
            {"shown", std::move(shown)}};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) refuse("usage: simulator_readers FILE");
    const fs::path path = argv[1];
    const std::string kind = path.extension().string();
    Json found;
    if (kind == ".obj" || kind == ".glb") found = read_by_assimp(path);
    if (kind == ".urdf" || kind == ".mjcf" || kind == ".xml") found = read_by_mujoco(path);
    if (kind == ".sdf") found = read_by_sdformat(path);
    if (found.is_null()) refuse("no reader for " + kind);
    std::puts(found.dump().c_str());
    return 0;
}
