// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace cdprep::test {

/// Returns whether a test asks all that it can, as `tests/run --full` does.
inline bool asks_all() {
    const char* all = std::getenv("CDPREP_ALL_POSES");
    return all != nullptr && std::string_view(all) == "yes";
}

/// A program with sanitizers does so many times fewer rounds, for it looks at memory and threads.
/// Whether answers are right is seen without sanitizers.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr int kSlowdown = 5;
#else
inline constexpr int kSlowdown = 1;
#endif

/// The number of rounds that a test does, at least one: by default a share of all.
inline int rounds(int all, int share) {
    return std::max(1, (asks_all() ? all : all / share) / kSlowdown);
}

}  // namespace cdprep::test
