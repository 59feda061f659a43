// SPDX-License-Identifier: GPL-3.0-or-later
// The importing child: reads one file by assimp, under limits, and writes what it
// found to descriptor 3 (scene_bytes.h). Started by assimp_child.cpp only:
//
//     cdprep-import-child PATH MEMORY_BYTES CPU_SECONDS
#include <assimp/config.h>
#include <assimp/scene.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <assimp/Importer.hpp>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cdprep/format/file_header.h"
#include "folder_files.h"
#include "import/scene_bytes.h"

namespace cdprep::import {
namespace {

constexpr int kResult = 3;  // the parent's descriptor
constexpr int kExitWritten = 0;
constexpr int kExitUnwritten = 1;

// Address sanitizers reserve terabytes, so their builds run without the limit.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitMemory = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kLimitMemory = false;
#else
constexpr bool kLimitMemory = true;
#endif
#else
constexpr bool kLimitMemory = true;
#endif

bool set_limit(int resource, std::uint64_t value) {
    rlimit limit{value, value};
    return ::setrlimit(static_cast<__rlimit_resource_t>(resource), &limit) == 0;
}

bool set_limits(std::uint64_t memory_bytes, std::uint64_t cpu_seconds) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // do not outlive the parent
    if (kLimitMemory && !set_limit(RLIMIT_AS, memory_bytes)) return false;
    return set_limit(RLIMIT_CPU, cpu_seconds) && set_limit(RLIMIT_CORE, 0) &&
           set_limit(RLIMIT_FSIZE, memory_bytes);
}

/// Writes arrays to the result, in pieces.
class ResultWriter {
public:
    template <class T>
    void add(std::span<const T> values) {
        const auto* bytes = reinterpret_cast<const char*>(values.data());
        for (std::size_t left = values.size_bytes(); left > 0;) {
            if (used_ == buffer_.size()) flush();
            const std::size_t count = std::min(left, buffer_.size() - used_);
            std::memcpy(buffer_.data() + used_, bytes, count);
            used_ += count;
            bytes += count;
            left -= count;
        }
    }

    template <class T>
    void add_one(const T& value) {
        add(std::span<const T>(&value, 1));
    }

    bool finish() {
        flush();
        return good_;
    }

private:
    void flush() {
        for (std::size_t done = 0; good_ && done < used_;) {
            const ssize_t wrote = ::write(kResult, buffer_.data() + done, used_ - done);
            good_ = wrote > 0;
            if (good_) done += static_cast<std::size_t>(wrote);
        }
        used_ = 0;
    }

    std::array<char, 65536> buffer_{};
    std::size_t used_ = 0;
    bool good_ = true;
};

std::string_view text_of(const aiString& text) {
    return {text.data, std::min<std::size_t>(text.length, sizeof text.data)};
}

/// The nodes in depth-first order, by hand: trees may be deeper than the stack.
struct NodeList {
    std::vector<const aiNode*> nodes;
    std::vector<std::uint32_t> parents;
};

NodeList list_nodes(const aiNode* root) {
    struct Pending {
        const aiNode* node;
        std::uint32_t parent;
    };
    NodeList list;
    std::vector<Pending> pending;
    if (root) pending.push_back({root, kNoParent});
    while (!pending.empty()) {
        const Pending top = pending.back();
        pending.pop_back();
        const auto number = static_cast<std::uint32_t>(list.nodes.size());
        list.nodes.push_back(top.node);
        list.parents.push_back(top.parent);
        for (unsigned i = top.node->mNumChildren; i-- > 0;) {
            pending.push_back({top.node->mChildren[i], number});
        }
    }
    return list;
}

/// Units and up axis where assimp tells them: FBX and glTF.
void describe_space(const aiScene& scene, SceneHeader& header) {
    constexpr double kMetresPerCentimetre = 0.01;
    if (!scene.mMetaData) return;
    float factor = 0;
    double exact_factor = 0;
    if (scene.mMetaData->Get("UnitScaleFactor", exact_factor) && exact_factor > 0) {
        header.metres_per_unit = exact_factor * kMetresPerCentimetre;
    } else if (scene.mMetaData->Get("UnitScaleFactor", factor) && factor > 0) {
        header.metres_per_unit = static_cast<double>(factor) * kMetresPerCentimetre;
    }
    std::int32_t axis = 0;
    if (scene.mMetaData->Get("UpAxis", axis) && axis >= 0 && axis <= 2) {
        header.up_axis = static_cast<std::uint32_t>(axis) + 1;  // format::UpAxis::x is 1
    }
    aiString importer;
    if (scene.mMetaData->Get("SourceAsset_Format", importer) &&
        text_of(importer).starts_with("glTF2")) {
        header.metres_per_unit = 1;  // glTF says so
        header.up_axis = static_cast<std::uint32_t>(format::UpAxis::y);
    }
}

SceneMesh describe(const aiMesh& mesh) {
    SceneMesh result{};
    result.vertex_count = mesh.HasPositions() ? mesh.mNumVertices : 0;
    result.face_count = mesh.mFaces ? mesh.mNumFaces : 0;
    for (std::uint64_t i = 0; i < result.face_count; ++i) {
        result.corner_count += mesh.mFaces[i].mNumIndices;
    }
    result.material = mesh.mMaterialIndex;
    return result;
}

/// Writes a scene array by array.
class SceneWriter {
public:
    SceneWriter(const aiScene& scene, std::uint64_t input_bytes)
        : meshes_(scene.mMeshes, scene.mNumMeshes), list_(list_nodes(scene.mRootNode)) {
        for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
            aiString name;
            scene.mMaterials[i]->Get(AI_MATKEY_NAME, name);
            materials_.emplace_back(text_of(name));
        }
        header_.magic = kSceneMagic;
        header_.outcome = SceneOutcome::read;
        header_.input_bytes = input_bytes;
        describe_space(scene, header_);
    }

