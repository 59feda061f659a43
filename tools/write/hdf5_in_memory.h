// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <hdf5.h>

#include "write/sparse_memory.h"

namespace cdprep::write {

/// Lets files that are made or opened with the file access list `access` live in
/// `memory`, whatever their name. `memory` outlives the open file.
///
/// HDF5 1.10 cannot close a file whose disk is full: it keeps the file as if it
/// were open and crashes when the program ends. What lives in memory never meets
/// a disk, and datasets that are allocated but not written take no room, which
/// its own memory driver does not manage.
[[nodiscard]] bool keep_in_memory(hid_t access, SparseMemory& memory);

}  // namespace cdprep::write
