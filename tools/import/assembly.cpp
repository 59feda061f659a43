// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/assembly.h"

#include <exception>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "import/assimp_child.h"
#include "import/file_kind.h"

namespace cdprep::import {

struct Assembly::Content {
    SourceFile file;
    ChildResult result;  ///< of the file
    ImportOptions options;
    std::optional<PlacedScene> scene = std::nullopt;  ///< refers to the members above
    std::vector<MeshNode> nodes = {};
    mesh::TriangleSoup notes = {};  ///< no triangles: hashes, unit and axis of every soup
};

Assembly::Assembly(std::unique_ptr<const Content> content) noexcept
    : content_(std::move(content)) {}
Assembly::Assembly(Assembly&&) noexcept = default;
Assembly& Assembly::operator=(Assembly&&) noexcept = default;
Assembly::~Assembly() = default;

Result<Assembly> Assembly::open(const std::filesystem::path& path, const ImportOptions& options) {
    try {
        Result<SourceFile> file = SourceFile::open(path, options.file_bytes);
        if (!file) return file.error();
        if (const auto kind = find_other_kind(file->bytes(), path)) return file->unreadable(*kind);
        Result<ChildResult> result = read_in_child(*file, path, options);
        if (!result) return result.error();
        auto content = std::make_unique<Content>(
            Content{std::move(file).value(), std::move(result).value(), options});
        Result<PlacedScene> scene = PlacedScene::make(content->file, content->result.bytes());
        if (!scene) return scene.error();
        content->scene.emplace(std::move(scene).value());
        content->nodes = content->scene->mesh_nodes();
        if (content->nodes.empty()) return content->file.unreadable("has no node with triangles");
        Result<mesh::TriangleSoup> notes = content->scene->flatten_nodes({}, options);
        if (!notes) return notes.error();
        if (const auto error = note_files(content->file, path, options, *notes)) return *error;
        content->notes = std::move(notes).value();
        return Assembly(std::move(content));
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::over_budget,
                     path.string() + ": there is not enough memory to read it."};
    } catch (const std::exception& problem) {
        return Error{ErrorCode::internal,
                     path.string() + ": reading it failed: " + problem.what() + "."};
    }
}

std::span<const MeshNode> Assembly::nodes() const noexcept {
    return content_->nodes;
}

std::span<const Affine> Assembly::world_from_nodes() const noexcept {
    return content_->scene->world_from_nodes();
}

std::string Assembly::path_of(std::uint32_t number) const {
    return content_->scene->path_of(number);
}

std::span<const mesh::InputFile> Assembly::other_files() const noexcept {
    return content_->notes.other_files;
}

Result<mesh::TriangleSoup> Assembly::triangles(std::span<const PlacedNode> nodes) const {
    const ImportOptions& options = content_->options;
    Result<mesh::TriangleSoup> soup = content_->scene->flatten_nodes(nodes, options);
    if (!soup) return soup;
    soup->source_hash = content_->notes.source_hash;
    soup->other_files = content_->notes.other_files;
    if (options.metres_per_unit) soup->metres_per_unit = *options.metres_per_unit;
    if (options.up_axis) soup->up_axis = *options.up_axis;
    return soup;
}

}  // namespace cdprep::import
