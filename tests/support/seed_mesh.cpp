// SPDX-License-Identifier: MIT
#include "support/seed_mesh.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "support/shared_models.h"

namespace cdprep::test {
namespace {

/// Used vertices' box, in double, as the pipeline's normalisation has it.
void normalise(TestMesh& mesh) {
    Double3 low = mesh.positions[mesh.triangles[0].vertex[0]], high = low;
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t.vertex) {
            const Double3& p = mesh.positions[v];
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
    }
    const Double3 size = {high.x - low.x, high.y - low.y, high.z - low.z};
    const double diagonal = std::sqrt(size.x * size.x + size.y * size.y + size.z * size.z);
    for (Double3& p : mesh.positions) {
        p = {(p.x - 0.5 * (low.x + high.x)) / diagonal, (p.y - 0.5 * (low.y + high.y)) / diagonal,
             (p.z - 0.5 * (low.z + high.z)) / diagonal};
    }
    mesh = in_floats(std::move(mesh));
}

}  // namespace

std::optional<TestMesh> seed_mesh_as_read(const std::string& name) {
    const auto folder = shared_models("seed");
    if (!folder) return std::nullopt;
    std::ifstream file(*folder / "seed" / (name + ".ply"), std::ios::binary);
    std::size_t vertices = 0, faces = 0;
    for (std::string line; std::getline(file, line) && line != "end_header";) {
        if (line.starts_with("element vertex ")) vertices = std::stoul(line.substr(15));
        if (line.starts_with("element face ")) faces = std::stoul(line.substr(13));
    }
    TestMesh mesh;
    for (std::size_t i = 0; i < vertices && file; ++i) {
        float p[3];
        file.read(reinterpret_cast<char*>(p), sizeof p);
        mesh.positions.push_back({p[0], p[1], p[2]});
    }
    for (std::size_t i = 0; i < faces && file; ++i) {
        Triangle t{};
        file.get();  // 3
        file.read(reinterpret_cast<char*>(t.vertex.data()), sizeof t.vertex);
        mesh.triangles.push_back(t);
    }
    if (!file || mesh.triangles.empty()) return std::nullopt;
    return mesh;
}

std::optional<TestMesh> seed_mesh(const std::string& name) {
    std::optional<TestMesh> mesh = seed_mesh_as_read(name);
    if (mesh) normalise(*mesh);
    return mesh;
}

}  // namespace cdprep::test
