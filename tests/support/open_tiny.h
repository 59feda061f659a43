// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "support/meshes.h"
#include "support/tiny_baker.h"

#include "cdprep/model.h"

namespace cdprep::test {

/// A model and the bytes that hold it.
struct OpenModel {
    AlignedBytes bytes;
    Model model;
};

/// Opens a file in memory. Ends the test program on failure.
inline OpenModel open_tiny(AlignedBytes bytes) {
    Result<Model> opened = Model::open(std::as_const(bytes).span());
    if (!opened) {
        std::fprintf(stderr, "%s\n", opened.error().message.c_str());
        std::abort();
    }
    return {std::move(bytes), std::move(opened).value()};
}

/// Bakes and opens a mesh.
inline OpenModel open_tiny(std::span<const Double3> positions, std::span<const Triangle> triangles,
                           const TinyOptions& options = {}) {
    return open_tiny(bake_tiny(positions, triangles, options));
}

inline OpenModel open_tiny(const TestMesh& mesh, const TinyOptions& options = {}) {
    return open_tiny(mesh.positions, mesh.triangles, options);
}

}  // namespace cdprep::test
