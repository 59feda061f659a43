// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_file/bake_cache.h"

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include "bake/pipeline.h"
#include "bake/provenance.h"
#include "cdprep/format/checksum.h"
#include "cdprep/model.h"
#include "import/source_file.h"
#include "text/json_layout.h"
#include "text/number_text.h"

namespace cdprep::scenes {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::uint64_t hash_of(std::string_view bytes) {
    return format::checksum(std::as_bytes(std::span(bytes)));
}

}  // namespace

BakeCache::BakeCache(fs::path folder) : folder_(std::move(folder)) {}

Result<std::uint64_t> BakeCache::hash_of_file(const fs::path& path, std::uint64_t max_bytes) {
    if (const auto known = hashes_.find(path); known != hashes_.end()) return known->second;
    const auto file = import::SourceFile::open(path, max_bytes);
    if (!file) return file.error();
    return hashes_[path] = hash_of(file->bytes());
}

/// Returns whether a baked file comes from the mesh, and from the other files as they are now.
/// `origin` is the provenance of the mesh without other files.
bool BakeCache::is_bake_of(const fs::path& baked, const fs::path& mesh, const std::string& origin,
                           std::uint64_t max_bytes) {
    const Result<Model> opened = Model::open(baked);  // damage anywhere: bake again
    if (!opened) return false;
    Json found = report::parsed<Json>(opened->record().provenance);
    if (!found.is_object() || !found.contains("source") || !found["source"].is_object()) {
        return false;
    }
    const Json files = found["source"].value("files", Json::array());
    found["source"].erase("files");
    if (found.dump() != origin) return false;
    for (const Json& file : files) {
        const auto is_text = [&](const char* key) {
            return file.contains(key) && file[key].is_string();
        };
        if (!file.is_object() || !is_text("name") || !is_text("xxh3_64")) return false;
        const auto hash =
            hash_of_file(mesh.parent_path() / file["name"].get<std::string>(), max_bytes);
        if (!hash || report::hexadecimal(*hash) != file["xxh3_64"]) return false;
    }
    return true;
}

Result<fs::path> BakeCache::find_or_bake(const fs::path& mesh, const cli::BakeOptions& options,
                                         const cli::Threads& threads,
                                         const std::function<void(const char*)>& begins) {
    std::error_code failure;
    fs::create_directories(folder_, failure);
    if (failure) {
        return Error{ErrorCode::unwritable,
                     folder_.string() + ": cannot be created: " + failure.message() + "."};
    }
    const auto hash = hash_of_file(mesh, options.import.file_bytes);
    if (!hash) return hash.error();
    mesh::TriangleSoup soup;
    soup.source_hash = *hash;
    const std::string origin = cli::provenance_json(options, soup);
    const fs::path baked =
        folder_ / (mesh.stem().string() + "-" + report::hexadecimal(hash_of(origin)) + ".cdp.h5");
    if (is_bake_of(baked, mesh, origin, options.import.file_bytes)) return baked;
    const auto done = cli::bake(mesh, baked, options, threads, begins);
    if (!done) return done.error();
    return baked;
}

}  // namespace cdprep::scenes
