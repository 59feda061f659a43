// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/bake_cache.h"

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <system_error>

#include "bake/pipeline.h"
#include "bake/provenance.h"
#include "cdprep/format/checksum.h"
#include "cdprep/model.h"
#include "import/source_file.h"
#include "text/number_text.h"

namespace cdprep::scenes {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::uint64_t hash_of(std::string_view bytes) {
    return format::checksum(std::as_bytes(std::span(bytes)));
}

/// Returns whether the files that a mesh refers to are those that were read.
bool are_same(const Json& files, const fs::path& folder, std::uint64_t max_bytes) {
    for (const Json& file : files) {
        const auto is_text = [&](const char* key) {
            return file.contains(key) && file[key].is_string();
        };
        if (!file.is_object() || !is_text("name") || !is_text("xxh3_64")) return false;
        const auto found =
            import::SourceFile::open(folder / file["name"].get<std::string>(), max_bytes);
        if (!found || report::hexadecimal(hash_of(found->bytes())) != file["xxh3_64"]) return false;
    }
    return true;
}

/// Returns whether a baked file comes from the mesh. `origin` is the provenance of the mesh without
/// other files.
bool is_bake_of(const fs::path& baked, const fs::path& mesh, const std::string& origin,
                std::uint64_t max_bytes) {
    const Result<Model> opened = Model::open(baked);  // damage anywhere: bake again
    if (!opened) return false;
    Json found = Json::parse(opened->record().provenance, nullptr, false);
    if (!found.is_object() || !found.contains("source") || !found["source"].is_object()) {
        return false;
    }
    const Json files = found["source"].value("files", Json::array());
    found["source"].erase("files");
    return found.dump() == origin && are_same(files, mesh.parent_path(), max_bytes);
}

}  // namespace

Result<fs::path> find_or_bake(const fs::path& mesh, const fs::path& folder,
                              const cli::BakeOptions& options, const cli::Threads& threads,
                              const std::function<void(const char*)>& begins) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) {
        return Error{ErrorCode::unwritable,
                     folder.string() + ": cannot be created: " + failure.message() + "."};
    }
    const auto source = import::SourceFile::open(mesh, options.import.file_bytes);
    if (!source) return source.error();
    mesh::TriangleSoup soup;
    soup.source_hash = hash_of(source->bytes());
    const std::string origin = cli::provenance_json(options, soup);
    const fs::path baked =
        folder / (mesh.stem().string() + "-" + report::hexadecimal(hash_of(origin)) + ".cdp.h5");
    if (is_bake_of(baked, mesh, origin, options.import.file_bytes)) return baked;
    const auto done = cli::bake(mesh, baked, options, threads, begins);
    if (!done) return done.error();
    return baked;
}

}  // namespace cdprep::scenes
