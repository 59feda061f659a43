// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <string_view>

namespace cdprep::test {

/// Returns whether long tests run in full: CDPREP_ALL_POSES=yes.
inline bool runs_all_poses() {
    const char* const all = std::getenv("CDPREP_ALL_POSES");
    return all != nullptr && std::string_view(all) == "yes";
}

}  // namespace cdprep::test
