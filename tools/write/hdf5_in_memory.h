// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <hdf5.h>

#include "write/sparse_memory.h"

namespace cdprep::write {

/// Stores files that are created or opened with the file access list `access` in `memory`,
/// whatever their name. `memory` must outlive the open file.
///
/// HDF5 1.10 cannot close a file on a full disk: it treats the file as open and crashes when
/// the program ends. A file in memory avoids the disk. Datasets that are allocated but not
/// written take no space; with the memory driver of HDF5 they would.
[[nodiscard]] bool keep_in_memory(hid_t access, SparseMemory& memory);

}  // namespace cdprep::write
