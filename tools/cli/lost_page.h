// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace cdprep::cli {

/// Ends the program with one sentence and Exit::unreadable when a page of a mapped file can
/// not be read any more: somebody truncated the file, or its disk or network share failed.
/// The sentence names the file where the system tells which it is (Linux does). Nothing else is
/// done: outputs that are not complete keep their temporary names, and the next writer of the
/// same output removes them, as after a killed program. Every other SIGBUS ends the program as
/// if nobody watched.
void watch_for_lost_pages();

}  // namespace cdprep::cli
