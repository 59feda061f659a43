// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/DefaultLogger.hpp>
#include <assimp/IOStream.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <charconv>
#include <cstring>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "input_files.h"

namespace cdprep::import {
namespace {

/// Opens for assimp the files that it may read, and records the opened and the missing ones.
class FolderFiles : public Assimp::DefaultIOSystem {
public:
    explicit FolderFiles(InputFiles& files) : files_(files) {}

    bool Exists(const char* name) const override {
        if (files_.find(name)) return true;
        files_.note_missing(name);
        return false;
    }

    Assimp::IOStream* Open(const char* name, const char* mode) override {
        const bool reads = std::strchr(mode, 'r') && !std::strchr(mode, '+');
        Assimp::IOStream* const stream =
            reads && Exists(name) ? DefaultIOSystem::Open(name, mode) : nullptr;
        if (stream) files_.note_opened(name, stream->FileSize());
        return stream;
    }

private:
    InputFiles& files_;
};

/// Keeps the first message of assimp that it skipped a mesh or node of a COLLADA file. It then
/// returns the rest as if the file were whole.
class SkippedParts : public Assimp::LogStream {
public:
    void write(const char* message) override {
        const std::string_view text(message);
        for (const std::string_view start : {"Unable to find geometry", "Unable to resolve ref"}) {
            const std::size_t at = text.find(start);
            if (!first_.empty() || at == text.npos) continue;
            first_ = text.substr(at, std::min(text.find(". Skip"), text.find('\n')) - at);
        }
    }

