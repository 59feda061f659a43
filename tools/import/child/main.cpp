// SPDX-License-Identifier: GPL-3.0-or-later
// The importing child: reads one file under limits and writes what it found to
// descriptor 3 (scene_bytes.h). Started by assimp_child.cpp only:
//
//     cdprep-import-child PATH MEMORY_BYTES CPU_SECONDS
#include <sys/prctl.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string>

#include "cdprep/format/float_environment.h"
#include "read_assimp.h"
#include "read_gltf.h"
#include "scene.h"

namespace cdprep::import {
namespace {

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

bool set_limit(__rlimit_resource_t resource, std::uint64_t value) {
    const rlimit limit{value, value};
    return ::setrlimit(resource, &limit) == 0;
}

bool set_limits(std::uint64_t memory_bytes, std::uint64_t cpu_seconds) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // do not outlive the parent
    if (kLimitMemory && !set_limit(RLIMIT_AS, memory_bytes)) return false;
    return set_limit(RLIMIT_CPU, cpu_seconds) && set_limit(RLIMIT_CORE, 0) &&
           set_limit(RLIMIT_FSIZE, memory_bytes);
}

bool import_scene(const std::string& path) {
    std::uint64_t input_bytes = 0;
    try {
        if (const std::optional<Scene> scene = read_gltf(path, input_bytes)) {
            return write_scene(*scene, input_bytes);
        }
        return write_scene(read_assimp(path, input_bytes), input_bytes);
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
    const cdprep::format::FloatEnvironment environment;
    constexpr int kArguments = 4;
    if (count != kArguments) return kExitUnwritten;
    const std::uint64_t memory_bytes = std::strtoull(arguments[2], nullptr, 10);
    const std::uint64_t cpu_seconds = std::strtoull(arguments[3], nullptr, 10);
    if (!set_limits(memory_bytes, cpu_seconds)) return kExitUnwritten;
    return import_scene(arguments[1]) ? kExitWritten : kExitUnwritten;
}
