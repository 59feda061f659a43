// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/import_file.h"

#include <exception>
#include <new>
#include <optional>
#include <span>
#include <string>

#include "cdprep/format/checksum.h"
#include "import/assimp_child.h"
#include "import/file_kind.h"
#include "import/readers.h"
#include "import/source_file.h"
#include "mesh/half_edges.h"

namespace cdprep::import {
namespace {

Result<mesh::TriangleSoup> read(const SourceFile& file, const std::filesystem::path& path,
                                const ImportOptions& options) {
    switch (sniff_format(file.bytes(), path)) {
        case MeshFormat::obj:
            return read_obj(file, options);
        case MeshFormat::stl:
            return read_stl(file, options);
        case MeshFormat::ply:
            return read_ply(file, options);
        case MeshFormat::off:
            return read_off(file, options);
        case MeshFormat::other:
            break;
    }
    return import_in_child(file, path, options);
}

std::uint64_t hash_of(const SourceFile& file) {
    return format::checksum(std::as_bytes(std::span(file.bytes())));
}

Error empty(const SourceFile& file, const mesh::TriangleSoup& soup) {
    const std::size_t points = soup.positions.size();
    return file.unreadable("has no triangles" +
                           (points == 0   ? std::string(" and no vertices")
                            : points == 1 ? std::string(", only 1 vertex")
                                          : ", only " + std::to_string(points) + " vertices") +
                           ". Check the file, or give --allow-empty to accept it");
}

Error too_many(const SourceFile& file, std::size_t triangles) {
    return file.over_budget("has " + std::to_string(triangles) + " triangles; at most " +
                            std::to_string(mesh::kMostMeshTriangles) + " are allowed");
}

}  // namespace

std::optional<Error> note_files(const SourceFile& file, const std::filesystem::path& path,
                                const ImportOptions& options, mesh::TriangleSoup& soup) {
    soup.source_hash = hash_of(file);
    for (mesh::InputFile& other : soup.other_files) {
        const std::filesystem::path name = path.parent_path() / other.name;
        if (options.find_conflict) {
            if (auto conflict = options.find_conflict(name)) return conflict;
        }
        const Result<SourceFile> opened = SourceFile::open(name, options.file_bytes);
        if (!opened) return opened.error();
        other.hash = hash_of(*opened);
    }
    return std::nullopt;
}

Result<mesh::TriangleSoup> import_file(const std::filesystem::path& path,
                                       const ImportOptions& options) {
    try {
        const Result<SourceFile> opened = SourceFile::open(path, options.file_bytes);
        if (!opened) return opened.error();
        const SourceFile& file = opened.value();
        if (const auto kind = find_other_kind(file.bytes(), path)) return file.unreadable(*kind);
        Result<mesh::TriangleSoup> soup = read(file, path, options);
        if (!soup) return soup;
        // First of all: a report about an empty file must not replace a file that it refers to.
        if (const auto error = note_files(file, path, options, *soup)) return *error;
        if (soup->triangles.empty() && !options.allow_empty) return empty(file, *soup);
        if (soup->triangles.size() > mesh::kMostMeshTriangles) {
            return too_many(file, soup->triangles.size());
        }
        if (options.metres_per_unit) soup->metres_per_unit = *options.metres_per_unit;
        if (options.up_axis) soup->up_axis = *options.up_axis;
        return soup;
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::over_budget,
                     path.string() + ": there is not enough memory to read it."};
    } catch (const std::exception& problem) {
        return Error{ErrorCode::internal,
                     path.string() + ": reading it failed: " + problem.what() + "."};
    }
}

}  // namespace cdprep::import