    [[nodiscard]] const std::string& first() const noexcept {
        return first_;
    }

private:
    std::string first_;
};

std::string_view text_of(const aiString& text) {
    return {text.data, std::min<std::size_t>(text.length, sizeof text.data)};
}

Scene::Mesh to_mesh(const aiMesh& mesh) {
    Scene::Mesh result;
    result.material = mesh.mMaterialIndex;
    for (unsigned i = 0; mesh.HasPositions() && i < mesh.mNumVertices; ++i) {
        const aiVector3D& p = mesh.mVertices[i];
        result.vertices.push_back({p.x, p.y, p.z});
    }
    for (unsigned i = 0; mesh.mFaces && i < mesh.mNumFaces; ++i) {
        const aiFace& face = mesh.mFaces[i];
        result.sizes.push_back(face.mNumIndices);
        result.corners.insert(result.corners.end(), face.mIndices,
                              face.mIndices + face.mNumIndices);
    }
    return result;
}

/// Returns true if bones or morph targets would move vertices of a mesh.
bool is_unposed(const aiMesh& mesh) {
    const auto counts = [](const aiAnimMesh* target) { return target && target->mWeight != 0; };
    return mesh.mNumBones > 0 ||
           (mesh.mAnimMeshes &&
            std::any_of(mesh.mAnimMeshes, mesh.mAnimMeshes + mesh.mNumAnimMeshes, counts));
}

Scene::Node to_node(const aiNode& node, std::uint32_t parent) {
    Scene::Node result;
    result.name = text_of(node.mName);
    result.parent = parent;
    for (unsigned row = 0; row < 4; ++row) {
        for (unsigned column = 0; column < 4; ++column) {
            result.parent_from_node[4 * row + column] = node.mTransformation[row][column];
        }
    }
    result.meshes.assign(node.mMeshes, node.mMeshes + node.mNumMeshes);
    return result;
}

/// Returns the nodes depth first. It uses no recursion, because trees may be deeper than the stack.
std::vector<Scene::Node> to_nodes(const aiNode* root) {
    struct Pending {
        const aiNode* node;
        std::uint32_t parent;
    };
    std::vector<Scene::Node> nodes;
    std::vector<Pending> pending;
    if (root) pending.push_back({root, kNoParent});
    while (!pending.empty()) {
        const Pending top = pending.back();
        pending.pop_back();
        const auto number = static_cast<std::uint32_t>(nodes.size());
        nodes.push_back(to_node(*top.node, top.parent));
        for (unsigned i = top.node->mNumChildren; i-- > 0;) {
            pending.push_back({top.node->mChildren[i], number});
        }
    }
    return nodes;
}

/// Returns the number of the file that assimp rounded to a float, if it has few digits.
double unrounded(float number) {
    std::array<char, 32> digits{};
    char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    double found = number;
    std::from_chars(digits.data(), end, found);
    return found;
}

/// Sets units and up axis, as far as assimp provides them.
void describe_space(const aiMetadata& metadata, Scene& scene) {
    // The unit of FBX is a centimetre. A product with 0.01 would be rounded once more.
    constexpr double kCentimetresPerMetre = 100;
    float factor = 0;
    double exact_factor = 0;
    if (metadata.Get("UnitScaleFactor", exact_factor) && exact_factor > 0) {
        scene.metres_per_unit = exact_factor / kCentimetresPerMetre;
    } else if (metadata.Get("UnitScaleFactor", factor) && factor > 0) {
        scene.metres_per_unit = unrounded(factor) / kCentimetresPerMetre;
    }
    std::int32_t axis = 0;
    if (metadata.Get("UpAxis", axis) && axis >= 0 && axis <= 2) {
        scene.up_axis = static_cast<format::UpAxis>(axis + 1);  // UpAxis::x is 1
    }
    aiString importer;
    const bool named = metadata.Get("SourceAsset_Format", importer);
    if (named && text_of(importer).starts_with("glTF")) {
        scene.metres_per_unit = 1;  // fixed by glTF
        scene.up_axis = format::UpAxis::y;
    }
    // assimp scales the root by the unit; in COLLADA the root has no transform.
    if (named && text_of(importer).starts_with("Collada") && !scene.nodes.empty()) {
        scene.nodes.front().parent_from_node = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    }
}

}  // namespace

Scene read_assimp(const std::string& path, InputFiles& files) {
    // Never destroyed: destroying some of its scenes crashes, and the process ends anyway. It is
    // static so that leak checkers see that it is reachable.
    static Assimp::Importer& importer = *new Assimp::Importer;
    importer.SetIOHandler(new FolderFiles(files));  // the importer owns it
    // A head alone is a model; the rest of the body may be missing.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_MD3_HANDLE_MULTIPART, false);
    // A file of bones without a mesh has no triangles.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyInteger(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, 1);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, false);
    static SkippedParts& skipped = *new SkippedParts;
    Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0)
        ->attachStream(&skipped, Assimp::Logger::Warn | Assimp::Logger::Err);
    const aiScene* const found = importer.ReadFile(path, 0);
    if (!found && importer.GetException()) std::rethrow_exception(importer.GetException());
    const bool is_known = importer.IsExtensionSupported(std::filesystem::path(path).extension());
    if (!found && !is_known) {
        throw std::runtime_error(
            "has an unsupported format. Export the mesh as OBJ, STL, PLY, OFF, glTF or 3MF");
    }
    if (!found) throw std::runtime_error(importer.GetErrorString());
    if (!skipped.first().empty()) {
        throw std::runtime_error("a part of it cannot be read: " + skipped.first());
    }

    Scene scene;
    for (unsigned i = 0; i < found->mNumMeshes; ++i) {
        scene.meshes.push_back(to_mesh(*found->mMeshes[i]));
        scene.unposed_meshes += is_unposed(*found->mMeshes[i]) ? 1 : 0;
    }
    scene.nodes = to_nodes(found->mRootNode);
    for (unsigned i = 0; i < found->mNumMaterials; ++i) {
        aiString name;
        found->mMaterials[i]->Get(AI_MATKEY_NAME, name);
        scene.materials.emplace_back(text_of(name));
    }
    if (found->mMetaData) describe_space(*found->mMetaData, scene);
    return scene;
}

}  // namespace cdprep::import
