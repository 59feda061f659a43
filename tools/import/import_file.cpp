// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/import_file.h"

#include <exception>
#include <new>
#include <string>

#include "import/assimp_child.h"
#include "import/read_obj.h"
#include "import/read_off.h"
#include "import/read_ply.h"
#include "import/read_stl.h"
#include "import/sniff_format.h"
#include "import/source_file.h"

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

}  // namespace

Result<mesh::TriangleSoup> import_file(const std::filesystem::path& path,
                                       const ImportOptions& options) {
    try {
        const Result<SourceFile> file = SourceFile::open(path, options.file_bytes);
        if (!file) return file.error();
        return read(file.value(), path, options);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::over_budget,
                     path.string() + ": there is not enough memory to read it."};
    } catch (const std::exception& problem) {
        return Error{ErrorCode::internal,
                     path.string() + ": reading it failed: " + problem.what() + "."};
    }
}

}  // namespace cdprep::import
