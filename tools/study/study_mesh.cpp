// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/study_mesh.h"

#include <span>
#include <utility>

#include "mesh/normalize.h"
#include "mesh/weld.h"

namespace cdprep::study {
namespace {

template <class Mesh>
std::uint64_t hash_of(const Mesh& mesh) {
    return geometry_hash(std::as_bytes(std::span(mesh.positions)),
                         std::as_bytes(std::span(mesh.triangles)));
}

}  // namespace

StudyMesh make_study_mesh(std::string name, std::filesystem::path file, mesh::TriangleSoup soup) {
    StudyMesh made;
    made.name = std::move(name);
    made.file = std::move(file);
    made.read_vertices = soup.positions.size();
    made.read_triangles = soup.triangles.size();
    made.read_hash = hash_of(soup);
    made.likeness = find_likeness(made.read_vertices, made.read_triangles, made.read_hash);
    made.normalize_factor = mesh::normalize(soup).factor;
    made.mesh = mesh::weld(soup).mesh;
    made.built_hash = hash_of(made.mesh);
    return made;
}

}  // namespace cdprep::study
