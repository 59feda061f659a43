// SPDX-License-Identifier: MIT
// Writes the two models that `answers` asks: a ball and a ring, with hulls.
//
// Usage: write_models BALL RING
#include <fstream>

#include "support/more_sections.h"
#include "support/open_tiny.h"

namespace {

bool write(const char* path, const cdprep::test::TestMesh& mesh) {
    using namespace cdprep::test;
    const AlignedBytes file =
        with_hulls(bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true}));
    std::ofstream out(path, std::ios::binary);
    const auto bytes = file.span();
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    return static_cast<bool>(out.flush());
}

}  // namespace

int main(int count, char** paths) {
    if (count != 3) return 2;
    return write(paths[1], cdprep::test::icosphere(2)) &&
                   write(paths[2], cdprep::test::torus(1, 0.25, 24, 12))
               ? 0
               : 1;
}
