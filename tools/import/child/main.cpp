// SPDX-License-Identifier: GPL-3.0-or-later
// The importing child: reads one file under limits and writes the scene to descriptor 3
// (scene_bytes.h). Only assimp_child.cpp starts it:
//
//     cdprep-import-child PATH MEMORY_BYTES CPU_SECONDS
#include <sys/prctl.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string>

#include "cdprep/format/float_environment.h"
#include "input_files.h"
#include "memory_limit.h"
#include "readers.h"
#include "scene.h"

namespace cdprep::import {
namespace {

constexpr int kExitWritten = 0;
constexpr int kExitUnwritten = 1;

/// Lowers a limit. Keeps a lower one, which a process cannot raise.
bool set_limit(__rlimit_resource_t resource, std::uint64_t value) {
    rlimit now{};
    if (::getrlimit(resource, &now) != 0) return false;
    const rlim_t least = std::min<rlim_t>(value, now.rlim_max);
    const rlimit limit{least, least};
    return ::setrlimit(resource, &limit) == 0;
}

bool set_limits(std::uint64_t memory_bytes, std::uint64_t cpu_seconds) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // do not outlive the parent
    if (!set_memory_limit(memory_bytes)) return false;
    return set_limit(RLIMIT_CPU, cpu_seconds) && set_limit(RLIMIT_CORE, 0) &&
           set_limit(RLIMIT_FSIZE, memory_bytes);
}

Scene read_scene(const std::string& path, InputFiles& files) {
    if (is_3mf(path)) return read_3mf(path, files);
    if (std::optional<Scene> scene = read_gltf(path, files)) return *std::move(scene);
    return read_assimp(path, files);
}

bool import_scene(const std::string& path) {
    InputFiles files(path);
    try {
        const Scene scene = read_scene(path, files);
        const std::string missing = files.missing_meshes();
        if (missing.empty()) return write_scene(scene, files);
        return write_failure(
            SceneOutcome::unreadable,
            "needs " + missing + ", which cannot be read from the same folder. Put it there",
            files);
    } catch (const std::bad_alloc&) {
        return write_failure(SceneOutcome::out_of_memory, "", files);
    } catch (const std::exception& problem) {
        return write_failure(SceneOutcome::unreadable, problem.what(), files);
    }
}

}  // namespace
}  // namespace cdprep::import

int main(int count, char** arguments) {
    using namespace cdprep::import;
    const cdprep::format::FloatEnvironment environment;
    constexpr int kArguments = 4;
    if (count != kArguments) return kExitUnwritten;
    const std::uint64_t memory_bytes = std::strtoull(arguments[2], nullptr, 10);
    const std::uint64_t cpu_seconds = std::strtoull(arguments[3], nullptr, 10);
    if (!set_limits(memory_bytes, cpu_seconds)) return kExitUnwritten;
    return import_scene(arguments[1]) ? kExitWritten : kExitUnwritten;
}
