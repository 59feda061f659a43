// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "cdprep/result.h"
#include "compare/peer_answers.h"

namespace cdprep::report {

/// Reads what the program of peers printed. Fails with `unreadable`, in a sentence, when it is
/// not what tests/bench/peers.cpp says, whatever it is.
[[nodiscard]] Result<study::PeerRun> read_peers(std::string_view json);

}  // namespace cdprep::report
