// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "bake/bake_options.h"
#include "mesh/mesh.h"

namespace cdprep::cli {

/// The origin of a baked file: everything that decides its bytes, and nothing else. It has no
/// time, no host, and no path except those by which the input refers to other files. Canonical
/// JSON: sorted keys, no blanks, shortest numbers.
[[nodiscard]] std::string provenance_json(const BakeOptions& options,
                                          const mesh::TriangleSoup& soup);

}  // namespace cdprep::cli
