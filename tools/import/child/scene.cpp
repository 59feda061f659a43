// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene.h"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <span>

namespace cdprep::import {
namespace {

constexpr int kResult = 3;  // the parent's descriptor

/// Writes arrays to the result, by way of a buffer.
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

    void add_text(std::string_view text) {
        add(std::span<const char>(text));
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

SceneHeader describe(const Scene& scene, const InputFiles& files) {
    SceneHeader header{};
    header.magic = kSceneMagic;
    header.outcome = SceneOutcome::read;
    header.up_axis = static_cast<std::uint32_t>(scene.up_axis);
    header.metres_per_unit = scene.metres_per_unit;
    header.input_bytes = files.bytes();
    header.unposed_meshes = scene.unposed_meshes;
    header.weightless_vertices = scene.weightless_vertices;
    header.mesh_count = scene.meshes.size();
    header.node_count = scene.nodes.size();
    header.material_count = scene.materials.size();
    for (const Scene::Mesh& mesh : scene.meshes) {
        header.vertex_count += mesh.vertices.size();
        header.face_count += mesh.sizes.size();
        header.corner_count += mesh.corners.size();
    }
    for (const Scene::Node& node : scene.nodes) {
        header.node_mesh_count += node.meshes.size();
        header.text_bytes += node.name.size();
    }
    for (const std::string& name : scene.materials) header.text_bytes += name.size();
    header.file_count = files.opened().size();
    for (const std::string& name : files.opened()) header.text_bytes += name.size();
    return header;
}

}  // namespace

bool write_scene(const Scene& scene, const InputFiles& files) {
    ResultWriter writer;
    writer.add_one(describe(scene, files));
    for (const Scene::Mesh& mesh : scene.meshes) {
        writer.add_one(SceneMesh{mesh.vertices.size(), mesh.sizes.size(), mesh.corners.size(),
                                 mesh.material, mesh.is_single ? 1U : 0U});
    }
    for (const Scene::Node& node : scene.nodes) {
        writer.add_one(SceneNode{
            node.parent_from_node, node.parent, static_cast<std::uint32_t>(node.meshes.size()),
            static_cast<std::uint32_t>(node.name.size()), node.is_posed ? 1U : 0U});
    }
    for (const Scene::Node& node : scene.nodes) writer.add(std::span(node.meshes));
    for (const std::string& name : scene.materials) {
        writer.add_one(static_cast<std::uint32_t>(name.size()));
    }
    for (const std::string& name : files.opened()) {
        writer.add_one(static_cast<std::uint32_t>(name.size()));
    }
    for (const Scene::Mesh& mesh : scene.meshes) writer.add(std::span(mesh.vertices));
    for (const Scene::Mesh& mesh : scene.meshes) writer.add(std::span(mesh.sizes));
    for (const Scene::Mesh& mesh : scene.meshes) writer.add(std::span(mesh.corners));
    for (const Scene::Node& node : scene.nodes) writer.add_text(node.name);
    for (const std::string& name : scene.materials) writer.add_text(name);
    for (const std::string& name : files.opened()) writer.add_text(name);
    return writer.finish();
}

bool write_failure(SceneOutcome outcome, std::string_view why, const InputFiles& files) {
    SceneHeader header{};
    header.magic = kSceneMagic;
    header.outcome = outcome;
    header.input_bytes = files.bytes();
    header.text_bytes = why.size();
    ResultWriter writer;
    writer.add_one(header);
    writer.add_text(why);
    return writer.finish();
}

}  // namespace cdprep::import