    bool write() {
        count();
        writer_.add_one(header_);
        for (const aiMesh* mesh : meshes_) writer_.add_one(describe(*mesh));
        write_nodes();
        for (const std::string& name : materials_) {
            writer_.add_one(static_cast<std::uint32_t>(name.size()));
        }
        write_geometry();
        for (const aiNode* node : list_.nodes) {
            writer_.add(std::span<const char>(text_of(node->mName)));
        }
        for (const std::string& name : materials_) writer_.add(std::span<const char>(name));
        return writer_.finish();
    }

private:
    void count() {
        header_.mesh_count = meshes_.size();
        header_.node_count = list_.nodes.size();
        header_.material_count = materials_.size();
        for (const aiMesh* mesh : meshes_) {
            const SceneMesh counts = describe(*mesh);
            header_.vertex_count += counts.vertex_count;
            header_.face_count += counts.face_count;
            header_.corner_count += counts.corner_count;
        }
        for (const aiNode* node : list_.nodes) {
            header_.node_mesh_count += node->mNumMeshes;
            header_.text_bytes += text_of(node->mName).size();
        }
        for (const std::string& name : materials_) header_.text_bytes += name.size();
    }

    void write_nodes() {
        for (std::size_t i = 0; i < list_.nodes.size(); ++i) {
            const aiNode& node = *list_.nodes[i];
            SceneNode result{};
            for (unsigned row = 0; row < 4; ++row) {
                for (unsigned column = 0; column < 4; ++column) {
                    result.parent_from_node[4 * row + column] = node.mTransformation[row][column];
                }
            }
            result.parent = list_.parents[i];
            result.mesh_count = node.mNumMeshes;
            result.name_bytes = static_cast<std::uint32_t>(text_of(node.mName).size());
            writer_.add_one(result);
        }
        for (const aiNode* node : list_.nodes) {
            writer_.add(std::span<const std::uint32_t>(node->mMeshes, node->mNumMeshes));
        }
    }

    void write_geometry() {
        for (const aiMesh* mesh : meshes_) {
            for (std::uint64_t i = 0; i < describe(*mesh).vertex_count; ++i) {
                const aiVector3D& p = mesh->mVertices[i];
                writer_.add_one(std::array<float, 3>{p.x, p.y, p.z});
            }
        }
        for (const aiMesh* mesh : meshes_) {
            for (std::uint64_t i = 0; i < describe(*mesh).face_count; ++i) {
                writer_.add_one(std::uint32_t{mesh->mFaces[i].mNumIndices});
            }
        }
        for (const aiMesh* mesh : meshes_) {
            for (std::uint64_t i = 0; i < describe(*mesh).face_count; ++i) {
                const aiFace& face = mesh->mFaces[i];
                writer_.add(std::span<const std::uint32_t>(face.mIndices, face.mNumIndices));
            }
        }
    }

    std::span<aiMesh* const> meshes_;
    NodeList list_;
    std::vector<std::string> materials_;
    SceneHeader header_{};
    ResultWriter writer_;
};

bool write_failure(SceneOutcome outcome, std::string_view why, std::uint64_t input_bytes) {
    SceneHeader header{};
    header.magic = kSceneMagic;
    header.outcome = outcome;
    header.input_bytes = input_bytes;
    header.text_bytes = why.size();
    ResultWriter writer;
    writer.add_one(header);
    writer.add(std::span<const char>(why));
    return writer.finish();
}

bool import_scene(const std::string& path) {
    std::uint64_t input_bytes = 0;
    try {
        Assimp::Importer importer;
        importer.SetIOHandler(new FolderFiles(path, input_bytes));  // the importer owns it
        importer.SetPropertyInteger(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, 1);
        importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, false);
        const aiScene* const scene = importer.ReadFile(path, 0);
        if (scene) return SceneWriter(*scene, input_bytes).write();
        if (importer.GetException()) std::rethrow_exception(importer.GetException());
        return write_failure(SceneOutcome::unreadable, importer.GetErrorString(), input_bytes);
    } catch (const std::bad_alloc&) {
        return write_failure(SceneOutcome::out_of_memory, "", input_bytes);
    } catch (const std::exception& problem) {
        return write_failure(SceneOutcome::unreadable, problem.what(), input_bytes);
    }
}

}  // namespace
}  // namespace cdprep::import

int main(int count, char** arguments) {
    using namespace cdprep::import;
    constexpr int kArguments = 4;
    if (count != kArguments) return kExitUnwritten;
    const std::uint64_t memory_bytes = std::strtoull(arguments[2], nullptr, 10);
    const std::uint64_t cpu_seconds = std::strtoull(arguments[3], nullptr, 10);
    if (!set_limits(memory_bytes, cpu_seconds)) return kExitUnwritten;
    // Without destructors: a hostile scene may be too deep to take apart.
    std::_Exit(import_scene(arguments[1]) ? kExitWritten : kExitUnwritten);
}
