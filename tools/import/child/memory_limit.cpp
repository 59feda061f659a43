// SPDX-License-Identifier: GPL-3.0-or-later
#include "memory_limit.h"

#include <sys/resource.h>

#include <algorithm>

#include "import/scene_bytes.h"

namespace cdprep::import {
namespace {

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

}  // namespace

bool set_memory_limit(std::uint64_t bytes) {
    rlimit now{};
    if (!kLimitMemory) return true;
    if (::getrlimit(RLIMIT_AS, &now) != 0) return false;
    // A lower limit stays: a process cannot raise it.
    const rlim_t most = std::min<rlim_t>(bytes, now.rlim_max);
    const rlimit limit{std::min<rlim_t>(most, honest_memory(0)), most};
    return ::setrlimit(RLIMIT_AS, &limit) == 0;
}

void allow_memory_for(std::uint64_t input_bytes) {
    rlimit limit{};
    if (!kLimitMemory || ::getrlimit(RLIMIT_AS, &limit) != 0) return;
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, honest_memory(input_bytes));
    ::setrlimit(RLIMIT_AS, &limit);
}

}  // namespace cdprep::import
