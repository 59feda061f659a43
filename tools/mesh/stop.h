// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

namespace cdprep::mesh {

/// A function that long work calls from time to time. If it returns true, the work ends; it then
/// returns true forever. An empty function never ends the work. Several threads may call it at
/// once; it must not throw.
using StopCheck = std::function<bool()>;

[[nodiscard]] inline bool is_stopped(const StopCheck& stop) {
    return stop && stop();
}

}  // namespace cdprep::mesh
