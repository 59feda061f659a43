// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

namespace cdprep::mesh {

/// Asked now and then during long work: true gives it up, and is true from then on. Empty
/// never does. May be called from several threads at once; must not throw.
using StopCheck = std::function<bool()>;

[[nodiscard]] inline bool is_stopped(const StopCheck& stop) {
    return stop && stop();
}

}  // namespace cdprep::mesh
