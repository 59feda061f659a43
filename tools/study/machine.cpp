// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/machine.h"

#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "cdprep/advanced/query_counts.h"

namespace cdprep::study {
namespace {

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("model name")) continue;
        const std::size_t colon = line.find(": ");
        if (colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown";
}

std::size_t usable_processors() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
    return static_cast<std::size_t>(CPU_COUNT(&set));
}

std::string compiler_name() {
#ifdef __clang__
    return "clang " __clang_version__;
#else
    return "gcc " __VERSION__;
#endif
}

std::uint64_t positive(long value) {
    return static_cast<std::uint64_t>(std::max(0L, value));
}

std::string system_name() {
    utsname name{};
    if (uname(&name) != 0) return "unknown";
    return std::string(name.sysname) + " " + name.release + " " + name.machine;
}

}  // namespace

Machine describe_machine() {
    Machine machine;
    machine.processor = processor_name();
    machine.processors = usable_processors();
    machine.memory = positive(sysconf(_SC_PHYS_PAGES)) * positive(sysconf(_SC_PAGESIZE));
    machine.last_cache = std::max(positive(sysconf(_SC_LEVEL3_CACHE_SIZE)),
                                  positive(sysconf(_SC_LEVEL2_CACHE_SIZE)));
    machine.system = system_name();
    machine.compiler = compiler_name();
    machine.build = CDPREP_BUILD_TYPE;
    machine.kernels = kernel_name();
    return machine;
}

}  // namespace cdprep::study
