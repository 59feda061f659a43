// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <string_view>

namespace cdprep::test {

/// Returns whether a test asks all that it can, as `tests/run --full` does.
inline bool asks_all() {
    const char* all = std::getenv("CDPREP_ALL_POSES");
    return all != nullptr && std::string_view(all) == "yes";
}

/// The number of rounds that a test does: by default a share of all.
inline int rounds(int all, int share) {
    return asks_all() ? all : all / share;
}

}  // namespace cdprep::test
